//! Sunflow's meaning of shaders and lights: linear light, inverse squares, Fresnel mirrors (format reference, §3).

use glam::Vec3;
use jaspe_texture::Space;

use crate::geometry::{Geometry, Hit, Hits, Id, Ids, Ray, Rays, Rows, Scratch, Surface, Surfaces};
use crate::light::{Arrival, Light};
use crate::material::{Albedo, Response, schlick, transmittance};
use crate::math::{self, basis, offset};
use crate::options::Look;
use crate::sampler::SampleKey;
use crate::wave::{Batch, Depth, Path, Queues, RayKind, Rules};

/// The dialect's own part of a scene.
#[derive(Debug, Clone)]
pub(crate) struct Sunflow {
    pub lights: Vec<Light>,
    pub background: Option<Vec3>,
    /// Most reflections and refractions of a path.
    pub max_reflection: u8,
    pub max_refraction: u8,
}

/// Rays of one ambient-occlusion look-up of the quick look.
const OCCLUSION_SAMPLES: u32 = 16;

/// A hit, ready to be shaded: everything faces the ray.
struct Point<'a> {
    path: &'a Path,
    /// Of the ray that arrived.
    direction: Vec3,
    key: SampleKey,
    hit: Hit,
    surface: Surface,
    /// The ray came from the inside of the shape.
    inside: bool,
    /// Cosine between the normal and the way back, 0 to 1.
    cosine: f32,
    color: Vec3,
    /// Where rays to the front side start.
    front: Vec3,
    /// A primitive that a ray leaving this point cannot meet again: flat ones.
    skip: Id,
}

/// One thread's room for the hits of a batch.
#[derive(Default)]
pub(crate) struct Room {
    points: Points,
    texture_points: Rows,
    colors: Vec<[f32; 3]>,
    shadows: Shadows,
    scratch: Scratch,
}

/// The hits of a batch in rows: see [`Point`] for what they mean.
#[derive(Default)]
struct Points {
    surfaces: Surfaces,
    front: Rows,
    cosine: Vec<f32>,
    inside: Vec<bool>,
    skip: Ids,
}

/// Rays towards lights, and what arrives if nothing is in the way.
#[derive(Default)]
struct Shadows {
    rays: Rays,
    light: Vec<Vec3>,
    nodes: Vec<u32>,
    blocked: Vec<bool>,
}

impl Shadows {
    /// Shadow rays that are traced together at most, give or take those of one point.
    const FULL: usize = 4096;

    fn push(&mut self, ray: Ray, light: Vec3, node: u32) {
        self.rays.push(ray);
        self.light.push(light);
        self.nodes.push(node);
    }

    /// Traces what is queued and hands out what arrives.
    fn trace(&mut self, geometry: &Geometry, queues: &mut Queues<Vec3>, scratch: &mut Scratch) {
        queues.stats.shadow_rays += self.nodes.len() as u64;
        geometry.occluded(self.rays.view(0.0), &mut self.blocked, scratch);
        for ((&light, &node), &blocked) in self.light.iter().zip(&self.nodes).zip(&self.blocked) {
            if !blocked {
                queues.nodes[node as usize] += light;
            }
        }
        self.rays.clear();
        self.light.clear();
        self.nodes.clear();
    }
}

impl Point<'_> {
    fn mirrored(&self) -> Vec3 {
        (self.direction + self.surface.normal * (2.0 * self.cosine)).normalize_or(self.surface.normal)
    }

    /// A pair of sample dimensions that belongs to this bounce alone.
    fn dimension(&self, which: u32) -> u32 {
        2 + 4 * self.path.depth.total() + which
    }
}

impl Rules for Sunflow {
    /// Linear light.
    type Node = Vec3;
    type Room = Room;
    const T_MIN: f32 = 0.0;

    fn shade(&self, batch: &Batch<'_>, room: &mut Room, queues: &mut Queues<Vec3>) {
        room.points.locate(batch);
        room.paint(batch);
        if let Albedo::Procedural(_) = batch.material.albedo {
            queues.stats.texture_points += batch.members.len() as u64;
        }
        for i in 0..batch.members.len() {
            let point = room.points.get(batch, i, Vec3::from_array(room.colors[i]));
            self.respond(batch, &point, &mut room.shadows, queues);
            if room.shadows.nodes.len() >= Shadows::FULL {
                room.shadows.trace(batch.geometry, queues, &mut room.scratch);
            }
        }
        room.shadows.trace(batch.geometry, queues, &mut room.scratch);
    }

