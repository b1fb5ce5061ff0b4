//! Simplex noise: gradients at the corners of tetrahedra instead of cubes, so that there are four to sum instead of eight,
//! and no blending along axes.
//!
//! Source: K. Perlin, "Noise Hardware", SIGGRAPH 2001 course notes, in the form of S. Gustavson, "Simplex Noise
//! Demystified", 2005: the twelve edge directions by the permutation, here with the radius √½ at which the parts of
//! the corners fade out within their tetrahedra (Perlin's larger one leaves small jumps). In single precision the skewed
//! coordinates round: past a million units from the origin the noise is rough, past 10³⁷ it is NaN.

use super::{Tables, hash_byte, plus_zero};
use crate::number::{Integer, Real};

/// Brings the largest absolute value to 1: without it, a search that climbs from four million points of twenty seeds ends
/// at 0.013 007 2, halfway between two corners, many times over.
const SCALE: f64 = 76.88;

/// The noise at a point of two or three dimensions; the other coordinate is 0.
#[inline(always)]
pub(crate) fn value<R: Real, const D: usize>(tables: &Tables, point: [R; D]) -> R {
    let (zero, one) = (R::constant(0.0), R::constant(1.0));
    let [px, py] = [point[0], point[1]];
    let pz = if D == 3 { point[D - 1] } else { zero };
    // In skewed coordinates the corners are whole numbers.
    let skew = (px + py + pz) * R::constant(1.0 / 3.0);
    let cell = [(px + skew).floor(), (py + skew).floor(), (pz + skew).floor()];
    let unskew = (cell[0] + cell[1] + cell[2]) * R::constant(1.0 / 6.0);
    let offset = [px - (cell[0] - unskew), py - (cell[1] - unskew), pz - (cell[2] - unskew)];
    // From the first corner to the last one goes one step along each axis, along the axis of the largest offset first.
    let [x, y, z] = offset;
    let (yx, zx, zy) = (x.less(y), x.less(z), y.less(z));
    let first = [R::select(yx | zx, zero, one), R::select(yx & !zy, one, zero), R::select(zx & zy, one, zero)];
    let second = [R::select(yx & zx, zero, one), R::select(!yx & zy, zero, one), R::select(zx | zy, one, zero)];
    let mut sum = zero;
    for (number, step) in [[zero; 3], first, second, [one; 3]].into_iter().enumerate() {
        let shift = R::constant(number as f64 / 6.0);
        let from = [x - step[0] + shift, y - step[1] + shift, z - step[2] + shift];
        sum = sum + corner(tables, [cell[0] + step[0], cell[1] + step[1], cell[2] + step[2]], from);
    }
    plus_zero(sum * R::constant(SCALE))
}

/// The part of a corner at the offset `from` it.
#[inline(always)]
fn corner<R: Real>(tables: &Tables, cell: [R; 3], from: [R; 3]) -> R {
    let hash = hash_byte::<R>(&tables.permutation, cell[0].to_int());
    let hash = hash_byte::<R>(&tables.permutation, hash + cell[1].to_int());
    let code = R::lookup(&tables.edges, hash + cell[2].to_int());
    let [x, y, z] = from;
    let inside = R::constant(0.5) - (x * x + y * y + z * z);
    // The comparison in this order keeps NaN.
    let inside = R::select(inside.less(R::constant(0.0)), R::constant(0.0), inside);
    let square = inside * inside;
    square * square * R::edge_dot(code & R::Int::constant(15), x, y, z)
}
