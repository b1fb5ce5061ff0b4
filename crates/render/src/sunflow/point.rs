//! Hits, ready to be shaded.

use glam::Vec3;

use crate::clock::{Clock, Stage};
use crate::geometry::{Hit, Id, Ids, Ray, Rows, Surface, Surfaces};
use crate::math::{self, offset};
use crate::modifier::Place;
use crate::sampler::SampleKey;
use crate::wave::{Batch, Cone, Path, RayKind};

/// Spread of the cones of rays into glossy lobes, and of rays that gather light: about what one of some sixteen rays stands for.
const GLOSSY: f32 = 0.1;
const GATHER: f32 = 0.5;

/// A hit, ready to be shaded: everything faces the ray.
pub(super) struct Point<'a> {
    pub path: &'a Path,
    /// Of the ray that arrived.
    pub direction: Vec3,
    pub key: SampleKey,
    /// By how much fewer rays of its own each sample of the pixel takes, so that several are not much dearer than one.
    pub share: u32,
    /// How many samples the pixel has: among them lights that all points have in common are divided.
    pub of: u32,
    pub hit: Hit,
    pub surface: Surface,
    /// The ray came from the inside of the shape.
    pub inside: bool,
    /// Cosine between the normal and the way back, 0 to 1.
    pub cosine: f32,
    pub color: Vec3,
    /// The colour of the coat.
    pub gloss: Vec3,
    /// Where rays to the front side start.
    pub front: Vec3,
    /// A primitive that a ray leaving this point cannot meet again: flat ones.
    pub skip: Id,
    /// One over the radius of a sphere, seen from outside; 0 for all else.
    curvature: f32,
}

/// The hits of a batch in rows: see [`Point`] for what they mean.
#[derive(Default)]
pub(super) struct Points {
    pub surfaces: Surfaces,
    front: Rows,
    cosine: Vec<f32>,
    inside: Vec<bool>,
    skip: Ids,
}

impl Point<'_> {
    pub fn mirrored(&self) -> Vec3 {
        (self.direction + self.surface.normal * (2.0 * self.cosine)).normalize_or(self.surface.normal)
    }

    /// Where rays to the back side start.
    pub fn back(&self) -> Vec3 {
        offset(self.surface.point, -self.surface.geometric)
    }

    /// A ray from the front side towards something that is `t_max` away.
    #[inline]
    pub fn toward(&self, direction: Vec3, t_max: f32) -> Ray {
        Ray { origin: self.front, direction, t_min: 0.0, t_max, skip: self.skip, time: self.hit.time }
    }

    /// A ray from here to wherever it goes.
    pub fn leave(&self, origin: Vec3, direction: Vec3) -> Ray {
        Ray { origin, direction, t_min: 0.0, t_max: f32::INFINITY, skip: self.skip, time: self.hit.time }
    }

    /// The cone of a ray that goes on from here. A mirror that bulges spreads it, and blurred rays stand for much.
    pub fn cone(&self, kind: RayKind) -> Cone {
        let here = self.path.cone.after(self.hit.t);
        let spread = match kind {
            RayKind::Camera | RayKind::Refraction => here.spread,
            RayKind::Reflection => here.spread + 2.0 * here.width * self.curvature,
            RayKind::Glossy => here.spread.max(GLOSSY),
            RayKind::Gather => here.spread.max(GATHER),
        };
        Cone { spread, ..here }
    }

    /// How many rays go out of as many as are asked for.
    pub fn count(&self, samples: u32) -> u32 {
        samples.div_ceil(self.share.max(1))
    }

    /// A pair of sample dimensions that belongs to this bounce alone.
    pub fn dimension(&self, which: Which) -> u32 {
        2 + 1024 * self.path.depth.total() + which as u32
    }

    /// The axes of the surface: along it, along it, and the normal (format reference, §3.13).
    pub fn frame(&self, batch: &Batch<'_>) -> [Vec3; 3] {
        let along = batch.geometry.tangent(&self.hit, self.surface.point);
        // After a modifier, any axes will do.
        math::frame(self.surface.normal, along.filter(|_| batch.material.modifier.is_none()))
    }
}

/// What a pair of sample dimensions is for.
#[derive(Debug, Clone, Copy)]
pub(super) enum Which {
    Glossy = 0,
    Gather = 1,
    Choice = 2,
    /// The first light; the others follow.
    Lights = 3,
}

impl Points {
    /// Surfaces of a batch, turned towards the rays. Their bumps are timed as textures.
    pub fn locate(&mut self, batch: &Batch<'_>, clock: &mut Clock) {
        let count = batch.len();
        batch.geometry.surfaces(batch.met, batch.runs, &mut self.surfaces);
        self.front.resize(count);
        self.cosine.resize(count, 0.0);
        self.inside.resize(count, false);
        self.skip.resize(count);
        if let Some(modifier) = &batch.material.modifier {
            clock.lap(Stage::Shade);
            for i in 0..count {
                let (hit, Surface { point, normal, .. }) = (batch.hit(i), self.surfaces.get(i));
                let [u, v, _] = math::frame(normal, batch.geometry.tangent(&hit, point));
                let object_from_world = &batch.geometry.pose(&hit).object_from_world;
                let uv = batch.geometry.uv(&hit, point);
                let place = Place { point, normal, tangent: [u, v], uv, object_from_world };
                self.surfaces.normal.set(i, modifier.normal(&place));
            }
            clock.lap(Stage::Texture);
        }
        for i in 0..count {
            let direction = batch.met.direction.get(i);
            let Surface { point, mut geometric, mut normal } = self.surfaces.get(i);
            let inside = direction.dot(geometric) >= 0.0;
            if inside {
                (geometric, normal) = (-geometric, -normal);
                self.surfaces.geometric.set(i, geometric);
                self.surfaces.normal.set(i, normal);
            }
            self.inside[i] = inside;
            self.cosine[i] = (-direction.dot(normal)).max(0.0);
            self.front.set(i, offset(point, geometric));
            let id = batch.met.hits.id.get(i);
            self.skip.set(i, if batch.geometry.is_flat(id.object) { id } else { Id::NONE });
        }
    }

    /// The side of the square of the surface for which a ray stands: between the sides of the slanting patch that it sees.
    pub fn footprint(&self, batch: &Batch<'_>, i: usize) -> f32 {
        batch.path(i).cone.after(batch.met.hits.t[i]).width / self.cosine[i].max(0.01).sqrt()
    }

    pub fn get<'a>(&self, batch: &Batch<'a>, i: usize, color: Vec3, gloss: Vec3) -> Point<'a> {
        let path = &batch.paths[batch.members[i] as usize];
        let SampleKey { pixel, .. } = batch.keys[path.node as usize];
        Point {
            path,
            direction: batch.met.direction.get(i),
            key: SampleKey { pixel, index: path.index },
            share: batch.of.isqrt(),
            of: batch.of,
            hit: batch.hit(i),
            surface: self.surfaces.get(i),
            inside: self.inside[i],
            cosine: self.cosine[i],
            color,
            gloss,
            front: self.front.get(i),
            skip: self.skip.get(i),
            curvature: if self.inside[i] { 0.0 } else { batch.geometry.curvature(batch.met.hits.id.object[i]) },
        }
    }
}
