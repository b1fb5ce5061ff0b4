//! Improved noise for eight points at a time, with AVX2.
//!
//! Gathers are slow, so the corners are hashed point by point from tables of pairs, seven reads for all eight corners,
//! and the codes staged through a small buffer. The next points are hashed beside the blends of the current ones: reads
//! and arithmetic use other ports, and neither waits for the other. Measured against the generic evaluation with its
//! gathers, this takes half the time (`cargo run --release --example speed`).

use std::arch::x86_64::*;

use super::{F32x8, I32x8, chosen};
use crate::basis::Tables;
use crate::basis::corners::{Corners, Curve};
use crate::number::{Dual, Integer, Real};
use crate::simd::pipeline::{self, ABSOLUTE, ALONE, Halves, Octave, PLAIN, Point, Sums};
use crate::simd::{Terms, Vector, triples};
use crate::table::CornerTables;

/// Points in a vector.
const LANES: usize = 8;

/// Points in a step, and vectors.
const STEP: usize = 32;
const VECTORS: usize = STEP / LANES;

/// The sums (and gradients) at the first points (without terms: the noise itself), a multiple of 8 of them; returns how many.
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn sum<const N: usize>(
    tables: &Tables,
    terms: Option<&Terms>,
    points: [&[f32]; 3],
    mut outputs: [&mut [f32]; N],
) -> usize {
    let (count, tables) = (outputs[0].len(), &tables.corners);
    let whole = count / STEP * STEP;
    let parts = outputs.each_mut().map(|output| &mut output[..whole]);
    pipeline::sum(&Staged(tables), terms, points.map(|axis| &axis[..whole]), parts);
    for start in (whole..count / LANES * LANES).step_by(LANES) {
        let point = points.map(|axis| axis[start..].first_chunk().expect("a whole vector"));
        let mut sums = outputs.each_mut().map(|output| output[start..].first_chunk_mut().expect("a whole vector"));
        sums.iter_mut().for_each(|sums| sums.fill(0.0));
        let terms = terms.unwrap_or(&Terms::ONE);
        for index in 0..terms.octaves() {
            let octave = Octave::of(terms, index);
            let (mut cells, mut codes) = ([Stage::EMPTY; 3], Stage::EMPTY);
            for (cells, numbers) in cells.iter_mut().zip(point) {
                find_cells::<PLAIN>(octave.frequency, numbers, &mut cells.0[0]);
            }
            hash::<N, 0, LANES>(tables, &cells, 0, &mut codes);
            if terms.absolute {
                add_vector::<ABSOLUTE, LANES, N>(&codes.0[0], &octave, point, &mut sums, 0);
            } else {
                add_vector::<PLAIN, LANES, N>(&codes.0[0], &octave, point, &mut sums, 0);
            }
        }
    }
    count / LANES * LANES
}

