//! Improved noise: the listing of [Perlin 2002].

use super::{Period, Tables, bilinear, columns, corners, lerp, plus_zero, split};
use crate::number::{Integer, Real};

/// The edge code (see [`Real::edge_dot`]) of each hash value's low four bits, from the function `grad` of the listing:
/// x+y, y−x, x−y, −x−y, x+z, z−x, x−z, −x−z, y+z, z−y, y−z, −y−z, and again x+y, z−y, y−x, −y−z.
pub(crate) const EDGE_CODES: [u8; 16] = [0, 9, 1, 8, 2, 11, 3, 10, 4, 13, 5, 12, 0, 13, 9, 12];

/// The curve 6t⁵ − 15t⁴ + 10t³, whose slope and curvature vanish at both ends.
#[inline(always)]
pub(super) fn fade<R: Real>(t: R) -> R {
    t * t * t * (t * (t * R::constant(6.0) - R::constant(15.0)) + R::constant(10.0))
}

/// The noise at a point of two or three dimensions; the other coordinate is 0.
#[inline(always)]
pub(crate) fn value<R: Real, const D: usize>(tables: &Tables, point: [R; D], period: &Period) -> R {
    let (cell, offset) = split(point);
    let (x, y) = (offset[0], offset[1]);
    let one = R::constant(1.0);
    let (x1, y1) = (x - one, y - one);
    let (u, v) = (fade(x), fade(y));
    let columns = columns(tables, cell[0], cell[1], period);
    if D == 2 {
        let mut codes = columns;
        for i in 0..4 {
            codes[i] = R::lookup(&tables.edges, columns[i]);
        }
        let low = [R::edge_dot_plane(codes[0], x, y), R::edge_dot_plane(codes[1], x1, y)];
        let high = [R::edge_dot_plane(codes[2], x, y1), R::edge_dot_plane(codes[3], x1, y1)];
        return plus_zero(bilinear(u, v, [low[0], low[1], high[0], high[1]]));
    }
    let mut codes = columns;
    for i in 0..4 {
        codes[i] = edge_codes::<R>(tables, columns[i], cell[2], period[2]);
    }
    let z = offset[2];
    let low = bilinear(u, v, layer(codes, [x, x1], [y, y1], z));
    for code in &mut codes {
        *code = code.shift_right(4);
    }
    let high = bilinear(u, v, layer(codes, [x, x1], [y, y1], z - one));
    plus_zero(lerp(fade(z), low, high))
}

/// The gradients' parts at four corners in the order of [`columns`].
#[inline(always)]
fn layer<R: Real>(codes: [R::Int; 4], x: [R; 2], y: [R; 2], z: R) -> [R; 4] {
    let low = [R::edge_dot(codes[0], x[0], y[0], z), R::edge_dot(codes[1], x[1], y[0], z)];
    let high = [R::edge_dot(codes[2], x[0], y[1], z), R::edge_dot(codes[3], x[1], y[1], z)];
    [low[0], low[1], high[0], high[1]]
}

/// The edge codes at the lower end (bits 0–3) and the upper end (bits 4–7) of a column.
#[inline(always)]
fn edge_codes<R: Real>(tables: &Tables, column: R::Int, z: R, period: f64) -> R::Int {
    if period == 0.0 {
        return R::lookup(&tables.edges, column + z.to_int());
    }
    let (low, high) = corners(z, period);
    let fifteen = R::Int::constant(15);
    let low = R::lookup(&tables.edges, column + low) & fifteen;
    let high = R::lookup(&tables.edges, column + high) & fifteen;
    low | high.shift_left(4)
}
