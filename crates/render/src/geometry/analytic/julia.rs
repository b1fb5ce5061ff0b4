//! A Julia set of quaternions (format reference, §3.13).
//!
//! The distance to it is estimated from how fast its points escape ([Hart, Sandin, Kauffman 1989] "Ray Tracing Deterministic
//! 3-D Fractals"), and the ray marches by that.

use std::cmp::Ordering;

use glam::{DVec3, DVec4, Vec3};
use jaspe_noise::math::ln;

use super::{Analytic, LocalRay, Meeting};
use crate::geometry::bvh::Aabb;

/// The points that z ← z² + c keeps near, in quaternions w x y z.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Julia {
    /// c, as w x y z.
    pub c: DVec4,
    /// How often z is squared.
    pub iterations: u32,
    /// Distance, in units of the world, at which the surface counts as met.
    pub epsilon: f64,
}

/// The set lies within this distance of the origin, squared.
const REACH2: f64 = 3.0;
/// A point has escaped when its square is past this.
const ESCAPE2: f64 = 10.0;
/// Steps after which a ray that is still near the surface has met it.
const MOST_STEPS: usize = 2000;
/// Half the distance between the points whose difference is the normal.
const DELTA: f64 = 1e-4;

impl Julia {
    fn square(&self, z: DVec4) -> DVec4 {
        let vector = z.truncate_first() * (2.0 * z.x);
        DVec4::new(z.x * z.x - z.y * z.y - z.z * z.z - z.w * z.w, vector.x, vector.y, vector.z) + self.c
    }

    /// An estimate of the distance from a point to the set; negative well inside.
    fn distance(&self, point: DVec3) -> f64 {
        let mut z = DVec4::new(point.x, point.y, point.z, 0.0);
        // |z′| alone matters, |2 z z′| is 2 |z| |z′|, and squares need no roots on the way.
        let (mut size2, mut growth2) = (z.length_squared(), 1.0);
        for _ in 0..self.iterations {
            growth2 *= 4.0 * size2;
            z = self.square(z);
            size2 = z.length_squared();
            if size2 > ESCAPE2 {
                break;
            }
        }
        // ½ |z| ln |z| / |z′|, with ln |z| from its square.
        if size2 > 0.0 { 0.25 * (size2 / growth2).sqrt() * ln(size2) } else { -1.0 }
    }

    /// The gradient of |z| after all iterations, as far as these stay within what numbers can hold.
    fn gradient(&self, point: DVec3) -> DVec3 {
        let offsets = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * DELTA);
        let mut ends = offsets.map(|offset| [point + offset, point - offset].map(|p| p.extend(0.0)));
        for _ in 0..self.iterations {
            let next = ends.map(|pair| pair.map(|z| self.square(z)));
            if next.iter().flatten().any(|z| z.length_squared() > 1e100) {
                break;
            }
            ends = next;
        }
        let slope = ends.map(|[ahead, behind]| ahead.length() - behind.length());
        DVec3::from_array(slope)
    }
}

/// A quaternion's last three components.
trait TruncateFirst {
    fn truncate_first(self) -> DVec3;
}

impl TruncateFirst for DVec4 {
    fn truncate_first(self) -> DVec3 {
        DVec3::new(self.y, self.z, self.w)
    }
}

impl Analytic for Julia {
    fn bounds(&self, _: usize) -> Aabb {
        Aabb { min: Vec3::splat(-1.733), max: Vec3::splat(1.733) }
    }