    fn miss(&self, path: &Path, _: Vec3, node: &mut Vec3) -> bool {
        // Sunflow: backgrounds are seen by camera rays only (R3).
        if let Some(background) = self.background.filter(|_| path.depth.total() == 0) {
            *node += path.weight * background;
            return true;
        }
        false
    }

    fn seen(&self, geometry: &Geometry, rays: &Rays, hits: &Hits, i: usize) -> Vec3 {
        let (ray, hit) = (rays.get(i), hits.get(i));
        let Surface { geometric, normal, .. } = geometry.surface(&ray, &hit);
        if ray.direction.dot(geometric) >= 0.0 { -normal } else { normal }
    }

    fn resolve(&self, nodes: &mut [Vec3], samples: usize, colors: &mut Vec<Vec3>) {
        colors.clear();
        // Scenes with absurd numbers overflow; one sample must not spoil its pixel, nor a sum of them overflow.
        let sane = |light: &Vec3| if light.is_finite() { light.min(Vec3::splat(1e30)) } else { Vec3::ZERO };
        colors.extend(nodes[..samples].iter().map(sane));
    }
}

impl Room {
    /// Colours of a batch, one per member.
    fn paint(&mut self, batch: &Batch<'_>) {
        let Room { points, texture_points, colors, .. } = self;
        let (geometry, point) = (batch.geometry, &points.surfaces.point);
        let uv = |i: usize| geometry.uv(&batch.hit(i), point.get(i));
        let count = batch.members.len();
        colors.resize(count, [0.0; 3]);
        match &batch.material.albedo {
            Albedo::Color(color) => colors.fill(color.to_array()),
            Albedo::Picture(picture) => {
                colors.iter_mut().enumerate().for_each(|(i, color)| *color = picture.smooth(uv(i)).to_array());
            }
            Albedo::Procedural(procedural) => {
                let local =
                    |i: usize| geometry.objects[batch.hit(i).id.object as usize].object_from_world.point(point.get(i));
                texture_points.resize(count);
                match procedural.texture.space() {
                    Space::World => return procedural.evaluate(point, colors),
                    Space::Local => (0..count).for_each(|i| texture_points.set(i, local(i))),
                    Space::Uv => (0..count).for_each(|i| texture_points.set(i, uv(i).extend(0.0))),
                }
                procedural.evaluate(texture_points, colors);
            }
        }
    }
}

impl Points {
    /// Surfaces of a batch, turned towards the rays.
    fn locate(&mut self, batch: &Batch<'_>) {
        let count = batch.members.len();
        batch.geometry.surfaces(batch.members, batch.rays, batch.hits, &mut self.surfaces);
        self.front.resize(count);
        self.cosine.resize(count, 0.0);
        self.inside.resize(count, false);
        self.skip.resize(count);
        for (i, &member) in batch.members.iter().enumerate() {
            let direction = batch.rays.direction.get(member as usize);
            let Surface { point, mut geometric, mut normal } = self.surfaces.get(i);
            let inside = direction.dot(geometric) >= 0.0;
            if inside {
                (geometric, normal) = (-geometric, -normal);
                self.surfaces.geometric.set(i, geometric);
                self.surfaces.normal.set(i, normal);
            }
            self.inside[i] = inside;
            self.cosine[i] = (-direction.dot(normal)).max(0.0);
            self.front.set(i, offset(point, geometric));
            let id = batch.hits.id.get(member as usize);
            self.skip.set(i, if batch.geometry.is_flat(id.object) { id } else { Id::NONE });
        }
    }

    fn get<'a>(&self, batch: &Batch<'a>, i: usize, color: Vec3) -> Point<'a> {
        let member = batch.members[i] as usize;
        let path = &batch.paths[member];
        Point {
            path,
            direction: batch.rays.direction.get(member),
            key: batch.keys[path.node as usize],
            hit: batch.hits.get(member),
            surface: self.surfaces.get(i),
            inside: self.inside[i],
            cosine: self.cosine[i],
            color,
            front: self.front.get(i),
            skip: self.skip.get(i),
        }
    }
}

