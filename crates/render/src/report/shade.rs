//! Hits in the report's meaning, all of a batch at once: each coordinate lies in a row of its own, so that the loops
//! over them are vectorised.

use glam::Vec3;

use super::{Gathered, MAX_BOUNCES, Report, ReportLight, T_MIN, UNLIT};
use crate::clock::Stage;
use crate::geometry::simd::{self, Simd};
use crate::geometry::{Geometry, Hit, Ids, Ray, RayView, Rows, Scratch, Shape};
use crate::material::{Coat, Gloss, Material, Response};
use crate::math;
use crate::wave::{Batch, Path, Queues, RayKind};

/// One thread's room for the hits of a batch.
#[derive(Default)]
pub(crate) struct Room {
    pub position: Rows,
    /// Not of unit length for triangles and planes.
    pub normal: Rows,
    /// From the reference point of the texture, of unit length: see [`Report::reference`].
    pub outward: Rows,
    /// Of points of spheres over their centres, over their radii.
    pub heights: Vec<f32>,
    /// Whether all are points of spheres.
    pub round: bool,
    pub texture_points: Rows,
    pub colors: Vec<[f32; 3]>,
    ids: Ids,
    sight: Sight,
    /// Light from the lights.
    direct: Rows,
    blocked: Vec<bool>,
    scratch: Scratch,
}

/// A light as the points of a batch see it.
#[derive(Default)]
struct Sight {
    direction: Rows,
    /// Where rays towards the light end; before their beginning where nothing arrives.
    t_max: Vec<f32>,
    /// Between the light and the normal.
    cosine: Vec<f32>,
    /// What arrives if nothing is in the way.
    light: Rows,
}

impl Room {
    /// Positions, normals and directions of a batch.
    pub fn locate(&mut self, report: &Report, batch: &Batch<'_>) {
        let count = batch.members.len();
        self.position.resize(count);
        self.normal.resize(count);
        self.outward.resize(count);
        self.ids.resize(count);
        self.heights.resize(count, 0.0);
        let heights = &mut self.heights[..count];
        let (mut position, mut outward) = (self.position.slices_mut(count), self.outward.slices_mut(count));
        let (objects, indices) = (&mut self.ids.object[..count], &mut self.ids.index[..count]);
        let mut round = true;
        for (i, &member) in batch.members.iter().enumerate() {
            let member = member as usize;
            let p = batch.rays.origin.get(member) + batch.rays.direction.get(member) * batch.hits.t[member];
            put(&mut position, i, p);
            let id = batch.hits.id.get(member);
            (objects[i], indices[i]) = (id.object, id.index);
            let center = match batch.geometry.objects[id.object as usize].shape {
                Shape::Sphere { center, radius } => {
                    heights[i] = (p.y - center.y) / radius;
                    center
                }
                _ => {
                    round = false;
                    report.reference(batch.geometry, &batch.hits.get(member))
                }
            };
            put(&mut outward, i, p - center);
        }
        simd::run(Normalize { rows: &mut self.outward });
        self.round = round;
        if round {
            self.normal.clone_from(&self.outward);
            return;
        }
        for (i, &object) in self.ids.object.iter().enumerate() {
            let normal = match batch.geometry.objects[object as usize].shape {
                Shape::Sphere { .. } => self.outward.get(i),
                Shape::Plane(index) => report.plane_normals[index as usize],
                _ => facing_normal(batch.geometry, &batch.ray(i), &batch.hit(i)),
            };
            self.normal.set(i, normal);
        }
    }
}

/// Writes point `i` of three rows.
#[inline(always)]
fn put(rows: &mut [&mut [f32]; 3], i: usize, p: Vec3) {
    (rows[0][i], rows[1][i], rows[2][i]) = (p.x, p.y, p.z);
}

/// Texture coordinates of points of spheres.
pub(super) struct SphereUvs<'a> {
    pub outward: &'a Rows,
    pub heights: &'a [f32],
    pub uvs: &'a mut Rows,
}

impl simd::Kernel for SphereUvs<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let count = self.heights.len();
        let [x, ..] = self.outward.slices(count);
        let [u, v, _] = self.uvs.slices_mut(count);
        for i in 0..count {
            let uv = super::sphere_uv(x[i], self.heights[i]);
            (u[i], v[i]) = (uv.x, uv.y);
        }
    }
}

/// Makes vectors unit vectors; those without a length become zero.
struct Normalize<'a> {
    rows: &'a mut Rows,
}

impl simd::Kernel for Normalize<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let count = self.rows.x.len();
        let [x, y, z] = self.rows.slices_mut(count);
        for i in 0..count {
            let scale = 1.0 / (x[i] * x[i] + y[i] * y[i] + z[i] * z[i]).sqrt();
            let scale = if scale < f32::INFINITY { scale } else { 0.0 };
            (x[i], y[i], z[i]) = (x[i] * scale, y[i] * scale, z[i] * scale);
        }
    }
}

