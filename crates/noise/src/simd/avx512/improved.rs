//! Improved noise for 64 points at a time, with AVX-512 and its byte permutations.
//!
//! The 64 points' cells are packed into bytes, so that one look-up in the table (which lies in four registers) serves all.
//! Measured against the generic evaluation in vectors of sixteen, this and the order of [`crate::simd::pipeline`] take
//! half the time (`cargo run --release --example speed`).

use std::arch::x86_64::*;

use super::{F32x16, I32x16};
use crate::basis::Tables;
use crate::basis::corners::{Corners, Curve};
use crate::basis::improved::blend_dots;
use crate::number::{Integer, Real};
use crate::simd::pipeline::{self, ALONE, Halves, Octave, PLAIN, Point, Sums};
use crate::simd::{BATCH, Terms, Vector, triples};

/// Points that take part in one step.
pub(super) const STEP: usize = 64;

/// The sums (and gradients) at the first points (without terms: the noise itself), a multiple of 64 of them; returns how many.
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
pub(in crate::simd) fn sum<const N: usize>(
    tables: &Tables,
    terms: Option<&Terms>,
    [x, y, z]: [&[f32]; 3],
    outputs: [&mut [f32]; N],
) -> usize {
    let whole = outputs[0].len() / STEP * STEP;
    pipeline::sum(&InSpace(tables), terms, [&x[..whole], &y[..whole], &z[..whole]], outputs)
}

/// The noise itself at a batch of points.
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
pub(in crate::simd) fn batch(
    tables: &Tables,
    x: &[f32; BATCH],
    y: &[f32; BATCH],
    z: &[f32; BATCH],
    values: &mut [f32; BATCH],
) {
    pipeline::batch(&InSpace(tables), [x, y, z], values);
}

/// The noise at the first points, which are not in columns, a multiple of 64 of them; returns how many.
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
pub(in crate::simd) fn at_points(tables: &Tables, points: &[[f32; 3]], values: &mut [f32]) -> usize {
    pipeline::at_points(&InSpace(tables), points, values)
}

/// A kernel whose codes stay in registers, one step ahead. It exists only where the machine has the instructions.
pub(in crate::simd) trait InRegisters {
    /// The codes of a step.
    type Codes: Copy;
    /// Room for them.
    const EMPTY: Self::Codes;
    /// Hashes the cells of the points, times the frequency.
    fn codes<const USE: u8>(&self, frequency: f32, point: Point<STEP>) -> Self::Codes;
    /// Adds one octave at 64 points, whose cells are hashed already.
    fn add<const USE: u8, const N: usize>(
        codes: &Self::Codes,
        octave: &Octave,
        point: Point<STEP>,
        sums: Sums<STEP, N>,
    );
    /// [`InRegisters::add`] with nothing to do beside it while the hashes are on their way.
    #[inline(always)]
    fn add_last<const USE: u8, const N: usize>(
        codes: &Self::Codes,
        octave: &Octave,
        point: Point<STEP>,
        sums: Sums<STEP, N>,
    ) {
        Self::add::<USE, N>(codes, octave, point, sums);
    }
    /// As [`Halves::take_apart`].
    fn take_apart(points: &[[f32; 3]; STEP], coordinates: &mut [[f32; STEP]; 3]);
}

impl<K: InRegisters> Halves<STEP> for K {
    const LEAD: usize = 1;
    type Codes = K::Codes;

    #[inline(always)]
    fn room(&self) -> Self::Codes {
        K::EMPTY
    }

    #[inline(always)]
    fn hash<const N: usize>(&self, frequency: f32, point: Point<STEP>, codes: &mut Self::Codes, _step: usize) {
        *codes = self.codes::<PLAIN>(frequency, point);
    }

    #[inline(always)]
    fn step<const USE: u8, const N: usize>(
        &self,
        octave: &Octave,
        point: Point<STEP>,
        sums: Sums<STEP, N>,
        codes: &mut Self::Codes,
        _step: usize,
        (frequency, later): (f32, Point<STEP>),
    ) {
        let later = self.codes::<USE>(frequency, later);
        K::add::<USE, N>(codes, octave, point, sums);
        *codes = later;
    }

    #[inline(always)]
    fn complete<const N: usize>(&self, _codes: &mut Self::Codes, _steps: usize) {}

    #[inline(always)]
    fn finish<const USE: u8, const N: usize>(
        &self,
        octave: &Octave,
        point: Point<STEP>,
        sums: Sums<STEP, N>,
        codes: &Self::Codes,
        _step: usize,
    ) {
        K::add_last::<USE, N>(codes, octave, point, sums);
    }

    #[inline(always)]
    fn take_apart(points: &[[f32; 3]; STEP], coordinates: &mut [[f32; STEP]; 3]) {
        K::take_apart(points, coordinates);
    }
}

/// The kernel in space.
struct InSpace<'a>(&'a Tables);

