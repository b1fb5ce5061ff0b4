//! Value noise: random numbers at the lattice points, interpolated by the curve 6t⁵ − 15t⁴ + 10t³, so that slope and
//! curvature are continuous. The numbers come from a hash and do not repeat after 256 cells.

use super::improved::fade;
use super::{Period, Tables, bilinear, hash, lerp, plus_zero, split};
use crate::number::{Integer, Real};

/// The noise at a point of two or three dimensions; the other coordinate is 0.
#[inline(always)]
pub(crate) fn value<R: Real, const D: usize>(tables: &Tables, point: [R; D], period: &Period) -> R {
    let (cell, offset) = split(point);
    let (u, v) = (fade(offset[0]), fade(offset[1]));
    let x = [hash::coordinate(&cell, 0, 0.0, period), hash::coordinate(&cell, 0, 1.0, period)];
    let y = [hash::coordinate(&cell, 1, 0.0, period), hash::coordinate(&cell, 1, 1.0, period)];
    if D == 2 {
        return plus_zero(bilinear(u, v, layer(tables, x, y, R::Int::constant(0))));
    }
    let low = bilinear(u, v, layer(tables, x, y, hash::coordinate(&cell, D - 1, 0.0, period)));
    let high = bilinear(u, v, layer(tables, x, y, hash::coordinate(&cell, D - 1, 1.0, period)));
    plus_zero(lerp(fade(offset[D - 1]), low, high))
}

/// The numbers at four corners: (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1).
#[inline(always)]
fn layer<R: Real>(tables: &Tables, x: [R::Int; 2], y: [R::Int; 2], z: R::Int) -> [R; 4] {
    let mut numbers = [R::constant(0.0); 4];
    for (i, number) in numbers.iter_mut().enumerate() {
        *number = hash::signed(hash::bits::<R>(tables.hash_seed, x[i % 2], y[i / 2], z));
    }
    numbers
}
