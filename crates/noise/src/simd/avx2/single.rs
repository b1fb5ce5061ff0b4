//! Improved noise at one point: the eight corners of its cell in the lanes of one AVX2 vector.

use std::arch::x86_64::*;

use super::improved::{Nothing, blend as blend_octaves};
use super::{F32x8, I32x8, corners};
use crate::basis::Tables;
use crate::number::Real;
use crate::simd::{LaneTerms, Vector};
use crate::table::CornerTables;

/// The noise at a point. (The coordinates come one by one, in registers: reading them as a vector, just after they were
/// written one by one, would stall.)
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn improved(tables: &Tables, x: f32, y: f32, z: f32) -> f32 {
    let position = position(x, y, z);
    noise(&tables.corners, position, _mm_cvttps_epi32(_mm_floor_ps(position)))
}

/// A point's coordinates along z, y, x, so that what is blended last comes first.
#[inline]
#[target_feature(enable = "avx2")]
pub(in crate::simd) fn position(x: f32, y: f32, z: f32) -> __m128 {
    _mm_setr_ps(z, y, x, 0.0)
}

/// The noise at a point whose cell is known. (Cell and offset are found apart: everything else waits for the cell.)
#[inline]
#[target_feature(enable = "avx2")]
pub(in crate::simd) fn noise(tables: &CornerTables, position: __m128, cell: __m128i) -> f32 {
    let (column, z) = corners::column(cell);
    // SAFETY: the column is that of a cell.
    let codes = unsafe { corners::hash(tables, &tables.parts, column, z) };
    let offset = _mm_sub_ps(position, _mm_floor_ps(position));
    blend(dots(codes, offset), offset)
}

/// The sum at a point, with its octaves in the lanes.
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn sum(tables: &Tables, terms: &LaneTerms, x: f32, y: f32, z: f32) -> f32 {
    let mut sum = 0.0;
    let mut rest = terms.octaves;
    for lanes in &terms.lanes {
        let count = rest.min(8);
        let noises = octaves(tables, F32x8::load(&lanes.frequencies), count, [x, y, z]);
        sum = add_lanes(sum, noises, F32x8::load(&lanes.amplitudes), terms.absolute, count);
        rest -= count;
    }
    sum
}

/// The sum and the first lanes' noises, times their amplitudes, one after the other. (A sum that began with 0 is never −0.)
#[inline]
#[target_feature(enable = "avx2")]
pub(in crate::simd) fn add_lanes(mut sum: f32, noises: F32x8, amplitudes: F32x8, absolute: bool, count: usize) -> f32 {
    let noises = if absolute { noises.abs() } else { noises };
    let mut parts = (noises * amplitudes).0;
    for _ in 0..count {
        sum += _mm256_cvtss_f32(parts);
        parts = _mm256_permutevar8x32_ps(parts, _mm256_setr_epi32(1, 2, 3, 4, 5, 6, 7, 0));
    }
    sum
}

/// The noise at the point times each frequency, of which `count` are in use.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn octaves(tables: &Tables, frequencies: F32x8, count: usize, point: [f32; 3]) -> F32x8 {
    let mut offset = [frequencies; 3];
    let mut cells = [_mm256_setzero_si256(); 3];
    for axis in 0..3 {
        let position = F32x8::splat(point[axis]) * frequencies;
        let floor = position.floor();
        offset[axis] = position - floor;
        cells[axis] = floor.to_int().0;
    }
    let [x, y, z] = cells;
    let (mut columns, mut ends) = ([0u32; 8], [0u32; 8]);
    // SAFETY: there is room for eight.
    unsafe {
        _mm256_storeu_si256(columns.as_mut_ptr().cast(), corners::columns(x, y));
        _mm256_storeu_si256(ends.as_mut_ptr().cast(), z);
    }
    let tables = &tables.corners;
    let hash = |lane: usize| {
        if lane < count {
            // SAFETY: the columns are those of cells.
            unsafe { corners::hash(tables, &tables.choices, columns[lane], ends[lane] as u8) as i32 }
        } else {
            0
        }
    };
    // (In registers: reading them as a vector, just after they were written one by one, would stall.)
    let low = _mm_setr_epi32(hash(0), hash(1), hash(2), hash(3));
    let high = if count > 4 { _mm_setr_epi32(hash(4), hash(5), hash(6), hash(7)) } else { _mm_setzero_si128() };
    let codes = I32x8(_mm256_set_m128i(high, low));
    blend_octaves(codes, offset, &mut Nothing)
}

/// The noise from the gradients' parts at the corners: they are halved axis by axis, x, y, z.
#[inline]
#[target_feature(enable = "avx2")]
fn blend(dots: __m256, offset: __m128) -> f32 {
    let curve = fade(offset);
    let (left, right) = (_mm256_castps256_ps128(dots), _mm256_extractf128_ps::<1>(dots));
    let sides = lerp(_mm_permute_ps::<0xaa>(curve), left, right);
    let edges = lerp(_mm_movehdup_ps(curve), sides, _mm_movehl_ps(sides, sides));
    _mm_cvtss_f32(lerp(curve, edges, _mm_movehdup_ps(edges)))
}

/// What the corners contribute: each adds one of eight numbers, offsets along x and y, to one of eight others, along z and y. (None of
/// them is −0, and so the noise is not.)
#[inline]
#[target_feature(enable = "avx2")]
fn dots(codes: u64, offset: __m128) -> __m256 {
    let upper = _mm_sub_ps(offset, _mm_set1_ps(1.0));
    let z_and_y = _mm_unpacklo_ps(offset, upper);
    let x_and_y = _mm_shuffle_ps::<0xe4>(_mm_unpackhi_ps(offset, upper), z_and_y);
    let both_signs = |offsets| _mm256_set_m128(_mm_sub_ps(_mm_setzero_ps(), offsets), offsets);
    let first = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(codes as i64));
    let second = _mm256_srli_epi32::<4>(first);
    _mm256_add_ps(
        _mm256_permutevar8x32_ps(both_signs(x_and_y), first),
        _mm256_permutevar8x32_ps(both_signs(z_and_y), second),
    )
}

#[inline]
#[target_feature(enable = "avx2")]
fn fade(t: __m128) -> __m128 {
    let inner = _mm_sub_ps(_mm_mul_ps(t, _mm_set1_ps(6.0)), _mm_set1_ps(15.0));
    let outer = _mm_add_ps(_mm_mul_ps(t, inner), _mm_set1_ps(10.0));
    _mm_mul_ps(_mm_mul_ps(_mm_mul_ps(t, t), t), outer)
}

#[inline]
#[target_feature(enable = "avx2")]
fn lerp(t: __m128, a: __m128, b: __m128) -> __m128 {
    _mm_add_ps(a, _mm_mul_ps(t, _mm_sub_ps(b, a)))
}
