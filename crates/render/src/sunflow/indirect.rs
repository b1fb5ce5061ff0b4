//! Light that comes by way of other matte surfaces (format reference, §3.14).

use std::sync::Arc;

use glam::Vec3;

use super::direct::Shadows;
use super::point::{Point, Which};
use super::virtual_lights::VirtualLights;
use super::{Queues, Sunflow};
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

impl Sunflow {
    /// Indirect light on a matte surface of a colour.
    pub(super) fn gather(&self, point: &Point<'_>, color: Vec3, shadows: &mut Shadows, queues: &mut Queues<Vec3>) {
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
                self.occlusion(point, [dark * color, bright * color], samples, distance, shadows, queues);
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
        shadows: &mut Shadows,
        queues: &mut Queues<Vec3>,
    ) {
        self.emit(point, dark, queues);
        let endless = distance <= 0.0;
        // Sunflow: a background is as good a wall as any (R10).
        if samples == 0 || endless && (self.background.is_some() || self.surroundings.is_some()) {
            return;
        }
        let t_max = if endless { f32::INFINITY } else { distance };
        let samples = point.count(samples);
        let light = point.path.weight * (bright - dark) / samples as f32;
        for i in 0..samples {
            let xi = point.key.nth(i, samples).pair(point.dimension(Which::Gather));
            let direction = math::cosine_hemisphere(point.surface.normal, xi);
            // A ray into the surface itself meets it.
            if direction.dot(point.surface.geometric) > 0.0 {
                shadows.push(point.toward(direction, t_max), light, point.path.node);
            }
        }
    }
}
