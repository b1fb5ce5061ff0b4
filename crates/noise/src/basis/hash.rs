//! A hash of cells, for the noises without a table: it does not repeat after 256 cells.

use super::Period;
use crate::number::{Integer, Real};

/// Odd numbers without a pattern, one for each axis: their products part neighbouring cells in all bits.
pub(crate) const FACTORS: [i32; 4] =
    [0x1f12_3bb5_u32 as i32, 0x5916_7d4d_u32 as i32, 0x2d5e_91a3_u32 as i32, 0x6b3f_a26d_u32 as i32];

/// The cell `steps` further along an axis, as an integer times the axis's factor.
#[inline(always)]
pub(super) fn coordinate<R: Real, const D: usize>(cell: &[R; D], axis: usize, steps: f64, period: &Period) -> R::Int {
    let moved = cell[axis] + R::constant(steps);
    super::wrap(moved, period[axis]).to_int() * R::Int::constant(FACTORS[axis])
}

/// [`coordinate`] of a cell and of the next one.
#[inline(always)]
pub(super) fn ends<R: Real, const D: usize>(cell: &[R; D], axis: usize, period: &Period) -> [R::Int; 2] {
    [coordinate(cell, axis, 0.0, period), coordinate(cell, axis, 1.0, period)]
}

/// 32 random bits of a cell, the upper ones better than the lowest, from the exclusive or of a seed and of its
/// coordinates as [`coordinate`] gives them. Two products by odd numbers, the first folded onto itself: the steps of
/// MurmurHash3's end (A. Appleby) as far as they reach the upper bits. (The multipliers are his.)
#[inline(always)]
pub(crate) fn bits<R: Real>(mixed: R::Int) -> R::Int {
    let mixed = mixed * R::Int::constant(0x85eb_ca6b_u32 as i32);
    let mixed = mixed ^ mixed.shift_right(15);
    mixed * R::Int::constant(0xc2b2_ae35_u32 as i32)
}

/// A number in [-1, 1) from random bits: the upper 24, which both precisions hold.
#[inline(always)]
pub(crate) fn signed<R: Real>(bits: R::Int) -> R {
    R::from_int(bits.shift_right(8)) * R::constant(1.0 / 8_388_608.0) - R::constant(1.0)
}