impl Sunflow {
    fn respond(&self, batch: &Batch<'_>, point: &Point<'_>, shadows: &mut Shadows, queues: &mut Queues<Vec3>) {
        let path = point.path;
        let specular = path.kind != RayKind::Glossy;
        match batch.material.response {
            Response::Constant => self.emit(point, point.color, queues),
            Response::Matte => self.matte(point, point.color, Vec3::ZERO, 0.0, shadows),
            Response::Phong { specular: ks, power, samples } => {
                let ks = if specular { ks } else { Vec3::ZERO };
                self.matte(point, point.color, ks, power, shadows);
                if ks != Vec3::ZERO {
                    self.glossy(point, ks, power, samples, queues);
                }
            }
            Response::Procedural { reflection, .. } => {
                let share = if specular { 1.0 / (1.0 + reflection) } else { 1.0 };
                self.matte(point, point.color * share, Vec3::ZERO, 0.0, shadows);
                if specular && reflection > 0.0 {
                    self.reflect(point, Vec3::splat(reflection * share), queues);
                }
            }
            Response::Mirror if specular => self.reflect(point, schlick(point.color, point.cosine), queues),
            Response::Glass { eta, absorption } if specular => self.glass(point, eta, absorption, queues),
            // Behind a glossy ray mirrors and glass are black: §3.6.
            Response::Mirror | Response::Glass { .. } => {}
            Response::Look(look) => self.look(batch, point, look, shadows, queues),
        }
    }

    fn emit(&self, point: &Point<'_>, light: Vec3, queues: &mut Queues<Vec3>) {
        queues.nodes[point.path.node as usize] += point.path.weight * light;
    }

    /// Direct light on a matte surface, with a Phong lobe where `ks` is not black.
    fn matte(&self, point: &Point<'_>, color: Vec3, ks: Vec3, power: f32, shadows: &mut Shadows) {
        let Surface { geometric, normal, .. } = point.surface;
        let matte = color * std::f32::consts::FRAC_1_PI;
        let lobe = ks * ((power + 2.0) * 0.5 * std::f32::consts::FRAC_1_PI);
        let mirrored = if ks == Vec3::ZERO { normal } else { point.mirrored() };
        if matte == Vec3::ZERO && ks == Vec3::ZERO {
            return;
        }
        let origin = point.front;
        for light in &self.lights {
            let Some(Arrival { direction, distance, irradiance }) = light.arrive(origin) else { continue };
            let cosine = direction.dot(normal);
            if cosine <= 0.0 || direction.dot(geometric) <= 0.0 {
                continue;
            }
            let mut response = matte;
            if ks != Vec3::ZERO {
                response += lobe * math::pow(direction.dot(mirrored).max(0.0), power);
            }
            let contribution = point.path.weight * response * irradiance * cosine;
            let ray = Ray { origin, direction, t_min: 0.0, t_max: distance, skip: point.skip };
            shadows.push(ray, contribution, point.path.node);
        }
    }

    /// Rays into the Phong lobe around the mirror direction (§3.10, `phongLobe`).
    fn glossy(&self, point: &Point<'_>, ks: Vec3, power: f32, samples: u32, queues: &mut Queues<Vec3>) {
        let depth = point.path.depth;
        if depth.reflection >= self.max_reflection || depth.diffuse > 0 {
            return;
        }
        let count = if depth.total() == 0 { samples } else { samples.min(1) };
        let around = point.mirrored();
        let (u, v) = basis(around);
        let scale = ks * ((power + 2.0) / (power + 1.0) / count as f32);
        for i in 0..count {
            let key = SampleKey { index: point.key.index * count + i, ..point.key };
            let [xi, yi] = key.pair(point.dimension(0));
            let cosine = math::pow(1.0 - yi, 1.0 / (power + 1.0));
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            let (sin, cos) = math::sin_cos_degrees(360.0 * f64::from(xi));
            let direction = u * (sine * cos as f32) + v * (sine * sin as f32) + around * cosine;
            let fall = direction.dot(point.surface.normal);
            if fall <= 0.0 || direction.dot(point.surface.geometric) <= 0.0 {
                continue;
            }
            self.queue(point, point.front, direction, scale * fall, RayKind::Glossy, depth.reflected(), queues);
        }
    }

    fn reflect(&self, point: &Point<'_>, tint: Vec3, queues: &mut Queues<Vec3>) {
        let depth = point.path.depth;
        if depth.reflection < self.max_reflection && depth.diffuse == 0 {
            let origin = point.front;
            self.queue(point, origin, point.mirrored(), tint, RayKind::Reflection, depth.reflected(), queues);
        }
    }

