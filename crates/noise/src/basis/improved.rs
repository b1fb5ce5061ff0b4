//! Improved noise: the listing of [Perlin 2002], and in four dimensions the one that he published as `ImprovedNoise4D`.

use super::corners::{Corners, Curve, blend, ends, hash_axis, hash_zero, with_plus_zeros};
use super::{Period, Tables, split};
use crate::number::{Dual, Integer, Real};

/// The edge code (see [`Real::edge_dot`]) of each hash value's low four bits, from the function `grad` of the listing:
/// x+y, y−x, x−y, −x−y, x+z, z−x, x−z, −x−z, y+z, z−y, y−z, −y−z, and again x+y, z−y, y−x, −y−z.
pub(crate) const EDGE_CODES: [u8; 16] = [0, 9, 1, 8, 2, 11, 3, 10, 4, 13, 5, 12, 0, 13, 9, 12];

/// The noise at a point; below three dimensions the other coordinates are 0.
#[inline(always)]
pub(crate) fn evaluate<R: Real, const D: usize, const G: bool>(
    tables: &Tables,
    point: [R; D],
    period: &Period,
) -> Dual<R, D> {
    let (cell, offset) = split(point);
    let mut codes = [R::Int::constant(0); 16];
    if D == 4 {
        let hashes = super::corners::hash(tables, &cell, period);
        return with_plus_zeros::<R, D, G>(blend_four::<R, D, G>(hashes, offset));
    }
    for axis in 0..D.min(2) {
        hash_axis(tables, &mut codes, axis, &cell, period);
    }
    if D == 1 {
        hash_zero::<R, D>(tables, &mut codes);
    }
    let count = 1 << D.min(2);
    for i in 0..count {
        if D < 3 {
            codes[i] = R::lookup(&tables.edges, codes[i]);
        } else if period[2] == 0.0 {
            codes[i] = R::lookup(&tables.edges, codes[i] + cell[D - 1].to_int());
            codes[i + count] = codes[i].shift_right(4);
        } else {
            let (low, high) = ends(cell[D - 1], period[2]);
            let column = codes[i];
            codes[i] = R::lookup(&tables.edges, column + low);
            codes[i + count] = R::lookup(&tables.edges, column + high);
        }
    }
    with_plus_zeros::<R, D, G>(blend_codes::<R, D, G>(codes, offset))
}

/// The blend of the corners with these edge codes, in up to three dimensions. The signs of zeros are unspecified.
#[inline(always)]
pub(crate) fn blend_codes<R: Real, const D: usize, const G: bool>(
    codes: Corners<R::Int>,
    offset: [R; D],
) -> Dual<R, D> {
    let zero = R::constant(0.0);
    let (mut values, mut slopes) = ([zero; 16], [[zero; D]; 16]);
    if D == 3 && !G {
        return blend_dots::<R, D, G>(codes, offset, &Curve::quintic(&offset));
    }
    for i in 0..1 << D {
        let from = from_corner(&offset, i);
        if G {
            let edge = R::edge(codes[i]);
            values[i] = edge[0] * from[0];
            for axis in 0..D {
                slopes[i][axis] = edge[axis];
                if axis > 0 {
                    values[i] = values[i] + edge[axis] * from[axis];
                }
            }
        } else {
            values[i] = R::edge_dot_plane(codes[i], from[0], if D == 1 { zero } else { from[1] });
        }
    }
    blend::<R, D, G>(values, if G { Some(slopes) } else { None }, &Curve::quintic(&offset))
}

/// [`blend_codes`] in three dimensions, of the value alone, where the curve is known.
#[inline(always)]
pub(crate) fn blend_dots<R: Real, const D: usize, const G: bool>(
    codes: Corners<R::Int>,
    offset: [R; D],
    curve: &Curve<R, D>,
) -> Dual<R, D> {
    let dots = R::cell_dots(codes.first_chunk().expect("sixteen"), [offset[0], offset[1], offset[D - 1]]);
    // (Spelled out: a copy between slices is a call where the compiler does not see this far.)
    let ([a, b, c, d, e, f, g, h], zero) = (dots, R::constant(0.0));
    let values = [a, b, c, d, e, f, g, h, zero, zero, zero, zero, zero, zero, zero, zero];
    blend::<R, D, G>(values, None, curve)
}

/// The offset from a corner. (D entries, and one more to name.)
#[inline(always)]
fn from_corner<R: Real, const D: usize>(offset: &[R; D], corner: usize) -> [R; 4] {
    let mut from = [R::constant(0.0); 4];
    for axis in 0..D {
        from[axis] = offset[axis];
        if corner >> axis & 1 == 1 {
            from[axis] = offset[axis] - R::constant(1.0);
        }
    }
    from
}

/// The blend of the sixteen corners in four dimensions, from their hashes.
#[inline(always)]
fn blend_four<R: Real, const D: usize, const G: bool>(hashes: Corners<R::Int>, offset: [R; D]) -> Dual<R, D> {
    let zero = R::constant(0.0);
    let (mut values, mut slopes) = ([zero; 16], [[zero; D]; 16]);
    for i in 0..16 {
        let [x, y, z, w] = from_corner(&offset, i);
        // Which three axes: w, x, y for 1, z, w, x for 2, and else y, z, w.
        let which = hashes[i] & R::Int::constant(24);
        let which = [which.equals(R::Int::constant(8)), which.equals(R::Int::constant(16))];
        let [a, b, c] = [sign::<R>(hashes[i], 4), sign::<R>(hashes[i], 2), sign::<R>(hashes[i], 1)];
        values[i] = a * pick(which, [w, z, y]) + b * pick(which, [x, w, z]) + c * pick(which, [y, x, w]);
        if G {
            let along = [[b, c, zero], [c, zero, a], [zero, a, b], [a, b, c]];
            for axis in 0..D {
                slopes[i][axis] = pick(which, along[axis]);
            }
        }
    }
    blend::<R, D, G>(values, if G { Some(slopes) } else { None }, &Curve::quintic(&offset))
}

/// The first number where the first is so, the second where the second is, and else the third. (No closure, and no more is
/// [`sign`]: they are not sure to be inlined.)
#[inline(always)]
fn pick<R: Real>([first, second]: [R::Mask; 2], [a, b, c]: [R; 3]) -> R {
    R::select(first, a, R::select(second, b, c))
}

/// 1 where this bit of a hash is set, else −1.
#[inline(always)]
fn sign<R: Real>(hash: R::Int, bit: i32) -> R {
    let (one, clear) = (R::constant(1.0), (hash & R::Int::constant(bit)).equals(R::Int::constant(0)));
    R::select(clear, -one, one)
}
