//! Photons that lights send (format reference, §3.15).

use glam::Vec3;

use super::{Beam, Lamp, Light};
use crate::math;

impl Light {
    /// All that the light sends, by which it is chosen among others; zero for skies, which send no photons.
    pub fn power(&self) -> Vec3 {
        let pi = std::f32::consts::PI;
        match self {
            Light::Point(lamp) => lamp.power,
            Light::Directional(beam) => beam.irradiance * (pi * beam.radius * beam.radius),
            Light::Ball(ball) => ball.radiance * (4.0 * pi * pi * ball.radius * ball.radius),
            Light::Ceiling(light) => light.radiance * (pi * light.area()),
            Light::Triangles { triangles, .. } => {
                let area: f32 = triangles.iter().map(|triangle| triangle.area).sum();
                triangles.first().map_or(Vec3::ZERO, |triangle| triangle.radiance * (pi * area))
            }
            Light::Sun(_) | Light::Surroundings { .. } | Light::Beams(_) => Vec3::ZERO,
        }
    }

    /// What all photons of the light carry together. Sunflow: those of a triangle only what this triangle sends (R16).
    pub fn photon_power(&self) -> Vec3 {
        match self {
            Light::Triangles { triangles, .. } => self.power() / triangles.len().max(1) as f32,
            _ => self.power(),
        }
    }

    /// Origin and direction of a photon, for two uniform numbers for its place and two for its direction. Those of a
    /// point may be `crowded` as in Sunflow (R16), which instant radiosity is scaled by.
    pub fn emit(&self, place: [f32; 2], [u, v]: [f32; 2], crowded: bool) -> Option<(Vec3, Vec3)> {
        match self {
            Light::Point(Lamp { position, .. }) if crowded => {
                let around = math::around(Vec3::Z, u, (v * (1.0 - v)).sqrt(), 1.0 - 2.0 * v);
                Some((*position, around.normalize_or(Vec3::Z)))
            }
            Light::Point(Lamp { position, .. }) => Some((*position, sphere([u, v]))),
            Light::Directional(Beam { source, direction, radius, .. }) => {
                let [turn, out] = place;
                Some((*source + math::around(*direction, turn, out.sqrt() * radius, 0.0), *direction))
            }
            Light::Ball(ball) => {
                let normal = sphere(place);
                let origin = math::offset(ball.center + normal * ball.radius, normal);
                Some((origin, math::cosine_hemisphere(normal, [u, v])))
            }
            Light::Ceiling(light) => {
                let [low, high] = light.corners();
                let [x, y] = place;
                let at = Vec3::new(low.x + x * (high.x - low.x), low.y + y * (high.y - low.y), low.z);
                let (sin, cos) = math::sin_cos_turns(u);
                let direction = Vec3::new(cos * v.sqrt(), sin * v.sqrt(), -(1.0 - v).sqrt());
                Some((math::offset(at, Vec3::NEG_Z), direction))
            }
            Light::Triangles { triangles, .. } => {
                let (triangle, place) = super::triangle::by_area(triangles, place)?;
                let origin = math::offset(triangle.point(place), triangle.normal);
                Some((origin, math::cosine_hemisphere(triangle.normal, [u, v])))
            }
            Light::Sun(_) | Light::Surroundings { .. } | Light::Beams(_) => None,
        }
    }
}

/// A direction, evenly over all.
fn sphere([turn, height]: [f32; 2]) -> Vec3 {
    let cosine = 1.0 - 2.0 * height;
    math::around(Vec3::Z, turn, (1.0 - cosine * cosine).max(0.0).sqrt(), cosine)
}
