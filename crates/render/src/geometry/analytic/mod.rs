//! Shapes that are met by a formula or a march, one ray at a time, in their own space and in double precision.
//!
//! Each lies in a leaf of the tree, with its box. A new one is a file here with an implementation of [`Analytic`], and an
//! entry in `compile/shape`.

mod banchoff;
mod cylinder;
mod flake;
mod hair;
mod julia;
mod polynomial;
mod torus;

use std::fmt::Debug;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};

pub(crate) use banchoff::Banchoff;
pub(crate) use cylinder::Cylinder;
pub(crate) use flake::Flake;
pub(crate) use hair::Hair;
pub(crate) use julia::Julia;
pub(crate) use torus::Torus;

use super::bvh::Aabb;
use super::{Hit, Id, Motions, Object, Pose, Ray, Surface};

/// A ray in the space of a shape. Distances along it are those of the world; its direction has the length that the world's
/// unit has there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LocalRay {
    pub origin: DVec3,
    pub direction: DVec3,
    pub t_min: f64,
    pub t_max: f64,
}

/// Where a ray meets a shape. What `u` and `v` mean is known to the shape alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Meeting {
    pub t: f64,
    pub u: f32,
    pub v: f32,
}

/// A shape in its own space.
pub(crate) trait Analytic: Debug + Send + Sync {
    /// How many parts it has, each with a box of its own.
    fn part_count(&self) -> usize {
        1
    }

    /// A box around a part.
    fn bounds(&self, part: usize) -> Aabb;

    /// The first meeting with a part between the ends of the ray, which are not part of it.
    fn meet(&self, part: usize, ray: &LocalRay) -> Option<Meeting>;

    /// The point of a meeting, as near to the surface as can be, and the normal there, outward and of any length.
    fn surface(&self, part: usize, ray: &LocalRay, meeting: &Meeting) -> (DVec3, DVec3);

    /// Texture coordinates at a point of a part; `uv` are those of the meeting.
    fn uv(&self, _part: usize, _uv: [f32; 2], _point: Vec3) -> Vec2 {
        Vec2::ZERO
    }

    /// The direction along which bumps and highlights are laid out, of any length, if the shape has one.
    fn tangent(&self, _part: usize, _uv: [f32; 2], _point: Vec3) -> Option<Vec3> {
        None
    }

    /// Whether a ray that leaves a part in a straight line cannot meet that part again.
    fn is_flat(&self) -> bool {
        false
    }
}

impl LocalRay {
    /// `ray` in the space of an object that is there.
    pub fn new(ray: &Ray, pose: &Pose) -> Self {
        LocalRay {
            origin: pose.object_from_world.point(ray.origin).as_dvec3(),
            direction: pose.object_from_world.vector(ray.direction).as_dvec3(),
            t_min: f64::from(ray.t_min),
            t_max: f64::from(ray.t_max),
        }
    }

    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// Whether `t` lies between the ends.
    pub fn holds(&self, t: f64) -> bool {
        t > self.t_min && t < self.t_max
    }

    /// The part of the ray within a box, as its first and last `t`; `None` if there is none.
    fn within(&self, bounds: Aabb) -> Option<[f64; 2]> {
        let inverse = self.direction.recip();
        let (low, high) =
            ((bounds.min.as_dvec3() - self.origin) * inverse, (bounds.max.as_dvec3() - self.origin) * inverse);
        // Where the ray runs in a side of the box, 0 · ∞ is NaN, which `min` and `max` of numbers pass over.
        let near = low.min(high).to_array().into_iter().fold(self.t_min, f64::max);
        let far = low.max(high).to_array().into_iter().fold(self.t_max, f64::min);
        (near < far).then_some([near, far])
    }
}

/// A part of a shape, as a leaf of the tree.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leaf {
    pub part: u32,
    /// Index into [`Leaves::objects`].
    pub object: u32,
}

/// The shapes of a tree and the leaves that they lie in.
#[derive(Debug, Clone, Default)]
pub(super) struct Leaves {
    pub shapes: Vec<Arc<dyn Analytic>>,
    /// The objects that show them, with their numbers and the shapes' indices.
    pub objects: Vec<(u32, u32, Object)>,
    pub leaves: Vec<Leaf>,
}

