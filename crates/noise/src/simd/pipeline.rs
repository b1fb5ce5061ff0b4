//! The order in which the kernels made by hand work: step by step, hashes one step ahead of blends.
//!
//! Hashing reads tables, blending multiplies and adds. The two use other ports of the machine, so the points of the next
//! step are hashed beside the blends of the current one, and neither waits for the other: across blocks and octaves too.

use crate::simd::Terms;

/// The coordinates of a step along each axis.
pub(super) type Point<'a, const STEP: usize> = [&'a [f32; STEP]; 3];

/// Points whose octaves are summed before the next ones: their coordinates and sums stay in the first cache.
const BLOCK: usize = 512;

/// One octave of a sum.
#[derive(Clone, Copy)]
pub(super) struct Octave {
    pub frequency: f32,
    pub amplitude: f32,
    pub absolute: bool,
}

/// A kernel of two halves, for `STEP` points at a time.
pub(super) trait Halves<const STEP: usize> {
    /// What hashing hands to blending.
    type Codes;
    /// Hashes the cells of the points, times the frequency.
    fn hash(&self, frequency: f32, point: Point<STEP>) -> Self::Codes;
    /// Adds an octave at the points whose `codes` are given, which become those of `next`. `ALONE`: it is the only octave,
    /// the frequencies are 1, and the sums are overwritten (and no zero is negative).
    fn step<const ALONE: bool>(
        &self,
        octave: &Octave,
        point: Point<STEP>,
        sums: &mut [f32; STEP],
        codes: &mut Self::Codes,
        next: (f32, Point<STEP>),
    );
    /// [`Halves::step`] without a next one.
    fn finish<const ALONE: bool>(
        &self,
        octave: &Octave,
        point: Point<STEP>,
        sums: &mut [f32; STEP],
        codes: &Self::Codes,
    );
}

/// The sums at the first points, a multiple of `STEP` of them; returns how many.
#[inline(always)]
pub(super) fn sum<H: Halves<STEP>, const STEP: usize>(
    halves: &H,
    terms: &Terms,
    points: [&[f32]; 3],
    values: &mut [f32],
) -> usize {
    let (values, rest) = values.as_chunks_mut::<STEP>();
    let (x, y, z) = (points[0].as_chunks().0, points[1].as_chunks().0, points[2].as_chunks().0);
    assert!(x.len() == values.len() && y.len() == values.len() && z.len() == values.len() && rest.len() < STEP);
    let points = [x, y, z];
    if terms.octaves == 0 {
        values.fill([0.0; STEP]);
    } else if terms.octaves == 1 {
        sum_alone(halves, terms, points, values);
    } else if !values.is_empty() {
        sum_several(halves, terms, points, values);
    }
    values.len() * STEP
}

#[inline(always)]
fn sum_alone<H: Halves<STEP>, const STEP: usize>(
    halves: &H,
    terms: &Terms,
    [x, y, z]: [&[[f32; STEP]]; 3],
    values: &mut [[f32; STEP]],
) {
    let octave = Octave { frequency: 1.0, amplitude: terms.amplitude(0) as f32, absolute: terms.absolute };
    let Some((last_values, values)) = values.split_last_mut() else { return };
    let mut codes = halves.hash(1.0, [&x[0], &y[0], &z[0]]);
    for (i, values) in values.iter_mut().enumerate() {
        let next = (1.0, [&x[i + 1], &y[i + 1], &z[i + 1]]);
        halves.step::<true>(&octave, [&x[i], &y[i], &z[i]], values, &mut codes, next);
    }
    let last = values.len();
    halves.finish::<true>(&octave, [&x[last], &y[last], &z[last]], last_values, &codes);
}

#[inline(always)]
fn sum_several<H: Halves<STEP>, const STEP: usize>(
    halves: &H,
    terms: &Terms,
    [x, y, z]: [&[[f32; STEP]]; 3],
    values: &mut [[f32; STEP]],
) {
    let mut codes = halves.hash(1.0, [&x[0], &y[0], &z[0]]);
    let last = values.len() - 1;
    for start in (0..values.len()).step_by(BLOCK / STEP) {
        let end = values.len().min(start + BLOCK / STEP);
        values[start..end].fill([0.0; STEP]);
        let mut frequency = 1.0;
        for index in 0..terms.octaves {
            let octave = Octave {
                frequency: frequency as f32,
                amplitude: terms.amplitude(index) as f32,
                absolute: terms.absolute,
            };
            frequency *= terms.lacunarity;
            // After the block comes its next octave, or the next block (after the last one, anything).
            let is_last = index + 1 == terms.octaves;
            let after = if is_last { (1.0, last.min(end)) } else { (frequency as f32, start) };
            for i in start..end {
                let (frequency, next) = if i + 1 == end { after } else { (octave.frequency, i + 1) };
                let next = (frequency, [&x[next], &y[next], &z[next]]);
                halves.step::<false>(&octave, [&x[i], &y[i], &z[i]], &mut values[i], &mut codes, next);
            }
        }
    }
}
