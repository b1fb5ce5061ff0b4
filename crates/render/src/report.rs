//! The 2010 program's meaning of a scene: display values throughout, lights with a linear range, half-and-half
//! mirrors, a camera formula of its own. Everything that is particular to this dialect is in this file.

use glam::{Vec2, Vec3};
use jaspe_texture::Space;

use crate::compile::CompiledScene;
use crate::geometry::{Geometry, Hit, Id, PlaneShape, Ray, Shape};
use crate::material::{Albedo, Material, Response, TextureBatch};
use crate::math;
use crate::sampler::SampleKey;
use crate::wave::{Batch, Node, PathRay, Queues, RayKind, Rules, ShadowRay};

/// Light that is there without any light source.
const AMBIENT: f32 = 0.01;
/// What a surface shows of its colour in a scene without lights.
const UNLIT: f32 = 0.05;
/// Hits closer than this are dropped.
const T_MIN: f32 = 1e-5;
/// Secondary rays are traced up to this many bounces from the first hit.
const MAX_BOUNCES: u32 = 4;

/// A point light: `range` is where its linear decay reaches zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ReportLight {
    pub position: Vec3,
    pub color: Vec3,
    pub range: f32,
}

/// The dialect's own part of a scene.
#[derive(Debug, Clone)]
pub(crate) struct Report {
    pub camera: ReportCamera,
    pub lights: Vec<ReportLight>,
    /// Normals of the planes as written: their length scales the light that the plane shows.
    pub plane_normals: Vec<Vec3>,
    /// Texture axes of the planes, once [`Report::fix_plane_axes`] has found them.
    pub plane_axes: Vec<[Vec3; 2]>,
}

/// The camera. Its focal length is in pixels of the scene's own width, so that another output size crops.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ReportCamera {
    eye: Vec3,
    forward: Vec3,
    right: Vec3,
    down: Vec3,
    /// Pixels left of and above the centre.
    half: [f32; 2],
}

impl ReportCamera {
    /// `fov` is horizontal, in degrees; `scene_width` as the scene says, `size` as the output is.
    pub fn new([eye, target, up]: [Vec3; 3], fov: f32, scene_width: u32, size: [u32; 2]) -> Self {
        let focal = (f64::from(scene_width / 2) / math::tan_degrees(f64::from(fov) * 0.5)) as f32;
        let forward = (target - eye).normalize_or(Vec3::NEG_Z);
        let down = -up.normalize_or(Vec3::Y);
        let right = down.cross(target - eye).normalize_or(Vec3::X);
        ReportCamera { eye, forward: forward * focal, right, down, half: size.map(|s| (s / 2) as f32) }
    }

    /// Origin and unit direction of the ray through a position in pixels from the top left.
    pub fn ray(&self, x: f32, y: f32) -> (Vec3, Vec3) {
        let plane = self.forward + self.right * (x - self.half[0]) + self.down * (y - self.half[1]);
        // The position on the image plane is relative to the eye already, and the eye is taken off once more: it is
        // what the original did.
        (self.eye, (plane - self.eye).normalize_or(self.forward))
    }

    /// Position in the image of sample `index` of pixel (x, y), of `edge` × `edge` cells with `repeats` samples each.
    pub fn position(x: u32, y: u32, key: &SampleKey, edge: u32, repeats: u32) -> [f32; 2] {
        if edge * edge * repeats == 1 {
            return [x as f32 + 0.5, y as f32 + 0.5];
        }
        // Cells are not stratified: the jitter is as wide as the pixel.
        let cell = key.index / repeats;
        let [r, s] = key.random_pair(0);
        let at =
            |pixel: u32, cell: u32, jitter: f32| pixel as f32 + (cell + 1) as f32 / (2 * edge) as f32 + jitter - 0.5;
        [at(x, cell / edge, r), at(y, cell % edge, s)]
    }
}

/// A hit in the original's terms.
struct Point<'a> {
    path: &'a PathRay,
    hit: &'a Hit,
    position: Vec3,
    /// Not of unit length for triangles and planes.
    normal: Vec3,
    color: Vec3,
}

impl Rules for Report {
    fn shade(&self, batch: &Batch<'_>, textures: &mut TextureBatch, colors: &mut Vec<Vec3>, queues: &mut Queues) {
        let material = &batch.scene.materials[batch.material as usize];
        self.albedos(batch, material, textures, colors);
        queues.stats.texture_points += textures.len() as u64;
        textures.clear();
        for ((path, hit), &color) in batch.iter().zip(colors.iter()) {
            let position = path.ray.origin + path.ray.direction * hit.t;
            let normal = self.normal(batch.geometry(), &path.ray, hit, position);
            self.respond(material, &Point { path, hit, position, normal, color }, queues);
        }
    }

    fn miss(&self, _: &CompiledScene, _: &PathRay) -> Option<Vec3> {
        Some(Vec3::ZERO)
    }

