//! Virtual lights where photons came to rest ([Keller 1997] "Instant Radiosity"; format reference, §3.14 `igi`).

use glam::Vec3;

use super::direct::Lit;
use super::photons::{self, Keep, Photon, Senders};
use super::point::{Point, Which};
use super::{Queues, Room, Shadows};
use crate::geometry::Geometry;
use crate::light::BEFORE;

/// Virtual lights, in sets of which every point takes one.
#[derive(Debug, Clone)]
pub(crate) struct VirtualLights {
    sets: Vec<Vec<Photon>>,
    /// What limits the light of near ones.
    bias: f32,
}

impl VirtualLights {
    /// Sends `samples` photons for each of `sets` sets.
    pub fn send(senders: &Senders<'_>, samples: u32, sets: u32, bias: f32) -> Self {
        let sets = (0..sets.max(1)).map(|set| photons::send(senders, Keep::All, set * samples, samples));
        VirtualLights { sets: sets.collect(), bias }
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
                    let share = (lit.point.share.max(1) as usize).min(lights.len());
                    if number % share == lit.point.key.index as usize % share {
                        self.add(light, lit, share as f32, &mut room.shadows);
                    }
                }
                room.flush(geometry, queues);
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
            let limit = std::f32::consts::PI * self.bias / color.max_element();
            let form = (here * there / distance2).min(limit);
            // Sunflow: the quarter is literal (R17).
            let brings = point.path.weight * *color * light.power * (0.25 * std::f32::consts::FRAC_1_PI * form * share);
            shadows.push(point.toward(direction, distance * BEFORE), brings, point.path.node);
        }
    }
}