    /// Clear glass. Sunflow: the Fresnel term keeps its index on the way out, and inside only total reflection
    /// reflects (R7).
    fn glass(&self, point: &Point<'_>, eta: f32, absorption: Vec3, queues: &mut Queues<Vec3>) {
        let normal = point.surface.normal;
        let mut tint = point.color;
        if point.inside && absorption != Vec3::ZERO {
            tint *= transmittance(absorption, point.hit.t);
        }
        let ratio = if point.inside { eta } else { 1.0 / eta };
        let rest = 1.0 - ratio * ratio * (1.0 - point.cosine * point.cosine);
        let total = rest < 0.0;
        let bent = point.direction * ratio + normal * (ratio * point.cosine - rest.max(0.0).sqrt());
        let bent = bent.normalize_or(point.direction);
        let cos1 = point.cosine;
        let cos2 = if total { 0.0 } else { -normal.dot(bent) };
        let parallel = (cos1 - eta * cos2) / (cos1 + eta * cos2);
        let perpendicular = (eta * cos1 - cos2) / (eta * cos1 + cos2);
        let kr = (0.5 * (parallel * parallel + perpendicular * perpendicular)).min(1.0);
        let depth = point.path.depth;
        if !total && depth.refraction < self.max_refraction && depth.diffuse == 0 {
            let origin = offset(point.surface.point, -point.surface.geometric);
            let weight = tint * (1.0 - kr);
            self.queue(point, origin, bent, weight, RayKind::Refraction, depth.refracted(), queues);
        }
        if !point.inside || total {
            self.reflect(point, tint * kr, queues);
        }
    }

    /// Queues a secondary ray, unless it would bring nothing.
    #[allow(clippy::too_many_arguments, reason = "one call per kind of ray; a struct would repeat PathRay")]
    fn queue(
        &self,
        point: &Point<'_>,
        origin: Vec3,
        direction: Vec3,
        tint: Vec3,
        kind: RayKind,
        depth: Depth,
        queues: &mut Queues<Vec3>,
    ) {
        let path = point.path;
        let weight = path.weight * tint;
        if weight.max_element() > 0.0 && weight.is_finite() {
            let ray = Ray { origin, direction, t_min: 0.0, t_max: f32::INFINITY, skip: point.skip };
            queues.next.push(ray, Path { weight, node: path.node, kind, depth });
        }
    }

    /// The quick looks of `--override`.
    fn look(&self, batch: &Batch<'_>, point: &Point<'_>, look: Look, shadows: &mut Shadows, queues: &mut Queues<Vec3>) {
        let normal = point.surface.normal;
        match look {
            Look::Normals => self.emit(point, (normal + Vec3::ONE) * 0.5, queues),
            Look::Uvs => {
                let uv = batch.geometry.uv(&point.hit, point.surface.point);
                self.emit(point, Vec3::new(uv.x - uv.x.floor(), uv.y - uv.y.floor(), 0.0), queues);
            }
            Look::Ids => {
                let bits = crate::sampler::hash(point.hit.id.object + 1);
                let channel = |shift: u32| 0.1 + 0.9 * (bits >> shift & 255) as f32 / 255.0;
                self.emit(point, Vec3::new(channel(0), channel(8), channel(16)) * point.cosine, queues);
            }
            Look::Gray => self.matte(point, Vec3::splat(0.5), Vec3::ZERO, 0.0, shadows),
            Look::AmbientOcclusion => {
                let (u, v) = basis(normal);
                let contribution = point.path.weight / OCCLUSION_SAMPLES as f32;
                let origin = point.front;
                for i in 0..OCCLUSION_SAMPLES {
                    let key = SampleKey { index: point.key.index * OCCLUSION_SAMPLES + i, ..point.key };
                    let [xi, yi] = key.pair(point.dimension(1));
                    let (sin, cos) = math::sin_cos_degrees(360.0 * f64::from(xi));
                    let (sine, cosine) = (yi.sqrt(), (1.0 - yi).sqrt());
                    let direction = u * (sine * cos as f32) + v * (sine * sin as f32) + normal * cosine;
                    if direction.dot(point.surface.geometric) <= 0.0 {
                        continue;
                    }
                    let ray = Ray { origin, direction, t_min: 0.0, t_max: f32::INFINITY, skip: point.skip };
                    shadows.push(ray, contribution, point.path.node);
                }
            }
        }
    }
}