/// The noise at the first points, which are not in columns, a multiple of 32 of them; returns how many.
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn at_points(tables: &Tables, points: &[[f32; 3]], values: &mut [f32]) -> usize {
    pipeline::at_points(&Staged(&tables.corners), points, values)
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
    fn hash<const N: usize>(&self, frequency: f32, point: Point<STEP>) -> Codes {
        let (mut cells, mut codes) = ([Stage::EMPTY; 3], Codes { stages: [Stage::EMPTY; 2], current: 0 });
        // SAFETY, here and below: the machine has AVX2.
        unsafe { find_step_cells::<PLAIN>(frequency, point, &mut cells) };
        for i in 0..VECTORS {
            hash::<N, 0, LANES>(self.0, &cells, i, &mut codes.stages[0]);
        }
        codes
    }

    #[inline(always)]
    fn step<const USE: u8, const N: usize>(
        &self,
        octave: &Octave,
        point: Point<STEP>,
        mut sums: Sums<STEP, N>,
        codes: &mut Codes,
        (frequency, next): (f32, Point<STEP>),
    ) {
        let mut cells = [Stage::EMPTY; 3];
        unsafe { find_step_cells::<USE>(frequency, next, &mut cells) };
        let [even, odd] = &mut codes.stages;
        let (current, next) = if codes.current == 0 { (&*even, odd) } else { (&*odd, even) };
        for i in 0..VECTORS {
            if N == 4 {
                hash::<N, 0, LANES>(self.0, &cells, i, next);
                unsafe { add_vector::<USE, STEP, N>(&current.0[i], octave, point, &mut sums, i) };
                continue;
            }
            // (Two points are hashed beside each edge of the cell that is blended: in larger pieces, one waits for the other.)
            let (codes, offset) = unsafe { locate::<USE, STEP>(&current.0[i], octave, point, i) };
            hash::<N, 0, 2>(self.0, &cells, i, next);
            let curve = Curve::quintic(&offset).at;
            let near = unsafe { edge(codes, 0, offset, curve[0]) };
            hash::<N, 2, 4>(self.0, &cells, i, next);
            let far = unsafe { edge(codes, 2, offset, curve[0]) };
            let low = lerp(curve[1], near, far);
            hash::<N, 4, 6>(self.0, &cells, i, next);
            let near = unsafe { edge(codes, 4, offset, curve[0]) };
            hash::<N, 6, 8>(self.0, &cells, i, next);
            let far = unsafe { edge(codes, 6, offset, curve[0]) };
            let value = lerp(curve[2], low, lerp(curve[1], near, far));
            pipeline::add::<F32x8, STEP, LANES, N, USE>(octave, Dual { value, gradient: [value; 3] }, &mut sums, i);
        }
        codes.current = 1 - codes.current;
    }

    #[inline(always)]
    fn take_apart(points: &[[f32; 3]; STEP], [x, y, z]: &mut [[f32; STEP]; 3]) {
        let numbers = points.as_flattened().as_chunks().0.as_chunks().0;
        let (x, y, z) = (x.as_chunks_mut().0, y.as_chunks_mut().0, z.as_chunks_mut().0);
        for group in 0..STEP / 8 {
            triples::eight(&numbers[group], [&mut x[group], &mut y[group], &mut z[group]]);
        }
    }

    #[inline(always)]
    fn finish<const USE: u8, const N: usize>(
        &self,
        octave: &Octave,
        point: Point<STEP>,
        mut sums: Sums<STEP, N>,
        codes: &Codes,
    ) {
        for i in 0..VECTORS {
            unsafe { add_vector::<USE, STEP, N>(&codes.stages[codes.current].0[i], octave, point, &mut sums, i) };
        }
    }
}

/// Eight coordinates, times the frequency; as they are where the octave is alone, since its frequency is 1.
#[inline(always)]
fn load<const USE: u8>(numbers: &[f32; LANES], frequency: f32) -> F32x8 {
    let numbers = F32x8::load(numbers);
    if USE == ALONE { numbers } else { numbers * F32x8::constant(f64::from(frequency)) }
}

/// The cells of the points of a step.
#[inline]
#[target_feature(enable = "avx2")]
fn find_step_cells<const USE: u8>(frequency: f32, points: Point<STEP>, cells: &mut [Stage; 3]) {
    for (cells, numbers) in cells.iter_mut().zip(points) {
        for (cells, numbers) in cells.0.iter_mut().zip(numbers.as_chunks().0) {
            find_cells::<USE>(frequency, numbers, cells);
        }
    }
}

/// The cells of eight coordinates.
#[inline]
#[target_feature(enable = "avx2")]
fn find_cells<const USE: u8>(frequency: f32, numbers: &[f32; LANES], cells: &mut [u32; LANES]) {
    let cell = _mm256_cvttps_epi32(_mm256_floor_ps(load::<USE>(numbers, frequency).0));
    // SAFETY: there is room for eight.
    unsafe { _mm256_storeu_si256(cells.as_mut_ptr().cast(), cell) };
}

