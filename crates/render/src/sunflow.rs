//! Sunflow's meaning of shaders and lights: linear light, inverse squares, Fresnel mirrors (format reference, §3).

use glam::{Vec2, Vec3};
use jaspe_texture::Space;

use crate::geometry::{Hit, Id, Ray, Surface};
use crate::light::{Arrival, Light};
use crate::material::{Albedo, Material, Response, TextureBatch, schlick, transmittance};
use crate::math::{self, basis, offset};
use crate::options::Look;
use crate::sampler::SampleKey;
use crate::wave::{Batch, Depth, Node, PathRay, Queues, RayKind, Rules, Seen, ShadowRay};

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
    path: &'a PathRay,
    hit: &'a Hit,
    surface: Surface,
    /// The ray came from the inside of the shape.
    inside: bool,
    /// Cosine between the normal and the way back, 0 to 1.
    cosine: f32,
    color: Vec3,
    /// A primitive that a ray leaving this point cannot meet again: flat ones.
    skip: Id,
}

impl Point<'_> {
    /// Where rays to the front side start.
    fn front(&self) -> Vec3 {
        offset(self.surface.point, self.surface.geometric)
    }

    fn mirrored(&self) -> Vec3 {
        (self.path.ray.direction + self.surface.normal * (2.0 * self.cosine)).normalize_or(self.surface.normal)
    }

    /// A pair of sample dimensions that belongs to this bounce alone.
    fn dimension(&self, which: u32) -> u32 {
        2 + 4 * self.path.depth.total() + which
    }
}

impl Rules for Sunflow {
    fn shade(&self, batch: &Batch<'_>, textures: &mut TextureBatch, colors: &mut Vec<Vec3>, queues: &mut Queues) {
        let material = batch.material;
        let surfaces: Vec<Surface> = batch.iter().map(|(path, hit)| batch.geometry.surface(&path.ray, hit)).collect();
        albedos(batch, &surfaces, textures, colors);
        queues.stats.texture_points += textures.len() as u64;
        textures.clear();
        for (((path, hit), &surface), &color) in batch.iter().zip(&surfaces).zip(colors.iter()) {
            let point = point(batch, path, hit, surface, color);
            if path.kind == RayKind::Camera {
                let seen = Seen { object: hit.id.object, normal: point.surface.normal };
                queues.seen[path.node as usize] = seen;
            }
            self.respond(batch, material, &point, queues);
        }
    }

    fn miss(&self, ray: &PathRay) -> Option<Vec3> {
        // Sunflow: backgrounds are seen by camera rays only (R3).
        if ray.depth.total() == 0 { self.background } else { None }
    }

    fn finish(&self, node: &Node) -> Vec3 {
        // Scenes with absurd numbers overflow; one sample must not spoil its pixel, nor a sum of them overflow.
        if node.direct.is_finite() { node.direct.min(Vec3::splat(1e30)) } else { Vec3::ZERO }
    }

    fn t_min(&self) -> f32 {
        0.0
    }
}

/// Colours of a batch, one per member.
fn albedos(batch: &Batch<'_>, surfaces: &[Surface], textures: &mut TextureBatch, colors: &mut Vec<Vec3>) {
    let geometry = batch.geometry;
    match &batch.material.albedo {
        Albedo::Color(color) => colors.resize(batch.members.len(), *color),
        Albedo::Picture(picture) => colors.extend(
            batch.iter().zip(surfaces).map(|((_, hit), surface)| picture.smooth(geometry.uv(hit, surface.point))),
        ),
        Albedo::Procedural(procedural) => {
            textures.clear();
            for ((_, hit), surface) in batch.iter().zip(surfaces) {
                textures.push(match procedural.texture.space() {
                    Space::World => surface.point,
                    Space::Local => geometry.objects[hit.id.object as usize].object_from_world.point(surface.point),
                    Space::Uv => {
                        let Vec2 { x, y } = geometry.uv(hit, surface.point);
                        Vec3::new(x, y, 0.0)
                    }
                });
            }
            textures.evaluate(procedural, colors);
        }
    }
}