    fn finish(&self, node: &Node) -> Vec3 {
        let direct = node.direct.clamp(Vec3::ZERO, Vec3::ONE);
        ((Vec3::splat(AMBIENT) + direct + node.indirect) * node.gain).clamp(Vec3::ZERO, Vec3::ONE)
    }

    fn t_min(&self) -> f32 {
        T_MIN
    }
}

impl Report {
    fn respond(&self, material: &Material, point: &Point<'_>, queues: &mut Queues) {
        let (kr, kt, eta) = match material.response {
            Response::Mirror => (1.0, 0.0, 0.0),
            Response::Glass { eta, .. } => (0.0, 1.0, eta),
            // The original never set an index for the one material of these that refracts.
            Response::Procedural { reflection, transmission } => (reflection, transmission, 0.0),
            _ => (0.0, 0.0, 0.0),
        };
        queues.nodes[point.path.node as usize].gain = 1.0 / (1.0 + kr + kt);
        self.direct(material, point, queues);
        if point.path.depth.total() < MAX_BOUNCES {
            if kr > 0.0 {
                let d = point.path.ray.direction;
                let mirrored = d - point.normal * (2.0 * point.normal.dot(d));
                spawn(point, mirrored.normalize_or(d), kr, RayKind::Reflection, queues);
            }
            if kt > 0.0
                && let Some(direction) = refract(point.path.ray.direction, point.normal, eta)
            {
                spawn(point, direction, kt, RayKind::Refraction, queues);
            }
        }
    }

    /// Light from the lights; nothing in between may be hit, glass included.
    fn direct(&self, material: &Material, point: &Point<'_>, queues: &mut Queues) {
        let node = point.path.node;
        let phong = match material.response {
            Response::Phong { specular, power, .. } => Some((specular, power)),
            _ => None,
        };
        if self.lights.is_empty() && phong.is_none() {
            queues.nodes[node as usize].direct += UNLIT * point.color;
        }
        for light in &self.lights {
            let to = light.position - point.position;
            let distance = to.length();
            let direction = to / distance;
            let cosine = point.normal.dot(direction);
            let contribution = match phong {
                Some((specular, power)) => {
                    let mirrored = (point.normal * (2.0 * cosine) - direction).normalize_or(point.normal);
                    let highlight = signed_power(mirrored.dot(point.path.ray.direction), power);
                    0.5 * point.color * cosine + specular * light.color * highlight
                }
                None if cosine <= 0.0 || distance > light.range => continue,
                None => cosine * light.color * point.color * (1.0 - distance / light.range),
            };
            if contribution.is_finite() && direction.is_finite() {
                // A little longer, so that a surface through the light itself is in the way everywhere.
                let t_max = distance * 1.000_01;
                let ray = Ray { origin: point.position, direction, t_min: T_MIN, t_max, skip: point.hit.id };
                queues.shadows.push(ShadowRay { ray, contribution, node });
            }
        }
    }

    /// The normal, of the length that the original gives it.
    fn normal(&self, geometry: &Geometry, ray: &Ray, hit: &Hit, position: Vec3) -> Vec3 {
        match geometry.objects[hit.id.object as usize].shape {
            Shape::Sphere { center, .. } => (position - center).normalize_or(Vec3::Z),
            Shape::Plane(index) => self.plane_normals[index as usize],
            _ => match triangle(geometry, hit) {
                Some([a, b, c]) => {
                    let normal = (b - a).cross(c - a);
                    if normal.dot(ray.direction) > 0.0 { -normal } else { normal }
                }
                None => geometry.surface(ray, hit).geometric,
            },
        }
    }

    /// Colours of a batch, one per member.
    fn albedos(&self, batch: &Batch<'_>, material: &Material, textures: &mut TextureBatch, colors: &mut Vec<Vec3>) {
        let geometry = batch.geometry();
        let position = |path: &PathRay, hit: &Hit| path.ray.origin + path.ray.direction * hit.t;
        match &material.albedo {
            Albedo::Color(color) => colors.resize(batch.members.len(), *color),
            Albedo::Picture(picture) => colors
                .extend(batch.iter().map(|(path, hit)| picture.nearest(self.uv(geometry, hit, position(path, hit))))),
            Albedo::Procedural(procedural) => {
                textures.clear();
                for (path, hit) in batch.iter() {
                    let p = position(path, hit);
                    textures.push(match procedural.texture.space() {
                        Space::World => p,
                        Space::Local => (p - self.reference(geometry, hit)).normalize_or_zero(),
                        Space::Uv => {
                            let Vec2 { x, y } = self.uv(geometry, hit, p);
                            Vec3::new(x, y, 0.0)
                        }
                    });
                }
                textures.evaluate(procedural, colors);
            }
        }
    }

    /// The point that directions are taken from: marble, stone and wood only know directions.
    fn reference(&self, geometry: &Geometry, hit: &Hit) -> Vec3 {
        match geometry.objects[hit.id.object as usize].shape {
            Shape::Sphere { center, .. } => center,
            Shape::Plane(index) => geometry.planes[index as usize].point,
            _ => triangle(geometry, hit).map_or(Vec3::ZERO, |[a, b, c]| (a + b + c) / 3.0 - Vec3::Y),
        }
    }

