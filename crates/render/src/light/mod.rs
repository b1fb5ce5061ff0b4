//! Lights of Sunflow's dialect: what they send to a point (format reference, §3.7).

mod cornell;
mod emit;
mod fan;
mod single;
mod sphere;
mod triangle;

use std::sync::Arc;

use glam::Vec3;

use crate::environment::{self, Environment};
use crate::sampler::SampleKey;
pub(crate) use cornell::Ceiling;
pub(crate) use fan::{FAN, Fan, Shape};
pub(crate) use single::{Beam, Lamp, Single, Spot};
pub(crate) use sphere::Ball;
use triangle::Seen;
pub(crate) use triangle::Shining;

/// A light in the world.
#[derive(Debug, Clone)]
pub(crate) enum Light {
    Point(Lamp),
    Directional(Beam),
    /// Parallel light from infinitely far away.
    Sun(Arrival),
    /// A shining sphere.
    Ball(Ball),
    /// Shining triangles.
    Triangles {
        triangles: Arc<[Shining]>,
        samples: u32,
    },
    /// The light in the ceiling of a Cornell box.
    Ceiling(Ceiling),
    /// The surroundings, looked at in other directions by every point.
    Surroundings {
        table: Arc<environment::Table>,
        samples: u32,
    },
    /// Parallel light from a few directions that all points share; points that light comes to by way of others take the
    /// second list.
    Beams([Arc<[Arrival]>; 2]),
}

/// A point that asks for light.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Receiver {
    pub point: Vec3,
    /// For shading, of unit length.
    pub normal: Vec3,
    /// The light comes by way of another matte surface: one sample will do.
    pub indirect: bool,
    /// So many samples of the pixel share the work of one.
    pub share: u32,
    pub key: SampleKey,
    /// The sample dimension of the first light; the others have those that follow.
    pub dimension: u32,
}

/// Light that arrives at a point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Arrival {
    /// Unit vector towards the light.
    pub direction: Vec3,
    /// How far the light is; what blocks it is closer.
    pub distance: f32,
    /// Irradiance on a surface that faces it: the sample's part of what the whole light gives.
    pub irradiance: Vec3,
}

impl Arrival {
    /// No light.
    pub const NONE: Arrival = Arrival { direction: Vec3::ZERO, distance: 0.0, irradiance: Vec3::ZERO };
}

/// Rays towards a shape that shines end so much before it that they do not meet it.
pub(crate) const BEFORE: f32 = 0.9999;
/// Triangles of one light up to which every one gets its own samples; of more, samples choose.
const EACH: usize = 16;
/// Samples for all triangles of a light that has more.
const CHOSEN: u32 = 64;

impl Light {
    /// The surroundings as beams from so many directions, for direct and for indirect light.
    pub fn beams(environment: &Environment, counts: [u32; 2], number: u64) -> Light {
        let beams = |count: u32| {
            let beam = |i: u32| {
                let (direction, light) = environment.sample(SampleKey::shared(i, number + 1).pair(0))?;
                Some(Arrival { direction, distance: f32::INFINITY, irradiance: light / count as f32 })
            };
            (0..count).filter_map(beam).collect()
        };
        Light::Beams(counts.map(beams))
    }

    /// Whether a point sees it in one direction: see [`Single`].
    pub fn is_single(&self) -> bool {
        matches!(self, Light::Point(_) | Light::Directional(_) | Light::Sun(_))
    }

    /// What arrives at a point, if nothing is in the way: light `number` of the scene, a fan of samples after the other.
    /// Those that are [`Single`], and beams, are left out.
    pub fn arrive(&self, number: u32, at: &Receiver, fan: &mut Fan, each: &mut impl FnMut(&mut Fan)) {
        let dimension = at.dimension + number;
        match self {
            Light::Point(_) | Light::Directional(_) | Light::Sun(_) | Light::Beams(_) => {}
            Light::Ball(ball) => {
                if let Some(cone) = ball.seen_from(at.point) {
                    fan.spread(at.key, dimension, at.count(ball.samples), &cone, ball.radiance, each);
                }
            }
            Light::Ceiling(light) => {
                if let Some(seen) = light.seen_from(at.point) {
                    fan.spread(at.key, dimension, at.count(light.samples), &seen, light.radiance, each);
                }
            }
            Light::Triangles { triangles, samples } if triangles.len() <= EACH => {
                let (count, key) = (at.count(*samples), at.key);
                for triangle in triangles.iter() {
                    match triangle.seen_from(at) {
                        Some(Seen::Wide(wide)) => fan.spread(key, dimension, count, &wide, triangle.radiance, each),
                        Some(Seen::Small(small)) => fan.spread(key, dimension, count, &small, triangle.radiance, each),
                        None => {}
                    }
                }
            }
            Light::Triangles { triangles, samples } => {
                let samples = samples.saturating_mul(triangles.len() as u32).min((*samples).max(CHOSEN));
                fan.choose(at.key, dimension, at.count(samples), |xi| triangle::choose(triangles, at, xi), each);
            }
            Light::Surroundings { table, samples } => {
                let look_up = |xi| {
                    let (direction, irradiance) = table.sample(xi);
                    Arrival { direction, distance: f32::INFINITY, irradiance }
                };
                fan.choose(at.key, dimension, at.count(*samples), look_up, each);
            }
        }
    }
}

impl Receiver {
    /// How many samples it takes of a light that asks for `samples`.
    pub fn count(&self, samples: u32) -> u32 {
        if self.indirect { samples.min(1) } else { samples.div_ceil(self.share.max(1)) }
    }
}
