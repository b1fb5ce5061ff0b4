//! A sphere that shines to all sides.

use glam::Vec3;

use super::{Arrival, BEFORE, Receiver};
use crate::math;

/// The sphere.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ball {
    pub center: Vec3,
    pub radius: f32,
    pub radiance: Vec3,
    pub samples: u32,
}

impl Ball {
    /// Sample `xi` of `count`, spread evenly over the cone under which the sphere is seen ([Shirley, Wang, Zimmerman
    /// 1996] "Monte Carlo Techniques for Direct Lighting Calculations", §3.2).
    pub fn arrive(&self, at: &Receiver, [u, v]: [f32; 2], count: f32) -> Option<Arrival> {
        let to = self.center - at.point;
        let (distance2, radius2) = (to.length_squared(), self.radius * self.radius);
        if distance2 <= radius2 {
            return None;
        }
        // One minus the cosine of the cone, without the cancellation for spheres far away.
        let sine2 = radius2 / distance2;
        let height = sine2 / (1.0 + (1.0 - sine2).sqrt());
        let cosine = 1.0 - u * height;
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let w = to / distance2.sqrt();
        let direction = math::around(w, v, sine, cosine);
        // Where the ray meets the near side; it grazes where rounding lets it miss.
        let along = to.dot(direction);
        let depth = (radius2 - (distance2 - along * along)).max(0.0).sqrt();
        let irradiance = self.radiance * (2.0 * std::f32::consts::PI * height / count);
        Some(Arrival { direction, distance: (along - depth) * BEFORE, irradiance })
    }
}
