//! Where and how a hit lies on its object.

use glam::{Vec2, Vec3};

use super::{Geometry, Hit, MeshShape, Ray, Shape};
use crate::math;

/// A point on a surface, in the world.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surface {
    pub point: Vec3,
    /// Unit normal of the shape itself, on the side where the shape has its outside.
    pub geometric: Vec3,
    /// Unit normal for shading, on the same side.
    pub normal: Vec3,
}

impl Geometry {
    /// The surface at a hit.
    #[inline]
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let object = &self.objects[hit.id.object as usize];
        match object.shape {
            Shape::Sphere { center, radius } => {
                let normal = (ray.origin + ray.direction * hit.t - center).normalize_or(Vec3::Z);
                // Back onto the sphere: the distance along the ray is the less exact the farther it reached.
                Surface { point: center + normal * radius, geometric: normal, normal }
            }
            Shape::Plane(index) => {
                let plane = &self.planes[index as usize];
                let point = ray.origin + ray.direction * hit.t;
                let point = point - plane.normal * (point - plane.point).dot(plane.normal);
                Surface { point, geometric: plane.normal, normal: plane.normal }
            }
            Shape::Mesh(index) => mesh_surface(&self.meshes[index as usize], hit),
            Shape::MeshInstance(index) => {
                let local = mesh_surface(&self.meshes[index as usize], hit);
                let normal = |n: Vec3| object.object_from_world.transposed(n).normalize_or(Vec3::Z);
                let geometric = normal(local.geometric);
                Surface { point: object.world_from_object.point(local.point), geometric, normal: normal(local.normal) }
            }
            Shape::Ellipsoid => {
                let local = object.object_from_world.point(ray.origin + ray.direction * hit.t).normalize_or(Vec3::Z);
                let normal = object.object_from_world.transposed(local).normalize_or(Vec3::Z);
                Surface { point: object.world_from_object.point(local), geometric: normal, normal }
            }
        }
    }

    /// Texture coordinates at a hit; zero where the shape has none (format reference, §3.13).
    pub fn uv(&self, hit: &Hit, point: Vec3) -> Vec2 {
        let object = &self.objects[hit.id.object as usize];
        match object.shape {
            Shape::Sphere { .. } | Shape::Ellipsoid => {
                let local = object.object_from_world.point(point);
                let longitude = math::atan2(local.y, local.x) / std::f32::consts::TAU;
                let u = if longitude < 0.0 { longitude + 1.0 } else { longitude };
                Vec2::new(u, math::acos(local.z.clamp(-1.0, 1.0)) / std::f32::consts::PI)
            }
            Shape::Plane(index) => {
                let plane = &self.planes[index as usize];
                plane.uv.map_or(Vec2::ZERO, |[du, dv]| {
                    let offset = point - plane.point;
                    Vec2::new(offset.dot(du), offset.dot(dv))
                })
            }
            Shape::Mesh(index) | Shape::MeshInstance(index) => {
                let mesh = &self.meshes[index as usize];
                mesh.triangle_uvs(hit.id.index as usize).map_or(Vec2::ZERO, |uvs| blend(uvs, hit))
            }
        }
    }

    /// The material at a hit.
    #[inline]
    pub fn material(&self, hit: &Hit) -> u32 {
        let object = &self.objects[hit.id.object as usize];
        let slot = match object.shape {
            Shape::Mesh(index) | Shape::MeshInstance(index) => {
                self.meshes[index as usize].slots.get(hit.id.index as usize).copied().unwrap_or(0)
            }
            _ => 0,
        };
        object.materials.get(slot as usize).copied().unwrap_or(crate::material::BLACK)
    }
}

/// Barycentric interpolation.
fn blend<T: std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T>>([a, b, c]: [T; 3], hit: &Hit) -> T {
    a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v
}

/// The surface in the space of the mesh.
#[inline]
fn mesh_surface(mesh: &MeshShape, hit: &Hit) -> Surface {
    let index = hit.id.index as usize;
    let [a, b, c] = mesh.triangle_points(index);
    let geometric = math::unit_normal(a, b, c);
    let normal = match mesh.normals.triangle(mesh, index) {
        Some(normals) => {
            let normal = blend(normals, hit).normalize_or(geometric);
            if normal.dot(geometric) < 0.0 { -normal } else { normal }
        }
        None => geometric,
    };
    Surface { point: blend([a, b, c], hit), geometric, normal }
}
