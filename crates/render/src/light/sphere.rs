//! A sphere that shines to all sides.

use glam::Vec3;

use super::BEFORE;
use super::fan::Shape;
use crate::math;

/// The sphere.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ball {
    pub center: Vec3,
    pub radius: f32,
    pub radiance: Vec3,
    pub samples: u32,
}

/// The cone under which a point sees it.
pub(super) struct Cone {
    /// From the point to the centre, and how long that is.
    to: Vec3,
    distance2: f32,
    radius2: f32,
    /// Two axes across the cone, and its own.
    axes: [Vec3; 3],
    /// One minus the cosine of its half angle.
    height: f32,
}

impl Ball {
    /// `None` from within.
    pub(super) fn seen_from(&self, point: Vec3) -> Option<Cone> {
        let to = self.center - point;
        let (distance2, radius2) = (to.length_squared(), self.radius * self.radius);
        if distance2 <= radius2 {
            return None;
        }
        let w = to / distance2.sqrt();
        let (u, v) = math::basis(w);
        // Without the cancellation for spheres far away.
        let sine2 = radius2 / distance2;
        let height = sine2 / (1.0 + (1.0 - sine2).sqrt());
        Some(Cone { to, distance2, radius2, axes: [u, v, w], height })
    }
}

impl Shape for Cone {
    /// Spread evenly over the cone ([Shirley, Wang, Zimmerman 1996] "Monte Carlo Techniques for Direct Lighting
    /// Calculations", §3.2).
    #[inline(always)]
    fn sample(&self, [a, b]: [f32; 2]) -> (Vec3, f32, f32) {
        let [u, v, w] = self.axes;
        let cosine = 1.0 - a * self.height;
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let (sin, cos) = math::sin_cos_turns(b);
        let direction = u * (sine * cos) + v * (sine * sin) + w * cosine;
        // Where the ray meets the near side; it grazes where rounding lets it miss.
        let along = self.to.dot(direction);
        let depth = (self.radius2 - (self.distance2 - along * along)).max(0.0).sqrt();
        (direction, (along - depth) * BEFORE, 2.0 * std::f32::consts::PI * self.height)
    }
}
