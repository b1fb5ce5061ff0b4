//! Improved noise at one point: the corners of its cell, or the octaves of a sum, in the lanes of vectors.

use std::arch::asm;
use std::arch::x86_64::*;

use super::{EDGE_X, EDGE_Y, EDGE_Z, F32x16, I32x16};
use crate::basis::Tables;
use crate::basis::corners::lerp;
use crate::noise::Noise;
use crate::number::Real;
use crate::simd::avx2::F32x8;
use crate::simd::avx2::corners::column;
use crate::simd::avx2::single::{Cell, Octaves, curve, noise, point};
pub(in crate::simd) use crate::simd::avx2::single::{in_plane, in_space};
use crate::simd::{Lanes, Vector};
use crate::sum::Sum;

/// The noise at a point: as with AVX2, but that cells are found at once.
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
pub(in crate::simd) fn improved(of: &Noise, x: f32, y: f32, z: f32) -> f32 {
    let cell = Cell { column: column(lowest_byte(x), lowest_byte(y)), z: lowest_byte(z) };
    noise(&of.tables().corners, point(x, y, z), [cell]).first_lanes()[0]
}

/// The lowest byte of a coordinate's cell.
#[inline]
#[target_feature(enable = "avx512f")]
fn lowest_byte(coordinate: f32) -> u8 {
    _mm_cvt_roundss_i32::<{ _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC }>(_mm_set_ss(coordinate)) as u8
}

/// The sum at a point.
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
pub(in crate::simd) fn sum(of: &Sum, x: f32, y: f32, z: f32) -> f32 {
    add_octaves(0.0, of.noise().tables(), of.lanes(), x, y, z)
}

/// The sum and some octaves at a point, with eight in the lanes: in the lower eight lanes at the corners below the point, in the
/// upper eight at those above it. (A sum that began with 0 is never −0.)
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
fn add_octaves(mut sum: f32, tables: &Tables, octaves: &[Lanes], x: f32, y: f32, z: f32) -> f32 {
    let Some((lanes, others)) = octaves.split_first() else { return sum };
    let noises = noises(tables, &lanes.frequencies, [x, y, z]).masked(&lanes.mask);
    let mut parts = (noises * F32x8::load(&lanes.amplitudes)).register();
    // (At most eight: the compiler then makes no loop.)
    for _ in 0..lanes.count.min(8) {
        sum += _mm256_cvtss_f32(parts);
        parts = _mm256_permutevar8x32_ps(parts, _mm256_setr_epi32(1, 2, 3, 4, 5, 6, 7, 0));
    }
    if others.is_empty() { sum } else { add_others(sum, tables, others, x, y, z) }
}

/// Octaves after the first eight. (A loop would not do: before it, the compiler would put all constants into registers, of which
/// calls that overlap have too few.)
#[inline(never)]
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
fn add_others(sum: f32, tables: &Tables, octaves: &[Lanes], x: f32, y: f32, z: f32) -> f32 {
    add_octaves(sum, tables, octaves, x, y, z)
}

/// The noise at the point times each frequency.
#[inline]
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
fn noises(tables: &Tables, frequencies: &[f32; 8], [x, y, z]: [f32; 3]) -> F32x8 {
    // SAFETY: there are eight frequencies.
    let frequencies = F32x16(unsafe { _mm512_broadcast_f32x8(_mm256_loadu_ps(frequencies.as_ptr())) });
    let (x, y, z) = (F32x16::splat(x) * frequencies, F32x16::splat(y) * frequencies, F32x16::splat(z) * frequencies);
    let codes = hash(tables, [cell(x), cell(y), cell(z)]);
    let (x, y, z) = (x - x.floor(), y - y.floor(), z - z.floor());
    let one = F32x16::constant(1.0);
    let to_corner = F32x16(_mm512_sub_ps(z.0, _mm512_mask_blend_ps(0xff00, _mm512_setzero_ps(), one.0)));
    let (x1, y1) = (x - one, y - one);
    let (near, far) = (
        [dot(codes, x, y, to_corner), dot(_mm512_srli_epi32::<16>(codes), x, y1, to_corner)],
        [dot(_mm512_srli_epi32::<8>(codes), x1, y, to_corner), dot(_mm512_srli_epi32::<24>(codes), x1, y1, to_corner)],
    );
    // (Of x and y, eight lanes each, one vector.)
    let x_and_y = curve(F32x16(_mm512_insertf32x8::<1>(x.0, _mm512_castps512_ps256(y.0))), F32x16::load);
    let z = curve(F32x8::from_register(_mm512_castps512_ps256(z.0)), |numbers| {
        F32x8::load(numbers.first_chunk().expect("eight of sixteen"))
    });
    let x = F32x16(_mm512_shuffle_f32x4::<0b01_00_01_00>(x_and_y.0, x_and_y.0));
    let y = F32x16(_mm512_shuffle_f32x4::<0b11_10_11_10>(x_and_y.0, x_and_y.0));
    let ends = lerp(y, lerp(x, near[0], far[0]), lerp(x, near[1], far[1]));
    let (below, above) = (_mm512_castps512_ps256(ends.0), _mm512_extractf32x8_ps::<1>(ends.0));
    lerp(z, F32x8::from_register(below), F32x8::from_register(above))
}

/// [`Real::edge_dot`]. (The components are read where they are used: constants in registers would leave less room for calls that
/// overlap.)
#[inline]
#[target_feature(enable = "avx512f")]
fn dot(codes: __m512i, x: F32x16, y: F32x16, z: F32x16) -> F32x16 {
    let component = |components: &'static [f32; 16]| {
        let permuted;
        // SAFETY: there are sixteen.
        unsafe {
            asm!("vpermps {0}, {1}, zmmword ptr [{2}]", lateout(zmm_reg) permuted, in(zmm_reg) codes, in(reg) components,
                options(pure, readonly, nostack, preserves_flags));
        }
        F32x16(permuted)
    };
    static EDGES: Edges = Edges { x: EDGE_X, y: EDGE_Y, z: EDGE_Z };
    (component(&EDGES.z) * z).plus_exact(component(&EDGES.y), y).plus_exact(component(&EDGES.x), x)
}

/// The components of the edge directions.
#[repr(C, align(64))]
struct Edges {
    x: [f32; 16],
    y: [f32; 16],
    z: [f32; 16],
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
fn hash(tables: &Tables, [x, y, z]: [__m512i; 3]) -> __m512i {
    let bytes = _mm512_broadcast_i32x4(_mm_setr_epi8(0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12));
    let (x, y, z) = (_mm512_shuffle_epi8(x, bytes), _mm512_shuffle_epi8(y, bytes), _mm512_shuffle_epi8(z, bytes));
    let x = _mm512_add_epi8(x, _mm512_set1_epi32(0x01_00_01_00));
    let y = _mm512_add_epi8(y, _mm512_set1_epi32(0x01_01_00_00));
    let z = _mm512_add_epi8(z, _mm512_mask_blend_epi32(0xff00, _mm512_setzero_si512(), _mm512_set1_epi8(1)));
    let sides = I32x16(x).permuted(&tables.permutation.bytes);
    let columns = I32x16(_mm512_add_epi8(sides.0, y)).permuted(&tables.permutation.bytes);
    I32x16(_mm512_add_epi8(columns.0, z)).permuted(&tables.edges.bytes).0
}