/// A hit with its surface turned towards the ray.
fn point<'a>(batch: &Batch<'_>, path: &'a PathRay, hit: &'a Hit, mut surface: Surface, color: Vec3) -> Point<'a> {
    let inside = path.ray.direction.dot(surface.geometric) >= 0.0;
    if inside {
        surface.geometric = -surface.geometric;
        surface.normal = -surface.normal;
    }
    let cosine = (-path.ray.direction.dot(surface.normal)).max(0.0);
    let skip = if batch.geometry.is_flat(hit.id.object) { hit.id } else { Id::NONE };
    Point { path, hit, surface, inside, cosine, color, skip }
}

impl Sunflow {
    fn respond(&self, batch: &Batch<'_>, material: &Material, point: &Point<'_>, queues: &mut Queues) {
        let path = point.path;
        let specular = path.kind != RayKind::Glossy;
        match material.response {
            Response::Constant => self.emit(point, point.color, queues),
            Response::Matte => self.matte(point, point.color, Vec3::ZERO, 0.0, queues),
            Response::Phong { specular: ks, power, samples } => {
                let ks = if specular { ks } else { Vec3::ZERO };
                self.matte(point, point.color, ks, power, queues);
                if ks != Vec3::ZERO {
                    self.glossy(point, ks, power, samples, queues);
                }
            }
            Response::Procedural { reflection, .. } => {
                let share = if specular { 1.0 / (1.0 + reflection) } else { 1.0 };
                self.matte(point, point.color * share, Vec3::ZERO, 0.0, queues);
                if specular && reflection > 0.0 {
                    self.reflect(point, Vec3::splat(reflection * share), queues);
                }
            }
            Response::Mirror if specular => self.reflect(point, schlick(point.color, point.cosine), queues),
            Response::Glass { eta, absorption } if specular => self.glass(point, eta, absorption, queues),
            // Behind a glossy ray mirrors and glass are black: §3.6.
            Response::Mirror | Response::Glass { .. } => {}
            Response::Look(look) => self.look(batch, point, look, queues),
        }
    }

    fn emit(&self, point: &Point<'_>, light: Vec3, queues: &mut Queues) {
        queues.nodes[point.path.node as usize].direct += point.path.weight * light;
    }