impl Report {
    /// Light from the lights; nothing in between may be hit, glass included.
    pub(super) fn direct(&self, batch: &Batch<'_>, room: &mut Room, queues: &mut Queues<Gathered>) {
        let Room { position, normal, colors, ids, sight, direct, blocked, scratch, .. } = room;
        let (count, material) = (batch.members.len(), batch.material);
        let lobe = match material.response {
            Response::Matte(Coat::Phong { specular: Gloss::Color(specular), power, .. }) => Some((specular, power)),
            _ => None,
        };
        direct.clear();
        direct.resize(count);
        if self.lights.is_empty() && lobe.is_none() {
            colors.iter().enumerate().for_each(|(i, color)| direct.set(i, UNLIT * Vec3::from_array(*color)));
        }
        for light in &self.lights {
            let points = LightPoints { position, normal, colors };
            simd::run(See { light, points, sight });
            if let Some(lobe) = lobe {
                sight.add_lobe(light, lobe, batch, points);
            }
            let rays = RayView {
                origin: position,
                direction: &sight.direction,
                t_max: &sight.t_max,
                skip: ids,
                t_min: T_MIN,
                time: &[],
            };
            queues.stats.shadow_rays += sight.t_max.iter().filter(|&&t_max| t_max >= 0.0).count() as u64;
            queues.clock.lap(Stage::Shade);
            batch.geometry.occluded(rays, blocked, scratch);
            queues.clock.lap(Stage::Trace);
            simd::run(Gather { light: &sight.light, blocked, direct });
        }
        let gain = Share::of(material).gain;
        for (i, &member) in batch.members.iter().enumerate() {
            let node = &mut queues.nodes[batch.paths[member as usize].node as usize];
            (node.direct, node.gain) = (direct.get(i), gain);
        }
    }
}

/// Points that are lit.
#[derive(Clone, Copy)]
struct LightPoints<'a> {
    position: &'a Rows,
    normal: &'a Rows,
    colors: &'a [[f32; 3]],
}

/// Looks from points to a light.
struct See<'a> {
    light: &'a ReportLight,
    points: LightPoints<'a>,
    sight: &'a mut Sight,
}

impl simd::Kernel for See<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let See { light, points: LightPoints { position, normal, colors }, sight } = self;
        let count = colors.len();
        sight.resize(count);
        let ([px, py, pz], [nx, ny, nz]) = (position.slices(count), normal.slices(count));
        let [dx, dy, dz] = sight.direction.slices_mut(count);
        let [red, green, blue] = sight.light.slices_mut(count);
        let (t_max, cosines) = (&mut sight.t_max[..count], &mut sight.cosine[..count]);
        for i in 0..count {
            let (x, y, z) = (light.position.x - px[i], light.position.y - py[i], light.position.z - pz[i]);
            let distance = (x * x + y * y + z * z).sqrt();
            let inverse = 1.0 / distance;
            (dx[i], dy[i], dz[i]) = (x * inverse, y * inverse, z * inverse);
            let cosine = nx[i] * dx[i] + ny[i] * dy[i] + nz[i] * dz[i];
            cosines[i] = cosine;
            // The cosine and the linear decay; comparisons fail for points in the light itself.
            let share = cosine * (1.0 - distance / light.range);
            let share = if cosine > 0.0 && distance <= light.range { share } else { 0.0 };
            red[i] = light.color.x * colors[i][0] * share;
            green[i] = light.color.y * colors[i][1] * share;
            blue[i] = light.color.z * colors[i][2] * share;
            let total = red[i].abs() + green[i].abs() + blue[i].abs();
            t_max[i] = reach(total, distance);
        }
    }
}

/// Where the ray towards a light ends that would bring `total`. A little behind the light, so that a surface through
/// the light itself is in the way everywhere; nowhere for no light, or a broken one.
#[inline(always)]
fn reach(total: f32, distance: f32) -> f32 {
    if total > 0.0 && total < f32::INFINITY { distance * 1.000_01 } else { -1.0 }
}

impl Sight {
    #[inline(always)]
    fn resize(&mut self, count: usize) {
        self.direction.resize(count);
        self.light.resize(count);
        self.t_max.resize(count, -1.0);
        self.cosine.resize(count, 0.0);
    }

    /// What the light gives to a glossy surface in place of a matte one. (The light's range has no part in it.)
    fn add_lobe(
        &mut self,
        light: &ReportLight,
        (specular, power): (Vec3, f32),
        batch: &Batch<'_>,
        points: LightPoints<'_>,
    ) {
        for (i, &member) in batch.members.iter().enumerate() {
            let along = batch.rays.direction.get(member as usize);
            let (normal, direction, cosine) = (points.normal.get(i), self.direction.get(i), self.cosine[i]);
            let mirrored = (normal * (2.0 * cosine) - direction).normalize_or(normal);
            let color = Vec3::from_array(points.colors[i]);
            let lit = 0.5 * color * cosine + specular * light.color * signed_power(mirrored.dot(along), power);
            self.light.set(i, lit);
            self.t_max[i] = reach(lit.abs().element_sum(), (light.position - points.position.get(i)).length());
        }
    }
}

