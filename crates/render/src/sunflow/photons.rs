//! Light sent out from the lights ([Jensen 2001] "Realistic Image Synthesis Using Photon Mapping"): photons for
//! caustics, and for virtual lights (format reference, §3.15).
//!
//! Photons travel in the same waves as the light that the camera sees, by rules of their own.

use std::sync::{Mutex, PoisonError};

use glam::Vec3;

use super::halton::halton;
use super::point::Point;
use super::{Batch, Coat, Path, Queues, Response, Room, Rules, Sunflow};
use crate::clock::Spent;
use crate::film::Pixel;
use crate::geometry::{Geometry, Hits, Rays};
use crate::light::Light;
use crate::material::luminance;
use crate::math;
use crate::options::Observer;
use crate::sampler::SampleKey;
use crate::threads;
use crate::wave::{RayKind, Samples, Workspace, World};

/// A photon where it came to a matte surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Photon {
    pub point: Vec3,
    /// Of the surface, on the side that the photon came from.
    pub normal: Vec3,
    /// In which it travelled.
    pub direction: Vec3,
    pub power: Vec3,
    /// Which of the photons that were sent.
    number: u32,
}

/// Which photons are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Keep {
    /// Those that come to their first matte surface by way of mirrors or glass.
    Caustics,
    /// All that come to a matte surface.
    All,
}

/// Photons sent at a time.
const CHUNK: u32 = 1024;

/// Who sends photons, and where.
pub(crate) struct Senders<'a> {
    pub rules: &'a Sunflow,
    pub world: &'a World,
    pub observer: &'a dyn Observer,
    /// What the threads spent on it.
    pub spent: Mutex<Spent>,
}

/// Sends `count` photons of the lights, numbered from `first` on, and returns those that are kept. The same photons for
/// any number of threads; fewer if the observer cancels.
pub(crate) fn send(senders: &Senders<'_>, keep: Keep, first: u32, count: u32) -> Vec<Photon> {
    let Senders { rules, world, observer, ref spent } = *senders;
    let sender = Sender::new(rules, keep, count);
    if sender.total <= 0.0 {
        return Vec::new();
    }
    let starts = (0..count).step_by(CHUNK as usize);
    let mut chunks = threads::deal(starts, |starts| {
        let mut workspace = Box::<Workspace<Sender<'_>>>::default();
        workspace.begin();
        let mut chunks = Vec::new();
        for start in starts.take_while(|_| !observer.cancelled()) {
            let mut samples = sender.emit(first + start..first + count.min(start + CHUNK));
            workspace.trace(world, &sender, &mut samples, false);
            let mut kept = std::mem::take(&mut workspace.room.kept);
            if keep == Keep::All {
                share_last(&mut kept, first + start);
            }
            chunks.push((start, kept));
        }
        let hand = workspace.end().spent;
        let mut spent = spent.lock().unwrap_or_else(PoisonError::into_inner);
        *spent = spent.plus(hand);
        chunks
    })
    .concat();
    chunks.sort_unstable_by_key(|&(start, _)| start);
    chunks.into_iter().flat_map(|(_, kept)| kept).collect()
}

/// Gives all that is kept of one photon the power that it had in the end, whether it went on from there or not. Sunflow: a
/// photon's power is one object, which every bounce changes (R17).
fn share_last(kept: &mut [Photon], first: u32) {
    let mut last = vec![Vec3::ZERO; CHUNK as usize];
    kept.iter().for_each(|photon| last[(photon.number - first) as usize] = photon.power);
    kept.iter_mut().for_each(|photon| photon.power = last[(photon.number - first) as usize]);
}

/// The rules by which photons travel.
struct Sender<'a> {
    rules: &'a Sunflow,
    keep: Keep,
    /// How many are sent altogether.
    count: f32,
    /// By light: what all its photons carry together.
    powers: Vec<Vec3>,
    /// By light: the sum of what lights are chosen by, up to this one.
    below: Vec<f32>,
    total: f32,
}

/// One thread's room.
#[derive(Default)]
pub(crate) struct PhotonRoom {
    shading: Room,
    kept: Vec<Photon>,
}

impl<'a> Sender<'a> {
    fn new(rules: &'a Sunflow, keep: Keep, count: u32) -> Self {
        let mut total = 0.0;
        let mut add = |light: &Light| {
            let share = luminance(light.power());
            total += if share.is_finite() { share } else { 0.0 };
            total
        };
        let below = rules.lights.iter().map(&mut add).collect();
        let powers = rules.lights.iter().map(Light::photon_power).collect();
        Sender { rules, keep, count: count as f32, powers, below, total }
    }

    /// The number of a photon's light, and its two uniform numbers for a place on the light.
    fn light(&self, key: SampleKey) -> (usize, [f32; 2]) {
        let [choice, v] = self.numbers(key, 0);
        let at = choice * self.total;
        let light = self.below.partition_point(|&below| below <= at).min(self.below.len() - 1);
        let first = if light == 0 { 0.0 } else { self.below[light - 1] };
        let u = ((at - first) / (self.below[light] - first)).clamp(0.0, 1.0);
        (light, [u, v])
    }

    /// A pair of numbers of a photon. Virtual lights are so few that they should lie where Sunflow's do.
    fn numbers(&self, key: SampleKey, pair: u32) -> [f32; 2] {
        match self.keep {
            Keep::Caustics => key.pair(pair),
            Keep::All => [halton(2 * pair, key.index), halton(2 * pair + 1, key.index)],
        }
    }

