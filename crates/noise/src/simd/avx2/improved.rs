//! Improved noise for eight points at a time, with AVX2.
//!
//! Gathers are slow, so the corners are hashed point by point from tables of pairs, seven reads for all eight corners,
//! and the codes staged through a small buffer. The next points are hashed beside the blends of the current ones: reads
//! and arithmetic use other ports, and neither waits for the other. Measured against the generic evaluation with its
//! gathers, this takes half the time (`cargo run --release --example speed`).

use std::arch::x86_64::*;

use crate::basis::Tables;
use crate::simd::Terms;
use crate::simd::pipeline::{self, Halves, Octave, Point};
use crate::table::CornerTables;

/// Points in a vector.
const LANES: usize = 8;

/// Points in a step, and vectors.
const STEP: usize = 32;
const VECTORS: usize = STEP / LANES;

/// The sums at the first points, a multiple of 8 of them; returns how many.
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn sum(tables: &Tables, terms: &Terms, points: [&[f32]; 3], values: &mut [f32]) -> usize {
    let tables = &tables.corners;
    let done = pipeline::sum(&Staged(tables), terms, points, values);
    let (rest, _) = values[done..].as_chunks_mut::<LANES>();
    let vectors = |axis: usize| points[axis][done..].as_chunks::<LANES>().0;
    let (x, y, z) = (vectors(0), vectors(1), vectors(2));
    for (i, sums) in rest.iter_mut().enumerate() {
        *sums = [0.0; LANES];
        let mut frequency = 1.0;
        for index in 0..terms.octaves {
            let amplitude = terms.amplitude(index) as f32;
            let octave = Octave { frequency: frequency as f32, amplitude, absolute: terms.absolute };
            let (mut cells, mut codes) = ([Stage::EMPTY; 3], Stage::EMPTY);
            for (cells, numbers) in cells.iter_mut().zip([&x[i], &y[i], &z[i]]) {
                find_cells::<false>(octave.frequency, numbers, &mut cells.0[0]);
            }
            hash(tables, &cells, 0, &mut codes);
            add_vector::<false>(&codes.0[0], &octave, [&x[i], &y[i], &z[i]], sums);
            frequency *= terms.lacunarity;
        }
    }
    done + rest.len() * LANES
}

/// Numbers of the points of a step. (Aligned, or vectors may straddle cache lines.)
#[repr(align(64))]
struct Stage([[u32; LANES]; VECTORS]);

impl Stage {
    const EMPTY: Stage = Stage([[0; LANES]; VECTORS]);
}

/// The codes of a step, and room for those of the next one.
struct Codes {
    stages: [Stage; 2],
    current: usize,
}

/// The kernel whose codes go through memory. It exists only where the machine has AVX2.
struct Staged<'a>(&'a CornerTables);

impl Halves<STEP> for Staged<'_> {
    type Codes = Codes;

    #[inline(always)]
    fn hash(&self, frequency: f32, point: Point<STEP>) -> Codes {
        let (mut cells, mut codes) = ([Stage::EMPTY; 3], Codes { stages: [Stage::EMPTY; 2], current: 0 });
        // SAFETY, here and below: the machine has AVX2.
        unsafe { find_step_cells::<false>(frequency, point, &mut cells) };
        for i in 0..VECTORS {
            hash(self.0, &cells, i, &mut codes.stages[0]);
        }
        codes
    }

    #[inline(always)]
    fn step<const ALONE: bool>(
        &self,
        octave: &Octave,
        point: Point<STEP>,
        sums: &mut [f32; STEP],
        codes: &mut Codes,
        (frequency, next): (f32, Point<STEP>),
    ) {
        let mut cells = [Stage::EMPTY; 3];
        unsafe { find_step_cells::<ALONE>(frequency, next, &mut cells) };
        let [x, y, z] = point.map(|coordinates| coordinates.as_chunks().0);
        let [even, odd] = &mut codes.stages;
        let (current, next) = if codes.current == 0 { (&*even, odd) } else { (&*odd, even) };
        for (i, sums) in sums.as_chunks_mut().0.iter_mut().enumerate() {
            hash(self.0, &cells, i, next);
            unsafe { add_vector::<ALONE>(&current.0[i], octave, [&x[i], &y[i], &z[i]], sums) };
        }
        codes.current = 1 - codes.current;
    }

    #[inline(always)]
    fn finish<const ALONE: bool>(&self, octave: &Octave, point: Point<STEP>, sums: &mut [f32; STEP], codes: &Codes) {
        let [x, y, z] = point.map(|coordinates| coordinates.as_chunks().0);
        for (i, sums) in sums.as_chunks_mut().0.iter_mut().enumerate() {
            unsafe { add_vector::<ALONE>(&codes.stages[codes.current].0[i], octave, [&x[i], &y[i], &z[i]], sums) };
        }
    }
}

/// Eight coordinates, times the frequency; as they are in the first octave, whose frequency is 1.
#[inline]
#[target_feature(enable = "avx2")]
fn load<const ALONE: bool>(numbers: &[f32; LANES], frequency: f32) -> __m256 {
    // SAFETY: there are eight.
    let numbers = unsafe { _mm256_loadu_ps(numbers.as_ptr()) };
    if ALONE { numbers } else { _mm256_mul_ps(_mm256_set1_ps(frequency), numbers) }
}

/// The cells of the points of a step.
#[inline]
#[target_feature(enable = "avx2")]
fn find_step_cells<const ALONE: bool>(frequency: f32, points: Point<STEP>, cells: &mut [Stage; 3]) {
    for (cells, numbers) in cells.iter_mut().zip(points) {
        for (cells, numbers) in cells.0.iter_mut().zip(numbers.as_chunks().0) {
            find_cells::<ALONE>(frequency, numbers, cells);
        }
    }
}

