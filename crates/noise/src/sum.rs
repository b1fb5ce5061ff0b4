//! Fractal sums: octaves of one noise, each of twice the frequency and half the amplitude of the one before.

use crate::noise::Noise;
use crate::number::{Dual, Real};
use crate::simd::{self, Kernel, Level, Terms};

/// What an octave adds to a [`Sum`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Combine {
    /// The noise itself: fractional Brownian motion, mean zero.
    Plain,
    /// Its absolute value: turbulence, zero at least, with creases where the noise passes zero. [Perlin 1985]
    Absolute,
}

impl Combine {
    /// Every way.
    pub const ALL: &[Combine] = &[Combine::Plain, Combine::Absolute];

    /// The word for it in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Combine::Plain => "plain",
            Combine::Absolute => "absolute",
        }
    }

    /// The way of this name.
    pub fn from_name(name: &str) -> Option<Combine> {
        Combine::ALL.iter().copied().find(|combine| combine.name() == name)
    }
}

/// A sum over K octaves of a noise: Σ 2⁻ᵏ n(2ᵏ p) for k from 0 to K − 1, or the same with |n|.
///
/// The octaves are added in this order, in the precision of the number type. The sum is below twice the largest absolute
/// value of the noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Sum {
    noise: Noise,
    combine: Combine,
    octaves: u32,
}

impl Sum {
    /// The ratio between the frequencies of neighbouring octaves.
    pub const LACUNARITY: f64 = 2.0;
    /// The ratio between the amplitudes of neighbouring octaves.
    pub const GAIN: f64 = 0.5;

    /// A sum of so many octaves; of none it is zero.
    pub fn new(noise: Noise, combine: Combine, octaves: u32) -> Self {
        Sum { noise, combine, octaves }
    }

    /// The noise that is summed.
    pub fn noise(&self) -> &Noise {
        &self.noise
    }

    /// What each octave adds.
    pub fn combine(&self) -> Combine {
        self.combine
    }

    /// The number of octaves.
    pub fn octaves(&self) -> u32 {
        self.octaves
    }

    /// The value at a point of two or three dimensions (two: the slice z = 0), in the precision of the number type.
    #[inline(always)]
    pub fn value<R: Real, const D: usize>(&self, point: [R; D]) -> R {
        let (mut frequency, mut amplitude) = (1.0, 1.0);
        let mut sum = R::constant(0.0);
        for _ in 0..self.octaves {
            let mut scaled = point;
            for coordinate in &mut scaled {
                *coordinate = *coordinate * R::constant(frequency);
            }
            let noise = self.noise.octave(scaled, frequency);
            let term = match self.combine {
                Combine::Plain => noise,
                Combine::Absolute => noise.abs(),
            };
            sum = sum + R::constant(amplitude) * term;
            frequency *= Self::LACUNARITY;
            amplitude *= Self::GAIN;
        }
        sum
    }

    /// The value at a point, and its exact derivative along each axis.
    pub fn value_and_gradient<R: Real, const D: usize>(&self, point: [R; D]) -> (R, [R; D]) {
        let dual = self.value(Dual::point(point));
        (dual.value, dual.gradient)
    }

    /// The values at many points: one slice of coordinates per axis (two or three), one slice for the values. The same
    /// bits as [`Sum::value`] in single precision.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill<const D: usize>(&self, points: [&[f32]; D], values: &mut [f32]) {
        self.fill_at(simd::level(), points, values);
    }

    /// The value at one point in single precision, with the machine's vector instructions.
    pub fn at<const D: usize>(&self, point: [f32; D]) -> f32 {
        self.noise.sum_at(simd::level(), &self.terms(), point).unwrap_or_else(|| self.value(point))
    }

    /// [`Sum::fill`] with the instructions of a level, at most those of the machine. For tests and measurements.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_at<const D: usize>(&self, level: Level, points: [&[f32]; D], values: &mut [f32]) {
        self.noise.sum_with(self, level, &self.terms(), points, values);
    }

    fn terms(&self) -> Terms {
        Terms {
            octaves: self.octaves,
            absolute: self.combine == Combine::Absolute,
            lacunarity: Self::LACUNARITY as f32,
            gain: Self::GAIN as f32,
        }
    }
}

impl<const D: usize> Kernel<D> for Sum {
    #[inline(always)]
    fn run<R: Real>(&self, point: [R; D]) -> R {
        self.value(point)
    }
}
