//! What an evaluation is generic over: a real number with its integer and its mask.
//!
//! An evaluation is written once over [`Real`]. Branches are [`Real::select`], tables are read by methods of the number,
//! so that each implementation reads them in its own way. Implementations must agree to the bit with `f32` (save for
//! the sign of zero, which evaluations remove by adding `+0` at the end): no fused multiply-add unless its product is
//! exact, no platform functions.

mod dual;
mod scalar;

pub use dual::Dual;

use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

use crate::table::{ByteTable, FloatTable, PairTable};

/// A truth value per lane.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {}

/// A 32-bit integer, or several; arithmetic wraps.
pub trait Integer:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
{
    /// The result of a comparison.
    type Mask: Mask;
    /// The same value in every lane.
    fn constant(value: i32) -> Self;
    /// Shifted towards the high bits; zeros come in. `count` is below 32.
    fn shift_left(self, count: u32) -> Self;
    /// Shifted towards the low bits; zeros come in. `count` is below 32.
    fn shift_right(self, count: u32) -> Self;
    /// Where both are equal.
    fn equals(self, other: Self) -> Self::Mask;
}

/// A real number: `f64`, `f32`, a vector of `f32`, or a [`Dual`] of those.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The integer of the same width.
    type Int: Integer<Mask = Self::Mask>;
    /// The result of a comparison.
    type Mask: Mask;
    /// Whether this is a number of double precision.
    const DOUBLE: bool;
    /// Whether this is one number, not several.
    const SCALAR: bool;

    /// The same value in every lane, rounded to the number's precision.
    fn constant(value: f64) -> Self;
    /// The largest whole number not above `self`.
    fn floor(self) -> Self;
    /// The absolute value.
    fn abs(self) -> Self;
    /// The square root, correctly rounded.
    fn sqrt(self) -> Self;
    /// Where `self < other`; nowhere where one is NaN.
    fn less(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is set, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// `yes` where the mask is set, else `no`.
    fn select_int(mask: Self::Mask, yes: Self::Int, no: Self::Int) -> Self::Int;
    /// A whole number as an integer. NaN and single-precision numbers outside the integer's range become the least
    /// integer, whose low eight bits are right (such numbers are multiples of 256). Double-precision numbers wrap.
    fn to_int(self) -> Self::Int;
    /// An integer as a number.
    fn from_int(value: Self::Int) -> Self;
    /// Times two to the `exponent`, which lies within the exponents of normal numbers.
    fn times_power_of_two(self, exponent: Self::Int) -> Self;
    /// Mantissa in [1, 2) and exponent of a positive normal number.
    fn split_exponent(self) -> (Self, Self);

    /// The table's byte at the low eight bits of `index`. Only the low eight bits of the result are specified.
    fn lookup(table: &ByteTable, index: Self::Int) -> Self::Int;
    /// The table's bytes at the low eight bits of `index` and at one more; the last entry is followed by the first. Only
    /// the low eight bits of the results are specified.
    fn lookup_pair(table: &PairTable, index: Self::Int) -> (Self::Int, Self::Int);
    /// The table's number at the low eight bits of `index`.
    fn pick(table: &FloatTable, index: Self::Int) -> Self;

    /// The smaller one; `other` where either is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.less(other), self, other)
    }

    /// The larger one; `other` where either is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(other.less(self), self, other)
    }

    /// The dot product of (x, y, z) with an edge direction of the cube, by the low four bits of `code`: bits 0–2 say x+y,
    /// x−y, x+z, x−z, y+z, y−z and again x+y, x−z, bit 3 negates. The sign of a zero is unspecified.
    #[inline(always)]
    fn edge_dot(code: Self::Int, x: Self, y: Self, z: Self) -> Self {
        let [x_part, y_part, z_part] = Self::edge(code);
        x_part * x + (y_part * y + z_part * z)
    }

    /// The components of that direction.
    #[inline(always)]
    fn edge(code: Self::Int) -> [Self; 3] {
        let (zero, one) = (Self::constant(0.0), Self::constant(1.0));
        let sign = Self::select(clear::<Self>(code, 8), one, -one);
        let second = Self::select(clear::<Self>(code, 1), sign, -sign);
        // Codes 6 and 7 are those of the first pair and of the second.
        let repeats = !(clear::<Self>(code, 4) | clear::<Self>(code, 2));
        let with_x = clear::<Self>(code, 4) | repeats;
        let with_z = !clear::<Self>(code, 6) & (!repeats | !clear::<Self>(code, 1));
        let y = Self::select(with_x, Self::select(with_z, zero, second), sign);
        [Self::select(with_x, sign, zero), y, Self::select(with_z, second, zero)]
    }

    /// `self + a · b`, where the product is exact, or where `self` is zero: fused or not, the bits are the same.
    #[inline(always)]
    fn plus_exact(self, a: Self, b: Self) -> Self {
        self + a * b
    }

    /// [`Real::edge_dot`] of the offset from a corner of a tetrahedron, given that from its first one, from where it has moved by
    /// `shift` along all axes and, with `STEP` −1, back by 1 along that of the largest offset, or with `STEP` 1 forth along that
    /// of the least one: z where the first mask is set, else x or y, of which y is larger where the second one is set.
    #[inline(always)]
    fn tetrahedron_dot<const STEP: i32>(
        code: Self::Int,
        [x, y, z]: [Self; 3],
        shift: f64,
        [is_z, rising]: [Self::Mask; 2],
    ) -> Self {
        let [edge_x, edge_y, edge_z] = Self::edge(code);
        let moved = (edge_x + edge_y + edge_z) * Self::constant(shift);
        let dot = moved.plus_exact(edge_z, z).plus_exact(edge_y, y).plus_exact(edge_x, x);
        match STEP {
            0 => dot,
            1 => dot + Self::select(is_z, edge_z, Self::select(rising, edge_x, edge_y)),
            _ => dot - Self::select(is_z, edge_z, Self::select(rising, edge_y, edge_x)),
        }
    }

    /// [`Real::edge_dot`] of the offsets from the eight corners of a cell (bit 0 of a corner's index says whether it is the
    /// upper one along x, bit 1 along y, bit 2 along z), given the offset from the lowest corner, which is not negative.
    #[inline(always)]
    fn cell_dots(codes: &[Self::Int; 8], offset: [Self; 3]) -> [Self; 8] {
        let ([x, y, z], one) = (offset, Self::constant(1.0));
        let (x, y, z) = ([x, x - one], [y, y - one], [z, z - one]);
        let mut dots = [one; 8];
        for (i, dot) in dots.iter_mut().enumerate() {
            *dot = Self::edge_dot(codes[i], x[i & 1], y[i >> 1 & 1], z[i >> 2]);
        }
        dots
    }

    /// [`Real::edge_dot`] for z = 0.
    #[inline(always)]
    fn edge_dot_plane(code: Self::Int, x: Self, y: Self) -> Self {
        Self::edge_dot(code, x, y, Self::constant(0.0))
    }
}

/// Where all these bits are zero.
#[inline(always)]
fn clear<R: Real>(code: R::Int, bits: i32) -> R::Mask {
    (code & R::Int::constant(bits)).equals(R::Int::constant(0))
}
