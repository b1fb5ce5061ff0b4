//! Lights of Sunflow's dialect: what they send to a point.

use glam::Vec3;

/// A light in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Light {
    /// Radiant power, spread evenly over all directions.
    Point { position: Vec3, power: Vec3 },
    /// A parallel beam; `irradiance` falls on a surface that faces it.
    Directional { source: Vec3, direction: Vec3, radius: f32, irradiance: Vec3 },
}

/// Light that arrives at a point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Arrival {
    /// Unit vector towards the light.
    pub direction: Vec3,
    /// How far the light is; what blocks it is closer.
    pub distance: f32,
    /// Irradiance on a surface that faces it.
    pub irradiance: Vec3,
}

impl Light {
    /// What arrives at `point`, if nothing is in the way (format reference, §3.7).
    #[inline]
    pub fn arrive(&self, point: Vec3) -> Option<Arrival> {
        match *self {
            Light::Point { position, power } => {
                let to = position - point;
                let distance2 = to.length_squared();
                if distance2 == 0.0 {
                    return None;
                }
                let distance = distance2.sqrt();
                let irradiance = power * (1.0 / (4.0 * std::f32::consts::PI * distance2));
                Some(Arrival { direction: to / distance, distance, irradiance })
            }
            Light::Directional { source, direction, radius, irradiance } => {
                let along = (point - source).dot(direction);
                let off = point - source - direction * along;
                let inside = along >= 0.0 && off.length_squared() <= radius * radius;
                inside.then_some(Arrival { direction: -direction, distance: along, irradiance })
            }
        }
    }
}
