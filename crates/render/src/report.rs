//! The 2010 program's meaning of a scene: display values throughout, lights with a linear range, half-and-half
//! mirrors, a camera formula of its own. Everything that is particular to this dialect is in this file.

use std::ops::Range;

use glam::{Vec2, Vec3};
use jaspe_texture::Space;

use crate::compile::CompiledScene;
use crate::geometry::{Geometry, Hit, Id, PlaneShape, Ray, Shape};
use crate::material::{Albedo, Material, Response, TextureBatch};
use crate::math;
use crate::sampler::SampleKey;
use crate::wave::{Batch, CameraSample, Node, PathRay, Queues, RayKind, Rules, ShadowRay};

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

    /// Appends samples of one pixel, of `edge` × `edge` cells with `repeats` samples each; `edge` is a power of two.
    pub fn samples(
        &self,
        [x, y]: [u32; 2],
        [edge, repeats]: [u32; 2],
        indices: Range<u32>,
        pixel: SampleKey,
        samples: &mut Vec<CameraSample>,
    ) {
        let alone = edge * edge * repeats == 1;
        let step = 0.5 / edge as f32;
        // Cells are not stratified: the jitter is as wide as the pixel.
        let at = |pixel: u32, cell: u32, jitter: f32| pixel as f32 + (cell + 1) as f32 * step + jitter - 0.5;
        let cell = indices.start / repeats;
        let (mut row, mut column, mut repeat) = (cell / edge, cell % edge, indices.start % repeats);
        samples.extend(indices.map(|index| {
            let key = pixel.with_index(index);
            let [r, s] = if alone { [0.5; 2] } else { key.random_pair(0) };
            let ray = Some(self.ray(at(x, row, r), at(y, column, s)));
            repeat += 1;
            if repeat == repeats {
                (repeat, column) = (0, column + 1);
            }
            if column == edge {
                (column, row) = (0, row + 1);
            }
            CameraSample { ray, key, weight: 1.0 }
        }));
    }
}

/// Hits that are shaded together.
const CHUNK: usize = 64;

/// One coordinate of all hits of a chunk.
type Row = [f32; CHUNK];

/// Hits in the original's terms, each coordinate in a row of its own, so that the loops over them are vectorised.
struct Points {
    position: [Row; 3],
    /// Not of unit length for triangles and planes.
    normal: [Row; 3],
}

/// A light as the points of a chunk see it.
struct Sight {
    direction: [Row; 3],
    distance: Row,
    /// Between the light and the normal.
    cosine: Row,
}

