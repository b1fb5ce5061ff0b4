//! Virtual lights where photons came to rest ([Keller 1997] "Instant Radiosity"; format reference, §3.14 `igi`).

use glam::Vec3;

use super::direct::{self, Lit};
use super::photons::{self, Keep, Photon, Senders};
use super::point::Which;
use super::{Queues, Room, Sunflow};
use crate::clock::Stage;
use crate::geometry::{Geometry, Id, Rays};
use crate::light::{Arrival, BEFORE, Single, Spot};
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
    pub(super) fn illuminate(
        &self,
        geometry: &Geometry,
        lit: &[Lit<'_>],
        room: &mut Room,
        queues: &mut Queues<Vec<Vec3>>,
    ) {
        let set = |lit: &Lit<'_>| {
            let [choice, _] = lit.point.key.pair(lit.point.dimension(Which::Choice));
            ((choice * self.sets.len() as f32) as usize).min(self.sets.len() - 1)
        };
        let value = |lit: &Lit<'_>| (lit.point.path.weight * lit.color, self.limit(lit.color));
        direct::in_turn(&self.sets, lit, set, value, room, |light, share, room| {
            // Sunflow: the quarter is literal (R17).
            let power = light.power * (0.25 * std::f32::consts::FRAC_1_PI * share);
            direct::shine(Virtual { point: light.point, normal: light.normal, power }, geometry, &[], room, queues);
        });
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
        queues: &mut Queues<Vec<Vec3>>,
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
}

/// A virtual light.
#[derive(Clone, Copy)]
struct Virtual {
    point: Vec3,
    normal: Vec3,
    power: Vec3,
}

impl Single for Virtual {
    #[inline(always)]
    fn reach(&self, at: &Spot) -> Arrival {
        let to = self.point - at.point;
        let distance2 = to.dot(to);
        let distance = distance2.sqrt();
        let direction = to / distance;
        let (here, there) = (direction.dot(at.normal), -direction.dot(self.normal));
        // The form factor without the cosine at the point, by which what arrives is multiplied.
        let (form, limit) = (there / distance2, at.limit / here);
        let form = if form < limit { form } else { limit };
        Arrival {
            direction,
            distance: distance * BEFORE,
            irradiance: self.power * if there > 0.0 { form } else { 0.0 },
        }
    }
}
