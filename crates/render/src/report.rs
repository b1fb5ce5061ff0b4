//! The 2010 program's meaning of a scene: display values throughout, lights with a linear range, half-and-half
//! mirrors, a camera formula of its own. Everything that is particular to this dialect is in this file.

mod camera;
mod shade;

use glam::{Vec2, Vec3};
use jaspe_texture::Space;

use crate::geometry::simd::{self, Simd};
use crate::geometry::{Geometry, Hit, Id, PlaneShape, Ray, Shape};
use crate::material::{Albedo, Material, TextureBatch};
use crate::math;
use crate::wave::{Batch, Node, PathRay, Queues, Rules};
pub(crate) use camera::{Grid, ReportCamera};
use shade::{CHUNK, Points, Share, spawn_all};

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

impl Rules for Report {
    fn shade(&self, batch: &Batch<'_>, textures: &mut TextureBatch, colors: &mut Vec<Vec3>, queues: &mut Queues) {
        let material = batch.material;
        self.albedos(batch, material, textures, colors);
        queues.stats.texture_points += textures.len() as u64;
        textures.clear();
        simd::run(Light { report: self, batch, material, colors, queues });
    }

    fn miss(&self, _: &PathRay) -> Option<Vec3> {
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

/// Light and secondary rays of a batch, as a kernel.
struct Light<'a, 'b> {
    report: &'a Report,
    batch: &'a Batch<'b>,
    material: &'a Material,
    colors: &'a [Vec3],
    queues: &'a mut Queues,
}

impl simd::Kernel for Light<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Light { report, batch, material, colors, queues } = self;
        let share = Share::of(material);
        let mut points = Points::NONE;
        for (chunk, colors) in batch.chunks(CHUNK).zip(colors.chunks(CHUNK)) {
            report.locate(&chunk, &mut points);
            for &(_, node) in &points.ids[..colors.len()] {
                queues.nodes[node as usize].gain = share.gain;
            }
            report.direct(&chunk, material, &points, colors, queues);
            if share.reflected > 0.0 || share.refracted > 0.0 {
                spawn_all(&chunk, &share, &points, queues);
            }
        }
    }
}

impl Report {
    /// Colours of a batch, one per member.
    fn albedos(&self, batch: &Batch<'_>, material: &Material, textures: &mut TextureBatch, colors: &mut Vec<Vec3>) {
        let geometry = batch.geometry;
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
