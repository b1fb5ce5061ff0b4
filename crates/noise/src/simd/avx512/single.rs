//! Improved noise at one point: the corners of its cell, or the octaves of a sum, in eight lanes.

use std::arch::x86_64::*;

use super::{F32x16, I32x16};
use crate::basis::Tables;
use crate::basis::corners::Curve;
use crate::number::{Integer, Real};
use crate::simd::avx2::F32x8;
use crate::simd::avx2::single::{add_lanes, noise, position};
use crate::simd::{LaneTerms, Vector};

/// The noise at a point: as with AVX2, but that the cell is found at once.
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
pub(in crate::simd) fn improved(tables: &Tables, x: f32, y: f32, z: f32) -> f32 {
    let position = position(x, y, z);
    let cell = cell(F32x16(_mm512_castps128_ps512(position)));
    noise(&tables.corners, position, _mm512_castsi512_si128(cell))
}

/// The sum at a point, with up to eight octaves in the lanes: in the lower eight lanes at the corners below the point, in the
/// upper eight at those above it.
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
pub(in crate::simd) fn sum(tables: &Tables, terms: &LaneTerms, x: f32, y: f32, z: f32) -> f32 {
    let mut sum = 0.0;
    let mut rest = terms.octaves;
    for lanes in &terms.lanes {
        let count = rest.min(8);
        let noises = octaves(tables, &lanes.frequencies, [x, y, z]);
        sum = add_lanes(sum, noises, F32x8::load(&lanes.amplitudes), terms.absolute, count);
        rest -= count;
    }
    sum
}

/// The noise at the point times each frequency.
#[inline]
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
fn octaves(tables: &Tables, frequencies: &[f32; 8], [x, y, z]: [f32; 3]) -> F32x8 {
    // SAFETY: there are eight frequencies.
    let frequencies = F32x16(unsafe { _mm512_broadcast_f32x8(_mm256_loadu_ps(frequencies.as_ptr())) });
    let (x, y, z) = (F32x16::splat(x) * frequencies, F32x16::splat(y) * frequencies, F32x16::splat(z) * frequencies);
    let codes = hash(tables, [cell(x), cell(y), cell(z)]);
    let (x, y, z) = (x - x.floor(), y - y.floor(), z - z.floor());
    let one = F32x16::constant(1.0);
    let to_corner = F32x16(_mm512_sub_ps(z.0, _mm512_mask_blend_ps(0xff00, _mm512_setzero_ps(), one.0)));
    let (x1, y1) = (x - one, y - one);
    let (near, far) = (
        [F32x16::edge_dot(codes, x, y, to_corner), F32x16::edge_dot(codes.shift_right(16), x, y1, to_corner)],
        [
            F32x16::edge_dot(codes.shift_right(8), x1, y, to_corner),
            F32x16::edge_dot(codes.shift_right(24), x1, y1, to_corner),
        ],
    );
    let curve = Curve::quintic(&[x, y, z]).at;
    let rows = [lerp(curve[0], near[0], far[0]), lerp(curve[0], near[1], far[1])];
    let ends = lerp(curve[1], rows[0], rows[1]);
    let (below, above) = (_mm512_castps512_ps256(ends.0), _mm512_extractf32x8_ps::<1>(ends.0));
    let curve = _mm512_castps512_ps256(curve[2].0);
    lerp(F32x8::from_lanes(curve), F32x8::from_lanes(below), F32x8::from_lanes(above))
}

#[inline(always)]
fn lerp<R: Real>(t: R, a: R, b: R) -> R {
    a + t * (b - a)
}

/// The cells of sixteen coordinates.
#[inline]
#[target_feature(enable = "avx512f")]
fn cell(position: F32x16) -> __m512i {
    _mm512_cvt_roundps_epi32::<{ _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC }>(position.0)
}

/// The edge codes of four corners per lane, a byte each: from the lowest on (0, 0), (1, 0), (0, 1), (1, 1) along x and y.
/// Of a byte the low four bits count.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vbmi")]
fn hash(tables: &Tables, [x, y, z]: [__m512i; 3]) -> I32x16 {
    let bytes = _mm512_broadcast_i32x4(_mm_setr_epi8(0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12));
    let (x, y, z) = (_mm512_shuffle_epi8(x, bytes), _mm512_shuffle_epi8(y, bytes), _mm512_shuffle_epi8(z, bytes));
    let x = _mm512_add_epi8(x, _mm512_set1_epi32(0x01_00_01_00));
    let y = _mm512_add_epi8(y, _mm512_set1_epi32(0x01_01_00_00));
    let z = _mm512_add_epi8(z, _mm512_mask_blend_epi32(0xff00, _mm512_setzero_si512(), _mm512_set1_epi8(1)));
    let sides = I32x16(x).permuted(&tables.permutation.bytes);
    let columns = I32x16(_mm512_add_epi8(sides.0, y)).permuted(&tables.permutation.bytes);
    I32x16(_mm512_add_epi8(columns.0, z)).permuted(&tables.edges.bytes)
}
