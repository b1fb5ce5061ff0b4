//! Improved noise for eight points at a time, with AVX2.
//!
//! Gathers are slow, so the corners are hashed point by point from tables of pairs, seven reads for all eight corners,
//! and the codes staged through a small buffer. The next points are hashed beside the blends of the current ones: reads
//! and arithmetic use other ports, and neither waits for the other. Measured against the generic evaluation with its
//! gathers, this takes half the time (`cargo run --release --example speed`).

use std::arch::x86_64::*;

use crate::basis::Tables;
use crate::simd::Terms;
use crate::table::CornerTables;

/// Points in a vector.
const LANES: usize = 8;

/// Points whose octaves are summed before the next ones: their coordinates and sums stay in the first cache.
const BLOCK: usize = 512;

/// The sums at the first points, a multiple of 8 of them; returns how many.
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn sum(tables: &Tables, terms: &Terms, points: [&[f32]; 3], values: &mut [f32]) -> usize {
    let count = values.len() / LANES * LANES;
    for start in (0..count).step_by(BLOCK) {
        let at = start..count.min(start + BLOCK);
        let points = [
            points[0][at.clone()].as_chunks().0,
            points[1][at.clone()].as_chunks().0,
            points[2][at.clone()].as_chunks().0,
        ];
        let values = values[at].as_chunks_mut().0;
        // (An amplitude of 1 lets the first octave overwrite what is there.)
        if terms.octaves == 0 || terms.amplitude(0) != 1.0 {
            values.fill([0.0; LANES]);
        }
        let mut frequency = 1.0;
        for index in 0..terms.octaves {
            let amplitude = terms.amplitude(index) as f32;
            let octave = Octave { frequency: frequency as f32, amplitude, absolute: terms.absolute };
            match index {
                0 if amplitude == 1.0 => add::<true>(&tables.corners, &octave, points, values),
                _ => add::<false>(&tables.corners, &octave, points, values),
            }
            frequency *= terms.lacunarity;
        }
    }
    count
}

/// One octave of a sum.
struct Octave {
    frequency: f32,
    amplitude: f32,
    absolute: bool,
}

/// Vectors of numbers in memory.
type Column<'a> = &'a [[f32; LANES]];

/// Vectors that are staged at a time.
const VECTORS: usize = 8;

/// Numbers of the points of a step. (Aligned, or vectors may straddle cache lines.)
#[repr(align(64))]
struct Stage([[u32; LANES]; VECTORS]);

impl Stage {
    const EMPTY: Stage = Stage([[0; LANES]; VECTORS]);
}

/// Adds one octave; the first one overwrites what was there.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn add<const FIRST: bool>(tables: &CornerTables, octave: &Octave, points: [Column; 3], values: &mut [[f32; LANES]]) {
    let (whole, rest) = values.as_chunks_mut::<VECTORS>();
    let [x, y, z] = points;
    let ((x, rest_x), (y, rest_y), (z, rest_z)) = (x.as_chunks(), y.as_chunks(), z.as_chunks());
    let (mut cells, mut codes) = ([Stage::EMPTY; 3], [Stage::EMPTY; 2]);
    let count = whole.len();
    assert!(x.len() == count && y.len() == count && z.len() == count);
    if let Some((last_sums, sums)) = whole.split_last_mut() {
        find_step_cells::<FIRST>(octave, [&x[0], &y[0], &z[0]], &mut cells);
        for i in 0..VECTORS {
            hash(tables, &cells, i, &mut codes[0]);
        }
        for (index, sums) in sums.iter_mut().enumerate() {
            let next = index + 1;
            find_step_cells::<FIRST>(octave, [&x[next], &y[next], &z[next]], &mut cells);
            let [even, odd] = &mut codes;
            let (codes, next_codes) = if index % 2 == 0 { (&*even, odd) } else { (&*odd, even) };
            let (x, y, z) = (&x[index], &y[index], &z[index]);
            for i in 0..VECTORS {
                hash(tables, &cells, i, next_codes);
                add_vector::<FIRST>(&codes.0[i], octave, [&x[i], &y[i], &z[i]], &mut sums[i]);
            }
        }
        let last = count - 1;
        for i in 0..VECTORS {
            let points = [&x[last][i], &y[last][i], &z[last][i]];
            add_vector::<FIRST>(&codes[last % 2].0[i], octave, points, &mut last_sums[i]);
        }
    }
    for (i, sums) in rest.iter_mut().enumerate() {
        let points = [&rest_x[i], &rest_y[i], &rest_z[i]];
        for (cells, numbers) in cells.iter_mut().zip(points) {
            find_cells::<FIRST>(octave, numbers, &mut cells.0[0]);
        }
        hash(tables, &cells, 0, &mut codes[0]);
        add_vector::<FIRST>(&codes[0].0[0], octave, points, sums);
    }
}

/// Eight coordinates, times the frequency; as they are in the first octave, whose frequency is 1.
#[inline]
#[target_feature(enable = "avx2")]
fn load<const FIRST: bool>(numbers: &[f32; LANES], octave: &Octave) -> __m256 {
    // SAFETY: there are eight.
    let numbers = unsafe { _mm256_loadu_ps(numbers.as_ptr()) };
    if FIRST { numbers } else { _mm256_mul_ps(_mm256_set1_ps(octave.frequency), numbers) }
}

/// The cells of the points of a step.
#[inline]
#[target_feature(enable = "avx2")]
fn find_step_cells<const FIRST: bool>(octave: &Octave, points: [&[[f32; LANES]; VECTORS]; 3], cells: &mut [Stage; 3]) {
    for (cells, numbers) in cells.iter_mut().zip(points) {
        for (cells, numbers) in cells.0.iter_mut().zip(numbers) {
            find_cells::<FIRST>(octave, numbers, cells);
        }
    }
}

/// The cells of eight coordinates.
#[inline]
#[target_feature(enable = "avx2")]
fn find_cells<const FIRST: bool>(octave: &Octave, numbers: &[f32; LANES], cells: &mut [u32; LANES]) {
    let cell = _mm256_cvttps_epi32(_mm256_floor_ps(load::<FIRST>(numbers, octave)));
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
fn add_vector<const FIRST: bool>(
    codes: &[u32; LANES],
    octave: &Octave,
    points: [&[f32; LANES]; 3],
    sum: &mut [f32; LANES],
) {
    let position =
        [load::<FIRST>(points[0], octave), load::<FIRST>(points[1], octave), load::<FIRST>(points[2], octave)];
    // SAFETY: there are eight codes.
    let noise = blend(unsafe { _mm256_loadu_si256(codes.as_ptr().cast()) }, position);
    // The mask that takes the sign off, or nothing.
    let keep = _mm256_castsi256_ps(_mm256_set1_epi32(if octave.absolute { i32::MAX } else { -1 }));
    let term = _mm256_and_ps(noise, keep);
    // SAFETY: there are eight sums.
    unsafe {
        let before = _mm256_loadu_ps(sum.as_ptr());
        let total =
            if FIRST { term } else { _mm256_add_ps(before, _mm256_mul_ps(_mm256_set1_ps(octave.amplitude), term)) };
        _mm256_storeu_ps(sum.as_mut_ptr(), total);
    }
}

/// The noise of eight points from the codes of [`CornerTables::hash`].
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
    _mm256_add_ps(lerp(fade(z), low, high), _mm256_setzero_ps())
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
