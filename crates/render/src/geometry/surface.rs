//! Where and how a hit lies on its object.

use glam::{Vec2, Vec3};

use super::analytic;
use super::simd::{self, Simd};
use super::{Geometry, Hit, Hits, Id, MeshShape, Met, Ray, Rows, Run, Shape, SphereSet};
use crate::math;
use crate::mesh_file::MeshFile;

/// A point on a surface, in the world.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surface {
    pub point: Vec3,
    /// Unit normal of the shape itself, on the side where the shape has its outside.
    pub geometric: Vec3,
    /// Unit normal for shading, on the same side.
    pub normal: Vec3,
}

/// Surfaces in rows: see [`Surface`] for what they mean.
#[derive(Debug, Default)]
pub(crate) struct Surfaces {
    pub point: Rows,
    pub geometric: Rows,
    pub normal: Rows,
    /// Of spheres, whose points are worked out together; negative elsewhere.
    radius: Vec<f32>,
}

impl Surfaces {
    pub fn resize(&mut self, count: usize) {
        self.point.resize(count);
        self.geometric.resize(count);
        self.normal.resize(count);
        self.radius.resize(count, -1.0);
    }

    pub fn get(&self, i: usize) -> Surface {
        Surface { point: self.point.get(i), geometric: self.geometric.get(i), normal: self.normal.get(i) }
    }
}

/// Moves points onto their spheres.
struct OntoSpheres<'a> {
    surfaces: &'a mut Surfaces,
}

impl simd::Kernel for OntoSpheres<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Surfaces { point, geometric, normal, radius } = self.surfaces;
        let count = radius.len();
        let ([px, py, pz], [gx, gy, gz]) = (point.slices_mut(count), geometric.slices_mut(count));
        let [nx, ny, nz] = normal.slices_mut(count);
        for i in 0..count {
            // For spheres the point is the centre so far, and the normal the way outward.
            let scale = 1.0 / (gx[i] * gx[i] + gy[i] * gy[i] + gz[i] * gz[i]).sqrt();
            let unit = scale > 0.0 && scale < f32::INFINITY;
            let pick = |n: f32, fallback: f32| if unit { n * scale } else { fallback };
            let (x, y, z) = (pick(gx[i], 0.0), pick(gy[i], 0.0), pick(gz[i], 1.0));
            let (r, sphere) = (radius[i], radius[i] >= 0.0);
            let onto = |center: f32, n: f32| if sphere { center + n * r } else { center };
            (px[i], py[i], pz[i]) = (onto(px[i], x), onto(py[i], y), onto(pz[i], z));
            let turn = |n: f32, old: f32| if sphere { n } else { old };
            (gx[i], gy[i], gz[i]) = (turn(x, gx[i]), turn(y, gy[i]), turn(z, gz[i]));
            (nx[i], ny[i], nz[i]) = (turn(x, nx[i]), turn(y, ny[i]), turn(z, nz[i]));
        }
    }
}

impl Geometry {
    /// The surfaces that rays have met; `runs` says on which objects.
    pub fn surfaces(&self, met: &Met, runs: &[Run], surfaces: &mut Surfaces) {
        let count = runs.iter().map(|run| run.count as usize).sum();
        surfaces.resize(count);
        let mut all = 0..count;
        for run in runs {
            let members = all.by_ref().take(run.count as usize);
            if let Shape::Sphere { center, radius } = self.objects[run.object as usize].shape {
                for i in members {
                    let outward = met.origin.get(i) + met.direction.get(i) * met.hits.t[i] - center;
                    surfaces.point.set(i, center);
                    surfaces.geometric.set(i, outward);
                    surfaces.radius[i] = radius;
                }
                continue;
            }
            for i in members {
                let surface = self.surface(&met.ray(i), &met.hits.get(i));
                surfaces.point.set(i, surface.point);
                surfaces.geometric.set(i, surface.geometric);
                surfaces.normal.set(i, surface.normal);
                surfaces.radius[i] = -1.0;
            }
        }
        simd::run(OntoSpheres { surfaces });
    }

