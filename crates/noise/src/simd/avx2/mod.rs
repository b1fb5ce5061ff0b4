//! Eight lanes: AVX2 and FMA. Tables are read by gathers.

pub(super) mod corners;
pub(super) mod improved;
pub(super) mod single;

use std::arch::x86_64::*;
use std::ops::{Neg, Not};

use super::{Vector, operators};
use crate::number::{Integer, Mask, Real};
use crate::table::{ByteTable, FloatTable, PairTable};

// SAFETY, for all `unsafe` blocks of this file: these types are private to `simd`, and values of them arise only in
// functions entered after the machine was found to have AVX2 and FMA.

/// Eight numbers.
#[derive(Clone, Copy)]
pub(in crate::simd) struct F32x8(__m256);
/// Eight integers.
#[derive(Clone, Copy)]
pub(in crate::simd) struct I32x8(__m256i);
/// All bits of a lane, or none.
#[derive(Clone, Copy)]
pub(super) struct M32x8(__m256);

operators! { F32x8: Add add _mm256_add_ps; Sub sub _mm256_sub_ps; Mul mul _mm256_mul_ps; Div div _mm256_div_ps; }
operators! { I32x8: Add add _mm256_add_epi32; Sub sub _mm256_sub_epi32; Mul mul _mm256_mullo_epi32; }
operators! { I32x8: BitAnd bitand _mm256_and_si256; BitOr bitor _mm256_or_si256; BitXor bitxor _mm256_xor_si256; }
operators! { M32x8: BitAnd bitand _mm256_and_ps; BitOr bitor _mm256_or_ps; }

impl Not for M32x8 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        M32x8(unsafe { _mm256_xor_ps(self.0, _mm256_castsi256_ps(_mm256_set1_epi32(-1))) })
    }
}

impl Neg for F32x8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        F32x8(unsafe { _mm256_xor_ps(self.0, _mm256_set1_ps(-0.0)) })
    }
}

impl Mask for M32x8 {}

impl I32x8 {
    /// The table's words at the low eight bits of each lane.
    #[inline(always)]
    fn gather(self, words: &[i32; 256]) -> Self {
        // The masked index lies within the table.
        I32x8(unsafe { _mm256_i32gather_epi32::<4>(words.as_ptr(), (self & Self::constant(255)).0) })
    }
}

impl Integer for I32x8 {
    type Mask = M32x8;
    #[inline(always)]
    fn constant(value: i32) -> Self {
        I32x8(unsafe { _mm256_set1_epi32(value) })
    }
    #[inline(always)]
    fn shift_left(self, count: u32) -> Self {
        I32x8(unsafe { _mm256_sll_epi32(self.0, _mm_cvtsi32_si128(count as i32)) })
    }
    #[inline(always)]
    fn shift_right(self, count: u32) -> Self {
        I32x8(unsafe { _mm256_srl_epi32(self.0, _mm_cvtsi32_si128(count as i32)) })
    }
    #[inline(always)]
    fn equals(self, other: Self) -> M32x8 {
        M32x8(unsafe { _mm256_castsi256_ps(_mm256_cmpeq_epi32(self.0, other.0)) })
    }
}

