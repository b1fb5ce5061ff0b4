//! Hits in the report's meaning, all of a batch at once: each coordinate lies in a row of its own, so that the loops
//! over them are vectorised.

use glam::{Vec3, Vec4};

use super::gathered::Gathered;
use super::{MAX_BOUNCES, Report, ReportLight, T_MIN, UNLIT};
use crate::clock::Stage;
use crate::geometry::simd::{self, Lanes, Simd, Vec3s};
use crate::geometry::{Geometry, Hit, Met, Ray, RayView, Rows, Scratch, Shape, padded, spread};
use crate::material::{Coat, Gloss, Material, Response};
use crate::math;
use crate::wave::{Batch, Path, Queues, RayKind};

/// One thread's room for the hits of a batch; its rows are [`padded`].
#[derive(Default)]
pub(crate) struct Room {
    pub position: Rows,
    /// Not of unit length for triangles and planes; empty where it is `outward`.
    normal: Rows,
    /// From the reference point of the texture, of unit length: see [`Report::reference`].
    pub outward: Rows,
    reference: Rows,
    radii: Vec<f32>,
    /// Of points of spheres over their centres, over their radii.
    pub heights: Vec<f32>,
    /// Whether all are points of spheres.
    pub round: bool,
    pub texture_points: Rows,
    pub coefficients: Vec<f32>,
    pub colors: Rows,
    sight: Sight,
    /// Light from the lights.
    direct: Rows,
    blocked: Vec<bool>,
    mirrored: Rows,
    scratch: Scratch,
}

/// A light as the points of a batch see it.
#[derive(Default)]
struct Sight {
    direction: Rows,
    /// Where rays towards the light end; before their beginning where nothing arrives.
    t_max: Vec<f32>,
    /// What arrives if nothing is in the way.
    light: Rows,
}

impl Room {
    /// Positions, normals and directions of a batch.
    pub fn locate(&mut self, report: &Report, batch: &Batch<'_>) {
        let Room { position, normal, outward, reference, radii, heights, round, .. } = self;
        let (count, geometry) = (batch.len(), batch.geometry);
        let shape = |object: u32| geometry.objects[object as usize].shape;
        let ball = |object: u32| match shape(object) {
            Shape::Sphere { center, radius } => center.extend(radius),
            _ => Vec4::ONE,
        };
        spread(&mut reference.x, batch.runs, count, |run| ball(run.object).x);
        spread(&mut reference.y, batch.runs, count, |run| ball(run.object).y);
        spread(&mut reference.z, batch.runs, count, |run| ball(run.object).z);
        spread(radii, batch.runs, count, |run| ball(run.object).w);
        *round = batch.runs.iter().all(|run| matches!(shape(run.object), Shape::Sphere { .. }));
        if !*round {
            (0..count).for_each(|i| reference.set(i, report.reference(geometry, &batch.hit(i))));
        }
        heights.resize(padded(count), 0.0);
        position.resize(padded(count));
        outward.resize(padded(count));
        simd::run(Locate { met: batch.met, reference, radii, heights, position, outward });
        normal.resize(if *round { 0 } else { padded(count) });
        if !*round {
            for (i, &object) in batch.met.hits.id.object[..count].iter().enumerate() {
                let of_shape = match shape(object) {
                    Shape::Sphere { .. } => outward.get(i),
                    Shape::Plane(index) => report.plane_normals[index as usize],
                    _ => facing_normal(geometry, &batch.ray(i), &batch.hit(i)),
                };
                normal.set(i, of_shape);
            }
        }
    }
}

/// Finds the points where rays arrive, the directions to them from points of reference, and their heights over those.
struct Locate<'a> {
    met: &'a Met,
    reference: &'a Rows,
    radii: &'a [f32],
    heights: &'a mut [f32],
    position: &'a mut Rows,
    /// Of unit length; zero for points of reference.
    outward: &'a mut Rows,
}

impl simd::Kernel for Locate<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Locate { met, reference, radii, heights, position, outward } = self;
        let (zero, one, infinite) = (S::Wide::splat(0.0), S::Wide::splat(1.0), S::Wide::splat(f32::INFINITY));
        for i in (0..heights.len()).step_by(S::Wide::COUNT) {
            let t = S::Wide::load(&met.hits.t[i..]);
            let point = met.origin.lanes::<S::Wide>(i).add(met.direction.lanes(i).scale(t));
            let out = point.sub(reference.lanes(i));
            let scale = one.div(out.dot(out).sqrt());
            let scale = scale.select_lt(infinite, scale, zero);
            position.set_lanes(i, point);
            outward.set_lanes(i, out.scale(scale));
            out.y.div(S::Wide::load(&radii[i..])).write(&mut heights[i..]);
        }
    }
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

