//! Strands of flat bands that face whoever looks at them (format reference, §3.13).

use glam::{DVec3, Vec2, Vec3};

use super::{Analytic, LocalRay, Meeting};
use crate::geometry::bvh::Aabb;

/// Strands one after the other, all of the same number of segments. A part is a segment.
#[derive(Debug, Clone)]
pub(crate) struct Hair {
    /// Segments per strand, at least 1.
    pub segments: usize,
    pub width: f32,
    /// `segments + 1` for each strand.
    pub points: Vec<Vec3>,
}

impl Hair {
    /// The ends of a segment.
    fn ends(&self, part: usize) -> [DVec3; 2] {
        let first = part / self.segments * (self.segments + 1) + part % self.segments;
        [self.points[first].as_dvec3(), self.points[first + 1].as_dvec3()]
    }

    fn direction(&self, part: usize) -> DVec3 {
        let [a, b] = self.ends(part);
        (b - a).normalize_or(DVec3::Z)
    }

    /// The direction of the strand, blended with that of the neighbours towards the joints within the strand.
    fn strand(&self, part: usize, along: f64) -> DVec3 {
        let place = part % self.segments;
        let own = self.direction(part);
        let other = match (along < 0.5, place) {
            (true, 1..) => self.direction(part - 1),
            (false, _) if place + 1 < self.segments => self.direction(part + 1),
            _ => return own,
        };
        // Halfway at the joint, all its own in the middle of the segment.
        let share = (along - 0.5).abs().min(0.5);
        own.lerp(other, share).normalize_or(own)
    }
}

impl Analytic for Hair {
    fn part_count(&self) -> usize {
        self.points.len() / (self.segments + 1) * self.segments
    }

    fn bounds(&self, part: usize) -> Aabb {
        let ends = self.ends(part).map(|end| end.as_vec3());
        let reach = Vec3::splat(0.5 * self.width * 1.000_001);
        let Aabb { min, max } = Aabb::around(ends);
        Aabb { min: min - reach, max: max + reach }
    }

    fn meet(&self, part: usize, ray: &LocalRay) -> Option<Meeting> {
        let [a, b] = self.ends(part);
        let axis = b - a;
        // The plane that holds the segment and faces the ray.
        let normal = ray.direction.cross(axis).cross(axis);
        let t = (a - ray.origin).dot(normal) / ray.direction.dot(normal);
        if !ray.holds(t) {
            return None;
        }
        let point = ray.at(t);
        let along = (point - a).dot(axis) / axis.length_squared();
        // Sunflow: the root of a strand is cut straight, all other ends are round.
        if part.is_multiple_of(self.segments) && along < 0.0 {
            return None;
        }
        let nearest = a + axis * along.clamp(0.0, 1.0);
        let reach = 0.5 * f64::from(self.width);
        let is_met = point.distance_squared(nearest) < reach * reach;
        is_met.then_some(Meeting { t, u: along.clamp(0.0, 1.0) as f32, v: 0.0 })
    }

    fn surface(&self, part: usize, ray: &LocalRay, meeting: &Meeting) -> (DVec3, DVec3) {
        let tangent = self.strand(part, f64::from(meeting.u));
        let towards = -ray.direction;
        (ray.at(meeting.t), towards - tangent * towards.dot(tangent))
    }

    fn uv(&self, part: usize, [u, _]: [f32; 2], _: Vec3) -> Vec2 {
        Vec2::new(0.0, ((part % self.segments) as f32 + u) / self.segments as f32)
    }

    fn tangent(&self, part: usize, [u, _]: [f32; 2], _: Vec3) -> Option<Vec3> {
        Some(self.strand(part, f64::from(u)).as_vec3())
    }

    fn is_flat(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strand() -> Hair {
        let points =
            [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0], [5.0, 0.0, 0.0], [5.0, 0.0, 1.0], [5.0, 1.0, 1.0]];
        Hair { segments: 2, width: 0.2, points: points.map(Vec3::from).to_vec() }
    }

    fn ray(from: [f64; 3], to: [f64; 3]) -> LocalRay {
        let (origin, to) = (DVec3::from(from), DVec3::from(to));
        LocalRay { origin, direction: to - origin, t_min: 0.0, t_max: f64::INFINITY }
    }

    #[test]
    fn strands_are_counted_by_their_segments() {
        let hair = strand();
        assert_eq!(hair.part_count(), 4);
        assert_eq!(hair.ends(2), [DVec3::new(5.0, 0.0, 0.0), DVec3::new(5.0, 0.0, 1.0)]);
        let bounds = hair.bounds(1);
        assert!(bounds.min.distance(Vec3::new(-0.1, -0.1, 0.9)) < 1e-5, "{bounds:?}");
    }

    #[test]
    fn a_band_is_as_wide_from_everywhere() {
        let hair = strand();
        for (x, y) in [(1.0, 0.0), (0.6, 0.8), (-0.8, 0.6)] {
            for (off, is_met) in [(0.0, true), (0.099, true), (-0.099, true), (0.101, false)] {
                let side = [-y * off, x * off, 0.5];
                let ray = ray([3.0 * x + side[0], 3.0 * y + side[1], 0.5], side);
                assert_eq!(hair.meet(0, &ray).is_some(), is_met, "{x} {y} {off}");
            }
        }
        let ray = ray([3.0, 0.0, 0.25], [2.0, 0.0, 0.25]);
        let meeting = hair.meet(0, &ray).expect("it is met");
        assert!((meeting.t - 3.0).abs() < 1e-12 && meeting.u == 0.25);
        let (point, normal) = hair.surface(0, &ray, &meeting);
        assert!(point.distance(DVec3::new(0.0, 0.0, 0.25)) < 1e-12 && normal.normalize() == DVec3::X);
        assert_eq!(hair.uv(1, [0.5, 0.0], Vec3::ZERO), Vec2::new(0.0, 0.75));
    }

    #[test]
    fn the_root_is_cut_and_other_ends_are_round() {
        let hair = strand();
        assert!(hair.meet(0, &ray([3.0, 0.0, -0.05], [2.0, 0.0, -0.05])).is_none());
        assert!(hair.meet(0, &ray([3.0, 0.0, 1.05], [2.0, 0.0, 1.05])).is_some());
        assert!(hair.meet(1, &ray([3.0, 0.0, 2.11], [2.0, 0.0, 2.11])).is_none());
    }

    #[test]
    fn the_tangent_turns_at_the_joints_of_a_strand() {
        let hair = strand();
        assert_eq!(hair.strand(2, 0.1), DVec3::Z);
        assert!(hair.strand(2, 1.0).distance(DVec3::new(0.0, 1.0, 1.0).normalize()) < 1e-12);
        assert!(hair.strand(3, 0.0).distance(DVec3::new(0.0, 1.0, 1.0).normalize()) < 1e-12);
        assert_eq!(hair.strand(3, 0.9), DVec3::Y);
    }
}
