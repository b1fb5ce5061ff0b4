//! Mirrors and glass.

use glam::Vec3;

use super::point::Point;
use super::{Queues, Sunflow};
use crate::geometry::Surface;
use crate::wave::{Path, RayKind};

impl Sunflow {
    pub(super) fn reflect(&self, point: &Point<'_>, tint: Vec3, queues: &mut Queues<Vec<Vec3>>) {
        let depth = point.path.depth;
        if depth.reflection < self.max_reflection && depth.diffuse == 0 {
            let weight = point.path.weight * tint;
            let path = Path { weight, kind: RayKind::Reflection, depth: depth.reflected(), ..*point.path };
            self.queue(point, [point.front, point.mirrored()], path, queues);
        }
    }

    /// Clear glass. Sunflow: the Fresnel term keeps its index on the way out, and inside only total reflection
    /// reflects (R7).
    pub(super) fn glass(&self, point: &Point<'_>, eta: f32, absorption: Vec3, queues: &mut Queues<Vec<Vec3>>) {
        let mut tint = point.color;
        if point.inside && absorption != Vec3::ZERO {
            tint *= transmittance(absorption, point.hit.t);
        }
        let (kr, bent) = point.refract(eta);
        let depth = point.path.depth;
        if let Some(bent) = bent
            && depth.refraction < self.max_refraction
            && depth.diffuse == 0
        {
            let weight = point.path.weight * tint * (1.0 - kr);
            let path = Path { weight, kind: RayKind::Refraction, depth: depth.refracted(), ..*point.path };
            self.queue(point, [point.back(), bent], path, queues);
        }
        if !point.inside || bent.is_none() {
            self.reflect(point, tint * kr, queues);
        }
    }
}

impl Point<'_> {
    /// The part of the light that glass reflects, and the way of the rest through it, unless all of it is reflected.
    pub(super) fn refract(&self, eta: f32) -> (f32, Option<Vec3>) {
        let Point { direction, cosine, inside, surface: Surface { normal, .. }, .. } = *self;
        let ratio = if inside { eta } else { 1.0 / eta };
        let rest = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
        let bent = direction * ratio + normal * (ratio * cosine - rest.max(0.0).sqrt());
        let bent = (rest >= 0.0).then(|| bent.normalize_or(direction));
        let (cos1, cos2) = (cosine, bent.map_or(0.0, |bent| -normal.dot(bent)));
        let parallel = (cos1 - eta * cos2) / (cos1 + eta * cos2);
        let perpendicular = (eta * cos1 - cos2) / (eta * cos1 + cos2);
        ((0.5 * (parallel * parallel + perpendicular * perpendicular)).min(1.0), bent)
    }
}

/// What is left of the light after `length` world units of absorbing glass.
pub(super) fn transmittance(absorption: Vec3, length: f32) -> Vec3 {
    let along = |a: f32| if a == 0.0 { 1.0 } else { jaspe_noise::math::exp(-f64::from(a * length)) as f32 };
    Vec3::new(along(absorption.x), along(absorption.y), along(absorption.z))
}
