//! Simplex noise: gradients at the corners of tetrahedra instead of cubes, so that there are four to sum instead of eight,
//! and no blending along axes; in four dimensions at the five corners of simplices instead of sixteen.
//!
//! Source: K. Perlin, "Noise Hardware", SIGGRAPH 2001 course notes, in the form of S. Gustavson, "Simplex Noise
//! Demystified", 2005: gradients towards the twelve edges of a cube, of which four count twice (the 32 of a hypercube), here
//! chosen by the hash of [`super::hash`], and with the radius √½ at which the parts of the corners fade out within their simplices (Perlin's
//! larger one leaves small jumps). In single precision the skewed coordinates round: past a million units from the
//! origin the noise is rough, past 10³⁷ it is NaN.
//!
//! A step of one unit along an axis leads from no corner to another; a step of three does in space, since the skew is ⅓. So with
//! a period, cells are stretched along its axis until a multiple of three of them fit (by a third at most for periods from
//! 3 on). In four dimensions the skew is irrational; with a period it is ¼ instead, and the multiple one of four.

use super::corners::plus_zero;
use super::{Period, Tables, hash, wrap};
use crate::number::{Dual, Integer, Real};

/// Brings the largest absolute value to 1: without it, a search that climbs from four million points of twenty seeds ends
/// at 0.013 007 2, halfway between two corners, many times over.
const SCALE: f64 = 76.88;

/// In four dimensions the largest of twenty million values of 64 seeds comes within 5 % of 1 by this.
const SCALE_FOUR: f64 = 60.0;

/// The lattice: cubes, compressed along their diagonal.
struct Shape {
    /// What times the sum of a point's coordinates, added to each, makes the corners whole numbers; and back.
    skew: f64,
    unskew: f64,
    /// With a period, the corners' coordinates are multiples of one over `parts`, and periods multiples of `units`.
    parts: f64,
    units: f64,
}

/// The lattice in `n` dimensions, with periods or without.
const fn shape(n: usize, periodic: bool) -> Shape {
    match (n, periodic) {
        (4, true) => Shape { skew: 0.25, unskew: 0.125, parts: 8.0, units: 4.0 },
        // (√5 − 1)/4 and (5 − √5)/20
        (4, false) => Shape { skew: 0.309_016_994_374_947_45, unskew: 0.138_196_601_125_010_5, parts: 0.0, units: 0.0 },
        _ => Shape { skew: 1.0 / 3.0, unskew: 1.0 / 6.0, parts: 6.0, units: 3.0 },
    }
}

/// How many units fit a period; 0 where there is none.
pub(crate) fn stretched(dimensions: usize, period: f64) -> f64 {
    let units = shape(dimensions, true).units;
    if period == 0.0 { 0.0 } else { units * (period / units).round().max(1.0) }
}

/// The noise at a point; below three dimensions the other coordinates are 0.
#[inline(always)]
pub(crate) fn evaluate<R: Real, const D: usize, const G: bool>(tables: &Tables, point: [R; D]) -> Dual<R, D> {
    sum::<R, D, G, false>(tables, point, &[0.0; 4])
}

/// The noise at a point, with periods, of which there is one at least.
#[inline(always)]
pub(crate) fn evaluate_periodic<R: Real, const D: usize, const G: bool>(
    tables: &Tables,
    point: [R; D],
    period: &Period,
    stretched: &Period,
) -> Dual<R, D> {
    let (mut point, mut stretch) = (point, [1.0; 4]);
    for axis in 0..D {
        if period[axis] != 0.0 {
            stretch[axis] = stretched[axis] / period[axis];
            point[axis] = wrap(point[axis], period[axis]) * R::constant(stretch[axis]);
        }
    }
    let mut sample = sum::<R, D, G, true>(tables, point, stretched);
    if G {
        for (part, stretch) in sample.gradient.iter_mut().zip(stretch) {
            *part = *part * R::constant(stretch);
        }
    }
    sample
}

