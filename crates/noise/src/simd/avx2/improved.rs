//! Improved noise for eight points at a time, with AVX2.
//!
//! Gathers are slow, so the corners are hashed point by point, eight reads for all eight corners,
//! and the codes staged through a small buffer. The next points are hashed beside the blends of the current ones: reads
//! and arithmetic use other ports, and neither waits for the other. Measured against the generic evaluation with its
//! gathers, this takes half the time (`cargo run --release --example speed`).

use std::arch::asm;
use std::arch::x86_64::*;

use super::{F32x8, I32x8, chosen, corners};
use crate::basis::Tables;
use crate::basis::corners::{Corners, Curve, lerp};
use crate::number::{Dual, Integer, Real};
use crate::simd::pipeline::{self, ALONE, Halves, Octave, PLAIN, Point, Sums};
use crate::simd::{BATCH, Terms, Vector, triples};
use crate::table::{ColumnCodes, CornerTables};

/// Points in a vector, and in a step.
const LANES: usize = 8;

/// The sums (and gradients) at the first points (without terms: the noise itself), a multiple of 8 of them; returns how many.
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn sum<const N: usize>(
    tables: &Tables,
    terms: Option<&Terms>,
    [x, y, z]: [&[f32]; 3],
    outputs: [&mut [f32]; N],
) -> usize {
    let whole = outputs[0].len() / LANES * LANES;
    pipeline::sum(&Staged::<3>(&tables.corners), terms, [&x[..whole], &y[..whole], &z[..whole]], outputs)
}

/// The sums (and gradients) at the first points of the plane: as [`sum`].
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn sum_in_plane<const N: usize>(
    tables: &Tables,
    terms: Option<&Terms>,
    [x, y]: [&[f32]; 2],
    outputs: [&mut [f32]; N],
) -> usize {
    let whole = outputs[0].len() / LANES * LANES;
    // (There is no third coordinate; what stands in its place is not read.)
    pipeline::sum(&Staged::<2>(&tables.corners), terms, [&x[..whole], &y[..whole], &y[..whole]], outputs)
}

/// The noise itself at a batch of points.
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn batch(
    tables: &Tables,
    x: &[f32; BATCH],
    y: &[f32; BATCH],
    z: &[f32; BATCH],
    values: &mut [f32; BATCH],
) {
    pipeline::batch(&Staged::<3>(&tables.corners), [x, y, z], values);
}

/// The noise at the first points, which are not in columns, a multiple of 8 of them; returns how many.
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn at_points(tables: &Tables, points: &[[f32; 3]], values: &mut [f32]) -> usize {
    pipeline::at_points(&Staged::<3>(&tables.corners), points, values)
}

/// Numbers of eight points. (Aligned, or vectors might straddle cache lines.)
#[derive(Clone, Copy)]
#[repr(align(32))]
struct Stage([u32; LANES]);

impl Stage {
    const EMPTY: Stage = Stage([0; LANES]);

    #[inline]
    #[target_feature(enable = "avx2")]
    fn put(&mut self, numbers: __m256i) {
        // SAFETY: there is room for eight.
        unsafe { _mm256_store_si256(self.0.as_mut_ptr().cast(), numbers) };
    }
}

/// The cells of eight points. (Those in the plane have the z 0.)
struct Cells {
    /// See [`corners::columns`]. Only [`Cells::find`] writes here.
    columns: Stage,
    z: Stage,
}

impl Cells {
    const EMPTY: Cells = Cells { columns: Stage::EMPTY, z: Stage::EMPTY };

    #[inline]
    #[target_feature(enable = "avx2")]
    fn find<const USE: u8, const D: usize>(&mut self, frequency: f32, point: Point<LANES>) {
        let mut cell = [_mm256_setzero_si256(); 3];
        for axis in 0..D {
            cell[axis] = _mm256_cvttps_epi32(_mm256_floor_ps(load::<USE>(point[axis], frequency).0));
        }
        let [x, y, z] = cell;
        self.columns.put(corners::columns(x, y));
        self.z.put(z);
    }
}

/// The kernel whose codes go through memory, in so many dimensions. It exists only where the machine has AVX2.
struct Staged<'a, const D: usize>(&'a CornerTables);

/// Codes in a ring.
const RING: usize = 8;

/// The cells of the latest step, and the codes of those before it.
struct Codes {
    cells: Cells,
    ring: [Stage; RING],
}

