//! Lattice noise: the report's "random noise", a table of random values 0–255 at the lattice points, interpolated by the
//! curve 3t² − 2t³ (straight lines would show as creases along the lattice).
//!
//! The values are mapped from 0–255 to −1…1, so that this noise has the mean zero as the gradient noises have: a plain
//! sum then has the same mean for any number of octaves, an absolute sum folds at zero, and a material may exchange one
//! noise for another without a shift of its colours.

use super::{Period, Tables, bilinear, columns, cubic, ends, hash_byte, lerp, plus_zero, split};
use crate::number::{Integer, Real};

/// The noise at a point of two or three dimensions; the other coordinate is 0.
#[inline(always)]
pub(crate) fn value<R: Real, const D: usize>(tables: &Tables, point: [R; D], period: &Period) -> R {
    let (cell, offset) = split(point);
    let (u, v) = (cubic(offset[0]), cubic(offset[1]));
    let columns = columns(tables, cell[0], cell[1], period);
    let (mut low, mut high) = ([u; 4], [u; 4]);
    for i in 0..4 {
        if D == 2 {
            low[i] = number(hash_byte::<R>(&tables.permutation, columns[i]));
        } else {
            let (below, above) = ends::<R>(tables, columns[i], cell[2], period[2]);
            (low[i], high[i]) = (number(below), number(above));
        }
    }
    let mut value = bilinear(u, v, low);
    if D == 3 {
        value = lerp(cubic(offset[2]), value, bilinear(u, v, high));
    }
    plus_zero(value * R::constant(2.0 / 255.0) - R::constant(1.0))
}

/// The value of a hash_byte, from 0 to 255.
#[inline(always)]
fn number<R: Real>(hash: R::Int) -> R {
    R::from_int(hash & R::Int::constant(255))
}
