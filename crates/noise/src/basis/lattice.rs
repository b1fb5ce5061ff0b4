//! Lattice noise: the report's "random noise", a table of random values 0–255 at the lattice points, interpolated by the
//! curve 3t² − 2t³ (straight lines would show as creases along the lattice).
//!
//! The values are mapped from 0–255 to −1…1, so that this noise has the mean zero as the gradient noises have: a plain
//! sum then has the same mean for any number of octaves, an absolute sum folds at zero, and a material may exchange one
//! noise for another without a shift of its colours.

use super::corners::{Curve, blend, hash, plus_zero};
use super::{Period, Tables, split};
use crate::number::{Dual, Integer, Real};

/// The noise at a point; below three dimensions the other coordinates are 0.
#[inline(always)]
pub(crate) fn evaluate<R: Real, const D: usize, const G: bool>(
    tables: &Tables,
    point: [R; D],
    period: &Period,
) -> Dual<R, D> {
    let (cell, offset) = split(point);
    let hashes = hash(tables, &cell, period);
    let mut values = [R::constant(0.0); 16];
    for i in 0..1 << D {
        values[i] = R::from_int(hashes[i] & R::Int::constant(255));
    }
    let mut sample = blend::<R, D, G>(values, None, &Curve::cubic(&offset));
    let scale = R::constant(2.0 / 255.0);
    sample.value = plus_zero(sample.value * scale - R::constant(1.0));
    if G {
        for part in &mut sample.gradient {
            *part = plus_zero(*part * scale);
        }
    }
    sample
}
