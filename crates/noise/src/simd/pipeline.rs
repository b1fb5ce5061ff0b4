//! The order in which the kernels made by hand work: step by step, hashes one step ahead of blends.
//!
//! Hashing reads tables, blending multiplies and adds. The two use other ports of the machine, so the points of the next
//! step are hashed beside the blends of the current one, and neither waits for the other: across blocks and octaves too.

use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};

use crate::basis::corners::Corners;
use crate::basis::improved::blend_codes;
use crate::number::Dual;
use crate::simd::{Terms, Vector};

/// The coordinates of a step along each axis.
pub(super) type Point<'a, const STEP: usize> = [&'a [f32; STEP]; 3];

/// The values of a step, and with N = 4 their derivatives along each axis.
pub(super) type Sums<'a, const STEP: usize, const N: usize> = [&'a mut [f32; STEP]; N];

/// Points whose octaves are summed before the next ones: their coordinates and sums stay in the first cache.
const BLOCK: usize = 512;

/// So many points ahead, coordinates are called for from memory: the machine itself begins anew with every page.
const AHEAD: usize = 512;

/// One octave of a sum.
#[derive(Clone, Copy)]
pub(super) struct Octave {
    pub frequency: f32,
    pub amplitude: f32,
    pub slope: f32,
}

/// What becomes of the noise: it is the value.
pub(super) const ALONE: u8 = 0;
/// It is added, times the amplitude.
pub(super) const PLAIN: u8 = 1;
/// Its absolute value is added, times the amplitude.
pub(super) const ABSOLUTE: u8 = 2;

impl Octave {
    /// That of this number.
    #[inline(always)]
    pub fn of(terms: &Terms, index: usize) -> Octave {
        Octave { frequency: terms.frequencies[index], amplitude: terms.amplitudes[index], slope: terms.slopes[index] }
    }
}

/// A kernel of two halves, for `STEP` points at a time.
pub(super) trait Halves<const STEP: usize> {
    /// What hashing hands to blending.
    type Codes;
    /// Hashes the cells of the points, times the frequency, for so many outputs.
    fn hash<const N: usize>(&self, frequency: f32, point: Point<STEP>) -> Self::Codes;
    /// Adds an octave at the points whose `codes` are given, which become those of `next`. `USE` is [`ALONE`] where the
    /// frequencies and the amplitude are 1 and the sums are overwritten (no zero is negative), [`PLAIN`] or [`ABSOLUTE`].
    fn step<const USE: u8, const N: usize>(
        &self,
        octave: &Octave,
        point: Point<STEP>,
        sums: Sums<STEP, N>,
        codes: &mut Self::Codes,
        next: (f32, Point<STEP>),
    );
    /// [`Halves::step`] without a next one.
    fn finish<const USE: u8, const N: usize>(
        &self,
        octave: &Octave,
        point: Point<STEP>,
        sums: Sums<STEP, N>,
        codes: &Self::Codes,
    );
    /// Takes the points of a step apart into their coordinates.
    fn take_apart(points: &[[f32; 3]; STEP], coordinates: &mut [[f32; STEP]; 3]);
}

/// The sums at the first points (without terms: the noise itself), a multiple of `STEP` of them; returns how many.
#[inline(always)]
pub(super) fn sum<H: Halves<STEP>, const STEP: usize, const N: usize>(
    halves: &H,
    terms: Option<&Terms>,
    points: [&[f32]; 3],
    mut outputs: [&mut [f32]; N],
) -> usize {
    let [x, y, z] = points;
    let points = [x.as_chunks().0, y.as_chunks().0, z.as_chunks().0];
    let steps = outputs[0].len() / STEP;
    if steps == 0 {
        return 0;
    }
    match terms {
        None => alone(halves, points, &mut outputs),
        Some(terms) if terms.absolute => octaves::<ABSOLUTE, H, STEP, N>(halves, terms, points, &mut outputs),
        Some(terms) => octaves::<PLAIN, H, STEP, N>(halves, terms, points, &mut outputs),
    }
    steps * STEP
}

/// The noise itself.
#[inline(always)]
fn alone<H: Halves<STEP>, const STEP: usize, const N: usize>(
    halves: &H,
    [x, y, z]: [&[[f32; STEP]]; 3],
    outputs: &mut [&mut [f32]; N],
) {
    let steps = outputs[0].len() / STEP;
    assert!(x.len() == steps && y.len() == steps && z.len() == steps);
    let octave = Octave { frequency: 1.0, amplitude: 1.0, slope: 1.0 };
    let point = |i: usize| [&x[i], &y[i], &z[i]];
    let last = steps - 1;
    let mut codes = halves.hash::<N>(1.0, point(0));
    for i in 0..last {
        prefetch([x, y, z], i + AHEAD / STEP);
        let next = (1.0, point(i + 1));
        halves.step::<ALONE, N>(&octave, point(i), sums(outputs, i), &mut codes, next);
    }
    halves.finish::<ALONE, N>(&octave, point(last), sums(outputs, last), &codes);
}