/// The cells of eight coordinates.
#[inline]
#[target_feature(enable = "avx2")]
fn find_cells<const ALONE: bool>(frequency: f32, numbers: &[f32; LANES], cells: &mut [u32; LANES]) {
    let cell = _mm256_cvttps_epi32(_mm256_floor_ps(load::<ALONE>(numbers, frequency)));
    // SAFETY: there is room for eight.
    unsafe { _mm256_storeu_si256(cells.as_mut_ptr().cast(), cell) };
}

/// The codes of the eight points of a vector.
#[inline(always)]
fn hash(tables: &CornerTables, cells: &[Stage; 3], vector: usize, codes: &mut Stage) {
    let [x, y, z] = [&cells[0].0[vector], &cells[1].0[vector], &cells[2].0[vector]];
    for (lane, code) in codes.0[vector].iter_mut().enumerate() {
        let code: *mut u32 = code;
        // SAFETY: a reference may be written through. Volatile, or else the compiler makes gathers of the reads.
        unsafe { code.write_volatile(tables.hash([x[lane] as u8, y[lane] as u8, z[lane] as u8])) };
    }
}

/// Adds one octave at eight points.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn add_vector<const ALONE: bool>(
    codes: &[u32; LANES],
    octave: &Octave,
    points: [&[f32; LANES]; 3],
    sum: &mut [f32; LANES],
) {
    let load = |axis: usize| load::<ALONE>(points[axis], octave.frequency);
    // SAFETY: there are eight codes.
    let noise = blend(unsafe { _mm256_loadu_si256(codes.as_ptr().cast()) }, [load(0), load(1), load(2)]);
    // The mask that takes the sign off, or nothing.
    let keep = _mm256_castsi256_ps(_mm256_set1_epi32(if octave.absolute { i32::MAX } else { -1 }));
    let (term, amplitude) = (_mm256_and_ps(noise, keep), _mm256_set1_ps(octave.amplitude));
    // SAFETY: there are eight sums.
    unsafe {
        // (Fused with zero, which makes −0 to +0: the product is rounded as it is alone.)
        let total = match ALONE {
            true => _mm256_fmadd_ps(amplitude, term, _mm256_setzero_ps()),
            false => _mm256_add_ps(_mm256_loadu_ps(sum.as_ptr()), _mm256_mul_ps(amplitude, term)),
        };
        _mm256_storeu_ps(sum.as_mut_ptr(), total);
    }
}

/// The noise (its zeros of either sign) of eight points from the codes of [`CornerTables::hash`].
#[inline]
#[target_feature(enable = "avx2,fma")]
fn blend(codes: __m256i, position: [__m256; 3]) -> __m256 {
    let one = _mm256_set1_ps(1.0);
    let [x, y, z] = [offset(position[0]), offset(position[1]), offset(position[2])];
    let (x1, y1, z1) = (_mm256_sub_ps(x, one), _mm256_sub_ps(y, one), _mm256_sub_ps(z, one));
    let (u, v) = (fade(x), fade(y));
    let low = lerp(
        v,
        lerp(u, dot::<0, 28>(codes, x, y, z), dot::<16, 12>(codes, x1, y, z)),
        lerp(u, dot::<8, 20>(codes, x, y1, z), dot::<24, 4>(codes, x1, y1, z)),
    );
    let high = lerp(
        v,
        lerp(u, dot::<4, 24>(codes, x, y, z1), dot::<20, 8>(codes, x1, y, z1)),
        lerp(u, dot::<12, 16>(codes, x, y1, z1), dot::<28, 0>(codes, x1, y1, z1)),
    );
    lerp(fade(z), low, high)
}

#[inline]
#[target_feature(enable = "avx2")]
fn offset(position: __m256) -> __m256 {
    _mm256_sub_ps(position, _mm256_floor_ps(position))
}

#[inline]
#[target_feature(enable = "avx2")]
fn fade(t: __m256) -> __m256 {
    let inner = _mm256_sub_ps(_mm256_mul_ps(t, _mm256_set1_ps(6.0)), _mm256_set1_ps(15.0));
    let outer = _mm256_add_ps(_mm256_mul_ps(t, inner), _mm256_set1_ps(10.0));
    _mm256_mul_ps(_mm256_mul_ps(_mm256_mul_ps(t, t), t), outer)
}

#[inline]
#[target_feature(enable = "avx2")]
fn lerp(t: __m256, a: __m256, b: __m256) -> __m256 {
    _mm256_add_ps(a, _mm256_mul_ps(t, _mm256_sub_ps(b, a)))
}

/// As [`crate::Real::edge_dot`] of the vectors of eight, with the code at the bit `RIGHT`, and its sign `LEFT` bits below the
/// top.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn dot<const RIGHT: i32, const LEFT: i32>(codes: __m256i, x: __m256, y: __m256, z: __m256) -> __m256 {
    let [line_x, line_y, line_z] = super::lines();
    let code = _mm256_srli_epi32::<RIGHT>(codes);
    let product = _mm256_mul_ps(_mm256_permutevar8x32_ps(line_z, code), z);
    let product = _mm256_fmadd_ps(_mm256_permutevar8x32_ps(line_y, code), y, product);
    let product = _mm256_fmadd_ps(_mm256_permutevar8x32_ps(line_x, code), x, product);
    let sign = _mm256_and_ps(_mm256_castsi256_ps(_mm256_slli_epi32::<LEFT>(codes)), _mm256_set1_ps(-0.0));
    _mm256_xor_ps(product, sign)
}
