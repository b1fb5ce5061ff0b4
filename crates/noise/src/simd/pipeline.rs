//! The order in which the kernels made by hand work: step by step, hashes one step ahead of blends.
//!
//! Hashing reads tables, blending multiplies and adds. The two use other ports of the machine, so the points of the next
//! step are hashed beside the blends of the current one, and neither waits for the other: across blocks and octaves too.

use crate::basis::corners::Corners;
use crate::basis::improved::blend_codes;
use crate::simd::{Terms, Vector};

/// The coordinates of a step along each axis.
pub(super) type Point<'a, const STEP: usize> = [&'a [f32; STEP]; 3];

/// The values of a step, and with N = 4 their derivatives along each axis.
pub(super) type Sums<'a, const STEP: usize, const N: usize> = [&'a mut [f32; STEP]; N];

/// Points whose octaves are summed before the next ones: their coordinates and sums stay in the first cache.
const BLOCK: usize = 512;

/// One octave of a sum.
#[derive(Clone, Copy)]
pub(super) struct Octave {
    pub frequency: f32,
    pub amplitude: f32,
    pub slope: f32,
    pub absolute: bool,
}

impl Octave {
    /// That of this number.
    #[inline(always)]
    pub fn of(terms: &Terms, index: usize) -> Octave {
        Octave {
            frequency: terms.frequencies[index],
            amplitude: terms.amplitudes[index],
            slope: terms.slopes[index],
            absolute: terms.absolute,
        }
    }
}

/// A kernel of two halves, for `STEP` points at a time.
pub(super) trait Halves<const STEP: usize> {
    /// What hashing hands to blending.
    type Codes;
    /// Hashes the cells of the points, times the frequency.
    fn hash(&self, frequency: f32, point: Point<STEP>) -> Self::Codes;
    /// Adds an octave at the points whose `codes` are given, which become those of `next`. `ALONE`: it is the only octave,
    /// the frequencies are 1, and the sums are overwritten (and no zero is negative).
    fn step<const ALONE: bool, const N: usize>(
        &self,
        octave: &Octave,
        point: Point<STEP>,
        sums: Sums<STEP, N>,
        codes: &mut Self::Codes,
        next: (f32, Point<STEP>),
    );
    /// [`Halves::step`] without a next one.
    fn finish<const ALONE: bool, const N: usize>(
        &self,
        octave: &Octave,
        point: Point<STEP>,
        sums: Sums<STEP, N>,
        codes: &Self::Codes,
    );
}

/// The sums at the first points, a multiple of `STEP` of them; returns how many.
#[inline(always)]
pub(super) fn sum<H: Halves<STEP>, const STEP: usize, const N: usize>(
    halves: &H,
    terms: &Terms,
    points: [&[f32]; 3],
    mut outputs: [&mut [f32]; N],
) -> usize {
    let steps = outputs[0].len() / STEP;
    let (x, y, z) = (points[0].as_chunks().0, points[1].as_chunks().0, points[2].as_chunks().0);
    assert!(x.len() == steps && y.len() == steps && z.len() == steps);
    let point = |i: usize| [&x[i], &y[i], &z[i]];
    if steps == 0 {
        return 0;
    }
    let last = steps - 1;
    if terms.octaves() == 1 {
        let octave = Octave::of(terms, 0);
        let mut codes = halves.hash(1.0, point(0));
        for i in 0..last {
            let next = (1.0, point(i + 1));
            halves.step::<true, N>(&octave, point(i), sums(&mut outputs, i), &mut codes, next);
        }
        halves.finish::<true, N>(&octave, point(last), sums(&mut outputs, last), &codes);
        return steps * STEP;
    }
    for output in &mut outputs {
        output[..steps * STEP].fill(0.0);
    }
    if terms.octaves() == 0 {
        return steps * STEP;
    }
    let mut codes = halves.hash(terms.frequencies[0], point(0));
    for start in (0..steps).step_by(BLOCK / STEP) {
        let end = steps.min(start + BLOCK / STEP);
        for index in 0..terms.octaves() {
            let octave = Octave::of(terms, index);
            // After the block comes its next octave, or the next block (after the last one, anything).
            let after = match terms.frequencies.get(index + 1) {
                Some(&frequency) => (frequency, start),
                None => (terms.frequencies[0], last.min(end)),
            };
            for i in start..end {
                let (frequency, next) = if i + 1 == end { after } else { (octave.frequency, i + 1) };
                let next = (frequency, point(next));
                halves.step::<false, N>(&octave, point(i), sums(&mut outputs, i), &mut codes, next);
            }
        }
    }
    steps * STEP
}

/// The outputs of a step.
#[inline(always)]
fn sums<'a, const STEP: usize, const N: usize>(outputs: &'a mut [&mut [f32]; N], step: usize) -> Sums<'a, STEP, N> {
    outputs.each_mut().map(|output| output[step * STEP..].first_chunk_mut().expect("a whole step"))
}

/// Adds an octave at the points of one vector of a step, from the corners' codes and the offsets in the cells.
#[inline(always)]
pub(super) fn add_vector<V: Vector<LANES>, const STEP: usize, const LANES: usize, const N: usize, const ALONE: bool>(
    octave: &Octave,
    codes: Corners<V::Int>,
    offset: [V; 3],
    sums: &mut Sums<STEP, N>,
    vector: usize,
) {
    let sample =
        if N == 4 { blend_codes::<V, 3, true>(codes, offset) } else { blend_codes::<V, 3, false>(codes, offset) };
    let (mut value, mut gradient) = (sample.value, sample.gradient);
    let zero = V::constant(0.0);
    if octave.absolute {
        let negative = value.less(zero);
        value = value.abs();
        for part in &mut gradient {
            *part = V::select(negative, -*part, *part);
        }
    }
    let factors = [octave.amplitude, octave.slope, octave.slope, octave.slope];
    for (i, sum) in sums.iter_mut().enumerate() {
        let (sums, _) = sum.as_chunks_mut();
        let term = if i == 0 { value } else { gradient[i - 1] } * V::constant(f64::from(factors[i]));
        // (The sum with zero makes −0 to +0.)
        let before = if ALONE { zero } else { V::load(&sums[vector]) };
        (before + term).store(&mut sums[vector]);
    }
}
