//! Classic noise: \[Perlin 1985\], with a table of 256 random unit gradients behind the permutation, and the curve
//! 3t² − 2t³. The paper prints no table; ours are drawn by the generator of [`crate::seed`].

use super::corners::{Curve, blend, hash, with_plus_zeros};
use super::{Period, Tables, split};
use crate::number::{Dual, Real};

/// The noise at a point; below three dimensions the other coordinates are 0.
#[inline(always)]
pub(crate) fn evaluate<R: Real, const D: usize, const G: bool>(
    tables: &Tables,
    point: [R; D],
    period: &Period,
) -> Dual<R, D> {
    let (cell, offset) = split(point);
    let hashes = hash(tables, &cell, period);
    let zero = R::constant(0.0);
    let (mut values, mut slopes) = ([zero; 16], [[zero; D]; 16]);
    for i in 0..1 << D {
        for axis in 0..D {
            let from = if i >> axis & 1 == 1 { offset[axis] - R::constant(1.0) } else { offset[axis] };
            let table = if D == 4 { &tables.gradients_four[axis] } else { &tables.gradients[axis] };
            slopes[i][axis] = R::pick(table, hashes[i]);
            let part = slopes[i][axis] * from;
            values[i] = if axis == 0 { part } else { values[i] + part };
        }
    }
    with_plus_zeros::<R, D, G>(blend::<R, D, G>(values, if G { Some(slopes) } else { None }, &Curve::cubic(&offset)))
}
