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
use crate::simd::{self, Level, Vector, Wide};

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
    let mut sample = Dual { value: zero, gradient: [zero; D] };
    if D == 4 {
        let mut padded = [zero; 4];
        padded[..D].copy_from_slice(&point);
        let (sum, gradient) = sum_four::<R, G, P>(tables, padded, period);
        let scale = R::constant(SCALE_FOUR);
        sample.value = plus_zero(sum * scale);
        if G {
            for (part, unscaled) in sample.gradient.iter_mut().zip(gradient) {
                *part = plus_zero(unscaled * scale);
            }
        }
    } else {
        let mut padded = [zero; 3];
        padded[..D].copy_from_slice(&point);
        let tetrahedron = Tetrahedron::new::<P>(tables.hash_seed, Cell::new(padded), period);
        let in_space = tetrahedron.sum::<G>();
        sample.value = in_space.value;
        if G {
            sample.gradient.copy_from_slice(&in_space.gradient[..D]);
        }
    }
    sample
}

/// The sum of some coordinates.
#[inline(always)]
fn total<R: Real, const N: usize>(parts: &[R; N]) -> R {
    let mut sum = parts[0] + parts[1];
    for &part in &parts[2..] {
        sum = sum + part;
    }
    sum
}

/// The coordinates of a corner, in the skewed space, as random bits to be: mixed with the seed.
#[inline(always)]
fn mixed_within_period<R: Real, const N: usize>(seed: i32, corner: [R; N], period: &Period) -> R::Int {
    // Unskewed they are whole parts.
    let (sum, parts) = (total(&corner), const { shape(N, true).parts });
    let mut mixed = R::Int::constant(seed);
    for (axis, &corner) in corner.iter().enumerate() {
        let coordinate = wrap(corner * R::constant(parts) - sum, period[axis] * parts);
        mixed = mixed ^ (coordinate.to_int() * R::Int::constant(hash::FACTORS[axis]));
    }
    mixed
}

/// Random bits from mixed coordinates, of which the upper four are good: a product of the number with itself and another one,
/// where [`hash::bits`] takes two. (A product by a constant alone leaves neighbours that are not independent.)
#[inline(always)]
fn random<R: Real>(mixed: R::Int) -> R::Int {
    mixed * (mixed + R::Int::constant(0x9e37_79b9_u32 as i32))
}

/// The cube of the skewed space in which a point lies.
#[derive(Clone, Copy)]
struct Cell<R: Real> {
    /// Its lowest corner.
    corner: [R; 3],
    /// That as integers, times the factors of [`hash`].
    mixed: [R::Int; 3],
    /// The point's offset from there, in the skewed space: from 0 to 1.
    within: [R; 3],
}

impl<R: Real> Cell<R> {
    #[inline(always)]
    fn new(point: [R; 3]) -> Self {
        let (mut corner, mut within, mut mixed) = (point, point, [R::Int::constant(0); 3]);
        let shift = total(&point) * R::constant(const { shape(3, false).skew });
        for axis in 0..3 {
            let skewed = point[axis] + shift;
            corner[axis] = skewed.floor();
            within[axis] = skewed - corner[axis];
            mixed[axis] = corner[axis].to_int() * R::Int::constant(hash::FACTORS[axis]);
        }
        Cell { corner, mixed, within }
    }

    /// The coordinates of the tetrahedron's corners, mixed with the seed.
    #[inline(always)]
    fn mixed_corners(&self, seed: i32, rising: R::Mask, first_z: R::Mask, last_z: R::Mask) -> [R::Int; 4] {
        let mut changes = self.mixed;
        for (change, factor) in changes.iter_mut().zip(hash::FACTORS) {
            // What the step to the next cell changes.
            *change = (*change + R::Int::constant(factor)) ^ *change;
        }
        let [x, y, z] = changes;
        let here = R::Int::constant(seed) ^ self.mixed[0] ^ self.mixed[1] ^ self.mixed[2];
        let there = here ^ x ^ y ^ z;
        let first = R::select_int(first_z, z, R::select_int(rising, y, x));
        let last = R::select_int(last_z, z, R::select_int(rising, x, y));
        [here, here ^ first, there ^ last, there]
    }
}

