//! Cellular noise: distances to random feature points, one in each cell.
//!
//! Source: S. Worley, "A Cellular Texture Basis Function", SIGGRAPH 1996; with one point per cell instead of a random
//! number of them, of which the 3ᴰ nearest cells in D dimensions are searched.

use super::corners::plus_zero;
use super::{Period, Tables, hash, nan_where_none, split};
use crate::number::{Dual, Integer, Real};

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

impl Metric {
    /// Every metric.
    pub const ALL: &[Metric] = &[Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev];

    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Metric::Euclidean => "euclidean",
            Metric::Manhattan => "manhattan",
            Metric::Chebyshev => "chebyshev",
        }
    }

    /// The metric of this name.
    pub fn from_name(name: &str) -> Option<Metric> {
        Metric::ALL.iter().copied().find(|metric| metric.name() == name)
    }
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

impl Feature {
    /// Every feature.
    pub const ALL: &[Feature] = &[Feature::First, Feature::Second, Feature::Difference, Feature::Cell];

    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Feature::First => "f1",
            Feature::Second => "f2",
            Feature::Difference => "f2-f1",
            Feature::Cell => "cell",
        }
    }

    /// The feature of this name.
    pub fn from_name(name: &str) -> Option<Feature> {
        Feature::ALL.iter().copied().find(|feature| feature.name() == name)
    }
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

/// What is kept of the feature points: only the distance to the nearest one, those to two, or the nearest one's number.
const ONE: u8 = 1;
const TWO: u8 = 2;
const NUMBER: u8 = 3;

/// The noise at a point. Feature points and distances lie in its dimensions.
#[inline(always)]
pub(crate) fn evaluate<R: Real, const D: usize, const G: bool>(
    tables: &Tables,
    cellular: &Cellular,
    point: [R; D],
    period: &Period,
) -> Dual<R, D> {
    // A search for each case: what it does not need costs nothing. (The metric costs little.)
    let metric = cellular.metric;
    let mut sample = match cellular.feature {
        Feature::First if metric == Metric::Euclidean => {
            search::<R, D, G, ONE>(tables, cellular, Metric::Euclidean, point, period)
        }
        Feature::First => search::<R, D, G, ONE>(tables, cellular, metric, point, period),
        Feature::Second | Feature::Difference => search::<R, D, G, TWO>(tables, cellular, metric, point, period),
        Feature::Cell => search::<R, D, false, NUMBER>(tables, cellular, metric, point, period),
    };
    let (_, offset) = split(point);
    sample.value = plus_zero(nan_where_none(sample.value, &offset));
    sample
}

/// How far a feature point is, and where it is seen from.
#[derive(Clone, Copy)]
struct Found<R, const D: usize> {
    distance: R,
    offset: [R; D],
}

impl<R: Real, const D: usize> Found<R, D> {
    /// `yes` where the mask is set, else `no`; offsets with `G` only.
    #[inline(always)]
    fn select<const G: bool>(mask: R::Mask, yes: Self, no: Self) -> Self {
        let mut found = no;
        found.distance = R::select(mask, yes.distance, no.distance);
        if G {
            for axis in 0..D {
                found.offset[axis] = R::select(mask, yes.offset[axis], no.offset[axis]);
            }
        }
        found
    }
}

/// The rows of three cells along x that are searched: their places along y, z and w. In fewer dimensions, the first ones. (A
/// list, so that the compiler keeps the loop: dozens of copies of its body would be no faster.)
static ROWS: [[usize; 3]; 27] = {
    let mut rows = [[0; 3]; 27];
    let mut i = 0;
    while i < 27 {
        rows[i] = [i % 3, i / 3 % 3, i / 9];
        i += 1;
    }
    rows
};

