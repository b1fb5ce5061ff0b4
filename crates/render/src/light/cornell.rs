//! The light in the ceiling of a Cornell box: a rectangle that shines downwards, −z.

use glam::Vec3;

use super::{Arrival, BEFORE, Receiver};

/// The rectangle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ceiling {
    /// Corners of the room.
    pub room: [Vec3; 2],
    pub radiance: Vec3,
    pub samples: u32,
}

impl Ceiling {
    /// Corners of the middle ninth of the ceiling.
    pub fn corners(&self) -> [Vec3; 2] {
        let [min, max] = self.room;
        let third = (max - min) / 3.0;
        [Vec3::new(min.x + third.x, min.y + third.y, max.z), Vec3::new(max.x - third.x, max.y - third.y, max.z)]
    }

    pub fn area(&self) -> f32 {
        let [low, high] = self.corners();
        (high.x - low.x) * (high.y - low.y)
    }

    /// Sample `xi` of `count`, spread evenly over the area.
    pub fn arrive(&self, at: &Receiver, [u, v]: [f32; 2], count: f32) -> Option<Arrival> {
        let [min, max] = self.room;
        let inside = at.point.cmpge(min).all() && at.point.cmple(max).all() && at.point.z < max.z;
        if !inside {
            return None;
        }
        let [low, high] = self.corners();
        let target = Vec3::new(low.x + u * (high.x - low.x), low.y + v * (high.y - low.y), max.z);
        let to = target - at.point;
        let distance2 = to.length_squared();
        let distance = distance2.sqrt();
        let irradiance = self.radiance * (self.area() * to.z / (distance * distance2 * count));
        Some(Arrival { direction: to / distance, distance: distance * BEFORE, irradiance })
    }
}
