//! Classic noise: [Perlin 1985], with a table of 256 random unit gradients behind the permutation, and the curve
//! 3t² − 2t³. The paper prints no table; ours are drawn by the generator of [`crate::seed`].

use super::{Period, Tables, bilinear, columns, cubic, ends, hash_byte, lerp, plus_zero, split};
use crate::number::Real;

/// The noise at a point of two or three dimensions; the other coordinate is 0.
#[inline(always)]
pub(crate) fn value<R: Real, const D: usize>(tables: &Tables, point: [R; D], period: &Period) -> R {
    let (cell, offset) = split(point);
    let one = R::constant(1.0);
    let (x, y) = ([offset[0], offset[0] - one], [offset[1], offset[1] - one]);
    let (u, v) = (cubic(x[0]), cubic(y[0]));
    let columns = columns(tables, cell[0], cell[1], period);
    if D == 2 {
        let mut hashes = columns;
        for i in 0..4 {
            hashes[i] = hash_byte::<R>(&tables.permutation, columns[i]);
        }
        return plus_zero(bilinear(u, v, layer(tables, hashes, x, y, None)));
    }
    let (mut low, mut high) = (columns, columns);
    for i in 0..4 {
        (low[i], high[i]) = ends(tables, columns[i], cell[2], period[2]);
    }
    let z = offset[2];
    let low = bilinear(u, v, layer(tables, low, x, y, Some(z)));
    let high = bilinear(u, v, layer(tables, high, x, y, Some(z - one)));
    plus_zero(lerp(cubic(z), low, high))
}

/// The gradients' parts at four corners in the order of [`columns`]; without `z` where z = 0.
#[inline(always)]
fn layer<R: Real>(tables: &Tables, hashes: [R::Int; 4], x: [R; 2], y: [R; 2], z: Option<R>) -> [R; 4] {
    let [table_x, table_y, table_z] = &tables.gradients;
    let mut dots = [x[0]; 4];
    for (i, dot) in dots.iter_mut().enumerate() {
        *dot = R::pick(table_x, hashes[i]) * x[i % 2] + R::pick(table_y, hashes[i]) * y[i / 2];
        if let Some(z) = z {
            *dot = *dot + R::pick(table_z, hashes[i]) * z;
        }
    }
    dots
}