impl<const D: usize> Halves<LANES> for Staged<'_, D> {
    /// (By then, the codes have arrived in memory: eight numbers that were written one by one just before cannot be read as a vector.
    /// The first of these steps is that between finding cells and hashing them.)
    const LEAD: usize = 3;
    type Codes = Codes;

    #[inline(always)]
    fn room(&self) -> Codes {
        Codes { cells: Cells::EMPTY, ring: [Stage::EMPTY; RING] }
    }

    #[inline(always)]
    fn hash<const N: usize>(&self, frequency: f32, point: Point<LANES>, codes: &mut Codes, step: usize) {
        if step > 0 {
            self.complete::<N>(codes, step);
        }
        // SAFETY, here and below: the machine has AVX2.
        unsafe { codes.cells.find::<PLAIN, D>(frequency, point) };
    }

    #[inline(always)]
    fn complete<const N: usize>(&self, Codes { cells, ring }: &mut Codes, steps: usize) {
        hash_all::<N, D>(self.0, cells, &mut ring[(steps - 1) % RING]);
    }

    #[inline(always)]
    fn step<const USE: u8, const N: usize>(
        &self,
        octave: &Octave,
        point: Point<LANES>,
        mut sums: Sums<LANES, N>,
        Codes { cells, ring }: &mut Codes,
        step: usize,
        (frequency, later): (f32, Point<LANES>),
    ) {
        let current = ring[step % RING];
        let hashed = &mut ring[(step + Self::LEAD - 1) % RING];
        // (In the plane, where half of the corners is left, taking turns is slower: 3.2 ns a point instead of 1.8.)
        if N == 4 || D == 2 {
            hash_all::<N, D>(self.0, cells, hashed);
            unsafe { cells.find::<USE, D>(frequency, later) };
            return unsafe { add_vector::<USE, N, D>(&current, octave, point, &mut sums) };
        }
        let (codes, offset) = unsafe { locate::<USE>(&current, octave, point) };
        let value = blend(codes, offset, &mut Hashes { tables: self.0, cells, codes: hashed });
        unsafe { cells.find::<USE, D>(frequency, later) };
        pipeline::add::<F32x8, LANES, LANES, 3, N, USE>(octave, Dual { value, gradient: [value; 3] }, &mut sums, 0);
    }

    #[inline(always)]
    fn take_apart(points: &[[f32; 3]; LANES], [x, y, z]: &mut [[f32; LANES]; 3]) {
        triples::eight(&points.as_flattened().as_chunks().0.as_chunks().0[0], [x, y, z]);
    }

    #[inline(always)]
    fn finish<const USE: u8, const N: usize>(
        &self,
        octave: &Octave,
        point: Point<LANES>,
        mut sums: Sums<LANES, N>,
        codes: &Codes,
        step: usize,
    ) {
        unsafe { add_vector::<USE, N, D>(&codes.ring[step % RING], octave, point, &mut sums) };
    }
}

/// Eight coordinates, times the frequency; as they are where the octave is alone, since its frequency is 1.
#[inline(always)]
fn load<const USE: u8>(numbers: &[f32; LANES], frequency: f32) -> F32x8 {
    let numbers = F32x8::load(numbers);
    if USE == ALONE { numbers } else { numbers * F32x8::constant(f64::from(frequency)) }
}

/// The codes of eight points: for the noise alone in space the choices of edges, else the edges.
#[inline(always)]
fn hash_all<const N: usize, const D: usize>(tables: &CornerTables, cells: &Cells, codes: &mut Stage) {
    let of_columns = if N == 4 || D == 2 { &tables.edges } else { &tables.choices };
    for lane in 0..LANES {
        hash::<D>(tables, of_columns, cells, codes, lane);
    }
}

/// The codes of one of eight points.
#[inline(always)]
fn hash<const D: usize>(
    tables: &CornerTables,
    of_columns: &ColumnCodes,
    cells: &Cells,
    codes: &mut Stage,
    lane: usize,
) {
    let code: *mut u32 = &mut codes.0[lane];
    let z = if D == 2 { 0 } else { cells.z.0[lane] as u8 };
    // SAFETY: the columns are those of cells, and a reference may be written through. Volatile, or else the compiler makes
    // gathers of the reads.
    unsafe { code.write_volatile(corners::hash(tables, of_columns, cells.columns.0[lane], z)) };
}

/// What is done beside a blend.
trait Beside {
    /// Before this corner; returns the codes.
    fn before(&mut self, corner: usize, codes: I32x8) -> I32x8;
    /// After a part of the blend; returns it.
    fn after(&self, part: F32x8) -> F32x8;
}

/// Nothing.
struct Nothing;

impl Beside for Nothing {
    #[inline(always)]
    fn before(&mut self, _corner: usize, codes: I32x8) -> I32x8 {
        codes
    }
    #[inline(always)]
    fn after(&self, part: F32x8) -> F32x8 {
        part
    }
}

/// Eight points are hashed, one beside each corner: in larger pieces, one waits for the other.
struct Hashes<'a> {
    tables: &'a CornerTables,
    cells: &'a Cells,
    codes: &'a mut Stage,
}

