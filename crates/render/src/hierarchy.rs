//! Triangles and the rays that meet them, without a scene: the kernel of the ray tracer for those who want only that.

use glam::Vec3;

use crate::geometry::{Geometry, Hits, Id, MeshShape, Placement, Plan, Ray, Rays, Scratch};
use crate::mesh_file::MeshFile;

/// A bounding hierarchy over the triangles of a mesh, and the mesh itself.
///
/// ```
/// use jaspe_render::{Answers, Hierarchy, MeshFile, RaySet};
///
/// let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let hierarchy = Hierarchy::new(MeshFile { points, triangles: vec![[0, 1, 2]], uvs: Vec::new() });
/// let mut rays = RaySet::default();
/// rays.push([0.25, 0.5, 2.0], [0.0, 0.0, -1.0], f32::INFINITY);
/// rays.push([0.25, 0.5, 2.0], [0.0, 0.0, 1.0], f32::INFINITY);
///
/// let mut answers = Answers::default();
/// hierarchy.closest(&rays, &mut answers);
/// let hit = answers.hit(0).expect("it goes through the triangle");
/// assert_eq!((hit.triangle, hit.t, hit.u, hit.v), (0, 2.0, 0.25, 0.5));
/// assert!(answers.hit(1).is_none());
/// ```
#[derive(Debug)]
pub struct Hierarchy {
    geometry: Geometry,
}

/// Rays to trace together, from `t = 0` on.
#[derive(Debug, Clone, Default)]
pub struct RaySet {
    rays: Rays,
}

/// What rays met. It is best used again and again: it has room that is not cheap to make.
#[derive(Default)]
pub struct Answers {
    hits: Hits,
    blocked: Vec<bool>,
    scratch: Scratch,
}

/// Where a ray meets a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TriangleHit {
    /// The distance, in lengths of the ray's direction.
    pub t: f32,
    /// The weight of the triangle's second corner.
    pub u: f32,
    /// The weight of its third corner.
    pub v: f32,
    /// Which triangle of the mesh.
    pub triangle: u32,
}

impl Hierarchy {
    /// Builds the hierarchy, on the threads of rayon's pool. Triangles that are not finite are never met.
    ///
    /// # Panics
    /// If a triangle names a point that is not there.
    pub fn new(mesh: MeshFile) -> Hierarchy {
        let points = mesh.points.into_iter().map(Vec3::from_array).collect();
        let mesh = MeshShape { points, triangles: mesh.triangles, ..MeshShape::default() };
        let mut plan = Plan::default();
        plan.mesh(mesh, &[Placement::identity()]);
        Hierarchy { geometry: plan.finish() }
    }

    /// The closest hit of each ray: [`Answers::hit`].
    pub fn closest(&self, rays: &RaySet, answers: &mut Answers) {
        self.geometry.closest(rays.rays.view(0.0), &mut answers.hits, &mut answers.scratch);
    }

    /// Whether each ray meets anything before its end: [`Answers::is_blocked`].
    pub fn occluded(&self, rays: &RaySet, answers: &mut Answers) {
        self.geometry.occluded(rays.rays.view(0.0), &mut answers.blocked, &mut answers.scratch);
    }

    /// How much memory the mesh and the hierarchy take, in bytes.
    pub fn bytes(&self) -> usize {
        self.geometry.bytes()
    }
}

impl RaySet {
    /// Adds a ray with `t` from 0 to `t_max`.
    pub fn push(&mut self, origin: [f32; 3], direction: [f32; 3], t_max: f32) {
        let (origin, direction) = (Vec3::from_array(origin), Vec3::from_array(direction));
        self.rays.push(Ray { origin, direction, t_min: 0.0, t_max, skip: Id::NONE, time: None });
    }

    /// How many rays there are.
    pub fn len(&self) -> usize {
        self.rays.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.rays.is_empty()
    }

    /// Origin, direction and end of ray `i`.
    ///
    /// # Panics
    /// If there is none.
    pub fn get(&self, i: usize) -> ([f32; 3], [f32; 3], f32) {
        let ray = self.rays.get(i);
        (ray.origin.to_array(), ray.direction.to_array(), ray.t_max)
    }
}

impl Answers {
    /// What ray `i` met first, of the last [`Hierarchy::closest`].
    ///
    /// # Panics
    /// If there is no such ray.
    pub fn hit(&self, i: usize) -> Option<TriangleHit> {
        let hit = self.hits.get(i);
        (hit.id != Id::NONE).then_some(TriangleHit { t: hit.t, u: hit.u, v: hit.v, triangle: hit.id.index })
    }

    /// Whether ray `i` is blocked, of the last [`Hierarchy::occluded`].
    ///
    /// # Panics
    /// If there is no such ray.
    pub fn is_blocked(&self, i: usize) -> bool {
        self.blocked[i]
    }
}
