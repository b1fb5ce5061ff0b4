//! The order in which the kernels made by hand work: step by step, hashes some steps ahead of blends.
//!
//! Hashing reads tables, blending multiplies and adds. The two use other ports of the machine, so the points of a later
//! step are hashed beside the blends of the current one, and neither waits for the other: across the octaves of a block too.

use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};

use crate::basis::corners::Corners;
use crate::basis::improved::blend_codes;
use crate::number::Dual;
use crate::simd::avx2::F32x8;
use crate::simd::{Away, BATCH, Terms, Vector};

/// The coordinates of a step along each axis.
pub(super) type Point<'a, const STEP: usize> = [&'a [f32; STEP]; 3];

/// The values of a step, and with N > 1 their derivatives along each axis.
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
    /// So many steps before a blend its points are hashed.
    const LEAD: usize;
    /// What hashing hands to blending: room for the codes of so many steps and one.
    type Codes;
    /// The room.
    fn room(&self) -> Self::Codes;
    /// Hashes the cells of the points, times the frequency, for so many outputs. Steps are numbered in their order.
    fn hash<const N: usize>(&self, frequency: f32, point: Point<STEP>, codes: &mut Self::Codes, step: usize);
    /// Adds an octave at the points of a step that has been hashed, and hashes those of the step [`Halves::LEAD`] later. `USE` is
    /// [`ALONE`] where the frequencies and the amplitude are 1 and the sums are overwritten (no zero is negative), [`PLAIN`]
    /// or [`ABSOLUTE`].
    fn step<const USE: u8, const N: usize>(
        &self,
        octave: &Octave,
        point: Point<STEP>,
        sums: Sums<STEP, N>,
        codes: &mut Self::Codes,
        step: usize,
        later: (f32, Point<STEP>),
    );
    /// Hashes what there is left to hash, after so many steps.
    fn complete<const N: usize>(&self, codes: &mut Self::Codes, steps: usize);
    /// [`Halves::step`] without a later one.
    fn finish<const USE: u8, const N: usize>(
        &self,
        octave: &Octave,
        point: Point<STEP>,
        sums: Sums<STEP, N>,
        codes: &Self::Codes,
        step: usize,
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
        None => octaves_of_block::<ALONE, H, STEP, N>(halves, &ONE, points, &mut outputs, Some((points, AHEAD / STEP))),
        Some(terms) if terms.absolute => octaves::<ABSOLUTE, H, STEP, N>(halves, terms, points, &mut outputs),
        Some(terms) => octaves::<PLAIN, H, STEP, N>(halves, terms, points, &mut outputs),
    }
    steps * STEP
}

/// The noise itself at a batch of points.
#[inline(always)]
pub(super) fn batch<H: Halves<STEP>, const STEP: usize>(
    halves: &H,
    [x, y, z]: [&[f32; BATCH]; 3],
    values: &mut [f32; BATCH],
) {
    let points = [x.as_chunks().0, y.as_chunks().0, z.as_chunks().0];
    octaves_of_block::<ALONE, H, STEP, 1>(halves, &ONE, points, &mut [values], None);
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
    let octave = Octave { frequency: 1.0, amplitude: 1.0, slope: 1.0 };
    let steps = points.len();
    if steps == 0 {
        return 0;
    }
    // Those of this step, and of the later ones up to that which is hashed beside it.
    const { assert!(H::LEAD < ROOMS) };
    let mut rooms = [const { Room([[0.0; STEP]; 3]) }; ROOMS];
    let mut codes = halves.room();
    for i in 0..steps.min(H::LEAD) {
        H::take_apart(&points[i], &mut rooms[i].0);
        halves.hash::<1>(1.0, rooms[i].point(), &mut codes, i);
    }
    let hashed_by_then = steps.saturating_sub(H::LEAD);
    for i in 0..hashed_by_then {
        prefetch([points], i + AHEAD / STEP);
        let later = i + H::LEAD;
        H::take_apart(&points[later], &mut rooms[later % ROOMS].0);
        let (point, later) = (rooms[i % ROOMS].point(), rooms[later % ROOMS].point());
        halves.step::<ALONE, 1>(&octave, point, [&mut outputs[i]], &mut codes, i, (1.0, later));
    }
    halves.complete::<1>(&mut codes, steps);
    for i in hashed_by_then..steps {
        halves.finish::<ALONE, 1>(&octave, rooms[i % ROOMS].point(), [&mut outputs[i]], &codes, i);
    }
    steps * STEP
}

/// How many steps are taken apart at once.
const ROOMS: usize = 4;

/// The noise alone.
const ONE: Terms = Terms { absolute: false, frequencies: &[1.0], amplitudes: &[1.0], slopes: &[1.0] };

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