/// Adds the light that is not blocked.
struct Gather<'a> {
    light: &'a Rows,
    blocked: &'a [bool],
    direct: &'a mut Rows,
}

impl simd::Kernel for Gather<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let count = self.blocked.len();
        for (row, light) in self.direct.slices_mut(count).into_iter().zip(self.light.slices(count)) {
            for i in 0..count {
                row[i] += if self.blocked[i] { 0.0 } else { light[i] };
            }
        }
    }
}

/// What a material makes of the light from around.
pub(super) struct Share {
    pub reflected: f32,
    pub refracted: f32,
    eta: f32,
    /// What the sum of all light is multiplied by.
    pub gain: f32,
}

impl Share {
    pub fn of(material: &Material) -> Share {
        let (reflected, refracted, eta) = match material.response {
            Response::Mirror => (1.0, 0.0, 0.0),
            Response::Glass { eta, .. } => (0.0, 1.0, eta),
            // The original never set an index for the one material of these that refracts.
            Response::Matte(Coat::Touch { reflection, transmission }) => (reflection, transmission, 0.0),
            _ => (0.0, 0.0, 0.0),
        };
        Share { reflected, refracted, eta, gain: 1.0 / (1.0 + reflected + refracted) }
    }
}

/// The normal of a triangle towards the ray, as long as its edges make it; of other shapes their own.
fn facing_normal(geometry: &Geometry, ray: &Ray, hit: &Hit) -> Vec3 {
    match geometry.triangle(hit) {
        Some([a, b, c]) => {
            let normal = (b - a).cross(c - a);
            if normal.dot(ray.direction) > 0.0 { -normal } else { normal }
        }
        None => geometry.surface(ray, hit).geometric,
    }
}

/// Queues the secondary rays of a batch.
pub(super) fn spawn_all(batch: &Batch<'_>, room: &Room, queues: &mut Queues<Gathered>) {
    let share = Share::of(batch.material);
    if share.reflected == 0.0 && share.refracted == 0.0 {
        return;
    }
    for (i, &member) in batch.members.iter().enumerate() {
        let path = batch.path(i);
        if path.depth.total() >= MAX_BOUNCES {
            continue;
        }
        let (d, normal) = (batch.rays.direction.get(member as usize), room.normal.get(i));
        let (origin, skip) = (room.position.get(i), room.ids.get(i));
        let from = |direction| Ray { origin, direction, t_min: T_MIN, t_max: f32::INFINITY, skip, time: None };
        if share.reflected > 0.0 {
            let mirrored = d - normal * (2.0 * normal.dot(d));
            spawn(path, from(mirrored.normalize_or(d)), share.reflected, RayKind::Reflection, queues);
        }
        if share.refracted > 0.0
            && let Some(direction) = refract(d, normal, share.eta)
        {
            spawn(path, from(direction), share.refracted, RayKind::Refraction, queues);
        }
    }
}

/// Queues a secondary ray with a node of its own.
fn spawn(path: &Path, ray: Ray, share: f32, kind: RayKind, queues: &mut Queues<Gathered>) {
    let node = queues.nodes.len() as u32;
    queues.nodes.push(Gathered { parent: path.node, share, ..Gathered::default() });
    let depth = if kind == RayKind::Refraction { path.depth.refracted() } else { path.depth.reflected() };
    queues.next.push(ray, Path { weight: Vec3::ONE, node, index: path.index, kind, depth, cone: path.cone });
}

/// The refracted direction. (Snell's law has `m |h|` where the original has `m`.)
fn refract(d: Vec3, normal: Vec3, eta: f32) -> Option<Vec3> {
    let h = normal.dot(d);
    let (m, n) = if h < 0.0 { (1.0 / eta, normal) } else { (eta, -normal) };
    let sine2 = (1.0 - h * h) * m * m;
    if !m.is_finite() || sine2 > 1.0 {
        return None;
    }
    (d * m - n * (m + (1.0 - sine2).sqrt())).try_normalize()
}

/// `base` to a power; negative bases keep their sign for odd whole exponents, and give nothing for broken ones.
fn signed_power(base: f32, exponent: f32) -> f32 {
    let power = math::pow(base.abs().min(1.0), exponent.max(0.0));
    match exponent % 2.0 {
        _ if base >= 0.0 => power,
        0.0 => power,
        rest if rest.abs() == 1.0 => -power,
        _ => 0.0,
    }
}
