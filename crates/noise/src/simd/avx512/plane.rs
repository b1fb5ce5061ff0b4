//! Improved noise in the plane for 64 points at a time: as [`super::improved`] in space, with half of the corners and, since one
//! table holds the codes of a column's entries, less than half of the look-ups.

use std::arch::x86_64::*;

use super::improved::{InRegisters, STEP, cells, load_table, lookup, offset};
use super::{F32x16, I32x16};
use crate::basis::Tables;
use crate::number::Integer;
use crate::simd::Terms;
use crate::simd::pipeline::{self, Octave, Point, Sums};

/// The sums (and gradients) at the first points (without terms: the noise itself), a multiple of 64 of them; returns how many.
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
pub(in crate::simd) fn sum<const N: usize>(
    tables: &Tables,
    terms: Option<&Terms>,
    [x, y]: [&[f32]; 2],
    outputs: [&mut [f32]; N],
) -> usize {
    let whole = outputs[0].len() / STEP * STEP;
    // (There is no third coordinate; what stands in its place is not read.)
    pipeline::sum(&InPlane(tables), terms, [&x[..whole], &y[..whole], &y[..whole]], outputs)
}

/// The kernel. It exists only where the machine has the instructions.
struct InPlane<'a>(&'a Tables);

impl InRegisters for InPlane<'_> {
    /// Of the columns at the lower and at the upper end along x: see [`Tables::plane`].
    type Codes = [__m512i; 2];
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
        mut sums: Sums<STEP, N>,
    ) {
        // (Written out, so that the shifts are by constants.)
        add_vector::<0, USE, N>(codes, octave, point, &mut sums);
        add_vector::<1, USE, N>(codes, octave, point, &mut sums);
        add_vector::<2, USE, N>(codes, octave, point, &mut sums);
        add_vector::<3, USE, N>(codes, octave, point, &mut sums);
    }

    #[inline(always)]
    fn take_apart(_: &[[f32; 3]; STEP], _: &mut [[f32; STEP]; 3]) {
        unreachable!("points of three coordinates do not lie in the plane");
    }
}

/// Adds one octave at sixteen of 64 points.
#[inline(always)]
fn add_vector<const GROUP: usize, const USE: u8, const N: usize>(
    codes: &[__m512i; 2],
    octave: &Octave,
    point: Point<STEP>,
    sums: &mut Sums<STEP, N>,
) {
    let bit = GROUP as u32 * 8;
    let mut corners = [I32x16(codes[0]); 16];
    for column in 0..2 {
        corners[column] = I32x16(codes[column]).shift_right(bit);
        corners[column + 2] = I32x16(codes[column]).shift_right(bit + 4);
    }
    let offset = offset::<USE, 2>(octave, point, GROUP);
    pipeline::add_vector::<F32x16, STEP, 16, 2, N, USE>(octave, corners, offset, sums, GROUP);
}

/// The codes of both columns of each cell. The byte `group` of the lane `i` belongs to the point 16 · group + i.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vbmi,avx512vbmi2")]
fn hash<const USE: u8>(tables: &Tables, frequency: f32, points: Point<STEP>) -> [__m512i; 2] {
    let (bytes, next) = (load_table(&tables.permutation.bytes), load_table(&tables.permutation.next));
    let codes = load_table(&tables.plane.bytes);
    let (x, y) = (cells::<USE>(points[0], frequency), cells::<USE>(points[1], frequency));
    let mask = _mm512_movepi8_mask(x);
    let left = _mm512_add_epi8(lookup(&bytes, x, mask), y);
    let right = _mm512_add_epi8(lookup(&next, x, mask), y);
    [lookup(&codes, left, _mm512_movepi8_mask(left)), lookup(&codes, right, _mm512_movepi8_mask(right))]
}