    /// The surface at a hit.
    #[inline]
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let pose = self.pose(hit);
        match self.objects[hit.id.object as usize].shape {
            Shape::Sphere { center, radius } => on_sphere(ray, hit, center, radius),
            Shape::Plane(index) => {
                let plane = &self.planes[index as usize];
                let point = ray.origin + ray.direction * hit.t;
                let point = point - plane.normal * (point - plane.point).dot(plane.normal);
                Surface { point, geometric: plane.normal, normal: plane.normal }
            }
            Shape::Mesh(index) => mesh_surface(&self.meshes[index as usize], hit),
            Shape::MeshInstance(index) => {
                let local = mesh_surface(&self.meshes[index as usize], hit);
                let normal = |n: Vec3| pose.object_from_world.transposed(n).normalize_or(Vec3::Z);
                let geometric = normal(local.geometric);
                Surface { point: pose.world_from_object.point(local.point), geometric, normal: normal(local.normal) }
            }
            Shape::Ellipsoid => {
                let local = pose.object_from_world.point(ray.origin + ray.direction * hit.t).normalize_or(Vec3::Z);
                let normal = pose.object_from_world.transposed(local).normalize_or(Vec3::Z);
                Surface { point: pose.world_from_object.point(local), geometric: normal, normal }
            }
            Shape::Spheres(index) => {
                let sphere = self.sphere_sets[index as usize].spheres[hit.id.index as usize];
                on_sphere(ray, hit, sphere.truncate(), sphere.w)
            }
            Shape::SpheresInstance(index) => {
                let sphere = self.sphere_sets[index as usize].spheres[hit.id.index as usize];
                let local = pose.object_from_world.point(ray.origin + ray.direction * hit.t) - sphere.truncate();
                let outward = local.normalize_or(Vec3::Z);
                let normal = pose.object_from_world.transposed(outward).normalize_or(Vec3::Z);
                let point = pose.world_from_object.point(sphere.truncate() + outward * sphere.w);
                Surface { point, geometric: normal, normal }
            }
            Shape::Analytic(index) => analytic::surface(&*self.tree.analytic.shapes[index as usize], &pose, ray, hit),
        }
    }

    /// Texture coordinates at a hit; zero where the shape has none (format reference, §3.13).
    pub fn uv(&self, hit: &Hit, point: Vec3) -> Vec2 {
        let pose = self.pose(hit);
        match self.objects[hit.id.object as usize].shape {
            Shape::Sphere { .. } | Shape::Ellipsoid => sphere_uv(pose.object_from_world.point(point)),
            Shape::Spheres(index) | Shape::SpheresInstance(index) => {
                let set = &self.sphere_sets[index as usize];
                if set.uv { sphere_uv(self.outward(set, hit, point)) } else { Vec2::ZERO }
            }
            Shape::Analytic(index) => {
                let local = pose.object_from_world.point(point);
                self.tree.analytic.shapes[index as usize].uv(hit.id.index as usize, [hit.u, hit.v], local)
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

    /// The corners of the triangle that was hit, in the world.
    pub fn triangle(&self, hit: &Hit) -> Option<[Vec3; 3]> {
        let pose = self.pose(hit);
        match self.objects[hit.id.object as usize].shape {
            Shape::Mesh(index) => Some(self.meshes[index as usize].triangle_points(hit.id.index as usize)),
            Shape::MeshInstance(index) => {
                let corners = self.meshes[index as usize].triangle_points(hit.id.index as usize);
                Some(corners.map(|corner| pose.world_from_object.point(corner)))
            }
            _ => None,
        }
    }

    /// All triangles in the world, at the middle of the exposure.
    pub fn triangles(&self) -> MeshFile {
        let mut all = MeshFile::default();
        for object in &self.objects {
            let (mesh, place) = match object.shape {
                Shape::Mesh(index) => (&self.meshes[index as usize], None),
                Shape::MeshInstance(index) => (&self.meshes[index as usize], Some(object.pose.world_from_object)),
                _ => continue,
            };
            let first = all.points.len() as u32;
            all.triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
            all.points.extend(mesh.points.iter().map(|&p| place.map_or(p, |place| place.point(p)).to_array()));
        }
        all
    }

    /// One over the radius of an object that is a sphere; 0 for all else.
    pub fn curvature(&self, object: u32) -> f32 {
        match self.objects[object as usize].shape {
            Shape::Sphere { radius, .. } => 1.0 / radius,
            _ => 0.0,
        }
    }

    /// How much of the texture coordinates a unit of length holds; 0 where that is not known.
    pub fn uv_scale(&self, hit: &Hit) -> f32 {
        let object = &self.objects[hit.id.object as usize];
        let scale = match object.shape {
            // Half a turn is 1.
            Shape::Sphere { .. } | Shape::Ellipsoid => {
                self.pose(hit).object_from_world.scale() * std::f32::consts::FRAC_1_PI
            }
            Shape::Plane(index) => {
                self.planes[index as usize].uv.map_or(0.0, |[du, dv]| (du.length() * dv.length()).sqrt())
            }
            Shape::Mesh(index) | Shape::MeshInstance(index) => {
                let uvs = self.meshes[index as usize].triangle_uvs(hit.id.index as usize);
                uvs.zip(self.triangle(hit)).map_or(0.0, |([p, q, r], [a, b, c])| {
                    ((q - p).perp_dot(r - p).abs() / (b - a).cross(c - a).length()).sqrt()
                })
            }
            Shape::Spheres(_) | Shape::SpheresInstance(_) | Shape::Analytic(_) => 0.0,
        };
        if scale.is_finite() { scale } else { 0.0 }
    }

    /// The direction in which the second texture coordinate grows, in the world; of spheres that of the parallels
    /// (format reference, §3.13). `None` where the shape has none.
    pub fn tangent(&self, hit: &Hit, point: Vec3) -> Option<Vec3> {
        let pose = self.pose(hit);
        match self.objects[hit.id.object as usize].shape {
            Shape::Sphere { .. } | Shape::Ellipsoid => {
                let local = pose.object_from_world.point(point);
                Some(pose.world_from_object.vector(Vec3::new(-local.y, local.x, 0.0)))
            }
            Shape::Plane(_) => None,
            Shape::Spheres(index) | Shape::SpheresInstance(index) => {
                let set = &self.sphere_sets[index as usize];
                let outward = self.outward(set, hit, point);
                set.uv.then(|| pose.world_from_object.vector(Vec3::new(-outward.y, outward.x, 0.0)))
            }
            Shape::Analytic(index) => {
                let local = pose.object_from_world.point(point);
                let shape = &self.tree.analytic.shapes[index as usize];
                let tangent = shape.tangent(hit.id.index as usize, [hit.u, hit.v], local)?;
                Some(pose.world_from_object.vector(tangent))
            }
            Shape::Mesh(index) | Shape::MeshInstance(index) => {
                let [uv0, uv1, uv2] = self.meshes[index as usize].triangle_uvs(hit.id.index as usize)?;
                let [v0, v1, v2] = self.triangle(hit)?;
                let (d1, d2) = (uv0 - uv2, uv1 - uv2);
                let area = d1.x * d2.y - d1.y * d2.x;
                (area != 0.0).then(|| ((v1 - v2) * d1.x - (v0 - v2) * d2.x) / area)
            }
        }
    }

    /// The way out of one of many spheres at a point in the world, as a unit vector in their object's space.
    fn outward(&self, set: &SphereSet, hit: &Hit, point: Vec3) -> Vec3 {
        let pose = self.pose(hit);
        let center = set.spheres[hit.id.index as usize].truncate();
        let outward = match self.objects[hit.id.object as usize].shape {
            Shape::SpheresInstance(_) => pose.object_from_world.point(point) - center,
            _ => pose.object_from_world.vector(point - center),
        };
        outward.normalize_or(Vec3::Z)
    }

    /// The hits in runs of one object and material, which is `none` where nothing is hit.
    pub fn runs(&self, hits: &Hits, none: u32, runs: &mut Vec<Run>) {
        runs.clear();
        let objects = &hits.id.object;
        let mut first = 0;
        while let Some(&object) = objects.get(first) {
            let only = self.only_material.get(object as usize).copied().unwrap_or(none);
            let same = alike(&objects[first..]);
            let (material, count) = if only == MANY {
                let material = |i: usize| self.material_of(hits.id.get(i));
                let of_first = material(first);
                (of_first, 1 + (first + 1..first + same).take_while(|&i| material(i) == of_first).count())
            } else {
                (only, same)
            };
            runs.push(Run { first: first as u32, count: count as u32, object, material });
            first += count;
        }
    }

    /// The material of a primitive.
    fn material_of(&self, id: Id) -> u32 {
        let object = &self.objects[id.object as usize];
        let slot = match object.shape {
            Shape::Mesh(index) | Shape::MeshInstance(index) => {
                self.meshes[index as usize].slots.get(id.index as usize).copied().unwrap_or(0)
            }
            _ => 0,
        };
        object.materials.get(slot as usize).copied().unwrap_or(crate::material::BLACK)
    }

    /// The material of each object that has only one, [`MANY`] for the others.
    pub(super) fn only_materials(&self) -> Vec<u32> {
        let many = |object: &super::Object| match object.shape {
            Shape::Mesh(index) | Shape::MeshInstance(index) => !self.meshes[index as usize].slots.is_empty(),
            _ => false,
        };
        let only =
            |(number, object)| if many(object) { MANY } else { self.material_of(Id { object: number, index: 0 }) };
        (0..).zip(&self.objects).map(only).collect()
    }
}

/// Texture coordinates of the unit sphere: longitude from the x axis, and angle from the z axis.
pub(super) fn sphere_uv(p: Vec3) -> Vec2 {
    let longitude = math::atan2(p.y, p.x) / std::f32::consts::TAU;
    let u = if longitude < 0.0 { longitude + 1.0 } else { longitude };
    Vec2::new(u, math::acos(p.z.clamp(-1.0, 1.0)) / std::f32::consts::PI)
}

/// How many numbers from the first on are the same.
fn alike(numbers: &[u32]) -> usize {
    const STEP: usize = 16;
    let first = numbers[0];
    // Without branches in between, a step at a time is compared in registers.
    let differs = |step: &[u32]| step.iter().fold(0, |all, number| all | (number ^ first)) != 0;
    let whole = numbers.chunks_exact(STEP).take_while(|step| !differs(step)).count() * STEP;
    whole + numbers[whole..].iter().take_while(|&&number| number == first).count()
}

/// In place of a material: different triangles have different ones.
const MANY: u32 = u32::MAX;

/// The surface of a sphere in the world.
#[inline]
fn on_sphere(ray: &Ray, hit: &Hit, center: Vec3, radius: f32) -> Surface {
    let normal = (ray.origin + ray.direction * hit.t - center).normalize_or(Vec3::Z);
    // Back onto the sphere: the distance along the ray is the less exact the farther it reached.
    Surface { point: center + normal * radius, geometric: normal, normal }
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