impl Leaves {
    /// Improves `best` by what the ray meets in a leaf. Never a part of the kernels, which it would only swell.
    #[inline(never)]
    pub fn meet(&self, leaf: usize, ray: &Ray, enter: f32, motions: &Motions, best: &mut Hit) {
        let Leaf { part, object } = self.leaves[leaf];
        let (number, shape, object) = &self.objects[object as usize];
        let id = Id { object: *number, index: part };
        if id == ray.skip {
            return;
        }
        // Hits as far as the best so far may still win by their name.
        let local = LocalRay::new(&Ray { t_max: best.t.next_up(), ..*ray }, &motions.pose(object, ray.time));
        if let Some(Meeting { t, u, v }) = self.shapes[*shape as usize].meet(part as usize, &local) {
            best.improve(Hit { t: (t as f32).max(enter), u, v, id, time: None });
        }
    }
}

/// The surface at a hit, in the world.
pub(super) fn surface(shape: &dyn Analytic, pose: &Pose, ray: &Ray, hit: &Hit) -> Surface {
    let local = LocalRay::new(ray, pose);
    let meeting = Meeting { t: f64::from(hit.t), u: hit.u, v: hit.v };
    let (point, normal) = shape.surface(hit.id.index as usize, &local, &meeting);
    let normal = pose.object_from_world.transposed(normal.normalize_or(DVec3::Z).as_vec3()).normalize_or(Vec3::Z);
    Surface { point: pose.world_from_object.point(point.as_vec3()), geometric: normal, normal }
}

/// Moves a point onto the surface where a function vanishes, given with its gradient: Newton's steps along the gradient.
fn onto(mut point: DVec3, function: impl Fn(DVec3) -> (f64, DVec3)) -> DVec3 {
    for _ in 0..3 {
        let (value, gradient) = function(point);
        let step = gradient * (value / gradient.length_squared());
        if !step.is_finite() {
            break;
        }
        point -= step;
    }
    point
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A ray between two points that is asked for all of its meetings, one after the other.
    pub fn meetings(shape: &dyn Analytic, from: DVec3, to: DVec3) -> Vec<Meeting> {
        let mut ray = LocalRay { origin: from, direction: to - from, t_min: 0.0, t_max: f64::INFINITY };
        let mut found = Vec::new();
        while let Some(meeting) = shape.meet(0, &ray) {
            assert!(ray.holds(meeting.t) && found.len() < 100, "{meeting:?}");
            found.push(meeting);
            ray.t_min = meeting.t + 1e-9;
        }
        found
    }

    /// Rays from all around through the neighbourhood of the origin.
    pub fn rays(count: usize) -> impl Iterator<Item = LocalRay> {
        let mut state = 12345u64;
        let mut next = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
        };
        let mut vector = move || DVec3::new(next(), next(), next());
        (0..count).map(move |_| {
            let origin = vector().normalize_or(DVec3::X) * 4.0;
            let direction = vector() * 1.2 - origin;
            LocalRay { origin, direction: direction.normalize(), t_min: 0.0, t_max: f64::INFINITY }
        })
    }

    #[test]
    fn boxes_cut_rays() {
        let bounds = Aabb { min: Vec3::splat(-1.0), max: Vec3::ONE };
        let along = |origin: DVec3, direction: DVec3| {
            LocalRay { origin, direction, t_min: 0.0, t_max: f64::INFINITY }.within(bounds)
        };
        assert_eq!(along(DVec3::new(-3.0, 0.0, 0.0), DVec3::X), Some([2.0, 4.0]));
        assert_eq!(along(DVec3::ZERO, DVec3::X * 2.0), Some([0.0, 0.5]));
        assert_eq!(along(DVec3::new(-3.0, 2.0, 0.0), DVec3::X), None);
        assert_eq!(along(DVec3::new(3.0, 0.0, 0.0), DVec3::X), None);
    }
}
