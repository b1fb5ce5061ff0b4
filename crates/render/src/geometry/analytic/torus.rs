//! A torus around the z axis (format reference, §3.13).

use glam::{DVec3, Vec2, Vec3};

use super::polynomial::first_root;
use super::{Analytic, LocalRay, Meeting, onto};
use crate::geometry::bvh::Aabb;
use crate::math;

/// The points of (|p|² − r² − R²)² = 4R² (r² − z²).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Torus {
    /// Radius of the tube, r.
    pub tube: f64,
    /// Radius of the circle in its middle, R.
    pub ring: f64,
}

impl Torus {
    fn function(&self, p: DVec3) -> (f64, DVec3) {
        let k = p.length_squared() - self.tube * self.tube - self.ring * self.ring;
        let four = 4.0 * self.ring * self.ring;
        let value = k * k - four * (self.tube * self.tube - p.z * p.z);
        (value, 4.0 * k * p + DVec3::Z * (2.0 * four * p.z))
    }
}

impl Analytic for Torus {
    fn bounds(&self, _: usize) -> Aabb {
        let reach = Vec3::new((self.ring + self.tube) as f32, (self.ring + self.tube) as f32, self.tube as f32);
        let reach = reach * 1.000_001;
        Aabb { min: -reach, max: reach }
    }

    fn meet(&self, part: usize, ray: &LocalRay) -> Option<Meeting> {
        let [near, far] = ray.within(self.bounds(part))?;
        // From where the ray enters the box, in units of the shape, so that the numbers stay small.
        let length = ray.direction.length();
        let (o, d) = (ray.at(near), ray.direction / length);
        let (b, ring2) = (o.dot(d), 4.0 * self.ring * self.ring);
        let e = o.length_squared() - self.tube * self.tube - self.ring * self.ring;
        let quartic = [
            e * e + ring2 * (o.z * o.z - self.tube * self.tube),
            4.0 * b * e + 2.0 * ring2 * o.z * d.z,
            4.0 * b * b + 2.0 * e + ring2 * d.z * d.z,
            4.0 * b,
            1.0,
        ];
        let t = near + first_root(&quartic, 0.0, (far - near) * length)? / length;
        ray.holds(t).then_some(Meeting { t, u: 0.0, v: 0.0 })
    }

    fn surface(&self, _: usize, ray: &LocalRay, meeting: &Meeting) -> (DVec3, DVec3) {
        let point = onto(ray.at(meeting.t), |p| self.function(p));
        (point, self.function(point).1)
    }

    fn uv(&self, _: usize, _: [f32; 2], p: Vec3) -> Vec2 {
        let around = math::atan2(p.y, p.x) / std::f32::consts::TAU;
        // (asin(z/r) + π/2) / π, by asin x = π/2 − acos x.
        let across = 1.0 - math::acos((p.z / self.tube as f32).clamp(-1.0, 1.0)) / std::f32::consts::PI;
        Vec2::new(if around < 0.0 { around + 1.0 } else { around }, across)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{meetings, rays};
    use super::*;

    const TORUS: Torus = Torus { tube: 0.25, ring: 1.0 };

    #[test]
    fn a_ray_along_an_axis_meets_it_four_times() {
        let found: Vec<f64> =
            meetings(&TORUS, DVec3::new(-3.0, 0.0, 0.0), DVec3::new(-2.0, 0.0, 0.0)).iter().map(|m| m.t).collect();
        assert_eq!(found.len(), 4);
        for (t, expected) in found.iter().zip([1.75, 2.25, 3.75, 4.25]) {
            assert!((t - expected).abs() < 1e-12, "{found:?}");
        }
        assert!(meetings(&TORUS, DVec3::new(0.0, 0.0, -3.0), DVec3::ZERO).is_empty());
        assert_eq!(meetings(&TORUS, DVec3::new(1.0, 0.0, -3.0), DVec3::new(1.0, 0.0, 0.0)).len(), 2);
    }

    #[test]
    fn points_lie_on_the_tube_and_normals_point_away_from_its_middle() {
        let mut met = 0;
        for ray in rays(2000) {
            let Some(meeting) = TORUS.meet(0, &ray) else { continue };
            let (point, normal) = TORUS.surface(0, &ray, &meeting);
            let middle = DVec3::new(point.x, point.y, 0.0).normalize();
            assert!((point.distance(middle) - 0.25).abs() < 1e-12, "{point}");
            assert!(normal.normalize().distance((point - middle) / 0.25) < 1e-9);
            assert!(point.distance(ray.at(meeting.t)) < 1e-9 && normal.dot(ray.direction) < 0.0);
            met += 1;
        }
        assert!(met > 500, "{met}");
    }

    #[test]
    fn texture_coordinates_go_around_and_across() {
        assert_eq!(TORUS.uv(0, [0.0; 2], Vec3::new(1.25, 0.0, 0.0)), Vec2::new(0.0, 0.5));
        assert!(TORUS.uv(0, [0.0; 2], Vec3::new(0.0, 1.0, 0.25)).distance(Vec2::new(0.25, 1.0)) < 1e-6);
        assert!(TORUS.uv(0, [0.0; 2], Vec3::new(0.0, -1.0, -0.25)).distance(Vec2::new(0.75, 0.0)) < 1e-6);
    }
}