impl Report {
    /// Light from the lights; nothing in between may be hit, glass included.
    pub(super) fn direct(&self, batch: &Batch<'_>, room: &mut Room, queues: &mut Queues<Gathered>) {
        let Room { position, normal, outward, round, colors, sight, direct, blocked, scratch, .. } = room;
        let (normal, material) = (if *round { &*outward } else { &*normal }, batch.material);
        let lobe = match material.response {
            Response::Matte(Coat::Phong { specular: Gloss::Color(specular), power, .. }) => Some((specular, power)),
            _ => None,
        };
        direct.resize(padded(batch.len()));
        if self.lights.is_empty() {
            let unlit = if lobe.is_none() { UNLIT } else { 0.0 };
            (0..batch.len()).for_each(|i| direct.set(i, unlit * colors.get(i)));
        }
        for (number, light) in self.lights.iter().enumerate() {
            let points = LightPoints { position, normal, colors };
            simd::run(See { light, points, sight });
            if let Some(lobe) = lobe {
                sight.add_lobe(light, lobe, batch, points);
            }
            sight.t_max[batch.len()..].fill(-1.0);
            let rays = RayView {
                origin: position,
                direction: &sight.direction,
                t_max: &sight.t_max,
                skip: &batch.met.hits.id,
                t_min: T_MIN,
                time: &[],
            };
            queues.stats.shadow_rays += sight.t_max.iter().filter(|&&t_max| t_max >= 0.0).count() as u64;
            queues.clock.lap(Stage::Shade);
            batch.geometry.occluded(rays, blocked, scratch);
            queues.clock.lap(Stage::Trace);
            simd::run(Gather { light: &sight.light, blocked, direct, first: number == 0 });
        }
        queues.nodes.note(batch.paths[0].node as usize, batch.runs, direct, Share::of(material).gain);
    }
}

/// Points that are lit.
#[derive(Clone, Copy)]
struct LightPoints<'a> {
    position: &'a Rows,
    normal: &'a Rows,
    colors: &'a Rows,
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
        let count = position.x.len();
        sight.resize(count);
        let (zero, one, infinite) = (S::Wide::splat(0.0), S::Wide::splat(1.0), S::Wide::splat(f32::INFINITY));
        let (center, color, range) =
            (Vec3s::splat(light.position), Vec3s::splat(light.color), S::Wide::splat(light.range));
        for i in (0..count).step_by(S::Wide::COUNT) {
            let to = center.sub(position.lanes::<S::Wide>(i));
            let distance = to.dot(to).sqrt();
            let direction = to.scale(one.div(distance));
            let cosine = normal.lanes(i).dot(direction);
            // The cosine and the linear decay; comparisons fail for points in the light itself.
            let share = cosine.mul(one.sub(distance.div(range)));
            let share = S::Wide::select(zero.lt(cosine) & distance.le(range), share, zero);
            let Vec3s { x: red, y: green, z: blue } = color.mul(colors.lanes(i)).scale(share);
            let total = red.max(zero.sub(red)).add(green.max(zero.sub(green))).add(blue.max(zero.sub(blue)));
            let reaches = zero.lt(total) & total.lt(infinite);
            sight.direction.set_lanes(i, direction);
            sight.light.set_lanes(i, Vec3s { x: red, y: green, z: blue });
            let reach = distance.mul(S::Wide::splat(BEHIND));
            S::Wide::select(reaches, reach, S::Wide::splat(-1.0)).write(&mut sight.t_max[i..]);
        }
    }
}

/// Where rays towards a light end, in distances to it: a little behind it, so that a surface through the light itself is
/// in the way everywhere.
const BEHIND: f32 = 1.000_01;

impl Sight {
    #[inline(always)]
    fn resize(&mut self, count: usize) {
        self.direction.resize(count);
        self.light.resize(count);
        self.t_max.resize(count, -1.0);
    }