impl Rules for Report {
    fn shade(&self, batch: &Batch<'_>, textures: &mut TextureBatch, colors: &mut Vec<Vec3>, queues: &mut Queues) {
        let material = &batch.scene.materials[batch.material as usize];
        self.albedos(batch, material, textures, colors);
        queues.stats.texture_points += textures.len() as u64;
        textures.clear();
        let response = Share::of(material);
        let mut points = Points { position: [[0.0; CHUNK]; 3], normal: [[0.0; CHUNK]; 3] };
        for (chunk, colors) in batch.chunks(CHUNK).zip(colors.chunks(CHUNK)) {
            self.locate(&chunk, &mut points);
            for (path, _) in chunk.iter() {
                queues.nodes[path.node as usize].gain = response.gain;
            }
            self.direct(&chunk, material, &points, colors, queues);
            if response.reflected > 0.0 || response.refracted > 0.0 {
                spawn_all(&chunk, &response, &points, queues);
            }
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
    /// Positions and normals of a chunk.
    fn locate(&self, chunk: &Batch<'_>, points: &mut Points) {
        let geometry = chunk.geometry();
        let mut curved = [false; CHUNK];
        for (i, (path, hit)) in chunk.iter().enumerate() {
            let position = path.ray.origin + path.ray.direction * hit.t;
            let normal = match geometry.objects[hit.id.object as usize].shape {
                Shape::Sphere { center, .. } => {
                    curved[i] = true;
                    position - center
                }
                Shape::Plane(index) => self.plane_normals[index as usize],
                _ => facing_normal(geometry, &path.ray, hit),
            };
            for axis in 0..3 {
                points.position[axis][i] = position[axis];
                points.normal[axis][i] = normal[axis];
            }
        }
        let [nx, ny, nz] = &mut points.normal;
        for i in 0..CHUNK {
            let length = (nx[i] * nx[i] + ny[i] * ny[i] + nz[i] * nz[i]).sqrt();
            let scale = if curved[i] && length > 0.0 { 1.0 / length } else { 1.0 };
            (nx[i], ny[i], nz[i]) = (nx[i] * scale, ny[i] * scale, nz[i] * scale);
        }
    }

    /// Light from the lights; nothing in between may be hit, glass included.
    fn direct(&self, chunk: &Batch<'_>, material: &Material, points: &Points, colors: &[Vec3], queues: &mut Queues) {
        let phong = match material.response {
            Response::Phong { specular, power, .. } => Some((specular, power)),
            _ => None,
        };
        if self.lights.is_empty() && phong.is_none() {
            for ((path, _), &color) in chunk.iter().zip(colors) {
                queues.nodes[path.node as usize].direct += UNLIT * color;
            }
        }
        for light in &self.lights {
            let sight = Sight::of(light, points);
            for (i, ((path, hit), &color)) in chunk.iter().zip(colors).enumerate() {
                let (direction, distance, cosine) = (at(&sight.direction, i), sight.distance[i], sight.cosine[i]);
                let contribution = match phong {
                    Some((specular, power)) => {
                        let normal = at(&points.normal, i);
                        let mirrored = (normal * (2.0 * cosine) - direction).normalize_or(normal);
                        let highlight = signed_power(mirrored.dot(path.ray.direction), power);
                        0.5 * color * cosine + specular * light.color * highlight
                    }
                    None if cosine <= 0.0 || distance > light.range => continue,
                    None => cosine * light.color * color * (1.0 - distance / light.range),
                };
                if contribution.is_finite() && direction.is_finite() {
                    // A little longer, so that a surface through the light itself is in the way everywhere.
                    let t_max = distance * 1.000_01;
                    let ray = Ray { origin: at(&points.position, i), direction, t_min: T_MIN, t_max, skip: hit.id };
                    queues.shadows.push(ShadowRay { ray, contribution, node: path.node });
                }
            }
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
            Response::Procedural { reflection, transmission } => (reflection, transmission, 0.0),
            _ => (0.0, 0.0, 0.0),
        };
        Share { reflected, refracted, eta, gain: 1.0 / (1.0 + reflected + refracted) }
    }
}

impl Sight {
    fn of(light: &ReportLight, points: &Points) -> Sight {
        let mut sight = Sight { direction: [[0.0; CHUNK]; 3], distance: [0.0; CHUNK], cosine: [0.0; CHUNK] };
        let ([px, py, pz], [nx, ny, nz]) = (&points.position, &points.normal);
        let [dx, dy, dz] = &mut sight.direction;
        for i in 0..CHUNK {
            let (x, y, z) = (light.position.x - px[i], light.position.y - py[i], light.position.z - pz[i]);
            let distance = (x * x + y * y + z * z).sqrt();
            (dx[i], dy[i], dz[i]) = (x / distance, y / distance, z / distance);
            sight.distance[i] = distance;
            sight.cosine[i] = nx[i] * dx[i] + ny[i] * dy[i] + nz[i] * dz[i];
        }
        sight
    }
}

/// Point `i` of three rows.
#[inline]
fn at(rows: &[Row; 3], i: usize) -> Vec3 {
    Vec3::new(rows[0][i], rows[1][i], rows[2][i])
}

/// The normal of a triangle towards the ray, as long as its edges make it; of other shapes their own.
fn facing_normal(geometry: &Geometry, ray: &Ray, hit: &Hit) -> Vec3 {
    match triangle(geometry, hit) {
        Some([a, b, c]) => {
            let normal = (b - a).cross(c - a);
            if normal.dot(ray.direction) > 0.0 { -normal } else { normal }
        }
        None => geometry.surface(ray, hit).geometric,
    }
}

/// Queues the secondary rays of a chunk.
fn spawn_all(chunk: &Batch<'_>, share: &Share, points: &Points, queues: &mut Queues) {
    for (i, (path, hit)) in chunk.iter().enumerate() {
        if path.depth.total() >= MAX_BOUNCES {
            continue;
        }
        let (d, normal) = (path.ray.direction, at(&points.normal, i));
        let from = |direction| Ray {
            origin: at(&points.position, i),
            direction,
            t_min: T_MIN,
            t_max: f32::INFINITY,
            skip: hit.id,
        };
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
fn spawn(path: &PathRay, ray: Ray, weight: f32, kind: RayKind, queues: &mut Queues) {
    let node = queues.nodes.len() as u32;
    queues.nodes.push(Node { direct: Vec3::ZERO, indirect: Vec3::ZERO, parent: path.node, weight, gain: 0.0 });
    let depth = if kind == RayKind::Refraction { path.depth.refracted() } else { path.depth.reflected() };
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
