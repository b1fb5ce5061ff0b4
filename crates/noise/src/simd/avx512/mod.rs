//! Sixteen lanes: AVX-512 with VBMI. Tables of bytes are read from four registers, 64 bytes at a time.

pub(super) mod improved;
pub(super) mod plane;
pub(super) mod single;

use std::arch::x86_64::*;
use std::ops::{Neg, Not};

use super::{Vector, operators};
use crate::number::{Integer, Mask, Real};
use crate::table::{ByteTable, FloatTable, PairTable};

// SAFETY, for all `unsafe` blocks of this file: these types are private to `simd`, and values of them arise only in
// functions entered after the machine was found to have AVX-512 with VBMI.

/// Sixteen numbers.
#[derive(Clone, Copy)]
pub(super) struct F32x16(__m512);
/// Sixteen integers.
#[derive(Clone, Copy)]
pub(super) struct I32x16(__m512i);
/// A bit per lane.
#[derive(Clone, Copy)]
pub(super) struct M32x16(__mmask16);

operators! { F32x16: Add add _mm512_add_ps; Sub sub _mm512_sub_ps; Mul mul _mm512_mul_ps; Div div _mm512_div_ps; }
operators! { I32x16: Add add _mm512_add_epi32; Sub sub _mm512_sub_epi32; Mul mul _mm512_mullo_epi32; }
operators! { I32x16: BitAnd bitand _mm512_and_si512; BitOr bitor _mm512_or_si512; BitXor bitxor _mm512_xor_si512; }
operators! { M32x16: BitAnd bitand _kand_mask16; BitOr bitor _kor_mask16; }

impl Not for M32x16 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        M32x16(!self.0)
    }
}

impl Neg for F32x16 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        F32x16(unsafe { _mm512_xor_ps(self.0, _mm512_set1_ps(-0.0)) })
    }
}

impl Mask for M32x16 {}

impl I32x16 {
    /// The table's bytes at each byte of the lanes (of which the lowest matters).
    #[inline(always)]
    fn permuted(self, bytes: &[u8; 256]) -> Self {
        unsafe {
            let quarters: *const __m512i = bytes.as_ptr().cast();
            let (first, second) = (_mm512_loadu_si512(quarters), _mm512_loadu_si512(quarters.add(1)));
            let (third, fourth) = (_mm512_loadu_si512(quarters.add(2)), _mm512_loadu_si512(quarters.add(3)));
            let low = _mm512_permutex2var_epi8(first, self.0, second);
            let high = _mm512_permutex2var_epi8(third, self.0, fourth);
            I32x16(_mm512_mask_blend_epi8(_mm512_movepi8_mask(self.0), low, high))
        }
    }
}

impl Integer for I32x16 {
    type Mask = M32x16;
    #[inline(always)]
    fn constant(value: i32) -> Self {
        I32x16(unsafe { _mm512_set1_epi32(value) })
    }
    #[inline(always)]
    fn shift_left(self, count: u32) -> Self {
        I32x16(unsafe { _mm512_sll_epi32(self.0, _mm_cvtsi32_si128(count as i32)) })
    }
    #[inline(always)]
    fn shift_right(self, count: u32) -> Self {
        I32x16(unsafe { _mm512_srl_epi32(self.0, _mm_cvtsi32_si128(count as i32)) })
    }
    #[inline(always)]
    fn equals(self, other: Self) -> M32x16 {
        M32x16(unsafe { _mm512_cmpeq_epi32_mask(self.0, other.0) })
    }
}

