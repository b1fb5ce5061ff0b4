//! A Julia set of quaternions (format reference, §3.13).
//!
//! The distance to it is estimated from how fast its points escape ([Hart, Sandin, Kauffman 1989] "Ray Tracing Deterministic
//! 3-D Fractals"), and the ray marches by that: several steps at a time, whose lengths are guessed and then checked.

use std::cmp::Ordering;

use glam::{DVec3, DVec4, Vec3};
use jaspe_noise::math::ln;

use super::{Analytic, LocalRay, Meeting};
use crate::geometry::bvh::Aabb;
use crate::geometry::simd::{self, Simd};

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
/// Steps that are looked ahead.
const AHEAD: usize = 8;
/// The part of what two neighbouring steps cover, if all goes as guessed, that is taken.
const BOLDNESS: f64 = 0.7;
/// By how much steps may grow from one to the next, as far as guesses go.
const GROWTH: [f64; 2] = [0.5, 2.0];
/// Half the distance between the points whose difference is the normal.
const DELTA: f64 = 1e-4;

impl Julia {
    /// z² + c.
    fn square(&self, z: DVec4) -> DVec4 {
        let vector = z.truncate_first() * (2.0 * z.x);
        DVec4::new(z.x * z.x - z.y * z.y - z.z * z.z - z.w * z.w, vector.x, vector.y, vector.z) + self.c
    }

    /// Estimates of the distances from points of a ray to the set, from below; negative well inside.
    fn distances(&self, ray: &LocalRay, t: &[f64; AHEAD]) -> [f64; AHEAD] {
        simd::run(Distances { julia: self, ray, t })
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

/// [`Julia::distances`].
struct Distances<'a> {
    julia: &'a Julia,
    ray: &'a LocalRay,
    t: &'a [f64; AHEAD],
}

impl simd::Kernel for Distances<'_> {
    type Output = [f64; AHEAD];

    #[inline(always)]
    fn run<S: Simd>(self) -> [f64; AHEAD] {
        let Distances { julia: Julia { c, iterations, .. }, ray: LocalRay { origin, direction, .. }, t } = self;
        let (mut w, mut x, mut y, mut z) = ([0.0; AHEAD], [0.0; AHEAD], [0.0; AHEAD], [0.0; AHEAD]);
        // Squares of |z| and |z′|, where the point escapes or after all iterations.
        let (mut size2, mut growth2) = ([0.0; AHEAD], [1.0; AHEAD]);
        for i in 0..AHEAD {
            w[i] = origin.x + direction.x * t[i];
            x[i] = origin.y + direction.y * t[i];
            y[i] = origin.z + direction.z * t[i];
            size2[i] = w[i] * w[i] + x[i] * x[i] + y[i] * y[i];
        }
        for _ in 0..*iterations {
            let mut left = 0;
            for i in 0..AHEAD {
                let double = w[i] + w[i];
                w[i] = w[i] * w[i] - x[i] * x[i] - y[i] * y[i] - z[i] * z[i] + c.x;
                (x[i], y[i], z[i]) = (double * x[i] + c.y, double * y[i] + c.z, double * z[i] + c.w);
                // Points that have escaped go on to wherever they go.
                let stays = size2[i] <= ESCAPE2;
                // |z′| alone matters, |2 z z′| is 2 |z| |z′|, and squares need no roots on the way.
                growth2[i] = if stays { growth2[i] * (4.0 * size2[i]) } else { growth2[i] };
                let next = w[i] * w[i] + x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
                size2[i] = if stays { next } else { size2[i] };
                left += i64::from(stays);
            }
            if left == 0 {
                break;
            }
        }
        let mut distances = [0.0; AHEAD];
        for i in 0..AHEAD {
            // ½ |z| ln |z| / |z′|, with ln |z| from its square. An estimate needs no more digits of it.
            let distance = 0.25 * (size2[i] / growth2[i]).sqrt() * f64::from(ln(size2[i] as f32));
            distances[i] = if size2[i] > 0.0 { distance } else { -1.0 };
        }
        distances
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
        // A NaN, where the ray misses the sphere, has no order.
        let is_past = |t: f64| t.partial_cmp(&end) != Some(Ordering::Less);
        if is_past(t) {
            return None;
        }
        let length = a.sqrt();
        let near = self.epsilon * length;
        // All lengths are those of the set's own space from here on. Where the ray is, the set is `radius` away.
        let [mut radius, ..] = self.distances(ray, &[t; AHEAD]);
        let (mut growth, mut steps) = (1.0f64, 0);
        while steps < MOST_STEPS {
            if radius < near {
                return (t > ray.t_min).then_some(Meeting { t, u: 0.0, v: 0.0 });
            }
            // The first step is safe. If distances go on to grow as they did, so are the others.
            let (mut ahead, mut next, mut guess) = ([t; AHEAD], t + radius / length, radius * growth);
            for ahead in &mut ahead {
                *ahead = next;
                next += BOLDNESS * (1.0 + growth) * guess / length;
                guess *= growth;
            }
            let distances = self.distances(ray, &ahead);
            for (i, (&next, &distance)) in ahead.iter().zip(&distances).enumerate() {
                let gap = (next - t) * length;
                // Nothing lies in between if the neighbourhoods of both ends touch ([Keinert et al. 2014] "Enhanced Sphere
                // Tracing"); but the surface is only met from outside.
                let is_safe = i == 0 || gap <= radius || distance >= near && gap <= radius + distance;
                if !is_safe {
                    break;
                }
                if is_past(next) {
                    return None;
                }
                growth = (distance / radius).clamp(GROWTH[0], GROWTH[1]);
                (t, radius, steps) = (next, distance, steps + 1);
                if radius < near {
                    break;
                }
            }
        }
        (radius < 10.0 * near).then_some(Meeting { t, u: 0.0, v: 0.0 })
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

    fn distance(point: DVec3) -> f64 {
        BALL.distances(&LocalRay { origin: point, direction: DVec3::X, t_min: 0.0, t_max: 1.0 }, &[0.0; AHEAD])[0]
    }

    #[test]
    fn steps_ahead_meet_what_single_steps_meet() {
        let julia = Julia { c: DVec4::new(-0.125, -0.256, 0.847, 0.0895), iterations: 8, epsilon: 1e-3 };
        let single = |ray: &LocalRay| {
            let reach = REACH2.sqrt();
            let mut t = 4.0 - reach;
            while t < 4.0 + reach {
                let [distance, ..] = julia.distances(ray, &[t; AHEAD]);
                if distance < julia.epsilon {
                    return Some(t);
                }
                t += distance;
            }
            None
        };
        let (mut met, mut apart) = (0, 0);
        for ray in rays(2000) {
            match (julia.meet(0, &ray), single(&ray)) {
                (Some(meeting), Some(t)) => {
                    met += 1;
                    // Rays that graze the surface may meet it a little later.
                    apart += u32::from((meeting.t - t).abs() > 3.0 * julia.epsilon);
                }
                (a, b) => apart += u32::from(a.is_some() != b.is_some()),
            }
        }
        assert!(met > 500 && apart < 10, "{met} {apart}");
    }

    #[test]
    fn distances_are_underestimated_and_points_inside_are_inside() {
        for radius in [1.01, 1.1, 1.3, 1.6] {
            let distance = distance(DVec3::new(0.0, radius, 0.0));
            assert!(distance > 0.0 && distance <= radius - 1.0, "{radius} {distance}");
        }
        assert!(distance(DVec3::new(0.5, 0.0, 0.0)) < 0.0);
        assert!(distance(DVec3::ZERO) < 0.0);
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
