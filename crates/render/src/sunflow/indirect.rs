//! Light that comes by way of other matte surfaces (format reference, §3.14).

use std::sync::Arc;

use glam::Vec3;

use super::direct::Kept;
use super::point::{Point, Which};
use super::virtual_lights::VirtualLights;
use super::{Queues, Room, Sunflow};
use crate::geometry::simd::{self, Simd};
use crate::light::{FAN, Fan, Shape};
use crate::math;
use crate::wave::{Path, RayKind};

/// How indirect light is found.
#[derive(Debug, Clone)]
pub(crate) enum Indirect {
    None,
    /// So many rays at the first matte surface of a path, one at the others.
    Paths {
        samples: u32,
    },
    /// Virtual lights that are still to be placed: so many photons for each of so many sets.
    Instant {
        samples: u32,
        sets: u32,
        bias: f32,
        bias_samples: u32,
    },
    VirtualLights(Arc<VirtualLights>),
    /// `bright` where nothing stands nearer than `distance`, else `dark`.
    Occlusion {
        dark: Vec3,
        bright: Vec3,
        samples: u32,
        distance: f32,
    },
    /// A colour by the slope of the surface.
    Slope {
        up: Vec3,
        sky: Vec3,
        ground: Vec3,
    },
}

/// The hemisphere above a surface, the density of its samples proportional to the cosine.
struct Sky {
    normal: Vec3,
    distance: f32,
}

impl Shape for Sky {
    #[inline(always)]
    fn sample(&self, xi: [f32; 2]) -> (Vec3, f32, f32) {
        (math::cosine_hemisphere(self.normal, xi), self.distance, 1.0)
    }
}

/// Keeps the directions of a fan that leave a surface.
struct Above<'a> {
    fan: &'a Fan,
    geometric: Vec3,
}

impl simd::Kernel for Above<'_> {
    type Output = Kept;

    #[inline(always)]
    fn run<S: Simd>(self) -> Kept {
        let [x, y, z] = &self.fan.direction;
        let mut is_kept = [false; FAN];
        for (i, is_kept) in is_kept.iter_mut().enumerate() {
            *is_kept = Vec3::new(x[i], y[i], z[i]).dot(self.geometric) > 0.0;
        }
        Kept::among(&is_kept, self.fan.size)
    }
}

impl Sunflow {
    /// Indirect light on a matte surface of a colour.
    pub(super) fn gather(&self, point: &Point<'_>, color: Vec3, room: &mut Room, queues: &mut Queues<Vec<Vec3>>) {
        let depth = point.path.depth;
        if depth.diffuse >= self.max_diffuse {
            return;
        }
        match self.indirect {
            // Virtual lights shine on all points of a batch, after this.
            Indirect::None | Indirect::Instant { .. } | Indirect::VirtualLights(_) => {}
            Indirect::Paths { samples } => {
                let count = if depth.diffuse == 0 { point.count(samples) } else { samples.min(1) };
                for i in 0..count {
                    let key = point.key.nth(i, count);
                    let xi = key.pair(point.dimension(Which::Gather));
                    let direction = math::cosine_hemisphere(point.surface.normal, xi);
                    let path = Path {
                        weight: point.path.weight * color / count as f32,
                        index: key.index,
                        kind: RayKind::Gather,
                        depth: depth.diffused(),
                        ..*point.path
                    };
                    self.queue(point, [point.front, direction], path, queues);
                }
            }
            Indirect::Occlusion { dark, bright, samples, distance } => {
                self.occlusion(point, [dark * color, bright * color], samples, distance, room, queues);
            }
            Indirect::Slope { up, sky, ground } => {
                let cosine = up.dot(point.surface.normal);
                let half_sine = 0.5 * (1.0 - cosine * cosine).max(0.0).sqrt();
                let (near, far) = if cosine > 0.0 { (sky, ground) } else { (ground, sky) };
                self.emit(point, color * near.lerp(far, half_sine), queues);
            }
        }
    }

    /// The mean over the hemisphere of `bright` where nothing stands nearer than `distance`, else `dark`.
    pub(super) fn occlusion(
        &self,
        point: &Point<'_>,
        [dark, bright]: [Vec3; 2],
        samples: u32,
        distance: f32,
        room: &mut Room,
        queues: &mut Queues<Vec<Vec3>>,
    ) {
        self.emit(point, dark, queues);
        let endless = distance <= 0.0;
        // Sunflow: a background is as good a wall as any (R10).
        if samples == 0 || endless && (self.background.is_some() || self.surroundings.is_some()) {
            return;
        }
        // They are cheap, and twice as many make up for Sunflow's samples at the corners of pixels, which neighbours share.
        let samples = point.count(samples.saturating_mul(2));
        let sky = Sky { normal: point.surface.normal, distance: if endless { f32::MAX } else { distance } };
        let (light, dimension) = (point.path.weight * (bright - dark), point.dimension(Which::Gather));
        let Room { fan, shadows, .. } = room;
        fan.spread(point.key, dimension, samples, &sky, light, &mut |fan| {
            // A ray into the surface itself meets it.
            let kept = simd::run(Above { fan, geometric: point.surface.geometric });
            shadows.push_fan(fan, &kept, point);
        });
    }
}
