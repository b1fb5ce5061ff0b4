//! Banchoff's surface (format reference, §3.13).

use glam::{DVec3, Vec3};

use super::polynomial::first_root;
use super::{Analytic, LocalRay, Meeting, onto};
use crate::geometry::bvh::Aabb;

/// The points of x⁴ + y⁴ + z⁴ − x² − y² − z² + 3/8 = 0.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Banchoff;

fn function(p: DVec3) -> (f64, DVec3) {
    let squares = p * p;
    let value = (squares * squares - squares).element_sum() + 0.375;
    (value, p * (4.0 * squares - 2.0))
}

impl Analytic for Banchoff {
    fn bounds(&self, _: usize) -> Aabb {
        // y⁴ − y² is −1/4 at least, and so x⁴ − x² is 1/8 at most: x² ≤ (1 + √1.5) / 2.
        Aabb { min: Vec3::splat(-1.0548), max: Vec3::splat(1.0548) }
    }

    fn meet(&self, part: usize, ray: &LocalRay) -> Option<Meeting> {
        let [near, far] = ray.within(self.bounds(part))?;
        let length = ray.direction.length();
        let (o, d) = (ray.at(near), ray.direction / length);
        let (o2, d2, od) = (o * o, d * d, o * d);
        // (o + t d)⁴ − (o + t d)² for each axis, by powers of t.
        let powers = [o2 * o2 - o2, 4.0 * od * o2 - 2.0 * od, 6.0 * o2 * d2 - d2, 4.0 * od * d2, d2 * d2];
        let mut quartic = powers.map(DVec3::element_sum);
        quartic[0] += 0.375;
        let t = near + first_root(&quartic, 0.0, (far - near) * length)? / length;
        ray.holds(t).then_some(Meeting { t, u: 0.0, v: 0.0 })
    }

    fn surface(&self, _: usize, ray: &LocalRay, meeting: &Meeting) -> (DVec3, DVec3) {
        let point = onto(ray.at(meeting.t), function);
        (point, function(point).1)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{meetings, rays};
    use super::*;

    #[test]
    fn points_satisfy_the_equation() {
        let mut met = 0;
        for ray in rays(2000) {
            let Some(meeting) = Banchoff.meet(0, &ray) else { continue };
            let (point, normal) = Banchoff.surface(0, &ray, &meeting);
            assert!(function(point).0.abs() < 1e-12 && point.distance(ray.at(meeting.t)) < 1e-7, "{point}");
            assert!(normal.dot(ray.direction) < 1e-6, "the first meeting is from outside");
            met += 1;
        }
        assert!(met > 500, "{met}");
    }

    #[test]
    fn a_ray_along_an_axis_goes_through_its_hole() {
        // On the x axis x⁴ − x² + 3/8 has no root: 1 − 4 · 3/8 < 0.
        assert!(meetings(&Banchoff, DVec3::new(-3.0, 0.0, 0.0), DVec3::new(-2.0, 0.0, 0.0)).is_empty());
        // Where y² = z² = 1/2, what is left is x⁴ − x² − 1/8: two roots.
        let s = 0.5f64.sqrt();
        let found = meetings(&Banchoff, DVec3::new(-3.0, s, s), DVec3::new(-2.0, s, s));
        let expected = ((1.0 + 1.5f64.sqrt()) / 2.0).sqrt();
        assert_eq!(found.len(), 2, "{found:?}");
        assert!((found[0].t - (3.0 - expected)).abs() < 1e-12 && (found[1].t - (3.0 + expected)).abs() < 1e-12);
    }
}
