//! Improved noise at one point: the eight corners of its cell in the lanes of one AVX2 vector.

use std::arch::x86_64::*;

use super::{F32x8, I32x8, chosen};
use crate::basis::Tables;
use crate::number::Real;
use crate::simd::{LaneTerms, Vector};

/// The noise at a point. (The coordinates come one by one, in registers: reading them as a vector, just after they were
/// written one by one, would stall.)
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn improved(tables: &Tables, x: f32, y: f32, z: f32) -> f32 {
    noise(tables, x, y, z)
}

/// The same, to be compiled for more instructions too.
#[inline]
#[target_feature(enable = "avx2")]
pub(in crate::simd) fn noise(tables: &Tables, x: f32, y: f32, z: f32) -> f32 {
    let (codes, offset) = locate(tables, x, y, z);
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

/// The sum and the first lanes' noises, times their amplitudes, one after the other.
#[inline]
#[target_feature(enable = "avx2")]
pub(in crate::simd) fn add_lanes(mut sum: f32, noises: F32x8, amplitudes: F32x8, absolute: bool, count: usize) -> f32 {
    let noises = if absolute { noises.abs() } else { noises };
    let mut parts = [0.0; 8];
    (noises * amplitudes).store(&mut parts);
    for part in &parts[..count] {
        sum += part;
    }
    sum
}

/// The noise at the point times each frequency, of which `count` are in use.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn octaves(tables: &Tables, frequencies: F32x8, count: usize, point: [f32; 3]) -> F32x8 {
    let mut offset = [frequencies; 3];
    let mut cells = [[0u32; 8]; 3];
    for axis in 0..3 {
        let position = F32x8::splat(point[axis]) * frequencies;
        let floor = position.floor();
        offset[axis] = position - floor;
        // SAFETY: there is room for eight.
        unsafe { _mm256_storeu_si256(cells[axis].as_mut_ptr().cast(), floor.to_int().0) };
    }
    let hash = |lane: usize| {
        if lane < count {
            tables
                .corners
                .hash(&tables.corners.choices, [cells[0][lane] as u8, cells[1][lane] as u8, cells[2][lane] as u8])
                as i32
        } else {
            0
        }
    };
    // (In registers: reading them as a vector, just after they were written one by one, would stall.)
    let low = _mm_setr_epi32(hash(0), hash(1), hash(2), hash(3));
    let high = if count > 4 { _mm_setr_epi32(hash(4), hash(5), hash(6), hash(7)) } else { _mm_setzero_si128() };
    let codes = I32x8(_mm256_set_m128i(high, low));
    super::improved::blend(codes, offset) + F32x8::constant(0.0)
}

/// The codes of the cell's corners in every lane, and the point's offset in the cell.
#[inline]
#[target_feature(enable = "avx2")]
fn locate(tables: &Tables, x: f32, y: f32, z: f32) -> (__m256i, __m128) {
    let position = _mm_setr_ps(x, y, z, 0.0);
    let floor = _mm_floor_ps(position);
    let cell = _mm_cvttps_epi32(floor);
    let cell = [_mm_cvtsi128_si32(cell), _mm_extract_epi32::<1>(cell), _mm_extract_epi32::<2>(cell)];
    let codes = tables.corners.hash(&tables.corners.choices, [cell[0] as u8, cell[1] as u8, cell[2] as u8]);
    (_mm256_set1_epi32(codes as i32), _mm_sub_ps(position, floor))
}

/// The noise from the gradients' parts at the corners: they are halved axis by axis, x, y, z.
#[inline]
#[target_feature(enable = "avx2")]
fn blend(dots: __m256, offset: __m128) -> f32 {
    let curve = fade(offset);
    let (left, right) = (_mm256_castps256_ps128(dots), _mm256_extractf128_ps::<1>(dots));
    let sides = lerp(_mm_permute_ps::<0x00>(curve), left, right);
    let edges = lerp(_mm_permute_ps::<0x55>(curve), sides, _mm_movehl_ps(sides, sides));
    let value = lerp(_mm_permute_ps::<0xaa>(curve), edges, _mm_movehdup_ps(edges));
    _mm_cvtss_f32(_mm_add_ps(value, _mm_setzero_ps()))
}

/// What the corners contribute, in the order of the codes: x changes last, z first.
#[inline]
#[target_feature(enable = "avx2")]
fn dots(codes: __m256i, offset: __m128) -> __m256 {
    let (offset, sign) = (_mm256_set_m128(offset, offset), _mm256_set1_ps(-0.0));
    let x = _mm256_sub_ps(_mm256_permute_ps::<0x00>(offset), _mm256_setr_ps(0., 0., 0., 0., 1., 1., 1., 1.));
    let y = _mm256_sub_ps(_mm256_permute_ps::<0x55>(offset), _mm256_setr_ps(0., 0., 1., 1., 0., 0., 1., 1.));
    let z = _mm256_sub_ps(_mm256_permute_ps::<0xaa>(offset), _mm256_setr_ps(0., 1., 0., 1., 0., 1., 0., 1.));
    let (x, y, z) = (_mm256_or_ps(x, sign), _mm256_andnot_ps(sign, y), _mm256_or_ps(z, sign));
    let code = _mm256_srlv_epi32(codes, _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28));
    chosen(code, _mm256_xor_ps(x, y), y, _mm256_xor_ps(z, y))
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
