//! Virtual lights where photons came to rest ([Keller 1997] "Instant Radiosity"; format reference, §3.14 `igi`).

use glam::Vec3;

use super::photons::{self, Keep, Photon};
use super::point::{Point, Which};
use super::{Shadows, Sunflow};
use crate::geometry::Ray;
use crate::wave::World;

/// Virtual lights, in sets of which every point takes one.
#[derive(Debug, Clone)]
pub(crate) struct VirtualLights {
    sets: Vec<Vec<Photon>>,
    /// What limits the light of near ones.
    bias: f32,
}

/// How close to a virtual light a shadow ray ends.
const BEFORE: f32 = 0.9999;

impl VirtualLights {
    /// Sends `samples` photons for each of `sets` sets.
    pub fn send(rules: &Sunflow, world: &World, samples: u32, sets: u32, bias: f32) -> Self {
        let sets = (0..sets.max(1)).map(|set| photons::send(rules, world, Keep::All, set * samples, samples));
        VirtualLights { sets: sets.collect(), bias }
    }

    /// Light of one set on a matte surface of a colour.
    pub(super) fn illuminate(&self, point: &Point<'_>, color: Vec3, shadows: &mut Shadows) {
        let [choice, _] = point.key.pair(point.dimension(Which::Choice));
        let set = (choice * self.sets.len() as f32) as usize;
        let limit = std::f32::consts::PI * self.bias / color.max_element();
        let matte = point.path.weight * color * std::f32::consts::FRAC_1_PI;
        for light in &self.sets[set.min(self.sets.len() - 1)] {
            let to = light.point - point.front;
            let distance2 = to.length_squared();
            let distance = distance2.sqrt();
            let direction = to / distance;
            let (here, there) = (direction.dot(point.surface.normal), -direction.dot(light.normal));
            if here > 0.0 && there > 0.0 && direction.dot(point.surface.geometric) > 0.0 {
                let form = (here * there / distance2).min(limit);
                // Sunflow: the quarter is literal (R17).
                let brings = matte * light.power * (0.25 * form);
                let t_max = distance * BEFORE;
                let ray = Ray { origin: point.front, direction, t_min: 0.0, t_max, skip: point.skip };
                shadows.push(ray, brings, point.path.node);
            }
        }
    }
}
