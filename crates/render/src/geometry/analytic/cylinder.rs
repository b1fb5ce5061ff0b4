//! The side of a cylinder around the z axis (format reference, §3.13).

use glam::{DVec3, Vec2, Vec3};

use super::{Analytic, LocalRay, Meeting};
use crate::geometry::bvh::Aabb;
use crate::math;

/// The points of x² + y² = 1 with z from −1 to 1.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cylinder;

impl Analytic for Cylinder {
    fn bounds(&self, _: usize) -> Aabb {
        let reach = Vec3::new(1.000_001, 1.000_001, 1.0);
        Aabb { min: -reach, max: reach }
    }

    fn meet(&self, _: usize, ray: &LocalRay) -> Option<Meeting> {
        let (o, d) = (ray.origin.truncate(), ray.direction.truncate());
        let (a, b, c) = (d.length_squared(), o.dot(d), o.length_squared() - 1.0);
        let root = (b * b - a * c).sqrt();
        // The two roots without cancellation: their product is c/a.
        let far = -b - root.copysign(b);
        let (first, second) = (far / a, c / far);
        [first.min(second), first.max(second)]
            .into_iter()
            .find(|&t| ray.holds(t) && ray.at(t).z.abs() <= 1.0)
            .map(|t| Meeting { t, u: 0.0, v: 0.0 })
    }

    fn surface(&self, _: usize, ray: &LocalRay, meeting: &Meeting) -> (DVec3, DVec3) {
        let point = ray.at(meeting.t);
        let normal = point.truncate().normalize_or(glam::DVec2::X).extend(0.0);
        (normal.with_z(point.z.clamp(-1.0, 1.0)), normal)
    }

    fn uv(&self, _: usize, _: [f32; 2], p: Vec3) -> Vec2 {
        let around = math::atan2(p.y, p.x) / std::f32::consts::TAU;
        Vec2::new(if around < 0.0 { around + 1.0 } else { around }, (p.z + 1.0) * 0.5)
    }

    fn tangent(&self, _: usize, _: [f32; 2], _: Vec3) -> Option<Vec3> {
        Some(Vec3::Z)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{meetings, rays};
    use super::*;

    #[test]
    fn it_has_a_side_and_no_caps() {
        let times = |from: [f64; 3], to: [f64; 3]| -> Vec<f64> {
            meetings(&Cylinder, from.into(), to.into()).iter().map(|meeting| meeting.t).collect()
        };
        assert_eq!(times([-3.0, 0.0, 0.5], [-2.0, 0.0, 0.5]), [2.0, 4.0]);
        assert_eq!(times([0.0, 0.0, 0.0], [0.0, 2.0, 0.0]), [0.5]);
        assert!(times([0.0, 0.0, -3.0], [0.0, 0.0, -2.0]).is_empty());
        assert!(times([-3.0, 0.0, 1.5], [-2.0, 0.0, 1.5]).is_empty());
        // Through the open end, and onto the inner side.
        assert_eq!(times([0.0, 0.0, 2.0], [0.5, 0.0, 1.0]), [2.0]);
        // Along the side.
        assert!(times([1.0, 0.0, -3.0], [1.0, 0.0, -2.0]).is_empty());
    }

    #[test]
    fn points_and_normals_are_those_of_the_circle() {
        let mut met = 0;
        for ray in rays(1000) {
            let Some(meeting) = Cylinder.meet(0, &ray) else { continue };
            let (point, normal) = Cylinder.surface(0, &ray, &meeting);
            assert!((point.truncate().length() - 1.0).abs() < 1e-12 && point.z.abs() <= 1.0);
            assert!(normal.distance(DVec3::new(point.x, point.y, 0.0)) < 1e-12);
            assert!(point.distance(ray.at(meeting.t)) < 1e-9);
            met += 1;
        }
        assert!(met > 500, "{met}");
    }

    #[test]
    fn texture_coordinates_go_around_and_up() {
        assert_eq!(Cylinder.uv(0, [0.0; 2], Vec3::new(1.0, 0.0, -1.0)), Vec2::ZERO);
        assert!(Cylinder.uv(0, [0.0; 2], Vec3::new(0.0, -1.0, 1.0)).distance(Vec2::new(0.75, 1.0)) < 1e-6);
    }
}
