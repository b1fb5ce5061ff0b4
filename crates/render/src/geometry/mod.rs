//! Shapes in space and the rays that meet them.
//!
//! Everything bounded lies in one tree ([`traverse::Tree`]); planes are infinite and tested one by one. What a ray
//! meets is named by an [`Id`]; where and how it lies there is worked out in [`surface`].

pub(crate) mod analytic;
mod build;
mod bvh;
mod collapse;
mod few;
mod hull;
mod kernel;
mod packet;
mod pages;
mod plan;
mod rays;
pub(crate) mod simd;
mod stream;
mod surface;
mod traverse;

#[cfg(test)]
mod tests;

use glam::{Vec2, Vec3, Vec4};
use jaspe_noise::simd::Level;

use crate::affine::{self, Affine};
use crate::motion::Motion;
use few::Few;
pub(crate) use plan::{Placement, Plan};
pub(crate) use rays::{Hits, Ids, Met, RayView, Rays, Rows, Run, group, padded, put_group, spread};
use stream::Outcome;
pub(crate) use stream::Scratch;
pub(crate) use surface::{Surface, Surfaces};

/// A primitive: which object, and which of its triangles (0 for everything else).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Id {
    pub object: u32,
    pub index: u32,
}

impl Id {
    /// No primitive.
    pub const NONE: Id = Id { object: u32::MAX, index: u32::MAX };

    /// Whether this primitive is the one to see where `other` is just as far away.
    #[inline(always)]
    fn precedes(self, other: Id) -> bool {
        other != Id::NONE && (self.object, self.index) < (other.object, other.index)
    }
}

/// A ray: points `origin + t · direction` with `t_min < t < t_max`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ray {
    pub origin: Vec3,
    /// Of unit length in the world.
    pub direction: Vec3,
    pub t_min: f32,
    pub t_max: f32,
    /// The primitive that the ray leaves and cannot meet again at once.
    pub skip: Id,
    /// The moment at which it sees what moves; none is the middle of the exposure.
    pub time: Option<f32>,
}

/// What a ray meets first. `u` and `v` weight a triangle's second and third vertex.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hit {
    pub t: f32,
    pub u: f32,
    pub v: f32,
    pub id: Id,
    /// That of the ray.
    pub time: Option<f32>,
}

impl Hit {
    /// Nothing, infinitely far away.
    pub const NONE: Hit = Hit { t: f32::INFINITY, u: 0.0, v: 0.0, id: Id::NONE, time: None };

    /// Takes the other hit if it is the one to see.
    #[inline(always)]
    fn improve(&mut self, other: Hit) {
        if other.t < self.t || other.t == self.t && other.id.precedes(self.id) {
            *self = other;
        }
    }
}

/// An infinite plane in the world.
#[derive(Debug, Clone)]
pub(crate) struct PlaneShape {
    pub point: Vec3,
    /// Of unit length.
    pub normal: Vec3,
    /// Gradients of the texture coordinates, where three points define them.
    pub uv: Option<[Vec3; 2]>,
    pub object: u32,
}

/// Triangles, in the world where they are seen once, in their own space where instances share them.
#[derive(Debug, Clone, Default)]
pub(crate) struct MeshShape {
    pub points: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    pub normals: PerVertex<Vec3>,
    pub uvs: PerVertex<Vec2>,
    /// Material slot per triangle; empty means slot 0 for all.
    pub slots: Vec<u32>,
}

/// Data per vertex of a mesh, per corner, or none.
#[derive(Debug, Clone, Default)]
pub(crate) enum PerVertex<T> {
    #[default]
    None,
    Vertex(Vec<T>),
    Corner(Vec<T>),
}

impl<T: Copy> PerVertex<T> {
    /// The three values of one triangle.
    pub fn triangle(&self, mesh: &MeshShape, index: usize) -> Option<[T; 3]> {
        match self {
            PerVertex::None => None,
            PerVertex::Vertex(values) => Some(mesh.triangles[index].map(|i| values[i as usize])),
            PerVertex::Corner(values) => Some([0, 1, 2].map(|k| values[3 * index + k])),
        }
    }
}

impl MeshShape {
    /// The corners of a triangle, in the mesh's space.
    #[inline]
    pub fn triangle_points(&self, index: usize) -> [Vec3; 3] {
        self.triangles[index].map(|i| self.points[i as usize])
    }

    /// How much memory the triangles take, without normals and texture coordinates.
    fn bytes(&self) -> usize {
        self.points.len() * size_of::<Vec3>() + self.triangles.len() * size_of::<[u32; 3]>()
    }

    /// The texture coordinates of a triangle's corners.
    pub fn triangle_uvs(&self, index: usize) -> Option<[Vec2; 3]> {
        self.uvs.triangle(self, index)
    }
}

/// What an object is.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Shape {
    Sphere {
        center: Vec3,
        radius: f32,
    },
    /// Index into the planes.
    Plane(u32),
    /// Index into the meshes; the mesh is in world space.
    Mesh(u32),
    /// Index into the meshes; the mesh is in object space.
    MeshInstance(u32),
    /// A unit sphere under a map that is no similarity.
    Ellipsoid,
    /// Index into the sets of spheres; the set is in world space.
    Spheres(u32),
    /// Index into the sets of spheres; the set is in object space.
    SpheresInstance(u32),
    /// Index into the shapes that are met by a formula; the shape is in object space.
    Analytic(u32),
}

