//! Simplex noise: gradients at the corners of tetrahedra instead of cubes, so that there are four to sum instead of eight,
//! and no blending along axes; in four dimensions at the five corners of simplices instead of sixteen.
//!
//! Source: K. Perlin, "Noise Hardware", SIGGRAPH 2001 course notes, in the form of S. Gustavson, "Simplex Noise
//! Demystified", 2005: gradients towards the twelve edges of a cube, of which four count twice (the 32 of a hypercube), here
//! chosen by the hash of [`super::hash`], and with the radius √½ at which the parts of the corners fade out within their simplices (Perlin's
//! larger one leaves small jumps). In single precision the skewed coordinates round: past a million units from the
//! origin the noise is rough, past 10³⁷ it is NaN.

use super::corners::plus_zero;
use super::{Tables, hash};
use crate::number::{Dual, Integer, Real};

/// Brings the largest absolute value to 1: without it, a search that climbs from four million points of twenty seeds ends
/// at 0.013 007 2, halfway between two corners, many times over.
const SCALE: f64 = 76.88;

/// In four dimensions the largest of twenty million values of 64 seeds comes within 5 % of 1 by this.
const SCALE_FOUR: f64 = 60.0;

/// The noise at a point; below three dimensions the other coordinates are 0.
#[inline(always)]
pub(crate) fn evaluate<R: Real, const D: usize, const G: bool>(tables: &Tables, point: [R; D]) -> Dual<R, D> {
    let zero = R::constant(0.0);
    let mut padded = [zero; 4];
    padded[..D].copy_from_slice(&point);
    let (sum, gradient) = if D == 4 { sum_four::<R, G>(tables, padded) } else { sum_three::<R, G>(tables, padded) };
    let scale = R::constant(if D == 4 { SCALE_FOUR } else { SCALE });
    let mut sample = Dual { value: plus_zero(sum * scale), gradient: [zero; D] };
    if G {
        for (part, unscaled) in sample.gradient.iter_mut().zip(gradient) {
            *part = plus_zero(unscaled * scale);
        }
    }
    sample
}

/// A simplex: its first corner, and the point as seen from there.
struct Base<R: Real> {
    /// The corner's coordinates and the seed, mixed for [`hash::bits`].
    mixed: R::Int,
    /// What a step along each axis changes of that.
    changes: [R::Int; 4],
    offset: [R; 4],
}

impl<R: Real> Base<R> {
    /// The one around a point of N dimensions. `skew` makes the corners whole numbers, `unskew` goes back.
    #[inline(always)]
    fn new<const N: usize>(seed: i32, point: [R; 4], skew: f64, unskew: f64) -> Self {
        let (mut cell, mut offset, mut hashes) = (point, point, [R::Int::constant(0); 4]);
        let mut changes = hashes;
        let shift = total::<R, N>(&point) * R::constant(skew);
        for axis in 0..N {
            cell[axis] = (point[axis] + shift).floor();
            hashes[axis] = cell[axis].to_int() * R::Int::constant(hash::FACTORS[axis]);
        }
        let mut mixed = hashes[0] ^ R::Int::constant(seed);
        for axis in 0..N {
            if axis > 0 {
                mixed = mixed ^ hashes[axis];
            }
            // What the step to the next cell changes.
            changes[axis] = (hashes[axis] + R::Int::constant(hash::FACTORS[axis])) ^ hashes[axis];
        }
        let shift = total::<R, N>(&cell) * R::constant(unskew);
        for axis in 0..N {
            offset[axis] = point[axis] - (cell[axis] - shift);
        }
        Base { mixed, changes, offset }
    }

    /// The random bits of the corner that is a step away along the axes of the mask, and the point as seen from there.
    /// (`number`: how many steps.)
    #[inline(always)]
    fn corner<const N: usize>(&self, steps: [R::Mask; 4], number: usize, unskew: f64) -> (R::Int, [R; 4]) {
        let (mut mixed, mut from) = (self.mixed, self.offset);
        let (zero, stay) = (R::Int::constant(0), number as f64 * unskew);
        for axis in 0..if number == 0 { 0 } else { N } {
            let (here, there) = (R::constant(stay), R::constant(stay - 1.0));
            if number == N {
                mixed = mixed ^ self.changes[axis];
                from[axis] = from[axis] + there;
            } else {
                mixed = mixed ^ R::select_int(steps[axis], self.changes[axis], zero);
                from[axis] = from[axis] + R::select(steps[axis], there, here);
            }
        }
        (hash::bits::<R>(mixed), from)
    }
}

