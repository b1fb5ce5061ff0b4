//! Virtual lights where photons came to rest ([Keller 1997] "Instant Radiosity"; format reference, §3.14 `igi`).

use glam::Vec3;

use super::direct::Lit;
use super::photons::{self, Keep, Photon, Senders};
use super::point::{Point, Which};
use super::{Queues, Room, Shadows, Sunflow};
use crate::clock::Stage;
use crate::geometry::{Geometry, Id, Rays};
use crate::light::BEFORE;
use crate::math;
use crate::wave::{Path, RayKind};

/// Virtual lights, in sets of which every point takes one.
#[derive(Debug, Clone)]
pub(crate) struct VirtualLights {
    sets: Vec<Vec<Photon>>,
    /// What limits the light of near ones.
    bias: f32,
    /// How many rays look for the light that the limit takes away.
    bias_samples: u32,
}

impl VirtualLights {
    /// Sends `samples` photons for each of `sets` sets.
    pub fn send(senders: &Senders<'_>, samples: u32, sets: u32, (bias, bias_samples): (f32, u32)) -> Self {
        let sets = (0..sets.max(1)).map(|set| photons::send(senders, Keep::All, set * samples, samples));
        VirtualLights { sets: sets.collect(), bias, bias_samples }
    }

    /// Light of one set on matte surfaces, one virtual light after the other. Of the samples of a pixel each takes its
    /// part of the set.
    pub(super) fn illuminate(&self, geometry: &Geometry, lit: &[Lit<'_>], room: &mut Room, queues: &mut Queues<Vec3>) {
        let of = |point: &Point<'_>| {
            let [choice, _] = point.key.pair(point.dimension(Which::Choice));
            ((choice * self.sets.len() as f32) as usize).min(self.sets.len() - 1)
        };
        let sets: Vec<usize> = lit.iter().map(|lit| of(&lit.point)).collect();
        for (set, lights) in self.sets.iter().enumerate() {
            for (number, light) in lights.iter().enumerate() {
                for (lit, _) in lit.iter().zip(&sets).filter(|&(_, &of)| of == set) {
                    let share = (lit.point.of.max(1) as usize).min(lights.len());
                    if number % share == lit.point.key.index as usize % share {
                        self.add(light, lit, share as f32, &mut room.shadows);
                    }
                }
                room.shadows.flush(geometry, queues, &mut room.scratch);
            }
        }
    }

    /// What the form factor of a virtual light counts at most on a surface of a colour.
    fn limit(&self, color: Vec3) -> f32 {
        std::f32::consts::PI * self.bias / color.max_element()
    }

    /// Looks for the light that the limit takes away from near surfaces: rays that are so short that it might apply go on as paths
    /// ([Kollig, Keller 2004] "Illumination in the Presence of Weak Singularities").
    pub(super) fn compensate(
        &self,
        rules: &Sunflow,
        geometry: &Geometry,
        lit: &[Lit<'_>],
        room: &mut Room,
        queues: &mut Queues<Vec3>,
    ) {
        let (mut rays, mut askers) = (Rays::default(), Vec::new());
        for Lit { point, color, .. } in lit {
            let depth = point.path.depth;
            let count = if depth.diffuse == 0 { point.count(self.bias_samples) } else { self.bias_samples.min(1) };
            for i in 0..count {
                let key = point.key.nth(i, count);
                let direction = math::cosine_hemisphere(point.surface.normal, key.pair(point.dimension(Which::Gather)));
                let reach = (direction.dot(point.surface.normal).max(0.0) / self.limit(*color)).sqrt();
                rays.push(point.toward(direction, reach));
                let weight = point.path.weight * *color / count as f32;
                let path =
                    Path { weight, index: key.index, kind: RayKind::Gather, depth: depth.diffused(), ..*point.path };
                askers.push((point, self.limit(*color), path));
            }
        }
        queues.clock.lap(Stage::Shade);
        geometry.closest(rays.view(0.0), &mut room.near, &mut room.scratch);
        queues.clock.lap(Stage::Trace);
        for (i, (point, limit, path)) in askers.into_iter().enumerate() {
            let (ray, hit) = (rays.get(i), room.near.get(i));
            if hit.id == Id::NONE {
                continue;
            }
            let here = ray.direction.dot(point.surface.normal);
            let there = ray.direction.dot(geometry.surface(&ray, &hit).normal).abs();
            let form = here * there / (hit.t * hit.t);
            if form > limit {
                let weight = path.weight * ((form - limit) / form);
                rules.queue(point, [point.front, ray.direction], Path { weight, ..path }, queues);
            }
        }
    }

    fn add(&self, light: &Photon, lit: &Lit<'_>, share: f32, shadows: &mut Shadows) {
        let Lit { point, color, .. } = lit;
        let to = light.point - point.front;
        let distance2 = to.length_squared();
        let distance = distance2.sqrt();
        let direction = to / distance;
        let (here, there) = (direction.dot(point.surface.normal), -direction.dot(light.normal));
        if here > 0.0 && there > 0.0 && direction.dot(point.surface.geometric) > 0.0 {
            let form = (here * there / distance2).min(self.limit(*color));
            // Sunflow: the quarter is literal (R17).
            let brings = point.path.weight * *color * light.power * (0.25 * std::f32::consts::FRAC_1_PI * form * share);
            shadows.push(point.toward(direction, distance * BEFORE), brings, point.path.node);
        }
    }
}
