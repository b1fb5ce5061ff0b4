//! Cellular noise: distances to random feature points, one in each cell.
//!
//! Source: S. Worley, "A Cellular Texture Basis Function", SIGGRAPH 1996; with one point per cell instead of a random
//! number of them, of which the 27 (in the plane 9) nearest cells are searched.

use super::{Period, Tables, hash, plus_zero, split};
use crate::number::{Integer, Real};

/// How the distance between two points is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Metric {
    /// As the crow flies.
    Euclidean,
    /// The sum of the distances along the axes.
    Manhattan,
    /// The largest of the distances along the axes.
    Chebyshev,
}

/// What cellular noise tells of the feature points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Feature {
    /// The distance to the nearest one (F1).
    First,
    /// The distance to the second nearest one (F2).
    Second,
    /// The difference of both (F2 − F1), zero halfway between two feature points.
    Difference,
    /// A random number in [-1, 1), the same wherever the same feature point is the nearest one.
    Cell,
}

/// The parameters of cellular noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cellular {
    /// How distances are measured.
    pub metric: Metric,
    /// What is told.
    pub feature: Feature,
    /// How far the feature points stray from the centres of their cells: from 0 (not at all) to 1 (all over the cell).
    pub jitter: f64,
}

impl Default for Cellular {
    /// The Euclidean distance to the nearest feature point, which may be anywhere in its cell.
    fn default() -> Self {
        Cellular { metric: Metric::Euclidean, feature: Feature::First, jitter: 1.0 }
    }
}

/// The nearest feature points so far.
struct Nearest<R: Real> {
    first: R,
    second: R,
    bits: R,
}

/// The noise at a point of two or three dimensions; in two, feature points and distances lie in the plane.
#[inline(always)]
pub(crate) fn value<R: Real, const D: usize>(
    tables: &Tables,
    cellular: &Cellular,
    point: [R; D],
    period: &Period,
) -> R {
    let (cell, offset) = split(point);
    let far = R::constant(1e9);
    let mut nearest = Nearest { first: far, second: far, bits: R::constant(0.0) };
    let range = |deep: bool| if deep { -1..=1 } else { 0..=0 };
    for dz in range(D == 3) {
        let (mut z, mut z_offset) = (R::Int::constant(0), None);
        if D == 3 {
            z = hash::coordinate(&cell, D - 1, f64::from(dz), period);
            z_offset = Some(offset[D - 1] - R::constant(f64::from(dz)));
        }
        for dy in range(true) {
            let y = hash::coordinate(&cell, 1, f64::from(dy), period);
            let y_offset = offset[1] - R::constant(f64::from(dy));
            for dx in range(true) {
                let x = hash::coordinate(&cell, 0, f64::from(dx), period);
                let x_offset = offset[0] - R::constant(f64::from(dx));
                let bits = hash::bits::<R>(tables.hash_seed, x, y, z);
                visit(&mut nearest, cellular, bits, (x_offset, y_offset, z_offset));
            }
        }
    }
    let mut value = finish(nearest, cellular);
    // Nothing, or NaN where a coordinate is none.
    for part in offset {
        value = value + part * R::constant(0.0);
    }
    plus_zero(value)
}

/// Takes one feature point into account; the offset is that from the corner of its cell.
#[inline(always)]
fn visit<R: Real>(nearest: &mut Nearest<R>, cellular: &Cellular, bits: R::Int, offset: (R, R, Option<R>)) {
    let (x, y, z) = offset;
    let dx = (x - feature::<R>(bits, cellular.jitter)).abs();
    let dy = (y - feature::<R>(bits.shift_right(10), cellular.jitter)).abs();
    let dz = match z {
        Some(z) => (z - feature::<R>(bits.shift_right(20), cellular.jitter)).abs(),
        None => R::constant(0.0),
    };
    // (Euclidean distances are compared by their squares.)
    let distance = match cellular.metric {
        Metric::Euclidean => dx * dx + dy * dy + dz * dz,
        Metric::Manhattan => dx + dy + dz,
        Metric::Chebyshev => R::select(dx.less(dy), dy, dx).max(dz),
    };
    let closer = distance.less(nearest.first);
    let between = distance.less(nearest.second);
    nearest.second = R::select(closer, nearest.first, R::select(between, distance, nearest.second));
    nearest.first = R::select(closer, distance, nearest.first);
    nearest.bits = R::select(closer, hash::signed(bits), nearest.bits);
}

/// A coordinate of a feature point within its cell, from the low ten bits.
#[inline(always)]
fn feature<R: Real>(bits: R::Int, jitter: f64) -> R {
    let unit = R::from_int(bits & R::Int::constant(1023)) - R::constant(511.5);
    unit * R::constant(jitter / 1024.0) + R::constant(0.5)
}

#[inline(always)]
fn finish<R: Real>(nearest: Nearest<R>, cellular: &Cellular) -> R {
    let (mut first, mut second) = (nearest.first, nearest.second);
    if cellular.metric == Metric::Euclidean {
        (first, second) = (first.sqrt(), second.sqrt());
    }
    match cellular.feature {
        Feature::First => first,
        Feature::Second => second,
        Feature::Difference => second - first,
        Feature::Cell => nearest.bits,
    }
}