    /// What the light gives to a glossy surface in place of a matte one. (The light's range has no part in it.)
    fn add_lobe(
        &mut self,
        light: &ReportLight,
        (specular, power): (Vec3, f32),
        batch: &Batch<'_>,
        points: LightPoints<'_>,
    ) {
        for i in 0..batch.len() {
            let along = batch.met.direction.get(i);
            let (normal, direction) = (points.normal.get(i), self.direction.get(i));
            let cosine = normal.dot(direction);
            let mirrored = (normal * (2.0 * cosine) - direction).normalize_or(normal);
            let color = points.colors.get(i);
            let lit = 0.5 * color * cosine + specular * light.color * signed_power(mirrored.dot(along), power);
            self.light.set(i, lit);
            let total = lit.abs().element_sum();
            let distance = (light.position - points.position.get(i)).length();
            self.t_max[i] = if total > 0.0 && total < f32::INFINITY { distance * BEHIND } else { -1.0 };
        }
    }
}

/// Adds the light that is not blocked.
struct Gather<'a> {
    light: &'a Rows,
    blocked: &'a [bool],
    direct: &'a mut Rows,
    /// There is nothing yet to which it could be added.
    first: bool,
}

impl simd::Kernel for Gather<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Gather { light, blocked, direct, first } = self;
        let Rows { x, y, z } = direct;
        for (row, light) in [(x, &light.x), (y, &light.y), (z, &light.z)] {
            for ((sum, &light), &blocked) in row.iter_mut().zip(light).zip(blocked) {
                let light = if blocked { 0.0 } else { light };
                *sum = if first { light } else { *sum + light };
            }
        }
    }
}

/// What a material makes of the light from around.
struct Share {
    reflected: f32,
    refracted: f32,
    eta: f32,
    /// What the sum of all light is multiplied by.
    gain: f32,
}

impl Share {
    fn of(material: &Material) -> Share {
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

impl Room {
    /// Queues the secondary rays of a batch, with a node for each.
    pub fn spawn(&mut self, batch: &Batch<'_>, queues: &mut Queues<Gathered>) {
        let Room { position, normal, outward, round, mirrored, .. } = self;
        let normal = if *round { &*outward } else { &*normal };
        let share = Share::of(batch.material);
        // All rays of a wave have bounced as often.
        let (path, first) = (batch.path(0), batch.paths[0].node);
        if path.depth.total() >= MAX_BOUNCES {
            return;
        }
        let Queues { next, nodes, .. } = queues;
        if share.reflected > 0.0 {
            mirrored.resize(padded(batch.len()));
            simd::run(Mirror { direction: &batch.met.direction, normal, mirrored });
            let path = Path { kind: RayKind::Reflection, depth: path.depth.reflected(), ..*path };
            let node = nodes.len() as u32..;
            next.rays.extend(batch.len(), position, mirrored, &batch.met.hits.id);
            next.paths.extend(node.zip(batch.members).map(|(node, _)| Path { node, ..path }));
            nodes.spawn(batch.members.iter().map(|member| first + member), share.reflected);
        }
        if share.refracted > 0.0 {
            let path = Path { kind: RayKind::Refraction, depth: path.depth.refracted(), ..*path };
            for (i, member) in batch.members.iter().enumerate() {
                if let Some(direction) = refract(batch.met.direction.get(i), normal.get(i), share.eta) {
                    let (origin, skip) = (position.get(i), batch.met.hits.id.get(i));
                    let ray = Ray { origin, direction, t_min: T_MIN, t_max: f32::INFINITY, skip, time: None };
                    next.push(ray, Path { node: nodes.len() as u32, ..path });
                    nodes.spawn(std::iter::once(first + member), share.refracted);
                }
            }
        }
    }
}

/// Mirrors directions.
struct Mirror<'a> {
    direction: &'a Rows,
    normal: &'a Rows,
    mirrored: &'a mut Rows,
}

impl simd::Kernel for Mirror<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Mirror { direction, normal, mirrored } = self;
        for i in (0..mirrored.x.len()).step_by(S::Wide::COUNT) {
            let (d, normal) = (direction.lanes::<S::Wide>(i), normal.lanes(i));
            let m = d.sub(normal.scale(S::Wide::splat(2.0).mul(normal.dot(d))));
            mirrored.set_lanes(i, m.unit_or(d));
        }
    }
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