impl Beside for Hashes<'_> {
    #[inline(always)]
    fn before(&mut self, corner: usize, codes: I32x8) -> I32x8 {
        hash::<3>(self.tables, &self.tables.choices, self.cells, self.codes, corner);
        // SAFETY, for both: the machine has AVX2.
        I32x8(unsafe { in_turn(codes.0) })
    }
    #[inline(always)]
    fn after(&self, part: F32x8) -> F32x8 {
        F32x8(unsafe { _mm256_castsi256_ps(in_turn(_mm256_castps_si256(part.0))) })
    }
}

/// The same vector, with what it is made from before and what is made from it after the instructions around. Left to itself, the
/// compiler puts all hashes in a row, and the machine, which looks a few hundred instructions ahead, does not find work for
/// all its units.
#[inline]
#[target_feature(enable = "avx2")]
fn in_turn(mut vector: __m256i) -> __m256i {
    // SAFETY: this is no instruction.
    unsafe { asm!("/* {0} */", inout(ymm_reg) vector, options(nomem, nostack, preserves_flags)) };
    vector
}

/// Adds one octave at eight points.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn add_vector<const USE: u8, const N: usize, const D: usize>(
    codes: &Stage,
    octave: &Octave,
    point: Point<LANES>,
    sums: &mut Sums<LANES, N>,
) {
    let (codes, offset) = locate::<USE>(codes, octave, point);
    if D == 2 {
        let [x, y, _] = offset;
        return pipeline::add_vector::<F32x8, LANES, LANES, 2, N, USE>(octave, by_corner(codes), [x, y], sums, 0);
    }
    if N == 4 {
        return pipeline::add_vector::<F32x8, LANES, LANES, 3, N, USE>(octave, by_corner(codes), offset, sums, 0);
    }
    let value = blend(codes, offset, &mut Nothing);
    pipeline::add::<F32x8, LANES, LANES, 3, N, USE>(octave, Dual { value, gradient: [value; 3] }, sums, 0);
}

/// The codes of eight points, and their offsets in their cells.
#[inline]
#[target_feature(enable = "avx2")]
fn locate<const USE: u8>(codes: &Stage, octave: &Octave, point: Point<LANES>) -> (I32x8, [F32x8; 3]) {
    // SAFETY: there are eight codes.
    let codes = I32x8(unsafe { _mm256_load_si256(codes.0.as_ptr().cast()) });
    let mut offset = [F32x8::constant(0.0); 3];
    for axis in 0..3 {
        let position = load::<USE>(point[axis], octave.frequency);
        offset[axis] = position - position.floor();
    }
    (codes, offset)
}

/// The noise, from the choices of the corners' edges and the offset in the cell.
#[inline(always)]
fn blend<B: Beside>(mut codes: I32x8, offset: [F32x8; 3], beside: &mut B) -> F32x8 {
    let [x, y, z] = Curve::quintic(&offset).at;
    let near = edge(&mut codes, 0, offset, x, beside);
    let low = lerp(y, beside.after(near), edge(&mut codes, 2, offset, x, beside));
    let low = beside.after(low);
    let near = edge(&mut codes, 4, offset, x, beside);
    lerp(z, low, lerp(y, beside.after(near), edge(&mut codes, 6, offset, x, beside)))
}

/// What two corners contribute that are neighbours along x: the one of this number (where bit 1 is that of y, bit 2 that of
/// z) and the next one.
#[inline(always)]
fn edge<B: Beside>(codes: &mut I32x8, first: usize, offset: [F32x8; 3], curve: F32x8, beside: &mut B) -> F32x8 {
    *codes = beside.before(first, *codes);
    // SAFETY, for both: the machine has AVX2.
    let left = beside.after(unsafe { corner(*codes, first, offset) });
    *codes = beside.before(first + 1, *codes);
    lerp(curve, left, unsafe { corner(*codes, first + 1, offset) })
}

/// What a corner contributes.
#[inline]
#[target_feature(enable = "avx2")]
fn corner(codes: I32x8, corner: usize, [x, y, z]: [F32x8; 3]) -> F32x8 {
    let (one, sign) = (F32x8::constant(1.0), _mm256_set1_ps(-0.0));
    let x = _mm256_or_ps(if corner & 1 == 0 { x } else { one - x }.0, sign);
    let y = if corner & 2 == 0 { y } else { one - y }.0;
    let z = _mm256_or_ps(if corner & 4 == 0 { z } else { one - z }.0, sign);
    F32x8(chosen(by_corner(codes)[corner].0, _mm256_xor_ps(x, y), y, _mm256_xor_ps(z, y)))
}

/// The codes of each corner, from all of them as [`corners::hash`] has them (where the highest bit is that of x).
#[inline(always)]
fn by_corner(codes: I32x8) -> Corners<I32x8> {
    let mut corners = [codes; 16];
    for (i, corner) in (0..8).zip(&mut corners) {
        *corner = codes.shift_right(16 * (i & 1) + 4 * (i & 2) + (i & 4));
    }
    corners
}
