//! Improved noise at one point: the eight corners of its cell in the lanes of one AVX2 vector.

use std::arch::x86_64::*;

use super::lines;
use crate::basis::Tables;
use crate::simd::Terms;

/// The noise at a point. Same bits as the generic evaluation. (The coordinates come one by one, in registers: reading them
/// as a vector, just after they were written one by one, would stall.)
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn improved(tables: &Tables, x: f32, y: f32, z: f32) -> f32 {
    noise(tables, x, y, z)
}

/// The sum at a point.
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn sum(tables: &Tables, terms: &Terms, x: f32, y: f32, z: f32) -> f32 {
    let (mut frequency, mut sum) = (1.0, 0.0);
    for octave in 0..terms.octaves {
        let scale = frequency as f32;
        let noise = noise(tables, x * scale, y * scale, z * scale);
        sum += terms.amplitude(octave) as f32 * if terms.absolute { noise.abs() } else { noise };
        frequency *= terms.lacunarity;
    }
    sum
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
