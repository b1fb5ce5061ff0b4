//! What the noises on a lattice of cubes share: the hashes of a cell's corners, and the blend between them.
//!
//! A cell in D dimensions has 2ᴰ corners. Their order is that of binary numbers: bit 0 of a corner's index says whether it
//! is the upper one along x, bit 1 along y, and so on. Arrays have room for the sixteen of four dimensions.

use super::{Period, Tables, wrap};
use crate::number::{Dual, Integer, Real};
use crate::table::PairTable;

/// Room for the corners of a cell.
pub(crate) type Corners<T> = [T; 16];

/// The lattice coordinates below and above along one axis.
#[inline(always)]
pub(super) fn ends<R: Real>(cell: R, period: f64) -> (R::Int, R::Int) {
    (wrap(cell, period).to_int(), wrap(cell + R::constant(1.0), period).to_int())
}

/// The table's entry alone.
#[inline(always)]
fn hash_byte<R: Real>(table: &PairTable, index: R::Int) -> R::Int {
    R::lookup_pair(table, index).0
}

/// The corners' hashes so far, 2ᵃ of them, become those of one more axis.
#[inline(always)]
pub(super) fn hash_axis<R: Real, const D: usize>(
    tables: &Tables,
    hashes: &mut Corners<R::Int>,
    axis: usize,
    cell: &[R; D],
    period: &Period,
) {
    let (table, count) = (&tables.permutation, 1 << axis);
    if period[axis] == 0.0 {
        let coordinate = cell[axis].to_int();
        for i in 0..count {
            (hashes[i], hashes[i + count]) = R::lookup_pair(table, hashes[i] + coordinate);
        }
    } else {
        let (low, high) = ends(cell[axis], period[axis]);
        for i in 0..count {
            let before = hashes[i];
            hashes[i] = hash_byte::<R>(table, before + low);
            hashes[i + count] = hash_byte::<R>(table, before + high);
        }
    }
}

/// The hashes of all corners. Below three dimensions, those of the slice in which the other coordinates are zero.
#[inline(always)]
pub(super) fn hash<R: Real, const D: usize>(tables: &Tables, cell: &[R; D], period: &Period) -> Corners<R::Int> {
    let mut hashes = [R::Int::constant(0); 16];
    for axis in 0..D {
        hash_axis(tables, &mut hashes, axis, cell, period);
    }
    for _ in D..3 {
        hash_zero::<R, D>(tables, &mut hashes);
    }
    hashes
}

/// The corners' hashes on an axis whose coordinate is zero.
#[inline(always)]
pub(super) fn hash_zero<R: Real, const D: usize>(tables: &Tables, hashes: &mut Corners<R::Int>) {
    for hash in hashes.iter_mut().take(1 << D) {
        *hash = hash_byte::<R>(&tables.permutation, *hash);
    }
}

/// How far a point is between the corners: along each axis the curve from 0 to 1, and its slope.
pub(crate) struct Curve<R, const D: usize> {
    pub at: [R; D],
    pub slope: [R; D],
}

impl<R: Real, const D: usize> Curve<R, D> {
    /// 6t⁵ − 15t⁴ + 10t³, whose slope 30t²(t − 1)² and curvature vanish at both ends. \[Perlin 2002\]
    #[inline(always)]
    pub fn quintic(offset: &[R; D]) -> Self {
        let (mut at, mut slope) = (*offset, *offset);
        for axis in 0..D {
            let t = offset[axis];
            at[axis] = quintic(t, [R::constant(6.0), R::constant(15.0), R::constant(10.0)]);
            let bump = t * (t - R::constant(1.0));
            slope[axis] = bump * bump * R::constant(30.0);
        }
        Curve { at, slope }
    }

    /// 3t² − 2t³, whose slope 6t(1 − t) vanishes at both ends. \[Perlin 1985\]
    #[inline(always)]
    pub fn cubic(offset: &[R; D]) -> Self {
        let (mut at, mut slope) = (*offset, *offset);
        for axis in 0..D {
            let t = offset[axis];
            at[axis] = t * t * (R::constant(3.0) - R::constant(2.0) * t);
            slope[axis] = t * (R::constant(1.0) - t) * R::constant(6.0);
        }
        Curve { at, slope }
    }
}

/// The curve of [`Curve::quintic`], from its coefficients.
#[inline(always)]
pub(crate) fn quintic<R: Real>(t: R, [six, fifteen, ten]: [R; 3]) -> R {
    t * t * t * (t * (t * six - fifteen) + ten)
}

/// From a to b.
#[inline(always)]
pub(crate) fn lerp<R: Real>(t: R, a: R, b: R) -> R {
    a + t * (b - a)
}

/// The corners' values, blended axis by axis, x first. With `G`, the gradient too, which is that of the curve between the
/// values and, where the values have slopes themselves, the blend of those. The signs of zeros are unspecified.
#[inline(always)]
pub(super) fn blend<R: Real, const D: usize, const G: bool>(
    mut values: Corners<R>,
    slopes: Option<Corners<[R; D]>>,
    curve: &Curve<R, D>,
) -> Dual<R, D> {
    let zero = R::constant(0.0);
    let sloped = slopes.is_some();
    let mut gradients = slopes.unwrap_or([[zero; D]; 16]);
    for axis in 0..D {
        let (t, slope) = (curve.at[axis], curve.slope[axis]);
        for i in 0..1 << (D - 1 - axis) {
            let rise = values[2 * i + 1] - values[2 * i];
            values[i] = values[2 * i] + t * rise;
            if !G {
                continue;
            }
            let (low, high) = (gradients[2 * i], gradients[2 * i + 1]);
            for (along, part) in gradients[i].iter_mut().enumerate() {
                // Before their turn, values without slopes have none.
                if sloped || along < axis {
                    *part = low[along] + t * (high[along] - low[along]);
                }
                if along == axis {
                    *part = if sloped { *part + slope * rise } else { slope * rise };
                }
            }
        }
    }
    Dual { value: values[0], gradient: gradients[0] }
}

/// The same value; a zero becomes `+0`. The number types may disagree on the sign of a zero until here.
#[inline(always)]
pub(super) fn plus_zero<R: Real>(value: R) -> R {
    value + R::constant(0.0)
}

/// [`plus_zero`] of the value and, with `G`, of the gradient.
#[inline(always)]
pub(super) fn with_plus_zeros<R: Real, const D: usize, const G: bool>(sample: Dual<R, D>) -> Dual<R, D> {
    let mut sample = sample;
    sample.value = plus_zero(sample.value);
    for axis in 0..if G { D } else { 0 } {
        sample.gradient[axis] = plus_zero(sample.gradient[axis]);
    }
    sample
}
