//! The 2010 program's meaning of a scene: display values throughout, lights with a linear range, half-and-half
//! mirrors, a camera formula of its own. Everything that is particular to this dialect is in this file.

mod camera;
mod gathered;
mod shade;

use glam::{Vec2, Vec3};
use jaspe_texture::Space;

use crate::clock::Stage;
use crate::film::Pixel;
use crate::geometry::{Geometry, Hit, Hits, Id, PlaneShape, Ray, Rays, Shape, padded, simd};
use crate::material::Albedo;
use crate::math;
use crate::wave::{Batch, Path, Queues, Rules};
pub(crate) use camera::{Grid, ReportCamera};
use gathered::Gathered;
use shade::Room;

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
    type Nodes = Gathered;
    type Room = Room;
    const T_MIN: f32 = T_MIN;
    const OPEN: bool = false;

    /// Every sample has few rays, so that more of them fill the batches.
    fn wave(&self) -> usize {
        2048
    }

    fn shade(&self, batch: &Batch<'_>, room: &mut Room, queues: &mut Queues<Gathered>) {
        room.locate(self, batch);
        queues.clock.lap(Stage::Shade);
        self.albedos(batch, room);
        queues.clock.lap(Stage::Texture);
        if let Albedo::Procedural(_) = batch.material.albedo {
            queues.stats.texture_points += batch.len() as u64;
        }
        self.direct(batch, room, queues);
        room.spawn(batch, queues);
    }

    fn miss(&self, _: &Path, _: Vec3, _: &mut Gathered) -> bool {
        true
    }

    fn seen(&self, _: &Geometry, _: &Rays, _: &Hits, _: usize) -> Vec3 {
        Vec3::ZERO
    }

    fn resolve(&self, nodes: &mut Gathered, pixels: &mut [Pixel]) {
        nodes.resolve(pixels);
    }
}

/// Texture coordinates of a sphere: `x` of the unit normal, and the height over the radius.
#[inline(always)]
fn sphere_uv(x: f32, height: f32) -> Vec2 {
    Vec2::new((x + 1.0) / 4.0, math::acos(height.clamp(-1.0, 1.0)) / std::f32::consts::PI)
}

impl Report {
    /// Colours of a batch, one per member.
    fn albedos(&self, batch: &Batch<'_>, room: &mut Room) {
        let Room { position, outward, heights, round, texture_points, coefficients, colors, .. } = room;
        let uv = |i: usize| self.uv(batch.geometry, &batch.hit(i), position.get(i));
        let count = batch.len();
        colors.resize(padded(count));
        match &batch.material.albedo {
            Albedo::Color(color) | Albedo::Blend { color, .. } => colors.fill(*color),
            Albedo::Picture(picture) => (0..count).for_each(|i| colors.set(i, picture.nearest(uv(i)))),
            Albedo::Procedural(procedural) => match procedural.texture.space() {
                Space::World => procedural.paint(position, coefficients, colors),
                Space::Local => procedural.paint(outward, coefficients, colors),
                Space::Uv => {
                    texture_points.resize(padded(count));
                    if *round {
                        simd::run(shade::SphereUvs { outward, heights, uvs: texture_points });
                    } else {
                        (0..count).for_each(|i| texture_points.set(i, uv(i).extend(0.0)));
                    }
                    procedural.paint(texture_points, coefficients, colors);
                }
            },
        }
    }

    /// The point that directions are taken from: marble, stone and wood only know directions.
    fn reference(&self, geometry: &Geometry, hit: &Hit) -> Vec3 {
        match geometry.objects[hit.id.object as usize].shape {
            Shape::Sphere { center, .. } => center,
            Shape::Plane(index) => geometry.planes[index as usize].point,
            _ => geometry.triangle(hit).map_or(Vec3::ZERO, |[a, b, c]| (a + b + c) / 3.0 - Vec3::Y),
        }
    }

    /// Texture coordinates.
    fn uv(&self, geometry: &Geometry, hit: &Hit, p: Vec3) -> Vec2 {
        match geometry.objects[hit.id.object as usize].shape {
            Shape::Sphere { center, radius } => {
                let n = (p - center).normalize_or(Vec3::Z);
                sphere_uv(n.x, (p.y - center.y) / radius)
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
            Shape::Ellipsoid | Shape::Spheres(_) | Shape::SpheresInstance(_) | Shape::Analytic(_) => {
                geometry.uv(hit, p)
            }
        }
    }

    /// Fixes the texture axes of every plane by the first point of it that is seen, row by row from the top left. (In
    /// the original it was the first point that any of its threads shaded.)
    pub fn fix_plane_axes(&mut self, geometry: &Geometry, size: [u32; 2]) {
        let mut first: Vec<Option<Vec3>> = vec![None; geometry.planes.len()];
        let (mut rays, mut hits) = (Rays::default(), Hits::default());
        let mut scratch = crate::geometry::Scratch::default();
        for y in 0..size[1] {
            if first.iter().all(Option::is_some) {
                break;
            }
            rays.clear();
            for x in 0..size[0] {
                let (origin, direction) = self.camera.ray(x as f32 + 0.5, y as f32 + 0.5);
                rays.push(Ray { origin, direction, t_min: T_MIN, t_max: f32::INFINITY, skip: Id::NONE, time: None });
            }
            geometry.closest(rays.view(T_MIN), &mut hits, &mut scratch);
            for i in 0..rays.len() {
                let Some(object) = geometry.objects.get(hits.id.object[i] as usize) else { continue };
                if let Shape::Plane(index) = object.shape {
                    first[index as usize].get_or_insert(rays.origin.get(i) + rays.direction.get(i) * hits.t[i]);
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
