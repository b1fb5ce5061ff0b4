//! A hash of cells, for the noises without a table: it does not repeat after 256 cells.

use super::Period;
use crate::number::{Integer, Real};

/// Odd numbers without a pattern, one for each axis: their products part neighbouring cells in all bits.
const FACTORS: [i32; 3] = [0x1f12_3bb5_u32 as i32, 0x5916_7d4d_u32 as i32, 0x2d5e_91a3_u32 as i32];

/// The cell `steps` further along an axis, as an integer times the axis's factor.
#[inline(always)]
pub(super) fn coordinate<R: Real, const D: usize>(cell: &[R; D], axis: usize, steps: f64, period: &Period) -> R::Int {
    let moved = cell[axis] + R::constant(steps);
    super::wrap(moved, period[axis]).to_int() * R::Int::constant(FACTORS[axis])
}

/// 32 random bits of a cell, from its coordinates as [`coordinate`] gives them. The last steps are those of MurmurHash3
/// (A. Appleby), which let each bit of the input change each bit of the result.
#[inline(always)]
pub(super) fn bits<R: Real>(seed: i32, x: R::Int, y: R::Int, z: R::Int) -> R::Int {
    let mixed = x ^ y ^ z ^ R::Int::constant(seed);
    let mixed = (mixed ^ mixed.shift_right(16)) * R::Int::constant(0x85eb_ca6b_u32 as i32);
    let mixed = (mixed ^ mixed.shift_right(13)) * R::Int::constant(0xc2b2_ae35_u32 as i32);
    mixed ^ mixed.shift_right(16)
}

/// A number in [-1, 1) from random bits: the upper 24, which both precisions hold.
#[inline(always)]
pub(super) fn signed<R: Real>(bits: R::Int) -> R {
    R::from_int(bits.shift_right(8)) * R::constant(1.0 / 8_388_608.0) - R::constant(1.0)
}
