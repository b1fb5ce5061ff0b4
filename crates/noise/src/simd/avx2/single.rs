//! Improved noise at one point: the eight corners of its cell in the lanes of one AVX2 vector.

use std::arch::x86_64::*;

use super::{F32x8, I32x8, lines};
use crate::basis::Tables;
use crate::basis::improved::blend_codes;
use crate::number::Real;
use crate::simd::{Terms, Vector};

/// The noise at a point. Same bits as the generic evaluation. (The coordinates come one by one, in registers: reading them
/// as a vector, just after they were written one by one, would stall.)
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn improved(tables: &Tables, x: f32, y: f32, z: f32) -> f32 {
    noise(tables, x, y, z)
}

/// The sum at a point, with its octaves in the lanes.
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn sum(tables: &Tables, terms: &Terms, x: f32, y: f32, z: f32) -> f32 {
    let mut sum = 0.0;
    let mut rest = terms.octaves();
    for lanes in terms.lanes {
        if rest == 1 {
            let frequency = lanes.frequencies[0];
            let noise = noise(tables, x * frequency, y * frequency, z * frequency);
            return sum + lanes.amplitudes[0] * if terms.absolute { noise.abs() } else { noise };
        }
        let count = rest.min(8);
        let noises = octaves(tables, F32x8::load(&lanes.frequencies), count, [x, y, z]);
        let noises = if terms.absolute { noises.abs() } else { noises };
        let mut parts = [0.0; 8];
        (noises * F32x8::load(&lanes.amplitudes)).store(&mut parts);
        for part in &parts[..count] {
            sum += part;
        }
        rest -= count;
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
            tables.corners.hash([cells[0][lane] as u8, cells[1][lane] as u8, cells[2][lane] as u8]) as i32
        } else {
            0
        }
    };
    // (In registers: reading them as a vector, just after they were written one by one, would stall.)
    let low = _mm_setr_epi32(hash(0), hash(1), hash(2), hash(3));
    let high = if count > 4 { _mm_setr_epi32(hash(4), hash(5), hash(6), hash(7)) } else { _mm_setzero_si128() };
    let codes = I32x8(_mm256_set_m128i(high, low));
    blend_codes::<F32x8, 3, false>(super::improved::corners(codes), offset).value + F32x8::constant(0.0)
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn noise(tables: &Tables, x: f32, y: f32, z: f32) -> f32 {
    let position = _mm_setr_ps(x, y, z, 0.0);
    let floor = _mm_floor_ps(position);
    let cell = _mm_cvttps_epi32(floor);
    let offset = _mm_sub_ps(position, floor);
    let cell = [_mm_cvtsi128_si32(cell), _mm_extract_epi32::<1>(cell), _mm_extract_epi32::<2>(cell)];
    let codes = _mm256_set1_epi32(tables.corners.hash([cell[0] as u8, cell[1] as u8, cell[2] as u8]) as i32);
    let dots = dots(codes, offset);
    // Halve the corners axis by axis: x, y, z.
    let curve = fade(offset);
    let (left, right) = (_mm256_castps256_ps128(dots), _mm256_extractf128_ps::<1>(dots));
    let sides = lerp(_mm_permute_ps::<0x00>(curve), left, right);
    let edges = lerp(_mm_permute_ps::<0x55>(curve), sides, _mm_movehl_ps(sides, sides));
    let value = lerp(_mm_permute_ps::<0xaa>(curve), edges, _mm_movehdup_ps(edges));
    _mm_cvtss_f32(_mm_add_ps(value, _mm_setzero_ps()))
}

/// The gradients' parts at the corners, in the order of the codes: x changes last, z first.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn dots(codes: __m256i, offset: __m128) -> __m256 {
    let code = _mm256_srlv_epi32(codes, _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28));
    let sign = _mm256_sllv_epi32(codes, _mm256_setr_epi32(28, 24, 20, 16, 12, 8, 4, 0));
    let offset = _mm256_set_m128(offset, offset);
    let x = _mm256_sub_ps(_mm256_permute_ps::<0x00>(offset), _mm256_setr_ps(0., 0., 0., 0., 1., 1., 1., 1.));
    let y = _mm256_sub_ps(_mm256_permute_ps::<0x55>(offset), _mm256_setr_ps(0., 0., 1., 1., 0., 0., 1., 1.));
    let z = _mm256_sub_ps(_mm256_permute_ps::<0xaa>(offset), _mm256_setr_ps(0., 1., 0., 1., 0., 1., 0., 1.));
    let [line_x, line_y, line_z] = lines();
    // As in `F32x8::edge_dot`: the products are exact.
    let product = _mm256_mul_ps(_mm256_permutevar8x32_ps(line_z, code), z);
    let product = _mm256_fmadd_ps(_mm256_permutevar8x32_ps(line_y, code), y, product);
    let product = _mm256_fmadd_ps(_mm256_permutevar8x32_ps(line_x, code), x, product);
    _mm256_xor_ps(product, _mm256_and_ps(_mm256_castsi256_ps(sign), _mm256_set1_ps(-0.0)))
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