impl Real for F32x8 {
    type Int = I32x8;
    type Mask = M32x8;
    const DOUBLE: bool = false;
    const SCALAR: bool = false;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        F32x8(unsafe { _mm256_set1_ps(value as f32) })
    }
    #[inline(always)]
    fn floor(self) -> Self {
        F32x8(unsafe { _mm256_floor_ps(self.0) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        F32x8(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        F32x8(unsafe { _mm256_sqrt_ps(self.0) })
    }
    #[inline(always)]
    fn less(self, other: Self) -> M32x8 {
        M32x8(unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: M32x8, yes: Self, no: Self) -> Self {
        F32x8(unsafe { _mm256_blendv_ps(no.0, yes.0, mask.0) })
    }
    #[inline(always)]
    fn select_int(mask: M32x8, yes: I32x8, no: I32x8) -> I32x8 {
        I32x8(unsafe { _mm256_blendv_epi8(no.0, yes.0, _mm256_castps_si256(mask.0)) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        F32x8(unsafe { _mm256_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        F32x8(unsafe { _mm256_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn to_int(self) -> I32x8 {
        I32x8(unsafe { _mm256_cvttps_epi32(self.0) })
    }
    #[inline(always)]
    fn from_int(value: I32x8) -> Self {
        F32x8(unsafe { _mm256_cvtepi32_ps(value.0) })
    }
    #[inline(always)]
    fn times_power_of_two(self, exponent: I32x8) -> Self {
        let bits = (exponent + I32x8::constant(127)).shift_left(23);
        self * F32x8(unsafe { _mm256_castsi256_ps(bits.0) })
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        let bits = I32x8(unsafe { _mm256_castps_si256(self.0) });
        let mantissa = bits & I32x8::constant(0x7f_ffff) | I32x8::constant(127 << 23);
        let exponent = Self::from_int(bits.shift_right(23) - I32x8::constant(127));
        (F32x8(unsafe { _mm256_castsi256_ps(mantissa.0) }), exponent)
    }
    #[inline(always)]
    fn lookup(table: &ByteTable, index: I32x8) -> I32x8 {
        index.gather(&table.words)
    }
    #[inline(always)]
    fn lookup_pair(table: &PairTable, index: I32x8) -> (I32x8, I32x8) {
        let pairs = index.gather(&table.pairs);
        (pairs, pairs.shift_right(8))
    }
    #[inline(always)]
    fn pick(table: &FloatTable, index: I32x8) -> Self {
        let index = index & I32x8::constant(255);
        // The masked index lies within the table.
        F32x8(unsafe { _mm256_i32gather_ps::<4>(table.singles.as_ptr(), index.0) })
    }

    /// The components come from tables in registers. Their products with 0, 1 and −1 are exact, and so is fusing them
    /// with the addition.
    #[inline(always)]
    fn edge_dot(code: I32x8, x: Self, y: Self, z: Self) -> Self {
        unsafe {
            let [line_x, line_y, line_z] = lines();
            let product = _mm256_mul_ps(_mm256_permutevar8x32_ps(line_z, code.0), z.0);
            let product = _mm256_fmadd_ps(_mm256_permutevar8x32_ps(line_y, code.0), y.0, product);
            F32x8(_mm256_fmadd_ps(_mm256_permutevar8x32_ps(line_x, code.0), x.0, product)).negated_by(code)
        }
    }
    #[inline(always)]
    fn plus_exact(self, a: Self, b: Self) -> Self {
        F32x8(unsafe { _mm256_fmadd_ps(a.0, b.0, self.0) })
    }
    /// The sign is that of the whole; the movements come from a table too.
    #[inline(always)]
    fn tetrahedron_dot<const STEP: i32>(
        code: I32x8,
        [x, y, z]: [Self; 3],
        shift: f64,
        [is_z, rising]: [M32x8; 2],
    ) -> Self {
        let [line_x, line_y, line_z] = Self::line(code);
        // (Lines with an even code have the sum 2, the others 0.)
        let moves = F32x8(unsafe { _mm256_setr_ps(2.0, 0.0, 2.0, 0.0, 2.0, 0.0, 2.0, 0.0) }) * Self::constant(shift);
        let moved = F32x8(unsafe { _mm256_permutevar_ps(moves.0, code.0) });
        let along_z = if shift == 0.0 { line_z * z } else { moved.plus_exact(line_z, z) };
        let dot = along_z.plus_exact(line_y, y).plus_exact(line_x, x);
        let (larger, smaller) = (Self::select(rising, line_y, line_x), Self::select(rising, line_x, line_y));
        let dot = match STEP {
            0 => dot,
            1 => dot + Self::select(is_z, line_z, smaller),
            _ => dot - Self::select(is_z, line_z, larger),
        };
        dot.negated_by(code)
    }
    #[inline(always)]
    fn edge(code: I32x8) -> [Self; 3] {
        let [x, y, z] = Self::line(code);
        [x.negated_by(code), y.negated_by(code), z.negated_by(code)]
    }
    #[inline(always)]
    fn edge_dot_plane(code: I32x8, x: Self, y: Self) -> Self {
        unsafe {
            let [line_x, line_y, _] = lines();
            let product = _mm256_mul_ps(_mm256_permutevar8x32_ps(line_y, code.0), y.0);
            F32x8(_mm256_fmadd_ps(_mm256_permutevar8x32_ps(line_x, code.0), x.0, product)).negated_by(code)
        }
    }
}

/// The sum of an edge's two components at the offset from a corner, by their choices in the low four bits of `code`: see
/// `choice_code` in `table.rs`. The offset has the lengths `y` (sign clear) and, negative, `x` and `z`, of which `x_or_y` and
/// `z_or_y` hold the differing bits. (A bit for the sign: where x is negative and y is not, it says which sign is taken.)
#[inline]
#[target_feature(enable = "avx2")]
fn chosen(code: __m256i, x_or_y: __m256, y: __m256, z_or_y: __m256) -> __m256 {
    let words = _mm256_castsi256_ps(_mm256_setr_epi32(0, i32::MAX, i32::MIN, -1, 0, i32::MAX, i32::MIN, -1));
    let first = _mm256_permutevar_ps(words, code);
    let second = _mm256_permutevar_ps(words, _mm256_srli_epi32::<2>(code));
    let first = _mm256_xor_ps(_mm256_and_ps(x_or_y, first), y);
    _mm256_add_ps(first, _mm256_xor_ps(_mm256_and_ps(z_or_y, second), y))
}

/// The components of the edge directions by the low three bits of their codes: see [`Real::edge_dot`].
#[inline]
#[target_feature(enable = "avx2")]
fn lines() -> [__m256; 3] {
    [
        _mm256_setr_ps(1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0),
        _mm256_setr_ps(1.0, -1.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0),
        _mm256_setr_ps(0.0, 0.0, 1.0, -1.0, 1.0, -1.0, 0.0, -1.0),
    ]
}

impl F32x8 {
    /// From the machine's register.
    #[inline(always)]
    pub fn from_register(register: __m256) -> Self {
        F32x8(register)
    }

    /// The machine's register.
    #[inline(always)]
    pub fn register(self) -> __m256 {
        self.0
    }

    /// The components of the edge's line, by the low three bits of its code.
    #[inline(always)]
    fn line(code: I32x8) -> [Self; 3] {
        unsafe {
            let [x, y, z] = lines();
            [
                F32x8(_mm256_permutevar8x32_ps(x, code.0)),
                F32x8(_mm256_permutevar8x32_ps(y, code.0)),
                F32x8(_mm256_permutevar8x32_ps(z, code.0)),
            ]
        }
    }

    /// Negated where bit 3 of `code` is set.
    #[inline(always)]
    fn negated_by(self, code: I32x8) -> Self {
        let sign = code.shift_left(28) & I32x8::constant(i32::MIN);
        F32x8(unsafe { _mm256_xor_ps(self.0, _mm256_castsi256_ps(sign.0)) })
    }
}

impl Vector<8> for F32x8 {
    #[inline(always)]
    fn load(lanes: &[f32; 8]) -> Self {
        F32x8(unsafe { _mm256_loadu_ps(lanes.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, lanes: &mut [f32; 8]) {
        unsafe { _mm256_storeu_ps(lanes.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn splat(value: f32) -> Self {
        F32x8(unsafe { _mm256_set1_ps(value) })
    }
    #[inline(always)]
    fn load_int(lanes: &[i32; 8]) -> I32x8 {
        I32x8(unsafe { _mm256_loadu_si256(lanes.as_ptr().cast()) })
    }
    #[inline(always)]
    fn store_int(integers: I32x8, lanes: &mut [i32; 8]) {
        unsafe { _mm256_storeu_si256(lanes.as_mut_ptr().cast(), integers.0) }
    }
    #[inline(always)]
    fn store_away(self, lanes: &mut [f32; 8]) {
        unsafe { _mm256_stream_ps(lanes.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn after_stores_away() {
        unsafe { _mm_sfence() }
    }
    #[inline(always)]
    fn expand(window: &[f32; 8], places: I32x8) -> Self {
        F32x8(unsafe { _mm256_permutevar8x32_ps(_mm256_loadu_ps(window.as_ptr()), places.0) })
    }
}
