//! The light of the surroundings as a table of directions, all of about the same brightness.

use glam::Vec3;
use rayon::prelude::*;

use super::Environment;
use crate::sampler::SampleKey;

/// Directions that stand for equal parts of the unit square, and what comes from there.
///
/// With a table a sample costs one look-up, where [`Environment::sample`] searches for a cell and unfolds it: for a sky
/// that is most of the work of lighting a scene. That there are 16,384 directions and no more is a relative error of some
/// 1e-4, far below what samples of a pixel leave.
#[derive(Debug)]
pub(crate) struct Table(Box<[Entry]>);

/// A direction and the radiance from there divided by its density; zero where no light comes from.
#[derive(Debug, Clone, Copy)]
struct Entry {
    direction: Vec3,
    light: Vec3,
}

/// Entries along each axis of the unit square.
const SIDE: usize = 128;
/// Samples that make the light of an entry.
const EACH: usize = 4;

impl Table {
    pub fn new(environment: &Environment) -> Table {
        // Stratified in every way that the square can be divided into so many boxes: no rows of directions cast shadows
        // whose steps could be seen. The first `SIDE`² fall into a cell each.
        let samples: Vec<_> = (0..(SIDE * SIDE * EACH) as u32)
            .into_par_iter()
            .map(|i| SampleKey::shared(i, 0).pair(0))
            .map(|xi| (cell(xi), environment.sample(xi)))
            .collect();
        let mut entries = vec![Entry { direction: Vec3::ZERO, light: Vec3::ZERO }; SIDE * SIDE].into_boxed_slice();
        for (cell, sample) in samples {
            if let Some((direction, light)) = sample {
                let entry = &mut entries[cell];
                entry.light += light / EACH as f32;
                if entry.direction == Vec3::ZERO {
                    entry.direction = direction;
                }
            }
        }
        Table(entries)
    }

    /// What [`Environment::sample`] gives, but for light of zero where that gives nothing.
    #[inline(always)]
    pub fn sample(&self, xi: [f32; 2]) -> (Vec3, Vec3) {
        let Entry { direction, light } = self.0[cell(xi)];
        (direction, light)
    }
}

/// Numbers at the ends and beyond count as the nearest cell.
#[inline(always)]
fn cell(xi: [f32; 2]) -> usize {
    let [column, row] = xi.map(|xi| ((xi * SIDE as f32) as usize).min(SIDE - 1));
    row * SIDE + column
}
