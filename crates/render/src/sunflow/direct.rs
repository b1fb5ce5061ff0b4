//! Light that comes straight from the lights.

use glam::Vec3;

use super::coat::Bsdf;
use super::point::{Point, Which};
use super::{Queues, Sunflow};
use crate::geometry::{Geometry, Ray, Rays, Scratch};
use crate::light::{Arrival, Receiver};

/// Rays towards lights, and what arrives if nothing is in the way.
#[derive(Default)]
pub(super) struct Shadows {
    rays: Rays,
    light: Vec<Vec3>,
    nodes: Vec<u32>,
    blocked: Vec<bool>,
}

impl Shadows {
    /// Shadow rays that are traced together at most, give or take those of one point.
    const FULL: usize = 4096;

    pub fn is_full(&self) -> bool {
        self.nodes.len() >= Shadows::FULL
    }

    /// Queues a ray that brings `light` to a node.
    pub fn push(&mut self, ray: Ray, light: Vec3, node: u32) {
        self.rays.push(ray);
        self.light.push(light);
        self.nodes.push(node);
    }

    /// Traces what is queued and hands out what arrives.
    pub fn trace(&mut self, geometry: &Geometry, queues: &mut Queues<Vec3>, scratch: &mut Scratch) {
        queues.stats.shadow_rays += self.nodes.len() as u64;
        geometry.occluded(self.rays.view(0.0), &mut self.blocked, scratch);
        for ((&light, &node), &blocked) in self.light.iter().zip(&self.nodes).zip(&self.blocked) {
            if !blocked {
                queues.nodes[node as usize] += light;
            }
        }
        self.rays.clear();
        self.light.clear();
        self.nodes.clear();
    }
}

impl Sunflow {
    /// Direct light on a surface.
    pub(super) fn illuminate(&self, point: &Point<'_>, bsdf: &Bsdf, shadows: &mut Shadows) {
        if bsdf.is_black() {
            return;
        }
        let at = Receiver {
            point: point.front,
            normal: point.surface.normal,
            indirect: point.path.depth.diffuse > 0,
            key: point.key,
            dimension: point.dimension(Which::Lights),
        };
        for (light, number) in self.lights.iter().zip(0..) {
            light.arrive(number, &at, &mut |arrival: Arrival| {
                let Arrival { direction, distance, irradiance } = arrival;
                let cosine = direction.dot(point.surface.normal);
                if cosine <= 0.0 || direction.dot(point.surface.geometric) <= 0.0 {
                    return;
                }
                let light = point.path.weight * bsdf.value(direction) * irradiance * cosine;
                if light != Vec3::ZERO {
                    let ray = Ray { origin: point.front, direction, t_min: 0.0, t_max: distance, skip: point.skip };
                    shadows.push(ray, light, point.path.node);
                }
            });
        }
    }
}