impl InRegisters for InSpace<'_> {
    type Codes = [__m512i; 4];
    // SAFETY: these are numbers.
    const EMPTY: Self::Codes = unsafe { std::mem::zeroed() };

    #[inline(always)]
    fn codes<const USE: u8>(&self, frequency: f32, point: Point<STEP>) -> Self::Codes {
        // SAFETY: the machine has the instructions.
        unsafe { hash::<USE>(self.0, frequency, point) }
    }

    #[inline(always)]
    fn add<const USE: u8, const N: usize>(
        codes: &Self::Codes,
        octave: &Octave,
        point: Point<STEP>,
        sums: Sums<STEP, N>,
    ) {
        add_step::<USE, N>(codes, octave, point, sums);
    }

    #[inline(always)]
    fn add_last<const USE: u8, const N: usize>(
        codes: &Self::Codes,
        octave: &Octave,
        point: Point<STEP>,
        sums: Sums<STEP, N>,
    ) {
        if N == 4 {
            return add_step::<USE, N>(codes, octave, point, sums);
        }
        finish::<USE, N>(codes, octave, point, sums);
    }

    #[inline(always)]
    fn take_apart(points: &[[f32; 3]; STEP], [x, y, z]: &mut [[f32; STEP]; 3]) {
        let numbers = points.as_flattened().as_chunks().0.as_chunks().0;
        let (x, y, z) = (x.as_chunks_mut().0, y.as_chunks_mut().0, z.as_chunks_mut().0);
        for group in 0..STEP / 16 {
            triples::sixteen(&numbers[group], [&mut x[group], &mut y[group], &mut z[group]]);
        }
    }
}

#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn load_table(bytes: &[u8; 256]) -> [__m512i; 4] {
    let (quarters, _) = bytes.as_chunks::<64>();
    let mut registers = [_mm512_setzero_si512(); 4];
    for (register, quarter) in registers.iter_mut().zip(quarters) {
        // SAFETY: the quarter has the 64 bytes that are read.
        *register = unsafe { _mm512_loadu_si512(quarter.as_ptr().cast()) };
    }
    registers
}

/// Sixteen coordinates of 64, times the frequency; as they are where the octave is alone, since its frequency is 1.
#[inline(always)]
fn load<const USE: u8>(numbers: &[f32; STEP], group: usize, frequency: f32) -> F32x16 {
    let numbers = F32x16::load(&numbers.as_chunks().0[group]);
    if USE == ALONE { numbers } else { numbers * F32x16::constant(f64::from(frequency)) }
}

/// Adds one octave at 64 points, whose cells are hashed already.
#[inline(always)]
fn add_step<const USE: u8, const N: usize>(
    codes: &[__m512i; 4],
    octave: &Octave,
    point: Point<STEP>,
    mut sums: Sums<STEP, N>,
) {
    // (Written out, so that the shifts are by constants.)
    add_vector::<0, USE, N>(codes, octave, point, &mut sums);
    add_vector::<1, USE, N>(codes, octave, point, &mut sums);
    add_vector::<2, USE, N>(codes, octave, point, &mut sums);
    add_vector::<3, USE, N>(codes, octave, point, &mut sums);
}

/// [`add_step`] with nothing to do beside it while the hashes are on their way, but what needs no hash: so that is done for
/// all points first.
#[inline(always)]
fn finish<const USE: u8, const N: usize>(
    codes: &[__m512i; 4],
    octave: &Octave,
    point: Point<STEP>,
    mut sums: Sums<STEP, N>,
) {
    let ready = [
        place::<USE>(octave, point, 0),
        place::<USE>(octave, point, 1),
        place::<USE>(octave, point, 2),
        place::<USE>(octave, point, 3),
    ];
    // (In memory: they fill more registers than there are, and the compiler would rather work them out late.)
    let ready = std::hint::black_box(&ready);
    finish_vector::<0, USE, N>(codes, octave, &ready[0], &mut sums);
    finish_vector::<1, USE, N>(codes, octave, &ready[1], &mut sums);
    finish_vector::<2, USE, N>(codes, octave, &ready[2], &mut sums);
    finish_vector::<3, USE, N>(codes, octave, &ready[3], &mut sums);
}

/// The offsets of sixteen points in their cells, and their curves.
#[inline(always)]
fn place<const USE: u8>(octave: &Octave, point: Point<STEP>, group: usize) -> [[F32x16; 3]; 2] {
    let offset = offset::<USE, 3>(octave, point, group);
    [offset, Curve::quintic(&offset).at]
}

