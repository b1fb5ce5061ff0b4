//! Value noise: random numbers at the lattice points, interpolated by the curve 6t⁵ − 15t⁴ + 10t³, so that slope and
//! curvature are continuous. The numbers come from a hash and do not repeat after 256 cells.

use super::corners::{Curve, blend, with_plus_zeros};
use super::{Period, Tables, hash, split};
use crate::number::{Dual, Integer, Real};

/// The noise at a point; a missing coordinate is 0.
#[inline(always)]
pub(crate) fn evaluate<R: Real, const D: usize, const G: bool>(
    tables: &Tables,
    point: [R; D],
    period: &Period,
) -> Dual<R, D> {
    let (cell, offset) = split(point);
    let mut mixed = [R::Int::constant(tables.hash_seed); 16];
    for axis in 0..D {
        let [low, high] = hash::ends(&cell, axis, period);
        for i in 0..1 << axis {
            mixed[i + (1 << axis)] = mixed[i] ^ high;
            mixed[i] = mixed[i] ^ low;
        }
    }
    let mut values = [R::constant(0.0); 16];
    for i in 0..1 << D {
        values[i] = hash::signed(hash::bits::<R>(mixed[i]));
    }
    with_plus_zeros::<R, D, G>(blend::<R, D, G>(values, None, &Curve::quintic(&offset)))
}