/// Many spheres that are one object, in the world where they are seen once, in their own space where instances share them.
#[derive(Debug, Clone)]
pub(crate) struct SphereSet {
    /// Centres, and radii as the fourth.
    pub spheres: Vec<Vec4>,
    /// Whether each has the texture coordinates of a sphere.
    pub uv: bool,
}

/// One visible object.
#[derive(Debug, Clone)]
pub(crate) struct Object {
    pub shape: Shape,
    /// In the middle of the exposure.
    pub pose: Pose,
    /// Index into the motions, if it moves during the exposure.
    motion: Option<u32>,
    /// First material; mesh slots count from here.
    pub materials: Vec<u32>,
}

/// Where an object is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pose {
    pub object_from_world: Affine,
    pub world_from_object: Affine,
}

/// How objects move.
#[derive(Debug, Clone, Default)]
struct Motions(Vec<Motion>);

impl Motions {
    /// Where an object is at a moment.
    #[inline]
    fn pose(&self, object: &Object, time: Option<f32>) -> Pose {
        match (object.motion, time) {
            (Some(motion), Some(time)) => self.moved(object, motion, time),
            _ => object.pose,
        }
    }

    /// Never a part of the kernels, which it would only swell. Where the object is flattened to nothing, it stands still.
    #[inline(never)]
    fn moved(&self, object: &Object, motion: u32, time: f32) -> Pose {
        let world_from_object = self.0[motion as usize].at(f64::from(time));
        affine::inverse(world_from_object).map_or(object.pose, |object_from_world| Pose {
            object_from_world: object_from_world.into(),
            world_from_object: world_from_object.into(),
        })
    }
}

/// All shapes of a scene.
#[derive(Debug, Clone)]
pub(crate) struct Geometry {
    tree: traverse::Tree,
    pub planes: Vec<PlaneShape>,
    pub meshes: Vec<MeshShape>,
    pub sphere_sets: Vec<SphereSet>,
    pub objects: Vec<Object>,
    /// See `Geometry::only_materials`.
    only_material: Vec<u32>,
}

impl Geometry {
    /// Whether anything moves during the exposure, so that rays need moments.
    pub fn is_moving(&self) -> bool {
        !self.tree.motions.0.is_empty()
    }

    /// Where the object of a hit is when it is met.
    #[inline]
    pub fn pose(&self, hit: &Hit) -> Pose {
        self.tree.motions.pose(&self.objects[hit.id.object as usize], hit.time)
    }

    /// Whether a ray that leaves a primitive of this object in a straight line cannot meet it again.
    #[inline]
    pub fn is_flat(&self, object: u32) -> bool {
        match self.objects[object as usize].shape {
            Shape::Plane(_) | Shape::Mesh(_) | Shape::MeshInstance(_) => true,
            Shape::Sphere { .. } | Shape::Ellipsoid | Shape::Spheres(_) | Shape::SpheresInstance(_) => false,
            Shape::Analytic(index) => self.tree.analytic.shapes[index as usize].is_flat(),
        }
    }

    /// How much memory meshes and hierarchy take.
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + self.meshes.iter().map(MeshShape::bytes).sum::<usize>()
    }

    /// The first hit of every ray.
    pub fn closest(&self, rays: RayView<'_>, hits: &mut Hits, scratch: &mut Scratch) {
        hits.resize(rays.len());
        hits.time.clear();
        hits.time.extend_from_slice(rays.time);
        self.closest_at(simd::level(), rays, hits, scratch);
    }

    /// For every shadow ray, whether something lies before its end; a ray that ends before it begins counts as blocked.
    pub fn occluded(&self, rays: RayView<'_>, blocked: &mut Vec<bool>, scratch: &mut Scratch) {
        blocked.resize(rays.len(), false);
        self.occluded_at(simd::level(), rays, blocked, scratch);
    }

    fn closest_at(&self, level: Level, rays: RayView<'_>, hits: &mut Hits, scratch: &mut Scratch) {
        self.meet(level, rays, scratch, stream::Closest(hits));
    }

    fn occluded_at(&self, level: Level, rays: RayView<'_>, blocked: &mut [bool], scratch: &mut Scratch) {
        self.meet(level, rays, scratch, stream::Blocked(blocked));
    }

    fn meet<O: Outcome>(&self, level: Level, rays: RayView<'_>, scratch: &mut Scratch, outcome: O) {
        match Few::of(&self.tree, &self.planes) {
            Some(few) => simd::run_at(level, few::Meet { few, rays, outcome }),
            None => simd::run_at(level, Meet { geometry: self, rays, scratch, outcome }),
        }
    }
}

/// What every ray meets by the tree, as a kernel.
struct Meet<'a, O> {
    geometry: &'a Geometry,
    rays: RayView<'a>,
    scratch: &'a mut Scratch,
    outcome: O,
}

impl<O: Outcome> simd::Kernel for Meet<'_, O> {
    type Output = ();

    #[inline(always)]
    fn run<S: simd::Simd>(self) {
        let Meet { geometry, rays, scratch, mut outcome } = self;
        stream::trace::<S, _>(geometry, rays, scratch, &mut outcome);
    }
}

impl PlaneShape {
    fn id(&self) -> Id {
        Id { object: self.object, index: 0 }
    }
}