/// The codes of these points of a vector: for the noise alone the choices of edges, with gradients the edges.
#[inline(always)]
fn hash<const N: usize, const FROM: usize, const TO: usize>(
    tables: &CornerTables,
    cells: &[Stage; 3],
    vector: usize,
    codes: &mut Stage,
) {
    let [x, y, z] = [&cells[0].0[vector], &cells[1].0[vector], &cells[2].0[vector]];
    let of_columns = if N == 4 { &tables.edges } else { &tables.choices };
    for lane in FROM..TO {
        let code = &mut codes.0[vector][lane];
        let code: *mut u32 = code;
        // SAFETY: a reference may be written through. Volatile, or else the compiler makes gathers of the reads.
        unsafe { code.write_volatile(tables.hash(of_columns, [x[lane] as u8, y[lane] as u8, z[lane] as u8])) };
    }
}

/// Adds one octave at eight points of a step.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn add_vector<const USE: u8, const STEP: usize, const N: usize>(
    codes: &[u32; LANES],
    octave: &Octave,
    point: Point<STEP>,
    sums: &mut Sums<STEP, N>,
    vector: usize,
) {
    let (codes, offset) = locate::<USE, STEP>(codes, octave, point, vector);
    if N == 4 {
        return pipeline::add_vector::<F32x8, STEP, LANES, N, USE>(octave, corners(codes), offset, sums, vector);
    }
    let value = blend(codes, offset);
    pipeline::add::<F32x8, STEP, LANES, N, USE>(octave, Dual { value, gradient: [value; 3] }, sums, vector);
}

/// The codes of eight points, and their offsets in their cells.
#[inline]
#[target_feature(enable = "avx2")]
fn locate<const USE: u8, const STEP: usize>(
    codes: &[u32; LANES],
    octave: &Octave,
    point: Point<STEP>,
    vector: usize,
) -> (I32x8, [F32x8; 3]) {
    // SAFETY: there are eight codes.
    let codes = I32x8(unsafe { _mm256_loadu_si256(codes.as_ptr().cast()) });
    let mut offset = [F32x8::constant(0.0); 3];
    for axis in 0..3 {
        let position = load::<USE>(&point[axis].as_chunks().0[vector], octave.frequency);
        offset[axis] = position - position.floor();
    }
    (codes, offset)
}

/// The noise, from the choices of the corners' edges and the offset in the cell.
#[inline]
#[target_feature(enable = "avx2")]
pub(super) fn blend(codes: I32x8, offset: [F32x8; 3]) -> F32x8 {
    let [x, y, z] = Curve::quintic(&offset).at;
    let low = lerp(y, edge(codes, 0, offset, x), edge(codes, 2, offset, x));
    lerp(z, low, lerp(y, edge(codes, 4, offset, x), edge(codes, 6, offset, x)))
}

/// What two corners contribute that are neighbours along x: the one of this number (where bit 1 is that of y, bit 2 that of
/// z) and the next one.
#[inline]
#[target_feature(enable = "avx2")]
fn edge(codes: I32x8, first: usize, [x, y, z]: [F32x8; 3], curve: F32x8) -> F32x8 {
    let (one, sign) = (_mm256_set1_ps(1.0), _mm256_set1_ps(-0.0));
    let x = [_mm256_or_ps(x.0, sign), _mm256_or_ps(_mm256_sub_ps(one, x.0), sign)];
    let y = if first & 2 == 0 { y.0 } else { _mm256_sub_ps(one, y.0) };
    let z = _mm256_or_ps(if first & 4 == 0 { z.0 } else { _mm256_sub_ps(one, z.0) }, sign);
    let (codes, z_or_y) = (corners(codes), _mm256_xor_ps(z, y));
    let left = chosen(codes[first].0, _mm256_xor_ps(x[0], y), y, z_or_y);
    let right = chosen(codes[first + 1].0, _mm256_xor_ps(x[1], y), y, z_or_y);
    lerp(curve, F32x8(left), F32x8(right))
}

#[inline(always)]
fn lerp(t: F32x8, a: F32x8, b: F32x8) -> F32x8 {
    a + t * (b - a)
}

/// The codes of each corner, from all of them as [`CornerTables::hash`] has them (where the highest bit is that of x).
#[inline(always)]
fn corners(codes: I32x8) -> Corners<I32x8> {
    let mut corners = [codes; 16];
    for (i, corner) in (0..8).zip(&mut corners) {
        *corner = codes.shift_right(16 * (i & 1) + 4 * (i & 2) + (i & 4));
    }
    corners
}