/// The noise by a search for the nearest feature points.
#[inline(always)]
fn search<R: Real, const D: usize, const G: bool, const KEPT: u8>(
    tables: &Tables,
    cellular: &Cellular,
    metric: Metric,
    point: [R; D],
    period: &Period,
) -> Dual<R, D> {
    let (cell, offset) = split(point);
    let grid = Grid::new(cellular.jitter);
    // Along each axis the hashes of three cells, and the point as seen from their feature points' middles.
    let (mut hashes, mut offsets) = ([[R::Int::constant(0); 3]; 4], [[R::constant(0.0); 3]; 4]);
    for axis in 0..D {
        for step in 0..3 {
            let steps = step as f64 - 1.0;
            hashes[axis][step] = hash::coordinate(&cell, axis, steps, period);
            offsets[axis][step] =
                (offset[axis] - R::constant(steps + 0.5)) * R::constant(grid.units) + R::constant(grid.middle);
        }
    }
    let far = Found { distance: R::constant(1e30), offset: [R::constant(0.0); D] };
    let (mut first, mut second, mut number) = (far, far, R::constant(0.0));
    for &[y, z, w] in &ROWS[..3usize.pow(D as u32 - 1)] {
        let row = hashes[1][y] ^ hashes[2][z] ^ hashes[3][w] ^ R::Int::constant(tables.hash_seed);
        for x in 0..3 {
            let bits = hash::bits::<R>(row ^ hashes[0][x]);
            let corner = [offsets[0][x], offsets[1][y], offsets[2][z], offsets[3][w]];
            let found = grid.visit::<R, D>(metric, bits, corner);
            if KEPT == NUMBER {
                let closer = found.distance.less(first.distance);
                number = R::select(closer, hash::signed(bits), number);
            }
            if !G {
                if KEPT == TWO {
                    second.distance = second.distance.min(first.distance.max(found.distance));
                }
                first.distance = first.distance.min(found.distance);
                continue;
            }
            let closer = found.distance.less(first.distance);
            if KEPT == TWO {
                let between = found.distance.less(second.distance);
                let middle = Found::select::<G>(between, found, second);
                second = Found::select::<G>(closer, first, middle);
            }
            first = Found::select::<G>(closer, found, first);
        }
    }
    if KEPT == NUMBER {
        return Dual { value: number, gradient: [R::constant(0.0); D] };
    }
    let first = grid.distance::<R, D, G>(metric, first);
    if KEPT == ONE {
        return first;
    }
    let second = grid.distance::<R, D, G>(metric, second);
    if cellular.feature == Feature::Second { second } else { second - first }
}

/// The grid on which feature points lie within their cells: 1024 places along each axis, spread by the
/// jitter. Distances are counted in its units until the search is over.
struct Grid {
    /// How many of its units make a cell.
    units: f64,
    /// The place of the middle.
    middle: f64,
    /// The bits of a place: none without jitter.
    mask: i32,
}

impl Grid {
    #[inline(always)]
    fn new(jitter: f64) -> Grid {
        let places = 1024.0;
        if jitter > 0.0 {
            Grid { units: places / jitter, middle: (places - 1.0) / 2.0, mask: 1023 }
        } else {
            Grid { units: places, middle: 0.0, mask: 0 }
        }
    }

    /// The feature point that the bits place in the cell whose middle is `corner` away.
    #[inline(always)]
    fn visit<R: Real, const D: usize>(&self, metric: Metric, bits: R::Int, corner: [R; 4]) -> Found<R, D> {
        let (mut offset, mut distance) = ([R::constant(0.0); D], R::constant(0.0));
        let mut rest = bits;
        for axis in 0..D {
            // Ten bits each from the top; in four dimensions a second round gives as many again.
            let shift = if axis < 3 { 22 - 10 * axis as u32 } else { 22 };
            if axis == 3 {
                rest = hash::bits::<R>(bits);
            }
            let place = R::from_int(rest.shift_right(shift) & R::Int::constant(self.mask));
            offset[axis] = corner[axis] - place;
            let part = match metric {
                Metric::Euclidean => offset[axis] * offset[axis],
                Metric::Manhattan | Metric::Chebyshev => offset[axis].abs(),
            };
            distance = match (axis, metric) {
                (0, _) => part,
                (_, Metric::Chebyshev) => distance.max(part),
                _ => distance + part,
            };
        }
        Found { distance, offset }
    }

    /// The distance in cells, and with `G` its gradient.
    #[inline(always)]
    fn distance<R: Real, const D: usize, const G: bool>(&self, metric: Metric, found: Found<R, D>) -> Dual<R, D> {
        let (zero, one) = (R::constant(0.0), R::constant(1.0));
        let length = if metric == Metric::Euclidean { found.distance.sqrt() } else { found.distance };
        let mut sample = Dual { value: length * R::constant(1.0 / self.units), gradient: [zero; D] };
        for axis in 0..if G { D } else { 0 } {
            let offset = found.offset[axis];
            let sign = R::select(zero.less(offset), one, R::select(offset.less(zero), -one, zero));
            // At a feature point itself, where there is no slope, the gradient is given as 0.
            sample.gradient[axis] = match metric {
                Metric::Euclidean => R::select(zero.less(length), offset / length, zero),
                Metric::Manhattan => sign,
                Metric::Chebyshev => R::select(offset.abs().less(length), zero, sign),
            };
        }
        sample
    }
}
