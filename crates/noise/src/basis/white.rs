//! White noise: one random number per cell, the same all over it.

use super::{Period, Tables, hash, plus_zero};
use crate::number::{Integer, Real};

/// The noise at a point of two or three dimensions; the other coordinate is 0.
#[inline(always)]
pub(crate) fn value<R: Real, const D: usize>(tables: &Tables, point: [R; D], period: &Period) -> R {
    let (cell, offset) = super::split(point);
    let x = hash::coordinate(&cell, 0, 0.0, period);
    let y = hash::coordinate(&cell, 1, 0.0, period);
    let z = if D == 3 { hash::coordinate(&cell, D - 1, 0.0, period) } else { R::Int::constant(0) };
    let mut value = hash::signed::<R>(hash::bits::<R>(tables.hash_seed, x, y, z));
    // Nothing, or NaN where a coordinate is none.
    for part in offset {
        value = value + part * R::constant(0.0);
    }
    plus_zero(value)
}
