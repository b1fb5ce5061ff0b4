//! Lights of which every point sees one direction.

use glam::Vec3;

use super::Arrival;

/// A light that sends a single ray to a point. What `reach` calls must be `#[inline(always)]`: it runs for many points
/// at a time.
pub(crate) trait Single {
    /// What arrives at a point, if nothing is in the way; its irradiance is zero where nothing does.
    fn reach(&self, at: &Spot) -> Arrival;
}

/// A point of a surface that asks for light.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spot {
    pub point: Vec3,
    pub normal: Vec3,
    /// What the form factors of virtual lights count there at most.
    pub limit: f32,
}

/// A point that sends its radiant power evenly to all directions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lamp {
    pub position: Vec3,
    pub power: Vec3,
}

/// A parallel beam from a disc; `irradiance` falls on a surface that faces it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Beam {
    pub source: Vec3,
    pub direction: Vec3,
    pub radius: f32,
    pub irradiance: Vec3,
}

impl Single for Lamp {
    #[inline(always)]
    fn reach(&self, &Spot { point, .. }: &Spot) -> Arrival {
        let to = self.position - point;
        let distance2 = to.dot(to);
        let distance = distance2.sqrt();
        let irradiance = self.power * (1.0 / (4.0 * std::f32::consts::PI * distance2));
        // Into the point itself: not a number, which lights nothing.
        Arrival { direction: to / distance, distance, irradiance }
    }
}

impl Single for Beam {
    #[inline(always)]
    fn reach(&self, &Spot { point, .. }: &Spot) -> Arrival {
        let from = point - self.source;
        let along = from.dot(self.direction);
        let off = from - self.direction * along;
        let within = (along >= 0.0) & (off.dot(off) <= self.radius * self.radius);
        let irradiance = self.irradiance * if within { 1.0 } else { 0.0 };
        Arrival { direction: -self.direction, distance: along, irradiance }
    }
}

/// Parallel light.
impl Single for Arrival {
    #[inline(always)]
    fn reach(&self, _: &Spot) -> Arrival {
        *self
    }
}