/// The corners' parts, scaled.
#[inline(always)]
fn sum<R: Real, const D: usize, const G: bool, const P: bool>(
    tables: &Tables,
    point: [R; D],
    period: &Period,
) -> Dual<R, D> {
    let zero = R::constant(0.0);
    let mut padded = [zero; 4];
    padded[..D].copy_from_slice(&point);
    let (sum, gradient) =
        if D == 4 { sum_four::<R, G, P>(tables, padded, period) } else { sum_three::<R, G, P>(tables, padded, period) };
    let scale = R::constant(if D == 4 { SCALE_FOUR } else { SCALE });
    let mut sample = Dual { value: plus_zero(sum * scale), gradient: [zero; D] };
    if G {
        for (part, unscaled) in sample.gradient.iter_mut().zip(gradient) {
            *part = plus_zero(unscaled * scale);
        }
    }
    sample
}

/// A simplex: its first corner, and the point as seen from there. `P`: with periods.
struct Base<'a, R: Real, const P: bool> {
    seed: i32,
    period: &'a Period,
    /// The corner's coordinates in the skewed space.
    cell: [R; 4],
    /// Those and the seed, mixed for [`hash::bits`] (without periods).
    mixed: R::Int,
    /// What a step along each axis changes of that.
    changes: [R::Int; 4],
    offset: [R; 4],
}

impl<'a, R: Real, const P: bool> Base<'a, R, P> {
    /// The one around a point of N dimensions.
    #[inline(always)]
    fn new<const N: usize>(seed: i32, point: [R; 4], period: &'a Period) -> Self {
        let Shape { skew, unskew, .. } = const { shape(N, P) };
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
        Base { seed, period, cell, mixed, changes, offset }
    }

    /// The random bits of the corner that is a step away along the axes of the mask, and the point as seen from there.
    /// (`number`: how many steps.)
    #[inline(always)]
    fn corner<const N: usize>(&self, steps: [R::Mask; 4], number: usize) -> (R::Int, [R; 4]) {
        let (mut mixed, mut from) = (self.mixed, self.offset);
        let (zero, stay) = (R::Int::constant(0), number as f64 * const { shape(N, P).unskew });
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
        if P {
            mixed = self.mixed_within_period::<N>(steps, number);
        }
        (hash::bits::<R>(mixed), from)
    }

    /// The corner's unskewed coordinates, in whole parts, within the periods, mixed with the seed.
    #[inline(always)]
    fn mixed_within_period<const N: usize>(&self, steps: [R::Mask; 4], number: usize) -> R::Int {
        let mut corner = self.cell;
        for axis in 0..if number == 0 { 0 } else { N } {
            let next = corner[axis] + R::constant(1.0);
            corner[axis] = if number == N { next } else { R::select(steps[axis], next, corner[axis]) };
        }
        let (sum, parts) = (total::<R, N>(&corner), const { shape(N, P).parts });
        let mut mixed = R::Int::constant(self.seed);
        for (axis, &corner) in corner[..N].iter().enumerate() {
            let coordinate = wrap(corner * R::constant(parts) - sum, self.period[axis] * parts);
            mixed = mixed ^ (coordinate.to_int() * R::Int::constant(hash::FACTORS[axis]));
        }
        mixed
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
fn sum_three<R: Real, const G: bool, const P: bool>(tables: &Tables, point: [R; 4], period: &Period) -> (R, [R; 4]) {
    let base = Base::<R, P>::new::<3>(tables.hash_seed, point, period);
    // From the first corner to the last one goes one step along each axis, along the axis of the largest offset first.
    let [x, y, z, _] = base.offset;
    let (yx, zx, zy) = (x.less(y), x.less(z), y.less(z));
    let first = [!(yx | zx), yx & !zy, zx & zy, yx];
    let second = [!(yx & zx), yx | !zy, zx | zy, yx];
    let mut sum = (R::constant(0.0), [R::constant(0.0); 4]);
    for (number, steps) in [first, first, second, second].into_iter().enumerate() {
        let (bits, from) = base.corner::<3>(steps, number);
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
fn sum_four<R: Real, const G: bool, const P: bool>(tables: &Tables, point: [R; 4], period: &Period) -> (R, [R; 4]) {
    let (zero, one) = (R::constant(0.0), R::constant(1.0));
    let base = Base::<R, P>::new::<4>(tables.hash_seed, point, period);
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
        let (bits, from) = base.corner::<4>(steps, number);
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
