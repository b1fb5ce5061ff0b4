//! White noise: one random number per cell, the same all over it.

use super::corners::plus_zero;
use super::{Period, Tables, hash, split};
use crate::number::{Dual, Integer, Real};

/// The noise at a point; a missing coordinate is 0. Its gradient is zero.
#[inline(always)]
pub(crate) fn evaluate<R: Real, const D: usize>(tables: &Tables, point: [R; D], period: &Period) -> Dual<R, D> {
    let (cell, offset) = split(point);
    let mut mixed = R::Int::constant(tables.hash_seed);
    for axis in 0..D {
        mixed = mixed ^ hash::coordinate(&cell, axis, 0.0, period);
    }
    let value = hash::signed::<R>(hash::bits::<R>(mixed));
    let value = super::nan_where_none(value, &offset);
    Dual { value: plus_zero(value), gradient: [R::constant(0.0); D] }
}