/// Adds one octave at sixteen of 64 points, whose offsets and curves are known.
#[inline(always)]
fn finish_vector<const GROUP: usize, const USE: u8, const N: usize>(
    codes: &[__m512i; 4],
    octave: &Octave,
    &[offset, curve]: &[[F32x16; 3]; 2],
    sums: &mut Sums<STEP, N>,
) {
    let curve = Curve { at: curve, slope: curve };
    let sample = blend_dots::<F32x16, 3, false>(corners::<GROUP>(codes), offset, &curve);
    pipeline::add::<F32x16, STEP, 16, 3, N, USE>(octave, sample, sums, GROUP);
}

/// Adds one octave at sixteen of 64 points.
#[inline(always)]
fn add_vector<const GROUP: usize, const USE: u8, const N: usize>(
    codes: &[__m512i; 4],
    octave: &Octave,
    point: Point<STEP>,
    sums: &mut Sums<STEP, N>,
) {
    let offset = offset::<USE, 3>(octave, point, GROUP);
    pipeline::add_vector::<F32x16, STEP, 16, 3, N, USE>(octave, corners::<GROUP>(codes), offset, sums, GROUP);
}

/// The codes of the corners at sixteen of 64 points. (Of each the low four bits count.)
#[inline(always)]
fn corners<const GROUP: usize>(codes: &[__m512i; 4]) -> Corners<I32x16> {
    let mut corners = [I32x16(codes[0]); 16];
    for column in 0..4 {
        // The bits of the code at the lower end, and of that at the upper end.
        let bit = GROUP as u32 * 8;
        corners[column] = I32x16(codes[column]).shift_right(bit);
        corners[column + 4] = I32x16(codes[column]).shift_right(bit + 4);
    }
    corners
}

/// The offsets in their cells of sixteen of 64 points, along the first `D` axes.
#[inline(always)]
pub(super) fn offset<const USE: u8, const D: usize>(octave: &Octave, point: Point<STEP>, group: usize) -> [F32x16; D] {
    let mut offset = [F32x16::constant(0.0); D];
    for axis in 0..D {
        let position = load::<USE>(point[axis], group, octave.frequency);
        offset[axis] = position - position.floor();
    }
    offset
}

/// The edge codes of the four columns over each cell. The byte `group` of the lane `i` belongs to the point
/// 16 · group + i; its low four bits are the code at the lower end, its high ones that at the upper end.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vbmi,avx512vbmi2")]
fn hash<const USE: u8>(tables: &Tables, frequency: f32, points: Point<STEP>) -> [__m512i; 4] {
    let (bytes, next) = (load_table(&tables.permutation.bytes), load_table(&tables.permutation.next));
    let edges = load_table(&tables.edges.bytes);
    let x = cells::<USE>(points[0], frequency);
    let y = cells::<USE>(points[1], frequency);
    let z = cells::<USE>(points[2], frequency);
    let mask = _mm512_movepi8_mask(x);
    let left = _mm512_add_epi8(lookup(&bytes, x, mask), y);
    let right = _mm512_add_epi8(lookup(&next, x, mask), y);
    let (left_mask, right_mask) = (_mm512_movepi8_mask(left), _mm512_movepi8_mask(right));
    let columns = [
        _mm512_add_epi8(lookup(&bytes, left, left_mask), z),
        _mm512_add_epi8(lookup(&bytes, right, right_mask), z),
        _mm512_add_epi8(lookup(&next, left, left_mask), z),
        _mm512_add_epi8(lookup(&next, right, right_mask), z),
    ];
    [
        lookup(&edges, columns[0], _mm512_movepi8_mask(columns[0])),
        lookup(&edges, columns[1], _mm512_movepi8_mask(columns[1])),
        lookup(&edges, columns[2], _mm512_movepi8_mask(columns[2])),
        lookup(&edges, columns[3], _mm512_movepi8_mask(columns[3])),
    ]
}

/// The low bytes of 64 cells: the byte `group` of the lane `i` belongs to the coordinate 16 · group + i.
#[inline]
#[target_feature(enable = "avx512f,avx512vbmi2")]
pub(super) fn cells<const USE: u8>(numbers: &[f32; STEP], frequency: f32) -> __m512i {
    let group = |group| {
        let numbers = load::<USE>(numbers, group, frequency).0;
        _mm512_cvt_roundps_epi32::<{ _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC }>(numbers)
    };
    // Each step shifts the bytes so far down, and one in at the top.
    let packed = _mm512_slli_epi32::<24>(group(0));
    let packed = _mm512_shrdi_epi32::<8>(packed, group(1));
    let packed = _mm512_shrdi_epi32::<8>(packed, group(2));
    _mm512_shrdi_epi32::<8>(packed, group(3))
}

/// The table's bytes at 64 indices; `mask` has their highest bits.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vbmi")]
pub(super) fn lookup(table: &[__m512i; 4], index: __m512i, mask: __mmask64) -> __m512i {
    let low = _mm512_permutex2var_epi8(table[0], index, table[1]);
    let high = _mm512_permutex2var_epi8(table[2], index, table[3]);
    _mm512_mask_blend_epi8(mask, low, high)
}