impl Real for F32x16 {
    type Int = I32x16;
    type Mask = M32x16;
    const DOUBLE: bool = false;
    const SCALAR: bool = false;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        F32x16(unsafe { _mm512_set1_ps(value as f32) })
    }
    #[inline(always)]
    fn floor(self) -> Self {
        F32x16(unsafe { _mm512_roundscale_ps::<{ _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC }>(self.0) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        F32x16(unsafe { _mm512_abs_ps(self.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        F32x16(unsafe { _mm512_sqrt_ps(self.0) })
    }
    #[inline(always)]
    fn less(self, other: Self) -> M32x16 {
        M32x16(unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: M32x16, yes: Self, no: Self) -> Self {
        F32x16(unsafe { _mm512_mask_blend_ps(mask.0, no.0, yes.0) })
    }
    #[inline(always)]
    fn select_int(mask: M32x16, yes: I32x16, no: I32x16) -> I32x16 {
        I32x16(unsafe { _mm512_mask_blend_epi32(mask.0, no.0, yes.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        F32x16(unsafe { _mm512_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        F32x16(unsafe { _mm512_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn to_int(self) -> I32x16 {
        I32x16(unsafe { _mm512_cvttps_epi32(self.0) })
    }
    #[inline(always)]
    fn from_int(value: I32x16) -> Self {
        F32x16(unsafe { _mm512_cvtepi32_ps(value.0) })
    }
    #[inline(always)]
    fn times_power_of_two(self, exponent: I32x16) -> Self {
        let bits = (exponent + I32x16::constant(127)).shift_left(23);
        self * F32x16(unsafe { _mm512_castsi512_ps(bits.0) })
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        let bits = I32x16(unsafe { _mm512_castps_si512(self.0) });
        let mantissa = bits & I32x16::constant(0x7f_ffff) | I32x16::constant(127 << 23);
        let exponent = Self::from_int(bits.shift_right(23) - I32x16::constant(127));
        (F32x16(unsafe { _mm512_castsi512_ps(mantissa.0) }), exponent)
    }
    #[inline(always)]
    fn lookup(table: &ByteTable, index: I32x16) -> I32x16 {
        index.permuted(&table.bytes)
    }
    #[inline(always)]
    fn lookup_pair(table: &PairTable, index: I32x16) -> (I32x16, I32x16) {
        (index.permuted(&table.bytes), index.permuted(&table.next))
    }
    #[inline(always)]
    fn pick(table: &FloatTable, index: I32x16) -> Self {
        let index = index & I32x16::constant(255);
        // The masked index lies within the table.
        F32x16(unsafe { _mm512_i32gather_ps::<4>(index.0, table.singles.as_ptr()) })
    }

    /// The components come from tables in registers, by the low four bits. Their products with 0, 1 and −1 are exact,
    /// and so is fusing them with the addition.
    #[inline(always)]
    fn edge_dot(code: I32x16, x: Self, y: Self, z: Self) -> Self {
        unsafe {
            let product = _mm512_mul_ps(_mm512_permutexvar_ps(code.0, _mm512_loadu_ps(EDGE_Z.as_ptr())), z.0);
            let edge_y = _mm512_permutexvar_ps(code.0, _mm512_loadu_ps(EDGE_Y.as_ptr()));
            let edge_x = _mm512_permutexvar_ps(code.0, _mm512_loadu_ps(EDGE_X.as_ptr()));
            F32x16(_mm512_fmadd_ps(edge_x, x.0, _mm512_fmadd_ps(edge_y, y.0, product)))
        }
    }
    #[inline(always)]
    fn edge(code: I32x16) -> [Self; 3] {
        let part =
            |table: &[f32; 16]| F32x16(unsafe { _mm512_permutexvar_ps(code.0, _mm512_loadu_ps(table.as_ptr())) });
        [part(&EDGE_X), part(&EDGE_Y), part(&EDGE_Z)]
    }
    #[inline(always)]
    fn plus_exact(self, a: Self, b: Self) -> Self {
        F32x16(unsafe { _mm512_fmadd_ps(a.0, b.0, self.0) })
    }
    /// The movements come from a table too.
    #[inline(always)]
    fn tetrahedron_dot<const STEP: i32>(
        code: I32x16,
        [x, y, z]: [Self; 3],
        shift: f64,
        [is_z, rising]: [M32x16; 2],
    ) -> Self {
        let [edge_x, edge_y, edge_z] = Self::edge(code);
        let moves = F32x16(unsafe { _mm512_loadu_ps(EDGE_SUM.as_ptr()) }) * Self::constant(shift);
        let moved = F32x16(unsafe { _mm512_permutexvar_ps(code.0, moves.0) });
        let along_z = if shift == 0.0 { edge_z * z } else { moved.plus_exact(edge_z, z) };
        let dot = along_z.plus_exact(edge_y, y).plus_exact(edge_x, x);
        let (larger, smaller) = (Self::select(rising, edge_y, edge_x), Self::select(rising, edge_x, edge_y));
        match STEP {
            0 => dot,
            1 => dot + Self::select(is_z, edge_z, smaller),
            _ => dot - Self::select(is_z, edge_z, larger),
        }
    }
    /// Of an edge's two components the first is along x or y, the second along y or z. Each is chosen, with its sign, by one
    /// instruction that takes some bits from one number and some from another: where x and z are negative and y is not, the
    /// bit that takes the sign is free to say which.
    #[inline(always)]
    fn cell_dots(codes: &[I32x16; 8], [x, y, z]: [Self; 3]) -> [Self; 8] {
        let (one, sign) = (Self::constant(1.0), Self::constant(-0.0));
        let negative = |number: Self| F32x16(unsafe { _mm512_or_ps(number.0, sign.0) });
        let (x, y, z) = ([negative(x), negative(one - x)], [y, one - y], [negative(z), negative(one - z)]);
        let mut dots = [one; 8];
        for (i, dot) in dots.iter_mut().enumerate() {
            let upper = [i & 1, i >> 1 & 1, i >> 2];
            let y = y[upper[1]];
            let first = choose(codes[i], &CHOICES[0][upper[0]][upper[1]], x[upper[0]], y);
            *dot = first + choose(codes[i], &CHOICES[1][upper[2]][upper[1]], z[upper[2]], y);
        }
        dots
    }
    #[inline(always)]
    fn edge_dot_plane(code: I32x16, x: Self, y: Self) -> Self {
        unsafe {
            let product = _mm512_mul_ps(_mm512_permutexvar_ps(code.0, _mm512_loadu_ps(EDGE_Y.as_ptr())), y.0);
            let edge_x = _mm512_permutexvar_ps(code.0, _mm512_loadu_ps(EDGE_X.as_ptr()));
            F32x16(_mm512_fmadd_ps(edge_x, x.0, product))
        }
    }
}

/// The components of the edge directions, by code: see [`Real::edge_dot`].
const EDGE_X: [f32; 16] = [1., 1., 1., 1., 0., 0., 1., 1., -1., -1., -1., -1., 0., 0., -1., -1.];
const EDGE_Y: [f32; 16] = [1., -1., 0., 0., 1., 1., 1., 0., -1., 1., 0., 0., -1., -1., -1., 0.];
const EDGE_Z: [f32; 16] = [0., 0., 1., -1., 1., -1., 0., -1., 0., 0., -1., 1., -1., 1., 0., 1.];

/// The sum of the three.
const EDGE_SUM: [f32; 16] = [2., 0., 2., 0., 2., 0., 2., 0., -2., 0., -2., 0., -2., 0., -2., 0.];

/// Bits of `yes` where those of the word at the code are set, else of `no`.
#[inline(always)]
fn choose(code: I32x16, words: &Words, yes: F32x16, no: F32x16) -> F32x16 {
    const CHOOSE: i32 = 0xca;
    unsafe {
        let choice = _mm512_permutexvar_epi32(code.0, _mm512_load_si512(words.0.as_ptr().cast()));
        let (yes, no) = (_mm512_castps_si512(yes.0), _mm512_castps_si512(no.0));
        F32x16(_mm512_castsi512_ps(_mm512_ternarylogic_epi32::<CHOOSE>(choice, yes, no)))
    }
}

/// Words for sixteen lanes.
#[repr(align(64))]
struct Words([i32; 16]);

/// What [`F32x16::cell_dots`] chooses with, by code: for the components along x or y, and along z or y; at the lower and the
/// upper end along x (or z); at both ends along y.
static CHOICES: [[[Words; 2]; 2]; 2] = {
    const fn words(outer: &[f32; 16], end: usize, end_y: usize) -> Words {
        let mut words = [0; 16];
        let mut code = 0;
        while code < 16 {
            let is_outer = outer[code] != 0.0;
            let (component, end) = if is_outer { (outer[code], end) } else { (EDGE_Y[code], end_y) };
            // From the upper end a point is seen in the negative direction.
            let negative = (component < 0.0) != (end == 1);
            words[code] = if is_outer { i32::MAX } else { 0 } | if negative { i32::MIN } else { 0 };
            code += 1;
        }
        Words(words)
    }
    const fn ends(outer: &[f32; 16]) -> [[Words; 2]; 2] {
        [[words(outer, 0, 0), words(outer, 0, 1)], [words(outer, 1, 0), words(outer, 1, 1)]]
    }
    [ends(&EDGE_X), ends(&EDGE_Z)]
};

impl Vector<16> for F32x16 {
    const TABLES_IN_REGISTERS: bool = true;
    #[inline(always)]
    fn load(lanes: &[f32; 16]) -> Self {
        F32x16(unsafe { _mm512_loadu_ps(lanes.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, lanes: &mut [f32; 16]) {
        unsafe { _mm512_storeu_ps(lanes.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn splat(value: f32) -> Self {
        F32x16(unsafe { _mm512_set1_ps(value) })
    }
    #[inline(always)]
    fn load_int(lanes: &[i32; 16]) -> I32x16 {
        I32x16(unsafe { _mm512_loadu_si512(lanes.as_ptr().cast()) })
    }
    #[inline(always)]
    fn store_int(integers: I32x16, lanes: &mut [i32; 16]) {
        unsafe { _mm512_storeu_si512(lanes.as_mut_ptr().cast(), integers.0) }
    }
    #[inline(always)]
    fn store_away(self, lanes: &mut [f32; 16]) {
        unsafe { _mm512_stream_ps(lanes.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn after_stores_away() {
        unsafe { _mm_sfence() }
    }
    #[inline(always)]
    fn expand(window: &[f32; 16], places: I32x16) -> Self {
        F32x16(unsafe { _mm512_permutexvar_ps(places.0, _mm512_loadu_ps(window.as_ptr())) })
    }
}
