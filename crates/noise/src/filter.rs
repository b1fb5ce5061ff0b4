//! How a noise looks when it is averaged over a footprint: the band limit of the sums.
//!
//! A footprint is divided into three parts along each axis, and each part is judged by the noise at its centre. (Footprints
//! of less than a quarter of a cell are judged as a whole; from an eighth on, the two ways blend.) The best guess at the average of a noise n over a square or cube of side s, from its value at the centre, is
//! m + w(s) (n − m), with the mean m and w = cov(n, average) / var(n). Measured (800 footprints of 256 points each, for
//! seven sides up to 2), w(s) is close to exp(−r s²); the rates r below fit it best. The mean of the absolute value is not zero,
//! so that turbulence fades to grey and not to black.
//!
//! From footprints of eight cells on, the mean is all that is left.

use crate::basis::Basis;
use crate::math;
use crate::number::{Dual, Real};

/// How fast, and to what, a noise fades.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fade {
    rate: f64,
    mean: f64,
}

impl Fade {
    /// That of a noise, or of its absolute value, in two or three dimensions; of cellular noise with its default
    /// parameters.
    pub fn of(basis: Basis, absolute: bool, dimensions: usize) -> Fade {
        // Rates: of the noise in the plane and in space, of its absolute value likewise; means of the absolute value.
        let (rates, means) = match basis {
            Basis::Improved => ([[0.69, 0.86], [1.42, 1.82]], [0.204, 0.220]),
            Basis::Classic => ([[0.61, 0.74], [1.15, 1.56]], [0.139, 0.148]),
            Basis::Lattice => ([[0.25, 0.37], [0.57, 0.88]], [0.356, 0.303]),
            Basis::Value => ([[0.26, 0.40], [0.59, 0.88]], [0.372, 0.327]),
            Basis::Simplex => ([[1.50, 2.43], [3.39, 5.75]], [0.315, 0.315]),
            Basis::Cellular => ([[0.90, 1.06], [0.92, 1.06]], [0.43, 0.52]),
            Basis::White => ([[0.48, 0.86], [0.49, 0.85]], [0.5, 0.5]),
        };
        let space = usize::from(dimensions > 2);
        let signed = basis != Basis::Cellular && !absolute;
        Fade { rate: rates[usize::from(absolute)][space], mean: if signed { 0.0 } else { means[space] } }
    }

    /// The noise (or its absolute value) at the centre of a footprint, faded; as it is where the footprint is zero. (Here and
    /// below: with `G` its gradient too, for footprints that stay the same.)
    #[inline(always)]
    pub fn apply<R: Real, const D: usize, const G: bool>(self, mut noise: Dual<R, D>, footprint: R) -> Dual<R, D> {
        let lost = R::constant(1.0) - math::exp(footprint * footprint * R::constant(-self.rate));
        noise.value = noise.value + lost * (R::constant(self.mean) - noise.value);
        for axis in 0..if G { D } else { 0 } {
            noise.gradient[axis] = noise.gradient[axis] - lost * noise.gradient[axis];
        }
        noise
    }

    /// [`Fade::apply`] for those who see no difference below [`FAINT`], and nothing but the mean from afar.
    #[inline(always)]
    pub fn apply_alone<R: Real, const D: usize, const G: bool>(self, noise: Dual<R, D>, footprint: R) -> Dual<R, D> {
        let zero = R::constant(0.0);
        let seen = footprint - R::constant(FAINT);
        let faded = self.apply::<R, D, G>(noise, R::select(seen.less(zero), zero, seen));
        self.mean_from_afar::<R, D, G>(faded, footprint)
    }

    /// The noise over a footprint: from its value at the centre, and from the average of those at the centres of the parts.
    #[inline(always)]
    pub fn blend<R: Real, const D: usize, const G: bool>(
        self,
        centre: Dual<R, D>,
        parts: Dual<R, D>,
        footprint: R,
    ) -> Dual<R, D> {
        let (zero, one) = (R::constant(0.0), R::constant(1.0));
        let whole = self.apply::<R, D, G>(centre, footprint);
        let parts = self.apply::<R, D, G>(parts, footprint * R::constant(1.0 / 3.0));
        let share = footprint * R::constant(1.0 / NEAR) - one;
        let share = R::select(share.less(zero), zero, R::select(one.less(share), one, share));
        let near = footprint.less(R::constant(NEAR));
        let mut blended = whole;
        blended.value = R::select(near, whole.value, whole.value + share * (parts.value - whole.value));
        for axis in 0..if G { D } else { 0 } {
            let (whole, parts) = (whole.gradient[axis], parts.gradient[axis]);
            blended.gradient[axis] = R::select(near, whole, whole + share * (parts - whole));
        }
        self.mean_from_afar::<R, D, G>(blended, footprint)
    }

    #[inline(always)]
    fn mean_from_afar<R: Real, const D: usize, const G: bool>(self, mut noise: Dual<R, D>, footprint: R) -> Dual<R, D> {
        let far = R::constant(FAR).less(footprint);
        noise.value = R::select(far, R::constant(self.mean), noise.value);
        for axis in 0..if G { D } else { 0 } {
            noise.gradient[axis] = R::select(far, R::constant(0.0), noise.gradient[axis]);
        }
        noise
    }
}

/// Up to here (in cells) a footprint is judged as a whole, from twice as much on by its parts.
pub(crate) const NEAR: f64 = 0.125;

/// Footprints below (in cells) are points to [`Fade::apply_alone`].
pub(crate) const FAINT: f64 = 0.05;

/// Beyond, only the mean is left.
pub(crate) const FAR: f64 = 8.0;

/// How many parts a footprint has in `D` dimensions.
pub(crate) const fn parts(dimensions: usize) -> usize {
    3usize.pow(dimensions as u32)
}

/// The centre of a part along an axis, as a share of the footprint from its centre.
#[inline(always)]
pub(crate) fn part_centre(part: usize, axis: usize) -> f64 {
    ((part / parts(axis) % 3) as f64 - 1.0) / 3.0
}

/// Adds the noise at the centre of a part to the average of all parts.
#[inline(always)]
pub(crate) fn add_part<R: Real, const D: usize, const G: bool>(average: &mut Dual<R, D>, noise: Dual<R, D>) {
    let share = R::constant(1.0 / parts(D) as f64);
    average.value = average.value + share * noise.value;
    for axis in 0..if G { D } else { 0 } {
        average.gradient[axis] = average.gradient[axis] + share * noise.gradient[axis];
    }
}