/// The sum of octaves, block by block.
#[inline(always)]
fn octaves<const USE: u8, H: Halves<STEP>, const STEP: usize, const N: usize>(
    halves: &H,
    terms: &Terms,
    points: [&[[f32; STEP]]; 3],
    outputs: &mut [&mut [f32]; N],
) {
    let steps = outputs[0].len() / STEP;
    let mut near = outputs.each_mut().map(std::mem::take);
    let mut far = None;
    if steps * STEP >= FAR {
        let away = std::mem::replace(&mut near, std::array::from_fn(|_| &mut [][..])).map(Away::to);
        far = Some((Block { points: [[0.0; BLOCK]; 3], sums: [[0.0; BLOCK]; N] }, away));
    }
    for start in (0..steps).step_by(BLOCK / STEP) {
        let end = steps.min(start + BLOCK / STEP);
        let count = (end - start) * STEP;
        let mut block = points;
        let mut sums: [&mut [f32]; N];
        match &mut far {
            None => {
                for (block, points) in block.iter_mut().zip(points) {
                    *block = &points[start..end];
                }
                sums = near.each_mut().map(|output| &mut output[start * STEP..end * STEP]);
            }
            Some((copy, _)) => {
                for (axis, points) in points.iter().enumerate() {
                    copy.points[axis][..count].copy_from_slice(points[start..end].as_flattened());
                }
                for (block, points) in block.iter_mut().zip(&copy.points) {
                    *block = points[..count].as_chunks().0;
                }
                sums = copy.sums.each_mut().map(|sums| &mut sums[..count]);
            }
        }
        octaves_of_block::<USE, H, STEP, N>(halves, terms, block, &mut sums, Some((points, start + BLOCK / STEP)));
        if let Some((copy, away)) = &mut far {
            for (away, sums) in away.iter_mut().zip(&copy.sums) {
                away.send::<F32x8, 8>(&sums[..count]);
            }
        }
    }
    if let Some((_, away)) = far {
        for away in away {
            away.finish::<F32x8, 8>();
        }
    }
}

/// From so many points on, the slices come from memory and go there. They are copied block by block, since large slices often begin
/// at the same place of a page, and their lines would drive each other out of the first cache.
const FAR: usize = 1 << 20;

/// The copy of a block.
#[repr(align(64))]
struct Block<const N: usize> {
    points: [[f32; BLOCK]; 3],
    sums: [[f32; BLOCK]; N],
}

/// The sum of octaves at the points of a block, while the next ones are called for, if there are any: those from a step of some slices
/// on.
#[inline(always)]
fn octaves_of_block<const USE: u8, H: Halves<STEP>, const STEP: usize, const N: usize>(
    halves: &H,
    terms: &Terms,
    [x, y, z]: [&[[f32; STEP]]; 3],
    outputs: &mut [&mut [f32]; N],
    ahead: Option<([&[[f32; STEP]]; 3], usize)>,
) {
    let steps = outputs[0].len() / STEP;
    assert!(x.len() == steps && y.len() == steps && z.len() == steps);
    let point = |i: usize| [&x[i], &y[i], &z[i]];
    if USE != ALONE {
        outputs.iter_mut().for_each(|output| output.fill(0.0));
    }
    let Some(last) = terms.octaves().checked_sub(1) else { return };
    let mut codes = halves.room();
    if steps < H::LEAD {
        for index in 0..terms.octaves() {
            for i in 0..steps {
                halves.hash::<N>(terms.frequencies[index], point(i), &mut codes, i);
            }
            halves.complete::<N>(&mut codes, steps);
            for i in 0..steps {
                halves.finish::<USE, N>(&Octave::of(terms, index), point(i), sums(outputs, i), &codes, i);
            }
        }
        return;
    }
    for i in 0..H::LEAD {
        halves.hash::<N>(terms.frequencies[0], point(i), &mut codes, i);
    }
    let (hashed_by_then, mut step) = (steps - H::LEAD, 0);
    for index in 0..=last {
        let octave = Octave::of(terms, index);
        for i in 0..hashed_by_then {
            if index == 0
                && let Some((ahead, first)) = ahead
            {
                prefetch(ahead, first + i);
            }
            let later = (octave.frequency, point(i + H::LEAD));
            halves.step::<USE, N>(&octave, point(i), sums(outputs, i), &mut codes, step, later);
            step += 1;
        }
        if index == last {
            break;
        }
        for i in hashed_by_then..steps {
            let later = (terms.frequencies[index + 1], point(i - hashed_by_then));
            halves.step::<USE, N>(&octave, point(i), sums(outputs, i), &mut codes, step, later);
            step += 1;
        }
    }
    halves.complete::<N>(&mut codes, step + H::LEAD);
    for i in 0..H::LEAD {
        let (point, sums) = (point(hashed_by_then + i), sums(outputs, hashed_by_then + i));
        if let Some((ahead, first)) = ahead {
            prefetch(ahead, first + hashed_by_then + i);
        }
        halves.finish::<USE, N>(&Octave::of(terms, last), point, sums, &codes, step + i);
    }
}

/// Calls for the numbers of a step from memory. (There need not be such a step: the machine passes over bad addresses.)
#[inline(always)]
fn prefetch<T, const N: usize>(slices: [&[T]; N], step: usize) {
    for slice in slices {
        let numbers = slice.as_ptr().wrapping_add(step).cast::<i8>();
        for line in 0..size_of::<T>().div_ceil(64) {
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
pub(super) fn add_vector<
    V: Vector<LANES>,
    const STEP: usize,
    const LANES: usize,
    const D: usize,
    const N: usize,
    const USE: u8,
>(
    octave: &Octave,
    codes: Corners<V::Int>,
    offset: [V; D],
    sums: &mut Sums<STEP, N>,
    vector: usize,
) {
    let sample =
        if N > 1 { blend_codes::<V, D, true>(codes, offset) } else { blend_codes::<V, D, false>(codes, offset) };
    add::<V, STEP, LANES, D, N, USE>(octave, sample, sums, vector);
}

/// Adds an octave's noise at the points of one vector of a step.
#[inline(always)]
pub(super) fn add<
    V: Vector<LANES>,
    const STEP: usize,
    const LANES: usize,
    const D: usize,
    const N: usize,
    const USE: u8,
>(
    octave: &Octave,
    sample: Dual<V, D>,
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