/// The tetrahedron of that cube in which the point lies. From its first corner to the last one goes one step along each axis,
/// along that of the largest offset first, along that of the least one last. (Of equal ones any will do: the corners between
/// count nothing there.)
#[derive(Clone, Copy)]
struct Tetrahedron<R: Real> {
    /// The point's offset from the first corner.
    offset: [R; 3],
    /// The sum of the skewed offsets, the largest and the least of them.
    total: R,
    largest: R,
    least: R,
    /// Whether y is larger than x, whether z is the largest, whether it is the least.
    rising: R::Mask,
    first_z: R::Mask,
    last_z: R::Mask,
    /// Random bits of the corners; the upper four are good.
    bits: [R::Int; 4],
}

impl<R: Real> Tetrahedron<R> {
    #[inline(always)]
    fn new<const P: bool>(seed: i32, cell: Cell<R>, period: &Period) -> Self {
        let [x, y, z] = cell.within;
        let sum = total(&cell.within);
        let shift = sum * R::constant(const { shape(3, false).unskew });
        let (larger, smaller, rising) = (x.max(y), x.min(y), x.less(y));
        let (first_z, last_z) = (larger.less(z), z.less(smaller));
        let mut tetrahedron = Tetrahedron {
            offset: [x - shift, y - shift, z - shift],
            total: sum,
            largest: larger.max(z),
            least: smaller.min(z),
            rising,
            first_z,
            last_z,
            bits: cell.mixed_corners(seed, rising, first_z, last_z),
        };
        if P {
            let (mut corners, one) = ([cell.corner; 4], R::constant(1.0));
            for (axis, &here) in cell.corner.iter().enumerate() {
                corners[1][axis] = here + tetrahedron.along::<false>(axis, one);
                corners[2][axis] = here + one - tetrahedron.along::<true>(axis, one);
                corners[3][axis] = here + one;
            }
            for (bits, corner) in tetrahedron.bits.iter_mut().zip(corners) {
                *bits = mixed_within_period::<R, 3>(seed, corner, period);
            }
        }
        for bits in &mut tetrahedron.bits {
            *bits = random::<R>(*bits);
        }
        tetrahedron
    }

    /// The sum over the corners, scaled, and with `G` its gradient.
    #[inline(always)]
    fn sum<const G: bool>(&self) -> Dual<R, 3> {
        let zero = R::constant(0.0);
        let [half, two] = [R::constant(0.5), R::constant(2.0)];
        // ½ − r² at the first corner; at the others it follows from that.
        let [x, y, z] = self.offset;
        let square = x * x + y * y + z * z;
        let (first, rest) = (half - square, R::constant(-0.25) - square);
        let inside = [
            first,
            rest.plus_exact(two, self.largest).plus_exact(-half, self.total),
            (R::constant(-0.5) - square + self.total).plus_exact(-two, self.least),
            rest.plus_exact(half, self.total),
        ];
        let (is_first, is_last) = ([self.first_z, self.rising], [self.last_z, self.rising]);
        let parts = [
            self.part::<0, 0>(inside[0], is_first),
            self.part::<1, -1>(inside[1], is_first),
            self.part::<2, 1>(inside[2], is_last),
            self.part::<3, 0>(inside[3], is_last),
        ];
        let value = parts[0].value + parts[1].value + parts[2].value + parts[3].value;
        let (scale, mut gradient) = (R::constant(SCALE), [zero; 3]);
        if G {
            // −8t³ times the dot product, times the offset from each corner.
            let inward = [parts[0].inward, parts[1].inward, parts[2].inward, parts[3].inward];
            let all = (inward[0] + inward[1]) + (inward[2] + inward[3]);
            let moved = inward[1] * R::constant(MOVES[1])
                + (inward[2] * R::constant(MOVES[2]) + inward[3] * R::constant(MOVES[3]));
            for part in &parts {
                let edge = R::edge(part.code);
                for axis in 0..3 {
                    gradient[axis] = gradient[axis].plus_exact(part.fourth, edge[axis]);
                }
            }
            for (axis, slope) in gradient.iter_mut().enumerate() {
                let back = self.along::<false>(axis, inward[1]);
                let forth = self.along::<true>(axis, inward[2]);
                let parts = all * self.offset[axis] + (moved + (forth - back));
                *slope = zero.plus_exact(slope.plus_exact(R::constant(-8.0), parts), scale);
            }
        }
        Dual { value: zero.plus_exact(value, scale), gradient }
    }