    fn emit(&self, indices: std::ops::Range<u32>) -> Samples {
        let mut samples = Samples::default();
        samples.resize(indices.len());
        for (i, index) in indices.enumerate() {
            let key = SampleKey::shared(index, 0);
            let (light, [u, v]) = self.light(key);
            let ([x, y], light) = (self.numbers(key, 1), &self.rules.lights[light]);
            let ray = match self.keep {
                Keep::Caustics => light.emit([u, v], [x, y], false),
                // Sunflow: what is left of the choice is for the direction.
                Keep::All => light.emit([x, y], [u, v], true),
            };
            samples.set(i, ray, key);
        }
        samples
    }

    /// A photon meets a surface: it is kept, and goes on, or is lost. One number decides, as the surface's colours say.
    fn meet(&self, batch: &Batch<'_>, point: &Point<'_>, kept: &mut Vec<Photon>, queues: &mut Queues<()>) {
        let depth = point.path.depth;
        let [choice, other] = self.numbers(point.key, 2 + depth.total());
        let response = &batch.material.response;
        if let Response::Matte(_) | Response::Look(_) = response {
            let blurred = depth.diffuse > 0;
            let wanted = match self.keep {
                Keep::Caustics => !blurred && depth.total() > 0,
                Keep::All => true,
            };
            if wanted {
                // Sunflow: a photon carries what its light has, whatever the chance was to be chosen (R16).
                let (light, _) = self.light(point.key);
                let power = point.path.weight * self.powers[light] / self.count;
                let normal = point.surface.normal;
                let number = point.key.index;
                kept.push(Photon { point: point.front, normal, direction: point.direction, power, number });
            }
        }
        let mut below = 0.0;
        // Whether the choice falls to a way on whose colour is this, and what the photon's power becomes.
        let mut chosen = |color: Vec3| {
            let (first, share) = (below, color.element_sum() / 3.0);
            below += share;
            (choice >= first && choice < below).then(|| color / share)
        };
        let limits = self.rules;
        match response {
            Response::Matte(coat) => {
                if let Some(tint) = chosen(point.color) {
                    if let Some(photon) = kept.last_mut().filter(|_| self.keep == Keep::All) {
                        photon.power *= tint;
                    }
                    if self.keep == Keep::All && depth.diffuse < limits.max_diffuse {
                        let turn = (choice / below).clamp(0.0, 1.0);
                        let [u, v, w] = point.frame(batch);
                        let (sin, cos) = math::sin_cos_turns(turn);
                        let across = (u * cos + v * sin) * other.sqrt();
                        let direction = across + w * (1.0 - other).sqrt();
                        self.go(point, point.front, direction, tint, RayKind::Gather, queues);
                    }
                    return;
                }
                let Some(tint) = chosen(point.gloss) else { return };
                let direction = match coat {
                    Coat::Mirror { .. } | Coat::Ward { .. } | Coat::None | Coat::Touch { .. } => point.mirrored(),
                    Coat::Phong { power, .. } => {
                        let cosine = math::pow(other, 1.0 / (power + 1.0));
                        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
                        math::around(point.mirrored(), (choice / below).clamp(0.0, 1.0), sine, cosine)
                    }
                };
                if depth.reflection < limits.max_reflection && direction.dot(point.surface.geometric) > 0.0 {
                    self.go(point, point.front, direction, tint, RayKind::Reflection, queues);
                }
            }
            Response::Mirror => {
                if let Some(tint) = chosen(point.color)
                    && depth.reflection < limits.max_reflection
                {
                    self.go(point, point.front, point.mirrored(), tint, RayKind::Reflection, queues);
                }
            }
            Response::Glass { eta, absorption } => {
                let head_on = ((1.0 - eta) / (1.0 + eta)).powi(2);
                if let Some(tint) = chosen(point.color * head_on) {
                    if !point.inside && depth.reflection < limits.max_reflection {
                        self.go(point, point.front, point.mirrored(), tint, RayKind::Reflection, queues);
                    }
                } else if let Some(mut tint) = chosen(point.color * (1.0 - head_on))
                    && depth.refraction < limits.max_refraction
                {
                    if point.inside {
                        tint *= super::specular::transmittance(*absorption, point.hit.t);
                    }
                    let (_, bent) = point.refract(*eta);
                    let (origin, direction) = match bent {
                        Some(bent) => (point.back(), bent),
                        None => (point.front, point.mirrored()),
                    };
                    self.go(point, origin, direction, tint, RayKind::Refraction, queues);
                }
            }
            _ => {}
        }
    }

    fn go(&self, point: &Point<'_>, origin: Vec3, direction: Vec3, tint: Vec3, kind: RayKind, queues: &mut Queues<()>) {
        let depth = match kind {
            RayKind::Gather => point.path.depth.diffused(),
            RayKind::Refraction => point.path.depth.refracted(),
            _ => point.path.depth.reflected(),
        };
        let weight = point.path.weight * tint;
        if weight.is_finite() {
            queues.next.push(point.leave(origin, direction), Path { weight, kind, depth, ..*point.path });
        }
    }
}

impl Rules for Sender<'_> {
    type Nodes = ();
    type Room = PhotonRoom;
    const T_MIN: f32 = 0.0;

    fn shade(&self, batch: &Batch<'_>, room: &mut PhotonRoom, queues: &mut Queues<()>) {
        room.shading.prepare(batch, &mut queues.clock);
        for i in 0..batch.len() {
            let point = room.shading.point(batch, i);
            self.meet(batch, &point, &mut room.kept, queues);
        }
    }

    fn miss(&self, _: &Path, _: Vec3, (): &mut ()) -> bool {
        false
    }

    fn seen(&self, _: &Geometry, _: &Rays, _: &Hits, _: usize) -> Vec3 {
        Vec3::ZERO
    }

    fn resolve(&self, (): &mut (), _: &mut [Pixel]) {}
}
