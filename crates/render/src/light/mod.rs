//! Lights of Sunflow's dialect: what they send to a point (format reference, §3.7).

mod cornell;
mod emit;
mod fan;
mod sphere;
mod triangle;

use std::sync::Arc;

use glam::Vec3;

use crate::environment::Environment;
use crate::sampler::SampleKey;
pub(crate) use cornell::Ceiling;
pub(crate) use sphere::Ball;
use triangle::Seen;
pub(crate) use triangle::Shining;

/// A light in the world.
#[derive(Debug, Clone)]
pub(crate) enum Light {
    /// Radiant power, spread evenly over all directions.
    Point { position: Vec3, power: Vec3 },
    /// A parallel beam; `irradiance` falls on a surface that faces it.
    Directional { source: Vec3, direction: Vec3, radius: f32, irradiance: Vec3 },
    /// A parallel beam from infinitely far away, which `towards` points to.
    Sun { towards: Vec3, irradiance: Vec3 },
    /// A shining sphere.
    Ball(Ball),
    /// Shining triangles.
    Triangles { triangles: Arc<[Shining]>, samples: u32 },
    /// The light in the ceiling of a Cornell box.
    Ceiling(Ceiling),
    /// The surroundings, looked at in other directions by every point.
    Surroundings { environment: Arc<Environment>, samples: u32 },
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
            let beam = |i: u32| beam(environment, SampleKey::shared(i, number + 1).pair(0), count as f32);
            (0..count).filter_map(beam).collect()
        };
        Light::Beams(counts.map(beams))
    }

    /// What arrives at a point, if nothing is in the way: light `number` of the scene, sample by sample. Beams are left
    /// out.
    #[inline]
    pub fn arrive(&self, number: u32, at: &Receiver, each: &mut impl FnMut(Arrival)) {
        match self {
            Light::Point { position, power } => {
                let to = *position - at.point;
                let distance2 = to.length_squared();
                if distance2 > 0.0 {
                    let distance = distance2.sqrt();
                    let irradiance = *power * (1.0 / (4.0 * std::f32::consts::PI * distance2));
                    each(Arrival { direction: to / distance, distance, irradiance });
                }
            }
            Light::Directional { source, direction, radius, irradiance } => {
                let along = (at.point - *source).dot(*direction);
                let off = at.point - *source - *direction * along;
                if along >= 0.0 && off.length_squared() <= radius * radius {
                    each(Arrival { direction: -*direction, distance: along, irradiance: *irradiance });
                }
            }
            Light::Sun { towards, irradiance } => {
                each(Arrival { direction: *towards, distance: f32::INFINITY, irradiance: *irradiance });
            }
            Light::Beams(_) => {}
            Light::Ball(ball) => {
                if let Some(cone) = ball.seen_from(at.point) {
                    fan::spread(at, number, ball.samples, &cone, ball.radiance, each);
                }
            }
            Light::Ceiling(light) => {
                if let Some(seen) = light.seen_from(at.point) {
                    fan::spread(at, number, light.samples, &seen, light.radiance, each);
                }
            }
            Light::Triangles { triangles, samples } if triangles.len() <= EACH => {
                for triangle in triangles.iter() {
                    match triangle.seen_from(at) {
                        Some(Seen::Wide(wide)) => fan::spread(at, number, *samples, &wide, triangle.radiance, each),
                        Some(Seen::Small(small)) => fan::spread(at, number, *samples, &small, triangle.radiance, each),
                        None => {}
                    }
                }
            }
            Light::Triangles { triangles, samples } => {
                let samples = samples.saturating_mul(triangles.len() as u32).min((*samples).max(CHOSEN));
                one_by_one(at, number, samples, |xi, n| triangle::choose(triangles, at, xi, n), each);
            }
            Light::Surroundings { environment, samples } => {
                one_by_one(at, number, *samples, |xi, n| beam(environment, xi, n), each);
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

/// Sample `xi` of `count` of the surroundings.
#[inline]
fn beam(environment: &Environment, xi: [f32; 2], count: f32) -> Option<Arrival> {
    let (direction, radiance) = environment.sample(xi)?;
    Some(Arrival { direction, distance: f32::INFINITY, irradiance: radiance / count })
}

/// Samples of a light each of which costs its own search; `look` gets two uniform numbers and the number of samples.
#[inline]
fn one_by_one(
    at: &Receiver,
    number: u32,
    samples: u32,
    look: impl Fn([f32; 2], f32) -> Option<Arrival>,
    each: &mut impl FnMut(Arrival),
) {
    let count = at.count(samples);
    for i in 0..count {
        let xi = at.key.nth(i, count).pair(at.dimension + number);
        look(xi, count as f32).into_iter().for_each(&mut *each);
    }
}