    /// That of a corner, given its t = ½ − r² and a step's axis.
    #[inline(always)]
    fn part<const CORNER: usize, const STEP: i32>(&self, inside: R, axis: [R::Mask; 2]) -> Part<R> {
        // t⁴, none beyond. (Zero is the one that a NaN replaces.)
        let inside = R::constant(0.0).max(inside);
        let square = inside * inside;
        let fourth = square * square;
        let code = self.bits[CORNER].shift_right(28);
        let dot = R::tetrahedron_dot::<STEP>(code, self.offset, MOVES[CORNER], axis);
        Part { value: fourth * dot, code, fourth, inward: square * inside * dot }
    }

    /// The value where the axis is that of the largest offset (or the least), else zero.
    #[inline(always)]
    fn along<const LEAST: bool>(&self, axis: usize, value: R) -> R {
        let (zero, is_z) = (R::constant(0.0), if LEAST { self.last_z } else { self.first_z });
        if axis == 2 {
            return R::select(is_z, value, zero);
        }
        let (if_rising, else_) = if (axis == 1) != LEAST { (value, zero) } else { (zero, value) };
        R::select(is_z, zero, R::select(self.rising, if_rising, else_))
    }
}

/// What a corner contributes: t⁴ times the dot product of its edge with the offset.
struct Part<R: Real> {
    value: R,
    /// The edge's.
    code: R::Int,
    /// t⁴ alone, and t³ times that dot product.
    fourth: R,
    inward: R,
}

/// By how much the corners of a tetrahedron lie, along all axes, from the first one, before the steps: a third of a step for
/// each, with the full steps of the last two turned round.
const MOVES: [f64; 4] = [0.0, 1.0 / 6.0, -2.0 / 3.0, -0.5];

/// The noise without periods at many points in space, and with four outputs its gradient; returns for how many points, which
/// are whole vectors.
pub(crate) fn fill<const N: usize>(
    level: Level,
    tables: &Tables,
    points: [&[f32]; 3],
    outputs: [&mut [f32]; N],
) -> usize {
    let mut done = 0;
    simd::run_wide(level, InSteps { seed: tables.hash_seed, points, outputs, done: &mut done });
    done
}

/// A point's way through the noise is a long chain of operations. So each turn of the loop takes three vectors one step each: it
/// sums the corners of one, finds the tetrahedra of the next and the cells of the one after that, of which none waits for another.
/// (It takes a fifth of the time off.)
struct InSteps<'a, const N: usize> {
    seed: i32,
    points: [&'a [f32]; 3],
    outputs: [&'a mut [f32]; N],
    done: &'a mut usize,
}

impl<const N: usize> Wide for InSteps<'_, N> {
    #[inline(always)]
    fn run<V: Vector<LANES>, const LANES: usize>(self) {
        let [x, y, z] = self.points;
        let (x, y, z) = (x.as_chunks::<LANES>().0, y.as_chunks::<LANES>().0, z.as_chunks::<LANES>().0);
        let mut outputs = self.outputs.map(|output| output.as_chunks_mut::<LANES>().0);
        let count = x.len();
        assert!(y.len() == count && z.len() == count);
        for output in &outputs {
            assert!(output.len() == count);
        }
        if count == 0 {
            return;
        }
        let (seed, last, none) = (self.seed, count - 1, [0.0; 4]);
        let mut tetrahedron = Tetrahedron::new::<false>(seed, cell::<V, LANES>(&x[0], &y[0], &z[0]), &none);
        let second = last.min(1);
        let mut before = cell::<V, LANES>(&x[second], &y[second], &z[second]);
        let Some((values, slopes)) = outputs.split_first_mut() else { return };
        for (i, value) in values.iter_mut().enumerate() {
            let third = last.min(i + 2);
            let next_tetrahedron = Tetrahedron::new::<false>(seed, before, &none);
            let sample = if N == 4 { tetrahedron.sum::<true>() } else { tetrahedron.sum::<false>() };
            sample.value.store(value);
            for (slopes, part) in slopes.iter_mut().zip(sample.gradient) {
                part.store(&mut slopes[i]);
            }
            let next = cell::<V, LANES>(&x[third], &y[third], &z[third]);
            (before, tetrahedron) = (next, next_tetrahedron);
        }
        *self.done = count * LANES;
    }
}

/// The cells of the points of a vector.
#[inline(always)]
fn cell<V: Vector<LANES>, const LANES: usize>(x: &[f32; LANES], y: &[f32; LANES], z: &[f32; LANES]) -> Cell<V> {
    Cell::new([V::load(x), V::load(y), V::load(z)])
}

