//! Fractal sums: octaves of one noise, each of a higher frequency and a smaller amplitude than the one before.
//!
//! The multifractal sums follow F. K. Musgrave in Ebert et al., "Texturing and Modeling: A Procedural Approach", chapter
//! "Procedural Fractal Terrains", with his offsets and with the amplitudes as powers of the gain.

use crate::filter::Fade;
use crate::noise::{Map, Noise, map};
use crate::number::{Dual, Real};
use crate::simd::{self, Kernel, Level, Terms};

/// What an octave adds to a [`Sum`].
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
        match self {
            Combine::Plain => "plain",
            Combine::Absolute => "absolute",
            Combine::Ridged => "ridged",
            Combine::Hybrid => "hybrid",
        }
    }

    /// The way of this name.
    pub fn from_name(name: &str) -> Option<Combine> {
        Combine::ALL.iter().copied().find(|combine| combine.name() == name)
    }
}

/// A sum over K octaves of a noise: Σ gᵏ n(lᵏ p) for k from 0 to K − 1, with the lacunarity l and the gain g; or the same
/// with another term for n: see [`Combine`].
///
/// The octaves are added in this order, in the precision of the number type; frequencies and amplitudes are rounded to
/// it from double precision. With the lacunarity 2 and the gain ½ they are exact.
#[derive(Debug, Clone, PartialEq)]
pub struct Sum {
    noise: Noise,
    combine: Combine,
    octaves: u32,
    /// What the amplitude of the last octave is multiplied by.
    last: f64,
    lacunarity: f64,
    gain: f64,
}

/// What Musgrave adds to the noise in the hybrid sum.
const HYBRID_OFFSET: f64 = 0.7;

/// The gain by which he weights an octave of the ridged sum with the one before.
const RIDGED_WEIGHT: f64 = 2.0;

impl Sum {
    /// A sum of so many octaves, of lacunarity 2 and gain ½; of none it is zero.
    pub fn new(noise: Noise, combine: Combine, octaves: u32) -> Self {
        Sum { noise, combine, octaves, last: 1.0, lacunarity: 2.0, gain: 0.5 }
    }

    /// The same sum with a number of octaves that need not be whole: the part past the point is the weight of one more
    /// octave, which fades in. Below 0 and NaN count as 0; more than 1024 as 1024.
    pub fn with_octaves(mut self, octaves: f64) -> Self {
        let octaves = if octaves > 0.0 { octaves.min(1024.0) } else { 0.0 };
        self.octaves = octaves.ceil() as u32;
        self.last = 1.0 - (octaves.ceil() - octaves);
        self
    }

    /// The same sum with another ratio between the frequencies of neighbouring octaves. (With a period, the sum repeats
    /// if this is a whole number.)
    pub fn with_lacunarity(mut self, lacunarity: f64) -> Self {
        self.lacunarity = lacunarity;
        self
    }

    /// The same sum with another ratio between the amplitudes of neighbouring octaves.
    pub fn with_gain(mut self, gain: f64) -> Self {
        self.gain = gain;
        self
    }

    /// The noise that is summed.
    pub fn noise(&self) -> &Noise {
        &self.noise
    }

    /// What each octave adds.
    pub fn combine(&self) -> Combine {
        self.combine
    }

    /// The number of octaves, with one that fades in counted as a whole one.
    pub fn octaves(&self) -> u32 {
        self.octaves
    }

    /// Bounds of the sum for gains from 0 to 1: no value is outside, though the nearest ones may be well within.
    pub fn range(&self) -> [f64; 2] {
        let [low, high] = self.noise.range();
        let largest = high.max(-low);
        let terms = self.terms();
        let amplitudes: f64 = (0..self.octaves).map(|octave| terms.amplitude(octave).abs()).sum();
        let [least, most] = match self.combine {
            Combine::Plain => [low, high],
            Combine::Absolute => [low.max(0.0), largest],
            Combine::Ridged => [0.0, (largest - 1.0).powi(2).max(1.0)],
            Combine::Hybrid if low + HYBRID_OFFSET >= 0.0 => [0.0, high + HYBRID_OFFSET],
            Combine::Hybrid => [-largest - HYBRID_OFFSET, largest + HYBRID_OFFSET],
        };
        [least * amplitudes, most * amplitudes]
    }

    /// The value at a point of two or three dimensions (two: the slice z = 0), in the precision of the number type.
    #[inline(always)]
    pub fn value<R: Real, const D: usize>(&self, point: [R; D]) -> R {
        self.evaluate(point, None)
    }

    /// The sum as it looks through a sample of the side `footprint`, in the units of the point: each octave fades to its
    /// mean as the footprint grows past its cells, so that what a picture cannot resolve turns even rather than noisy.
    /// At a footprint of 0 this is [`Sum::value`].
    ///
    /// The root mean square of the difference from the true average over the footprint, for improved noise of five octaves,
    /// is below 0.08 (plain) and 0.06 (absolute) everywhere, and below 0.025 from a footprint of four units on. (What
    /// remains comes from the neighbours, of which the value at the centre does not know.)
    #[inline(always)]
    pub fn value_filtered<R: Real, const D: usize>(&self, point: [R; D], footprint: R) -> R {
        self.evaluate(point, Some(footprint))
    }