/// The noise itself at points that are not in columns yet, a multiple of `STEP` of them; returns how many. They are taken apart
/// step by step, so that their way from memory is hidden behind the noise.
#[inline(always)]
pub(super) fn at_points<H: Halves<STEP>, const STEP: usize>(
    halves: &H,
    points: &[[f32; 3]],
    values: &mut [f32],
) -> usize {
    let (points, outputs) = (points.as_chunks::<STEP>().0, values.as_chunks_mut::<STEP>().0);
    assert_eq!(points.len(), outputs.len());
    let Some(last) = points.len().checked_sub(1) else { return 0 };
    let octave = Octave { frequency: 1.0, amplitude: 1.0, slope: 1.0 };
    // Those of this step, and those of the next one.
    let mut rooms = [Room([[0.0; STEP]; 3]), Room([[0.0; STEP]; 3])];
    H::take_apart(&points[0], &mut rooms[0].0);
    let mut codes = halves.hash::<1>(1.0, rooms[0].point());
    for i in 0..last {
        prefetch([points], i + AHEAD / STEP);
        let next = (i + 1) % 2;
        H::take_apart(&points[i + 1], &mut rooms[next].0);
        let (point, next) = (rooms[i % 2].point(), rooms[next].point());
        halves.step::<ALONE, 1>(&octave, point, [&mut outputs[i]], &mut codes, (1.0, next));
    }
    halves.finish::<ALONE, 1>(&octave, rooms[last % 2].point(), [&mut outputs[last]], &codes);
    points.len() * STEP
}

/// The coordinates of a step. (Aligned, or vectors may straddle cache lines.)
#[repr(align(64))]
struct Room<const STEP: usize>([[f32; STEP]; 3]);

impl<const STEP: usize> Room<STEP> {
    #[inline(always)]
    fn point(&self) -> Point<'_, STEP> {
        let [x, y, z] = &self.0;
        [x, y, z]
    }
}

/// The sum of octaves.
#[inline(always)]
fn octaves<const USE: u8, H: Halves<STEP>, const STEP: usize, const N: usize>(
    halves: &H,
    terms: &Terms,
    [x, y, z]: [&[[f32; STEP]]; 3],
    outputs: &mut [&mut [f32]; N],
) {
    let steps = outputs[0].len() / STEP;
    assert!(x.len() == steps && y.len() == steps && z.len() == steps);
    let point = |i: usize| [&x[i], &y[i], &z[i]];
    for output in outputs.iter_mut() {
        output[..steps * STEP].fill(0.0);
    }
    if terms.octaves() == 0 {
        return;
    }
    let last = steps - 1;
    let mut codes = halves.hash::<N>(terms.frequencies[0], point(0));
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
                if index == 0 {
                    prefetch([x, y, z], i + AHEAD / STEP);
                }
                let (frequency, next) = if i + 1 == end { after } else { (octave.frequency, i + 1) };
                let next = (frequency, point(next));
                halves.step::<USE, N>(&octave, point(i), sums(outputs, i), &mut codes, next);
            }
        }
    }
}

/// Calls for the numbers of a step from memory. (There need not be such a step: the machine passes over bad addresses.)
#[inline(always)]
fn prefetch<T, const N: usize>(slices: [&[T]; N], step: usize) {
    for slice in slices {
        let numbers = slice.as_ptr().wrapping_add(step).cast::<i8>();
        for line in 0..size_of::<T>() / 64 {
            // SAFETY: nothing is read.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(numbers.wrapping_add(64 * line)) };
        }
    }
}

/// The outputs of a step.
#[inline(always)]
fn sums<'a, const STEP: usize, const N: usize>(outputs: &'a mut [&mut [f32]; N], step: usize) -> Sums<'a, STEP, N> {
    outputs.each_mut().map(|output| output[step * STEP..].first_chunk_mut().expect("a whole step"))
}

/// Adds an octave at the points of one vector of a step, from the corners' codes and the offsets in the cells.
#[inline(always)]
pub(super) fn add_vector<V: Vector<LANES>, const STEP: usize, const LANES: usize, const N: usize, const USE: u8>(
    octave: &Octave,
    codes: Corners<V::Int>,
    offset: [V; 3],
    sums: &mut Sums<STEP, N>,
    vector: usize,
) {
    let sample =
        if N == 4 { blend_codes::<V, 3, true>(codes, offset) } else { blend_codes::<V, 3, false>(codes, offset) };
    add::<V, STEP, LANES, N, USE>(octave, sample, sums, vector);
}

/// Adds an octave's noise at the points of one vector of a step.
#[inline(always)]
pub(super) fn add<V: Vector<LANES>, const STEP: usize, const LANES: usize, const N: usize, const USE: u8>(
    octave: &Octave,
    sample: Dual<V, 3>,
    sums: &mut Sums<STEP, N>,
    vector: usize,
) {
    let (mut value, mut gradient) = (sample.value, sample.gradient);
    let zero = V::constant(0.0);
    if USE == ABSOLUTE {
        let negative = value.less(zero);
        value = value.abs();
        for part in &mut gradient {
            *part = V::select(negative, -*part, *part);
        }
    }
    for (i, sum) in sums.iter_mut().enumerate() {
        let sum = &mut sum.as_chunks_mut().0[vector];
        let part = if i == 0 { value } else { gradient[i - 1] };
        let factor = if i == 0 { octave.amplitude } else { octave.slope };
        // (The sum with zero makes −0 to +0.)
        let sums = if USE == ALONE { part + zero } else { V::load(sum) + part * V::splat(factor) };
        sums.store(sum);
    }
}