#[inline(always)]
fn total<R: Real, const N: usize>(parts: &[R; 4]) -> R {
    let mut sum = parts[0] + parts[1];
    for &part in &parts[2..N] {
        sum = sum + part;
    }
    sum
}

#[inline(always)]
fn sum_three<R: Real, const G: bool>(tables: &Tables, point: [R; 4]) -> (R, [R; 4]) {
    const UNSKEW: f64 = 1.0 / 6.0;
    let base = Base::new::<3>(tables.hash_seed, point, 1.0 / 3.0, UNSKEW);
    // From the first corner to the last one goes one step along each axis, along the axis of the largest offset first.
    let [x, y, z, _] = base.offset;
    let (yx, zx, zy) = (x.less(y), x.less(z), y.less(z));
    let first = [!(yx | zx), yx & !zy, zx & zy, yx];
    let second = [!(yx & zx), yx | !zy, zx | zy, yx];
    let mut sum = (R::constant(0.0), [R::constant(0.0); 4]);
    for (number, steps) in [first, first, second, second].into_iter().enumerate() {
        let (bits, from) = base.corner::<3>(steps, number, UNSKEW);
        let code = bits.shift_right(28);
        if G {
            let [x, y, z] = R::edge(code);
            add_corner::<R, 3, G>(&mut sum, from, [x, y, z, x]);
        } else {
            let part = falloff::<R, 3>(&from).0 * R::edge_dot(code, from[0], from[1], from[2]);
            sum.0 = if number == 0 { part } else { sum.0 + part };
        }
    }
    sum
}

#[inline(always)]
fn sum_four<R: Real, const G: bool>(tables: &Tables, point: [R; 4]) -> (R, [R; 4]) {
    // (√5 − 1)/4 and (5 − √5)/20
    const SKEW: f64 = 0.309_016_994_374_947_45;
    const UNSKEW: f64 = 0.138_196_601_125_010_5;
    let (zero, one) = (R::constant(0.0), R::constant(1.0));
    let base = Base::new::<4>(tables.hash_seed, point, SKEW, UNSKEW);
    // Along which axes is the offset larger than along how many others?
    let mut rank = [zero; 4];
    for low in 0..4 {
        for high in low + 1..4 {
            let above = base.offset[low].less(base.offset[high]);
            rank[low] = rank[low] + R::select(above, zero, one);
            rank[high] = rank[high] + R::select(above, one, zero);
        }
    }
    let mut sum = (zero, [zero; 4]);
    for number in 0..5 {
        let bound = R::constant(3.5 - number as f64);
        let steps = [bound.less(rank[0]), bound.less(rank[1]), bound.less(rank[2]), bound.less(rank[3])];
        let (bits, from) = base.corner::<4>(steps, number, UNSKEW);
        // One of the four axes has no part; the other three have random signs.
        let sign = |bit: i32| R::select((bits & R::Int::constant(bit << 20)).equals(R::Int::constant(0)), one, -one);
        let without = bits.shift_right(30);
        let part = |axis: i32| R::select(without.equals(R::Int::constant(axis)), zero, sign(1 << axis));
        let gradient = [part(0), part(1), part(2), part(3)];
        add_corner::<R, 4, G>(&mut sum, from, gradient);
    }
    sum
}

/// How much a corner counts, t⁴ with t = ½ − r² (none beyond), and t and t³.
#[inline(always)]
fn falloff<R: Real, const N: usize>(from: &[R; 4]) -> (R, R) {
    let mut square = from[0] * from[0];
    for &part in &from[1..N] {
        square = square + part * part;
    }
    // (Zero is the one that a NaN replaces.)
    let inside = R::constant(0.0).max(R::constant(0.5) - square);
    let square = inside * inside;
    (square * square, square * inside)
}

/// Adds the part of a corner with this gradient at the offset `from` it.
#[inline(always)]
fn add_corner<R: Real, const N: usize, const G: bool>(sum: &mut (R, [R; 4]), from: [R; 4], gradient: [R; 4]) {
    let mut dot = gradient[0] * from[0];
    for axis in 1..N {
        dot = dot + gradient[axis] * from[axis];
    }
    let (fourth, cube) = falloff::<R, N>(&from);
    sum.0 = sum.0 + fourth * dot;
    if G {
        let inward = cube * dot * R::constant(-8.0);
        for axis in 0..N {
            sum.1[axis] = sum.1[axis] + (fourth * gradient[axis] + inward * from[axis]);
        }
    }
}