    /// Texture coordinates.
    fn uv(&self, geometry: &Geometry, hit: &Hit, p: Vec3) -> Vec2 {
        match geometry.objects[hit.id.object as usize].shape {
            Shape::Sphere { center, radius } => {
                let n = (p - center).normalize_or(Vec3::Z);
                let height = ((p.y - center.y) / radius).clamp(-1.0, 1.0);
                Vec2::new((n.x + 1.0) / 4.0, math::acos(height) / std::f32::consts::PI)
            }
            Shape::Plane(index) => {
                let offset = p - geometry.planes[index as usize].point;
                let [eu, ev] = self.plane_axes[index as usize];
                let along = |axis: Vec3| (offset.dot(axis) % 10.0).abs() / 10.0;
                Vec2::new(along(eu), along(ev))
            }
            Shape::Mesh(index) | Shape::MeshInstance(index) => {
                let mesh = &geometry.meshes[index as usize];
                let uvs = mesh.triangle_uvs(hit.id.index as usize);
                let [a, b, c] = uvs.unwrap_or([Vec2::new(0.1, 0.1), Vec2::new(0.5, 0.1), Vec2::new(0.1, 0.5)]);
                // The original forgets to add the first vertex's own coordinates.
                let Vec2 { x: u, y: v } = (b - a) * hit.u + (c - a) * hit.v;
                Vec2::new(u.abs(), if v < 0.0 { 1.0 - v.abs() } else { v })
            }
            Shape::Ellipsoid => geometry.uv(hit, p),
        }
    }

    /// Fixes the texture axes of every plane by the first point of it that is seen, row by row from the top left. (In
    /// the original it was the first point that any of its threads shaded.)
    pub fn fix_plane_axes(&mut self, geometry: &Geometry, size: [u32; 2]) {
        let mut first: Vec<Option<Vec3>> = vec![None; geometry.planes.len()];
        let mut hits = Vec::new();
        let mut scratch = crate::geometry::Scratch::default();
        for y in 0..size[1] {
            if first.iter().all(Option::is_some) {
                break;
            }
            let rays: Vec<PixelRay> = (0..size[0])
                .map(|x| {
                    let (origin, direction) = self.camera.ray(x as f32 + 0.5, y as f32 + 0.5);
                    PixelRay(Ray { origin, direction, t_min: T_MIN, t_max: f32::INFINITY, skip: Id::NONE })
                })
                .collect();
            geometry.closest(&rays, &mut hits, &mut scratch);
            for (ray, hit) in rays.iter().zip(&hits) {
                if hit.id == Id::NONE {
                    continue;
                }
                if let Shape::Plane(index) = geometry.objects[hit.id.object as usize].shape {
                    first[index as usize].get_or_insert(ray.0.origin + ray.0.direction * hit.t);
                }
            }
        }
        let axes = |(plane, first): (&PlaneShape, &Option<Vec3>)| {
            let along = first.map_or(Vec3::ZERO, |q| q - plane.point).normalize_or(math::basis(plane.normal).0);
            [along.cross(plane.normal).normalize_or(math::basis(plane.normal).1), along]
        };
        self.plane_axes = geometry.planes.iter().zip(&first).map(axes).collect();
    }
}

/// A ray by itself, for the geometry's batches.
struct PixelRay(Ray);

impl AsRef<Ray> for PixelRay {
    fn as_ref(&self) -> &Ray {
        &self.0
    }
}

/// The corners of the triangle that was hit, in the world.
fn triangle(geometry: &Geometry, hit: &Hit) -> Option<[Vec3; 3]> {
    let object = &geometry.objects[hit.id.object as usize];
    match object.shape {
        Shape::Mesh(index) => Some(geometry.meshes[index as usize].triangle_points(hit.id.index as usize)),
        Shape::MeshInstance(index) => {
            let corners = geometry.meshes[index as usize].triangle_points(hit.id.index as usize);
            Some(corners.map(|corner| object.world_from_object.point(corner)))
        }
        _ => None,
    }
}

/// Queues a secondary ray with a node of its own.
fn spawn(point: &Point<'_>, direction: Vec3, weight: f32, kind: RayKind, queues: &mut Queues) {
    let path = point.path;
    let node = queues.nodes.len() as u32;
    queues.nodes.push(Node { direct: Vec3::ZERO, indirect: Vec3::ZERO, parent: path.node, weight, gain: 0.0 });
    let depth = if kind == RayKind::Refraction { path.depth.refracted() } else { path.depth.reflected() };
    let ray = Ray { origin: point.position, direction, t_min: T_MIN, t_max: f32::INFINITY, skip: point.hit.id };
    queues.rays.push(PathRay { ray, weight: Vec3::ONE, node, key: path.key, kind, depth });
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