    #[inline(always)]
    fn evaluate<R: Real, const D: usize>(&self, point: [R; D], footprint: Option<R>) -> R {
        let folded = matches!(self.combine, Combine::Absolute | Combine::Ridged);
        let fade = Fade::of(self.noise.basis(), folded, D);
        let terms = self.terms();
        let (zero, one) = (R::constant(0.0), R::constant(1.0));
        let (mut sum, mut weight) = (zero, one);
        let mut frequency = 1.0;
        for octave in 0..self.octaves {
            let amplitude = R::constant(terms.amplitude(octave));
            let mut noise = self.octave(point, frequency);
            if folded {
                noise = noise.abs();
            }
            if let Some(footprint) = footprint {
                noise = fade.apply(noise, footprint * R::constant(frequency));
            }
            let term = match self.combine {
                Combine::Plain | Combine::Absolute => amplitude * noise,
                Combine::Ridged => {
                    let ridge = one - noise;
                    let signal = weight * (ridge * ridge);
                    let next = signal * R::constant(RIDGED_WEIGHT);
                    weight = R::select(one.less(next), one, next);
                    amplitude * signal
                }
                Combine::Hybrid => {
                    let signal = amplitude * (noise + R::constant(HYBRID_OFFSET));
                    let term = weight * signal;
                    weight = R::select(one.less(term), one, term);
                    term
                }
            };
            sum = sum + term;
            frequency *= self.lacunarity;
        }
        sum
    }

    /// The noise of one octave.
    #[inline(always)]
    fn octave<R: Real, const D: usize>(&self, point: [R; D], frequency: f64) -> R {
        let mut scaled = point;
        for coordinate in &mut scaled {
            *coordinate = *coordinate * R::constant(frequency);
        }
        self.noise.octave(scaled, frequency)
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
        let sum = if self.is_plain() { self.noise.sum_at(simd::level(), &self.terms(), point) } else { None };
        sum.unwrap_or_else(|| self.value(point))
    }

    /// [`Sum::fill`] with the instructions of a level, at most those of the machine. For tests and measurements.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_at<const D: usize>(&self, level: Level, points: [&[f32]; D], values: &mut [f32]) {
        if self.is_plain() {
            let rest = |level, points: [&[f32]; D], values: &mut [f32]| map(self, level, points, values);
            self.noise.sum_with(level, &self.terms(), points, values, rest);
        } else {
            map(self, level, points, values);
        }
    }

    /// The values at many points, each with its footprint: the same bits as [`Sum::value_filtered`] in single precision.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_filtered<const D: usize>(&self, points: [&[f32]; D], footprints: &[f32], values: &mut [f32]) {
        self.fill_filtered_at(simd::level(), points, footprints, values);
    }

    /// [`Sum::fill_filtered`] with the instructions of a level, at most those of the machine. For tests and measurements.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_filtered_at<const D: usize>(
        &self,
        level: Level,
        points: [&[f32]; D],
        footprints: &[f32],
        values: &mut [f32],
    ) {
        const { assert!(D == 2 || D == 3, "a noise has two or three dimensions") };
        match D {
            2 => self.map_filtered_plane(level, [points[0], points[1], footprints], values),
            _ => self.map_filtered_space(level, [points[0], points[1], points[D - 1], footprints], values),
        }
    }

    #[inline(never)]
    fn map_filtered_plane(&self, level: Level, inputs: [&[f32]; 3], values: &mut [f32]) {
        simd::map_at(level, &Filtered(self), inputs, values);
    }

    #[inline(never)]
    fn map_filtered_space(&self, level: Level, inputs: [&[f32]; 4], values: &mut [f32]) {
        simd::map_at(level, &Filtered(self), inputs, values);
    }

    #[inline(always)]
    fn terms(&self) -> Terms {
        Terms {
            octaves: self.octaves,
            absolute: self.combine == Combine::Absolute,
            lacunarity: self.lacunarity,
            gain: self.gain,
            last: self.last,
        }
    }

    /// Whether the octaves are independent of each other.
    fn is_plain(&self) -> bool {
        matches!(self.combine, Combine::Plain | Combine::Absolute)
    }
}

impl<const D: usize> Kernel<D> for Sum {
    #[inline(always)]
    fn run<R: Real>(&self, point: [R; D]) -> R {
        self.value(point)
    }
}

/// A sum whose last input is the footprint.
struct Filtered<'a>(&'a Sum);

impl Kernel<3> for Filtered<'_> {
    #[inline(always)]
    fn run<R: Real>(&self, [x, y, footprint]: [R; 3]) -> R {
        self.0.value_filtered([x, y], footprint)
    }
}

impl Kernel<4> for Filtered<'_> {
    #[inline(always)]
    fn run<R: Real>(&self, [x, y, z, footprint]: [R; 4]) -> R {
        self.0.value_filtered([x, y, z], footprint)
    }
}

impl Map for Sum {
    #[inline(never)]
    fn map_plane(&self, level: Level, points: [&[f32]; 2], values: &mut [f32]) {
        simd::map_at(level, self, points, values);
    }

    #[inline(never)]
    fn map_space(&self, level: Level, points: [&[f32]; 3], values: &mut [f32]) {
        simd::map_at(level, self, points, values);
    }
}