    /// Direct light on a matte surface, with a Phong lobe where `ks` is not black.
    fn matte(&self, point: &Point<'_>, color: Vec3, ks: Vec3, power: f32, queues: &mut Queues) {
        let Surface { geometric, normal, .. } = point.surface;
        let matte = color * std::f32::consts::FRAC_1_PI;
        let lobe = ks * ((power + 2.0) * 0.5 * std::f32::consts::FRAC_1_PI);
        let mirrored = if ks == Vec3::ZERO { normal } else { point.mirrored() };
        if matte == Vec3::ZERO && ks == Vec3::ZERO {
            return;
        }
        let origin = point.front();
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
            queues.shadows.push(ShadowRay { ray, contribution, node: point.path.node });
        }
    }

    /// Rays into the Phong lobe around the mirror direction (§3.10, `phongLobe`).
    fn glossy(&self, point: &Point<'_>, ks: Vec3, power: f32, samples: u32, queues: &mut Queues) {
        let depth = point.path.depth;
        if depth.reflection >= self.max_reflection || depth.diffuse > 0 {
            return;
        }
        let count = if depth.total() == 0 { samples } else { samples.min(1) };
        let around = point.mirrored();
        let (u, v) = basis(around);
        let scale = ks * ((power + 2.0) / (power + 1.0) / count as f32);
        for i in 0..count {
            let key = SampleKey { index: point.path.key.index * count + i, ..point.path.key };
            let [xi, yi] = key.pair(point.dimension(0));
            let cosine = math::pow(1.0 - yi, 1.0 / (power + 1.0));
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            let (sin, cos) = math::sin_cos_degrees(360.0 * f64::from(xi));
            let direction = u * (sine * cos as f32) + v * (sine * sin as f32) + around * cosine;
            let fall = direction.dot(point.surface.normal);
            if fall <= 0.0 || direction.dot(point.surface.geometric) <= 0.0 {
                continue;
            }
            self.queue(point, point.front(), direction, scale * fall, RayKind::Glossy, depth.reflected(), queues);
        }
    }

    fn reflect(&self, point: &Point<'_>, tint: Vec3, queues: &mut Queues) {
        let depth = point.path.depth;
        if depth.reflection < self.max_reflection && depth.diffuse == 0 {
            let origin = point.front();
            self.queue(point, origin, point.mirrored(), tint, RayKind::Reflection, depth.reflected(), queues);
        }
    }

    /// Clear glass. Sunflow: the Fresnel term keeps its index on the way out, and inside only total reflection
    /// reflects (R7).
    fn glass(&self, point: &Point<'_>, eta: f32, absorption: Vec3, queues: &mut Queues) {
        let normal = point.surface.normal;
        let mut tint = point.color;
        if point.inside && absorption != Vec3::ZERO {
            tint *= transmittance(absorption, point.hit.t);
        }
        let ratio = if point.inside { eta } else { 1.0 / eta };
        let rest = 1.0 - ratio * ratio * (1.0 - point.cosine * point.cosine);
        let total = rest < 0.0;
        let bent = point.path.ray.direction * ratio + normal * (ratio * point.cosine - rest.max(0.0).sqrt());
        let bent = bent.normalize_or(point.path.ray.direction);
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
        queues: &mut Queues,
    ) {
        let path = point.path;
        let weight = path.weight * tint;
        if weight.max_element() > 0.0 && weight.is_finite() {
            let ray = Ray { origin, direction, t_min: 0.0, t_max: f32::INFINITY, skip: point.skip };
            queues.rays.push(PathRay { ray, weight, node: path.node, key: path.key, kind, depth });
        }
    }

    /// The quick looks of `--override`.
    fn look(&self, batch: &Batch<'_>, point: &Point<'_>, look: Look, queues: &mut Queues) {
        let normal = point.surface.normal;
        match look {
            Look::Normals => self.emit(point, (normal + Vec3::ONE) * 0.5, queues),
            Look::Uvs => {
                let uv = batch.geometry.uv(point.hit, point.surface.point);
                self.emit(point, Vec3::new(uv.x - uv.x.floor(), uv.y - uv.y.floor(), 0.0), queues);
            }
            Look::Ids => {
                let bits = crate::sampler::hash(point.hit.id.object + 1);
                let channel = |shift: u32| 0.1 + 0.9 * (bits >> shift & 255) as f32 / 255.0;
                self.emit(point, Vec3::new(channel(0), channel(8), channel(16)) * point.cosine, queues);
            }
            Look::Gray => self.matte(point, Vec3::splat(0.5), Vec3::ZERO, 0.0, queues),
            Look::AmbientOcclusion => {
                let (u, v) = basis(normal);
                let contribution = point.path.weight / OCCLUSION_SAMPLES as f32;
                let origin = point.front();
                for i in 0..OCCLUSION_SAMPLES {
                    let key = SampleKey { index: point.path.key.index * OCCLUSION_SAMPLES + i, ..point.path.key };
                    let [xi, yi] = key.pair(point.dimension(1));
                    let (sin, cos) = math::sin_cos_degrees(360.0 * f64::from(xi));
                    let (sine, cosine) = (yi.sqrt(), (1.0 - yi).sqrt());
                    let direction = u * (sine * cos as f32) + v * (sine * sin as f32) + normal * cosine;
                    if direction.dot(point.surface.geometric) <= 0.0 {
                        continue;
                    }
                    let ray = Ray { origin, direction, t_min: 0.0, t_max: f32::INFINITY, skip: point.skip };
                    queues.shadows.push(ShadowRay { ray, contribution, node: point.path.node });
                }
            }
        }
    }
}
