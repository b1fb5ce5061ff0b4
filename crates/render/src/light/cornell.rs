//! The light in the ceiling of a Cornell box: a rectangle that shines downwards, −z.

use glam::Vec3;

use super::BEFORE;
use super::fan::Shape;

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

    /// `None` from outside of the room.
    pub(super) fn seen_from(&self, point: Vec3) -> Option<Above> {
        let [min, max] = self.room;
        let inside = point.cmpge(min).all() && point.cmple(max).all() && point.z < max.z;
        let [low, high] = self.corners();
        inside.then(|| Above { low: low - point, size: high - low, area: self.area() })
    }
}

/// The rectangle above a point.
pub(super) struct Above {
    /// From the point to the corner.
    low: Vec3,
    size: Vec3,
    area: f32,
}

impl Shape for Above {
    /// Spread evenly over the area.
    #[inline(always)]
    fn sample(&self, [u, v]: [f32; 2]) -> (Vec3, f32, f32) {
        let to = Vec3::new(self.low.x + u * self.size.x, self.low.y + v * self.size.y, self.low.z);
        let distance2 = to.dot(to);
        let distance = distance2.sqrt();
        (to * (1.0 / distance), distance * BEFORE, self.area * to.z / (distance * distance2))
    }
}
