//! `f32` and `f64` as numbers, `i32` and `bool` as their companions.

use super::{Integer, Mask, Real};
use crate::table::{ByteTable, FloatTable, PairTable};

impl Mask for bool {}

/// An `i32` whose arithmetic wraps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wrapping(pub i32);

macro_rules! wrapping_operators {
    ($($operator:ident $method:ident $wrapping:path;)*) => {$(
        impl std::ops::$operator for Wrapping {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Wrapping($wrapping(self.0, other.0))
            }
        }
    )*};
}
wrapping_operators! {
    Add add i32::wrapping_add;
    Sub sub i32::wrapping_sub;
    Mul mul i32::wrapping_mul;
    BitAnd bitand std::ops::BitAnd::bitand;
    BitOr bitor std::ops::BitOr::bitor;
    BitXor bitxor std::ops::BitXor::bitxor;
}

impl Integer for Wrapping {
    type Mask = bool;
    #[inline(always)]
    fn constant(value: i32) -> Self {
        Wrapping(value)
    }
    #[inline(always)]
    fn shift_left(self, count: u32) -> Self {
        Wrapping(self.0 << count)
    }
    #[inline(always)]
    fn shift_right(self, count: u32) -> Self {
        Wrapping((self.0 as u32 >> count) as i32)
    }
    #[inline(always)]
    fn equals(self, other: Self) -> bool {
        self == other
    }
}

/// The edge directions by code: see [`Real::edge_dot`].
const EDGES: [[f32; 3]; 16] = [
    [1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, 1.0, -1.0],
    [1.0, 1.0, 0.0],
    [1.0, 0.0, -1.0],
    [-1.0, -1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [-1.0, 0.0, -1.0],
    [-1.0, 0.0, 1.0],
    [0.0, -1.0, -1.0],
    [0.0, -1.0, 1.0],
    [-1.0, -1.0, 0.0],
    [-1.0, 0.0, 1.0],
];

macro_rules! scalar {
    ($float:ident, $bits:ident, $signed:ident, $double:literal, $mantissa_bits:literal, $bias:literal, $entries:ident, $to_int:expr) => {
        impl Real for $float {
            type Int = Wrapping;
            type Mask = bool;
            const DOUBLE: bool = $double;
            const SCALAR: bool = true;

            #[inline(always)]
            fn constant(value: f64) -> Self {
                value as $float
            }
            #[inline(always)]
            fn floor(self) -> Self {
                $float::floor(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $float::abs(self)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                $float::sqrt(self)
            }
            #[inline(always)]
            fn less(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn select(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }
            #[inline(always)]
            fn select_int(mask: bool, yes: Wrapping, no: Wrapping) -> Wrapping {
                if mask { yes } else { no }
            }
            #[inline(always)]
            fn to_int(self) -> Wrapping {
                Wrapping($to_int(self))
            }
            #[inline(always)]
            fn from_int(value: Wrapping) -> Self {
                value.0 as $float
            }
            #[inline(always)]
            fn times_power_of_two(self, exponent: Wrapping) -> Self {
                let bits = (exponent.0 as $signed).wrapping_add($bias) as $bits;
                self * $float::from_bits(bits << $mantissa_bits)
            }
            #[inline(always)]
            fn split_exponent(self) -> (Self, Self) {
                let bits = self.to_bits();
                let mantissa = bits & ((1 << $mantissa_bits) - 1);
                let exponent = (bits >> $mantissa_bits) as i32 - $bias;
                ($float::from_bits(mantissa | ($bias << $mantissa_bits)), exponent as $float)
            }
            #[inline(always)]
            fn lookup(table: &ByteTable, index: Wrapping) -> Wrapping {
                Wrapping(i32::from(table.bytes[(index.0 & 255) as usize]))
            }
            #[inline(always)]
            fn lookup_pair(table: &PairTable, index: Wrapping) -> (Wrapping, Wrapping) {
                let pair = table.pairs[(index.0 & 255) as usize];
                (Wrapping(pair & 255), Wrapping(pair >> 8))
            }
            #[inline(always)]
            fn pick(table: &FloatTable, index: Wrapping) -> Self {
                table.$entries[(index.0 & 255) as usize]
            }
            /// From a table: branches on random bits would be guessed wrong half of the time.
            #[inline(always)]
            fn edge_dot(code: Wrapping, x: Self, y: Self, z: Self) -> Self {
                let [edge_x, edge_y, edge_z] = EDGES[(code.0 & 15) as usize];
                $float::from(edge_x) * x + ($float::from(edge_y) * y + $float::from(edge_z) * z)
            }
            #[inline(always)]
            fn edge(code: Wrapping) -> [Self; 3] {
                let [x, y, z] = EDGES[(code.0 & 15) as usize];
                [x.into(), y.into(), z.into()]
            }
        }
    };
}
// (A single-precision number past 2³¹ is a multiple of 256, a double-precision number past 2⁶³ of 2048.)
scalar!(f32, u32, i32, false, 23, 127, singles, |number: f32| {
    if number.abs() < 2_147_483_648.0 { number as i32 } else { i32::MIN }
});
scalar!(f64, u64, i64, true, 52, 1023, doubles, |number: f64| {
    if number.abs() < 9.0e18 { number as i64 as i32 } else { i32::MIN }
});
