//! A picture of the surroundings by longitude and latitude.

use std::f32::consts::{PI, TAU};
use std::sync::Arc;

use glam::{Vec2, Vec3};
use jaspe_noise::math::{cos, sin};

use super::Sight;
use super::distribution::Distribution2d;
use crate::material::{PictureMap, luminance};
use crate::math;

/// A picture and how it lies around the scene (format reference, §3.9).
#[derive(Debug)]
pub(super) struct Panorama {
    map: Arc<PictureMap>,
    /// Towards the middle of the picture.
    center: Vec3,
    /// Towards its top edge.
    top: Vec3,
    /// Towards the middle of its left half.
    side: Vec3,
}

/// Rows and columns of the table of brightness: a larger picture has several pixels in a cell.
const MOST_CELLS: [usize; 2] = [4096, 2048];

impl Panorama {
    pub fn new(map: Arc<PictureMap>, center: Vec3, up: Vec3) -> Panorama {
        let center = center.normalize_or(Vec3::Z);
        let side = up.cross(center).normalize_or(math::basis(center).0);
        Panorama { map, center, top: center.cross(side), side }
    }

    /// What comes from a direction.
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        let longitude = math::atan2(direction.dot(self.side), direction.dot(self.center));
        let angle = math::acos((-direction.dot(self.top)).clamp(-1.0, 1.0));
        self.look_up([0.5 - 0.5 * longitude / PI, angle / PI])
    }

    /// v = 0 is the bottom edge. The top edge must not wrap around to it.
    fn look_up(&self, [u, v]: [f32; 2]) -> Vec3 {
        self.map.smooth(Vec2::new(u, v.min(1.0 - f32::EPSILON)))
    }

    /// What lies at a point of the picture.
    pub fn unfold(&self, [u, v]: [f32; 2]) -> Sight {
        let (sin_u, cos_u) = (sin(TAU * u), cos(TAU * u));
        let (sin_v, cos_v) = (sin(PI * v).max(0.0), cos(PI * v));
        Sight {
            direction: self.side * (sin_v * sin_u) - self.center * (sin_v * cos_u) - self.top * cos_v,
            radiance: self.look_up([u, v]),
            stretch: TAU * PI * sin_v,
        }
    }

    /// Brightness over the picture: of each cell the exact mean, as smoothed in the look-up, times its solid angle.
    pub fn distribution(&self) -> Distribution2d {
        let [width, height] = self.map.size();
        let (columns, rows) = (width.min(MOST_CELLS[0]), height.min(MOST_CELLS[1]));
        let mut weights = vec![0.0; columns * rows];
        let across = overlaps(width, columns);
        let mut along = overlaps(height, rows);
        // Row by row of the picture, so that each is read once.
        along.sort_by_key(|overlap| overlap.texel);
        for same_texel in along.chunk_by(|a, b| a.texel == b.texel) {
            let mut means = vec![0.0; columns];
            let row = height - 1 - same_texel[0].texel;
            for overlap in &across {
                means[overlap.cell] += overlap.weight * luminance(self.map.texel(overlap.texel, row));
            }
            for overlap in same_texel {
                let solid_angle = solid_angle(overlap.cell, rows) * overlap.weight;
                let cells = &mut weights[overlap.cell * columns..][..columns];
                cells.iter_mut().zip(&means).for_each(|(weight, mean)| *weight += mean * solid_angle);
            }
        }
        Distribution2d::new(columns, &weights)
    }
}

/// The share of a row of cells in the sphere.
fn solid_angle(row: usize, rows: usize) -> f32 {
    let height = |row: usize| cos(std::f64::consts::PI * row as f64 / rows as f64);
    (0.5 * (height(row) - height(row + 1))) as f32
}

/// That a texel shows in a cell, along one axis.
struct Overlap {
    cell: usize,
    texel: usize,
    /// The texel's mean weight in the look-ups of the cell.
    weight: f32,
}

/// Every texel that shows in a cell, for cells that divide one axis of a picture evenly. See [`PictureMap::smooth`]: texel
/// i stands at i / (size − 1).
fn overlaps(size: usize, cells: usize) -> Vec<Overlap> {
    let step = (size - 1) as f64 / cells as f64;
    let mut overlaps = Vec::new();
    for cell in 0..cells {
        let (mut from, end) = (cell as f64 * step, (cell + 1) as f64 * step);
        if step == 0.0 {
            overlaps.push(Overlap { cell, texel: 0, weight: 1.0 });
        }
        while from < end {
            let low = from.floor();
            let to = end.min(low + 1.0);
            // The integral of the upper texel's weight 3t² − 2t³.
            let integral = |t: f64| t * t * t * (1.0 - 0.5 * t);
            let high = (integral(to - low) - integral(from - low)) / step;
            let texel = low as usize;
            overlaps.push(Overlap { cell, texel, weight: ((to - from) / step - high) as f32 });
            overlaps.push(Overlap { cell, texel: (texel + 1).min(size - 1), weight: high as f32 });
            from = to;
        }
    }
    overlaps
}