    fn meet(&self, _: usize, ray: &LocalRay) -> Option<Meeting> {
        // The part of the ray within the sphere that holds the set.
        let (a, b) = (ray.direction.length_squared(), ray.origin.dot(ray.direction));
        let root = (b * b - a * (ray.origin.length_squared() - REACH2)).sqrt();
        let (mut t, end) = (((-b - root) / a).max(ray.t_min), ((-b + root) / a).min(ray.t_max));
        let length = a.sqrt();
        let near = self.epsilon * length;
        for _ in 0..MOST_STEPS {
            // A NaN, where the ray misses the sphere, has no order.
            if t.partial_cmp(&end) != Some(Ordering::Less) {
                return None;
            }
            let distance = self.distance(ray.at(t));
            if distance < near {
                return (t > ray.t_min).then_some(Meeting { t, u: 0.0, v: 0.0 });
            }
            t += distance / length;
        }
        (self.distance(ray.at(t)) < 10.0 * near).then_some(Meeting { t, u: 0.0, v: 0.0 })
    }

    fn surface(&self, _: usize, ray: &LocalRay, meeting: &Meeting) -> (DVec3, DVec3) {
        let point = ray.at(meeting.t);
        let normal = self.gradient(point).normalize_or(-ray.direction.normalize_or(DVec3::Z));
        // Sunflow: as far off that rays from there do not begin within the surface's reach.
        (point + normal * (20.0 * self.epsilon * ray.direction.length()), normal)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::rays;
    use super::*;

    /// With c = 0 the set is the unit ball.
    const BALL: Julia = Julia { c: DVec4::ZERO, iterations: 8, epsilon: 1e-6 };

    #[test]
    fn without_a_constant_it_is_the_unit_ball() {
        let mut met = 0;
        for ray in rays(500) {
            let (b, c) = (ray.origin.dot(ray.direction), ray.origin.length_squared() - 1.0);
            let square = b * b - c;
            let meeting = BALL.meet(0, &ray);
            if square > 0.01 {
                let meeting = meeting.expect("the ball is met");
                assert!((meeting.t - (-b - square.sqrt())).abs() < 1e-4, "{meeting:?}");
                let (point, normal) = BALL.surface(0, &ray, &meeting);
                assert!(normal.distance(point.normalize()) < 1e-3, "{normal} {point}");
                met += 1;
            } else if square < -0.01 {
                assert_eq!(meeting, None);
            }
        }
        assert!(met > 100, "{met}");
    }

    #[test]
    fn distances_are_underestimated_and_points_inside_are_inside() {
        for radius in [1.01, 1.1, 1.3, 1.6] {
            let distance = BALL.distance(DVec3::new(0.0, radius, 0.0));
            assert!(distance > 0.0 && distance <= radius - 1.0, "{radius} {distance}");
        }
        assert!(BALL.distance(DVec3::new(0.5, 0.0, 0.0)) < 0.0);
        assert!(BALL.distance(DVec3::ZERO) < 0.0);
    }

    #[test]
    fn marching_ends_whatever_the_numbers() {
        let ray =
            LocalRay { origin: DVec3::new(-3.0, 0.1, 0.0), direction: DVec3::X, t_min: 0.0, t_max: f64::INFINITY };
        for (iterations, epsilon) in [(0, 1e-5), (1000, 1e-300), (1000, 1e30), (15, f64::MIN_POSITIVE)] {
            for c in [DVec4::ZERO, DVec4::splat(1e30), DVec4::new(-0.4, 0.2, 0.3, -0.2)] {
                let julia = Julia { c, iterations, epsilon };
                if let Some(meeting) = julia.meet(0, &ray) {
                    assert!(meeting.t.is_finite());
                    let (point, normal) = julia.surface(0, &ray, &meeting);
                    assert!(normal.is_finite() && (point.is_finite() || epsilon > 1.0));
                }
            }
        }
    }

    #[test]
    fn a_quaternion_is_squared() {
        let julia = Julia { c: DVec4::new(1.0, 2.0, 3.0, 4.0), ..BALL };
        // (1 + 2i + 3j + 4k)² = −28 + 4i + 6j + 8k.
        assert_eq!(julia.square(DVec4::new(1.0, 2.0, 3.0, 4.0)), DVec4::new(-27.0, 6.0, 9.0, 12.0));
    }
}
