//! Four lanes: SSE 4.1. Tables are read lane by lane.

use std::arch::x86_64::*;
use std::ops::{Neg, Not};

use super::{Vector, operators};
use crate::number::{Integer, Mask, Real};
use crate::table::{ByteTable, FloatTable, PairTable};

// SAFETY, for all `unsafe` blocks of this file: these types are private to `simd`, and values of them arise only in
// functions entered after the machine was found to have SSE 4.1.

/// Four numbers.
#[derive(Clone, Copy)]
pub(super) struct F32x4(__m128);
/// Four integers.
#[derive(Clone, Copy)]
pub(super) struct I32x4(__m128i);
/// All bits of a lane, or none.
#[derive(Clone, Copy)]
pub(super) struct M32x4(__m128);

operators! { F32x4: Add add _mm_add_ps; Sub sub _mm_sub_ps; Mul mul _mm_mul_ps; Div div _mm_div_ps; }
operators! { I32x4: Add add _mm_add_epi32; Sub sub _mm_sub_epi32; Mul mul _mm_mullo_epi32; }
operators! { I32x4: BitAnd bitand _mm_and_si128; BitOr bitor _mm_or_si128; BitXor bitxor _mm_xor_si128; }
operators! { M32x4: BitAnd bitand _mm_and_ps; BitOr bitor _mm_or_ps; }

impl Not for M32x4 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        M32x4(unsafe { _mm_xor_ps(self.0, _mm_castsi128_ps(_mm_set1_epi32(-1))) })
    }
}

impl Neg for F32x4 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        F32x4(unsafe { _mm_xor_ps(self.0, _mm_set1_ps(-0.0)) })
    }
}

impl Mask for M32x4 {}

impl F32x4 {
    /// From the machine's register.
    #[inline(always)]
    pub fn from_register(register: __m128) -> Self {
        F32x4(register)
    }

    /// The machine's register.
    #[inline(always)]
    pub fn register(self) -> __m128 {
        self.0
    }
}

impl I32x4 {
    #[inline(always)]
    fn from_lanes(lanes: [i32; 4]) -> Self {
        I32x4(unsafe { _mm_setr_epi32(lanes[0], lanes[1], lanes[2], lanes[3]) })
    }

    /// The low eight bits of each lane.
    #[inline(always)]
    fn indices(self) -> [usize; 4] {
        unsafe {
            let index = _mm_and_si128(self.0, _mm_set1_epi32(255));
            let low = _mm_cvtsi128_si64(index) as u64;
            let high = _mm_extract_epi64::<1>(index) as u64;
            // The mask again, for the compiler: it then sees that the index lies within the table.
            [low & 255, low >> 32 & 255, high & 255, high >> 32 & 255].map(|lane| lane as usize)
        }
    }
}

impl Integer for I32x4 {
    type Mask = M32x4;
    #[inline(always)]
    fn constant(value: i32) -> Self {
        I32x4(unsafe { _mm_set1_epi32(value) })
    }
    #[inline(always)]
    fn shift_left(self, count: u32) -> Self {
        I32x4(unsafe { _mm_sll_epi32(self.0, _mm_cvtsi32_si128(count as i32)) })
    }
    #[inline(always)]
    fn shift_right(self, count: u32) -> Self {
        I32x4(unsafe { _mm_srl_epi32(self.0, _mm_cvtsi32_si128(count as i32)) })
    }
    #[inline(always)]
    fn equals(self, other: Self) -> M32x4 {
        M32x4(unsafe { _mm_castsi128_ps(_mm_cmpeq_epi32(self.0, other.0)) })
    }
}

impl Real for F32x4 {
    type Int = I32x4;
    type Mask = M32x4;
    const DOUBLE: bool = false;
    const SCALAR: bool = false;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        F32x4(unsafe { _mm_set1_ps(value as f32) })
    }
    #[inline(always)]
    fn floor(self) -> Self {
        F32x4(unsafe { _mm_floor_ps(self.0) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        F32x4(unsafe { _mm_andnot_ps(_mm_set1_ps(-0.0), self.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        F32x4(unsafe { _mm_sqrt_ps(self.0) })
    }
    #[inline(always)]
    fn less(self, other: Self) -> M32x4 {
        M32x4(unsafe { _mm_cmplt_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: M32x4, yes: Self, no: Self) -> Self {
        F32x4(unsafe { _mm_blendv_ps(no.0, yes.0, mask.0) })
    }
    #[inline(always)]
    fn select_int(mask: M32x4, yes: I32x4, no: I32x4) -> I32x4 {
        I32x4(unsafe { _mm_blendv_epi8(no.0, yes.0, _mm_castps_si128(mask.0)) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        F32x4(unsafe { _mm_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        F32x4(unsafe { _mm_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn to_int(self) -> I32x4 {
        I32x4(unsafe { _mm_cvttps_epi32(self.0) })
    }
    #[inline(always)]
    fn from_int(value: I32x4) -> Self {
        F32x4(unsafe { _mm_cvtepi32_ps(value.0) })
    }
    #[inline(always)]
    fn times_power_of_two(self, exponent: I32x4) -> Self {
        let bits = (exponent + I32x4::constant(127)).shift_left(23);
        self * F32x4(unsafe { _mm_castsi128_ps(bits.0) })
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        let bits = I32x4(unsafe { _mm_castps_si128(self.0) });
        let mantissa = bits & I32x4::constant(0x7f_ffff) | I32x4::constant(127 << 23);
        let exponent = Self::from_int(bits.shift_right(23) - I32x4::constant(127));
        (F32x4(unsafe { _mm_castsi128_ps(mantissa.0) }), exponent)
    }
    #[inline(always)]
    fn lookup(table: &ByteTable, index: I32x4) -> I32x4 {
        I32x4::from_lanes(index.indices().map(|i| table.words[i]))
    }
    #[inline(always)]
    fn lookup_pair(table: &PairTable, index: I32x4) -> (I32x4, I32x4) {
        let pairs = I32x4::from_lanes(index.indices().map(|i| table.pairs[i]));
        (pairs, pairs.shift_right(8))
    }
    #[inline(always)]
    fn pick(table: &FloatTable, index: I32x4) -> Self {
        Self::load(&index.indices().map(|i| table.singles[i]))
    }
}

impl Vector<4> for F32x4 {
    #[inline(always)]
    fn load(lanes: &[f32; 4]) -> Self {
        F32x4(unsafe { _mm_loadu_ps(lanes.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, lanes: &mut [f32; 4]) {
        unsafe { _mm_storeu_ps(lanes.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn splat(value: f32) -> Self {
        F32x4(unsafe { _mm_set1_ps(value) })
    }
    #[inline(always)]
    fn load_int(lanes: &[i32; 4]) -> I32x4 {
        I32x4(unsafe { _mm_loadu_si128(lanes.as_ptr().cast()) })
    }
    #[inline(always)]
    fn store_int(integers: I32x4, lanes: &mut [i32; 4]) {
        unsafe { _mm_storeu_si128(lanes.as_mut_ptr().cast(), integers.0) }
    }
    #[inline(always)]
    fn expand(window: &[f32; 4], places: I32x4) -> Self {
        let [a, b, c, d] = places.indices().map(|place| window[place % 4]);
        F32x4(unsafe { _mm_setr_ps(a, b, c, d) })
    }
}
