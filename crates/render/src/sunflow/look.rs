//! Quick looks at a scene, and the shader that draws its triangles.

use glam::Vec3;

use super::point::Point;
use super::{Batch, Queues, Room, Sunflow};
use crate::options::Look;
use crate::sampler;

/// Rays of the quick look at ambient occlusion.
const OCCLUSION_SAMPLES: u32 = 16;

impl Sunflow {
    /// The quick looks of `--override`.
    pub(super) fn look(
        &self,
        batch: &Batch<'_>,
        point: &Point<'_>,
        look: Look,
        room: &mut Room,
        queues: &mut Queues<Vec<Vec3>>,
    ) {
        match look {
            Look::Normals => self.emit(point, (point.surface.normal + Vec3::ONE) * 0.5, queues),
            Look::Uvs => {
                let uv = batch.geometry.uv(&point.hit, point.surface.point);
                self.emit(point, Vec3::new(uv.x - uv.x.floor(), uv.y - uv.y.floor(), 0.0), queues);
            }
            Look::Ids => {
                let bits = sampler::hash(point.hit.id.object + 1);
                let channel = |shift: u32| 0.1 + 0.9 * (bits >> shift & 255) as f32 / 255.0;
                self.emit(point, Vec3::new(channel(0), channel(8), channel(16)) * point.cosine, queues);
            }
            Look::Gray => {}
            Look::AmbientOcclusion => {
                self.occlusion(point, [Vec3::ZERO, Vec3::ONE], OCCLUSION_SAMPLES, f32::INFINITY, room, queues);
            }
        }
    }

    /// Lines where the nearest edge of the triangle is seen under less than `width` radians.
    pub(super) fn wireframe(
        &self,
        batch: &Batch<'_>,
        point: &Point<'_>,
        line: Vec3,
        width: f32,
        queues: &mut Queues<Vec<Vec3>>,
    ) {
        let near = batch.geometry.triangle(&point.hit).is_some_and(|corners| {
            let [a, b, c] = corners;
            [(a, b), (b, c), (c, a)].into_iter().any(|(from, to)| {
                let (along, p) = (to - from, point.surface.point - from);
                let nearest = along * (p.dot(along) / along.length_squared()).clamp(0.0, 1.0);
                (p - nearest).length() <= width * point.hit.t
            })
        });
        self.emit(point, if near { line } else { point.color }, queues);
    }
}
