//! What an octave adds to a sum, and how the octaves before weigh on it.

use crate::declaration::{Declaration, SUMS};
use crate::number::{Dual, Real};

/// What Musgrave adds to the noise in the hybrid sum.
pub(super) const HYBRID_OFFSET: f64 = 0.7;

/// The gain by which he weights an octave of the ridged sum with the one before.
const RIDGED_WEIGHT: f64 = 2.0;

/// What an octave adds to a [`Sum`](crate::Sum).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Combine {
    /// The noise itself: fractional Brownian motion, mean zero.
    Plain,
    /// Its absolute value: turbulence, zero at least, with creases where the noise passes zero. \[Perlin 1985\]
    Absolute,
    /// (1 − |noise|)², with sharp ridges where the noise passes zero; weighted by twice the octave before (at most 1), so
    /// that slopes are smooth and ridges rough. \[Musgrave\]
    Ridged,
    /// noise + 0.7, weighted by the product of the octaves before (at most 1), so that valleys are smooth and heights
    /// rough. \[Musgrave\]
    Hybrid,
}

impl Combine {
    /// Every way.
    pub const ALL: &[Combine] = &[Combine::Plain, Combine::Absolute, Combine::Ridged, Combine::Hybrid];

    /// The word for it in scenes.
    pub fn name(self) -> &'static str {
        self.declaration().name
    }

    /// The way of this name or term.
    pub fn from_name(name: &str) -> Option<Combine> {
        Declaration::find(SUMS, name)
    }

    /// Whether the octaves are independent of each other.
    #[inline(always)]
    pub(super) fn is_plain(self) -> bool {
        matches!(self, Combine::Plain | Combine::Absolute)
    }

    /// Whether it is the absolute value of the noise that counts.
    #[inline(always)]
    pub(super) fn folds(self) -> bool {
        matches!(self, Combine::Absolute | Combine::Ridged)
    }

    /// The noise, or its absolute value.
    #[inline(always)]
    pub(crate) fn fold<R: Real, const D: usize, const G: bool>(self, mut noise: Dual<R, D>) -> Dual<R, D> {
        if self.folds() {
            let negative = noise.value.less(R::constant(0.0));
            noise.value = noise.value.abs();
            for axis in 0..if G { D } else { 0 } {
                noise.gradient[axis] = R::select(negative, -noise.gradient[axis], noise.gradient[axis]);
            }
        }
        noise
    }

    /// An octave's term of a multifractal sum, whose weight becomes that of the next octave.
    #[inline(always)]
    fn weighted<N: Real>(self, noise: N, amplitude: f64, weight: &mut N) -> N {
        let (one, amplitude) = (N::constant(1.0), N::constant(amplitude));
        if self == Combine::Ridged {
            let ridge = one - noise;
            let signal = *weight * (ridge * ridge);
            let next = signal * N::constant(RIDGED_WEIGHT);
            *weight = N::select(one.less(next), one, next);
            amplitude * signal
        } else {
            let signal = amplitude * (noise + N::constant(HYBRID_OFFSET));
            let term = *weight * signal;
            *weight = N::select(one.less(term), one, term);
            term
        }
    }
}

/// A sum of the octaves so far.
#[derive(Clone, Copy)]
pub(crate) struct Partial<R, const D: usize> {
    pub sum: Dual<R, D>,
    /// What the next octave of a multifractal sum is multiplied by.
    pub weight: Dual<R, D>,
}

impl<R: Real, const D: usize> Partial<R, D> {
    /// Of no octaves.
    #[inline(always)]
    pub fn new() -> Self {
        let of = |value| Dual { value: R::constant(value), gradient: [R::constant(0.0); D] };
        Partial { sum: of(0.0), weight: of(1.0) }
    }

    /// Adds an octave: its noise, folded, with the gradient along the point times the frequency.
    #[inline(always)]
    pub fn add<const G: bool>(&mut self, combine: Combine, frequency: f64, amplitude: f64, mut noise: Dual<R, D>) {
        let sum = &mut self.sum;
        if combine.is_plain() {
            sum.value = sum.value + R::constant(amplitude) * noise.value;
            for axis in 0..if G { D } else { 0 } {
                let slope = R::constant(amplitude * frequency);
                sum.gradient[axis] = sum.gradient[axis] + slope * noise.gradient[axis];
            }
        } else if G {
            for axis in 0..D {
                noise.gradient[axis] = noise.gradient[axis] * R::constant(frequency);
            }
            *sum = *sum + combine.weighted(noise, amplitude, &mut self.weight);
        } else {
            sum.value = sum.value + combine.weighted(noise.value, amplitude, &mut self.weight.value);
        }
    }
}