/// The sum over the corners of a simplex of four dimensions and, with `G`, its gradient.
#[inline(always)]
fn sum_four<R: Real, const G: bool, const P: bool>(tables: &Tables, point: [R; 4], period: &Period) -> (R, [R; 4]) {
    let (zero, one) = (R::constant(0.0), R::constant(1.0));
    let Shape { skew, unskew, .. } = const { shape(4, P) };
    let (mut cell, mut offset, mut here) = (point, point, [R::Int::constant(0); 4]);
    let mut there = here;
    let shift = total(&point) * R::constant(skew);
    for axis in 0..4 {
        cell[axis] = (point[axis] + shift).floor();
        let factor = R::Int::constant(hash::FACTORS[axis]);
        here[axis] = cell[axis].to_int() * factor;
        there[axis] = here[axis] + factor;
    }
    let shift = total(&cell) * R::constant(unskew);
    for axis in 0..4 {
        offset[axis] = point[axis] - (cell[axis] - shift);
    }
    // Along which axes is the offset larger than along how many others?
    let mut rank = [zero; 4];
    for low in 0..4 {
        for high in low + 1..4 {
            let above = offset[low].less(offset[high]);
            rank[low] = rank[low] + R::select(above, zero, one);
            rank[high] = rank[high] + R::select(above, one, zero);
        }
    }
    let mut sum = (zero, [zero; 4]);
    for number in 0..5 {
        // The corner lies one step away along the axes of highest rank, `number` of them.
        let (mut corner, mut from) = (cell, offset);
        let mut mixed = R::Int::constant(tables.hash_seed);
        for axis in 0..4 {
            let step = R::constant(3.5 - number as f64).less(rank[axis]);
            let stay = number as f64 * unskew;
            corner[axis] = R::select(step, cell[axis] + one, cell[axis]);
            from[axis] = offset[axis] + R::select(step, R::constant(stay - 1.0), R::constant(stay));
            mixed = mixed ^ R::select_int(step, there[axis], here[axis]);
        }
        if P {
            mixed = mixed_within_period(tables.hash_seed, corner, period);
        }
        let bits = hash::bits::<R>(mixed);
        // One of the four axes has no part; the other three have random signs.
        let without = bits.shift_right(30);
        let mut gradient = [zero; 4];
        for (axis, part) in gradient.iter_mut().enumerate() {
            let sign = bits & R::Int::constant(1 << (axis + 20));
            let signed = R::select(sign.equals(R::Int::constant(0)), one, -one);
            *part = R::select(without.equals(R::Int::constant(axis as i32)), zero, signed);
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Integer;

    /// The edge code of a corner.
    fn code(seed: i32, [x, y, z]: [i32; 3]) -> usize {
        type Int = <f32 as Real>::Int;
        let part = |axis: usize, cell: i32| Int::constant(cell) * Int::constant(hash::FACTORS[axis]);
        let mixed = Int::constant(seed) ^ part(0, x) ^ part(1, y) ^ part(2, z);
        random::<f32>(mixed).shift_right(28).0 as usize
    }

    #[test]
    fn edges_of_neighbouring_corners_are_independent() {
        const SIDE: i32 = 64;
        let steps = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1], [-1, 2, 0], [64, 0, -256]];
        for seed in [0, 0x1234_5678, -77] {
            for (i, first) in steps.iter().enumerate() {
                for second in [first.map(|step| 2 * step), steps[(i + 1) % steps.len()]] {
                    let mut counts = vec![0u32; 4096];
                    for cell in 0..SIDE * SIDE * SIDE {
                        let corner = [cell % SIDE - 20, cell / SIDE % SIDE, cell / SIDE / SIDE];
                        let moved = |by: [i32; 3]| std::array::from_fn(|axis| corner[axis] + by[axis]);
                        let codes = [code(seed, corner), code(seed, moved(*first)), code(seed, moved(second))];
                        counts[(codes[0] * 16 + codes[1]) * 16 + codes[2]] += 1;
                    }
                    // χ² with 4095 degrees of freedom: its deviation is √8190, and of 36 the largest seldom passes 4 of them.
                    let expected = f64::from(SIDE.pow(3)) / 4096.0;
                    let square: f64 =
                        counts.iter().map(|&count| (f64::from(count) - expected).powi(2) / expected).sum();
                    let deviations = (square - 4095.0) / 8190f64.sqrt();
                    assert!(deviations.abs() < 4.0, "{seed}, {first:?}, {second:?}: {deviations}");
                }
            }
        }
    }
}
