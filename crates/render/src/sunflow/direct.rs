//! Light that comes straight from the lights.

use std::sync::Arc;

use glam::Vec3;

use super::coat::Bsdf;
use super::point::{Point, Which};
use super::{Queues, Room, Sunflow};
use crate::clock::Stage;
use crate::geometry::{Geometry, Ray, Rays, Scratch};
use crate::light::{Arrival, Light, Receiver};

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
        queues.clock.lap(Stage::Shade);
        geometry.occluded(self.rays.view(0.0), &mut self.blocked, scratch);
        queues.clock.lap(Stage::Trace);
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

/// A surface that waits for light, and is not black.
pub(super) struct Lit<'a> {
    pub point: Point<'a>,
    pub bsdf: Bsdf,
    /// Its matte colour, for virtual lights.
    pub color: Vec3,
}

impl Lit<'_> {
    /// Queues a ray towards light that arrives, unless the surface makes nothing of it.
    #[inline]
    pub fn ask(&self, arrival: Arrival, shadows: &mut Shadows) {
        let (point, Arrival { direction, distance, irradiance }) = (&self.point, arrival);
        let cosine = direction.dot(point.surface.normal);
        if cosine <= 0.0 || direction.dot(point.surface.geometric) <= 0.0 {
            return;
        }
        let light = point.path.weight * self.bsdf.value(direction) * irradiance * cosine;
        if light != Vec3::ZERO {
            shadows.push(point.toward(direction, distance), light, point.path.node);
        }
    }
}

impl Sunflow {
    /// Direct light on surfaces, one light after the other, so that the rays towards it go together.
    pub(super) fn illuminate(&self, geometry: &Geometry, lit: &[Lit<'_>], room: &mut Room, queues: &mut Queues<Vec3>) {
        for (light, number) in self.lights.iter().zip(0..) {
            if let Light::Beams(beams) = light {
                self.shine(beams, geometry, lit, room, queues);
                continue;
            }
            for lit in lit {
                let point = &lit.point;
                let at = Receiver {
                    point: point.front,
                    normal: point.surface.normal,
                    indirect: point.path.depth.diffuse > 0,
                    share: point.share,
                    key: point.key,
                    dimension: point.dimension(Which::Lights),
                };
                light.arrive(number, &at, &mut |arrival| lit.ask(arrival, &mut room.shadows));
                room.flush(geometry, queues);
            }
        }
    }

    /// Beams, of which the samples of a pixel take one each in turn.
    fn shine(
        &self,
        beams: &[Arc<[Arrival]>; 2],
        geometry: &Geometry,
        lit: &[Lit<'_>],
        room: &mut Room,
        queues: &mut Queues<Vec3>,
    ) {
        let longest = beams[0].len().max(beams[1].len());
        for number in 0..longest {
            for lit in lit {
                let point = &lit.point;
                let beams = &beams[usize::from(point.path.depth.diffuse > 0)];
                let share = (point.of.max(1) as usize).min(beams.len().max(1));
                if number < beams.len() && number % share == point.key.index as usize % share {
                    let beam = beams[number];
                    lit.ask(Arrival { irradiance: beam.irradiance * share as f32, ..beam }, &mut room.shadows);
                }
            }
            room.flush(geometry, queues);
        }
    }
}
