//! A noise ready to evaluate: a basis, the tables of a seed, a period.

use std::fmt;
use std::sync::Arc;

use crate::basis::cellular::{Cellular, Feature, Metric};
use crate::basis::{Basis, Period, Tables, cellular, classic, improved, lattice, simplex, value, white};
use crate::number::{Dual, Real};
use crate::simd::{self, Kernel, Level, Terms};

/// A noise: points in, numbers out. Cheap to clone; immutable.
#[derive(Debug, Clone)]
pub struct Noise {
    basis: Basis,
    seed: u64,
    period: Period,
    cellular: Cellular,
    tables: Arc<Tables>,
}

/// Why [`Noise::with_period`] refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PeriodError {
    /// The axis, from 0.
    pub axis: usize,
    /// The period that was asked for.
    pub period: u32,
    /// The longest one that the noise can have; 0 if it can have none.
    pub longest: u32,
}

impl fmt::Display for PeriodError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let axis = ["x", "y", "z"][self.axis.min(2)];
        match self.longest {
            0 => write!(formatter, "this noise repeats along no axis, found a period of {} along {axis}", self.period),
            longest => write!(formatter, "expected a period up to {longest} along {axis}, found {}", self.period),
        }
    }
}

impl std::error::Error for PeriodError {}

impl Noise {
    /// The longest period that an axis may have: up to here single precision counts cells one by one.
    pub const LONGEST_PERIOD: u32 = 1 << 24;

    /// The noise of this basis and seed. Seed 0 has the published permutation, other seeds a shuffle of it.
    pub fn new(basis: Basis, seed: u64) -> Self {
        Noise { basis, seed, period: [0.0; 3], cellular: Cellular::default(), tables: Arc::new(Tables::new(seed)) }
    }

    /// The same noise, repeating after so many cells along x, y and z: the value at p and at p + period are the same
    /// bits wherever single precision represents both points exactly. 0 leaves an axis at the 256 of the noises with a
    /// table, and without a period otherwise.
    ///
    /// # Errors
    /// When a period is longer than [`Noise::LONGEST_PERIOD`], and for simplex noise, whose lattice is skewed.
    pub fn with_period(mut self, period: [u32; 3]) -> Result<Self, PeriodError> {
        let longest = if self.basis == Basis::Simplex { 0 } else { Self::LONGEST_PERIOD };
        if let Some(axis) = period.iter().position(|&cells| cells > longest) {
            return Err(PeriodError { axis, period: period[axis], longest });
        }
        self.period = period.map(f64::from);
        Ok(self)
    }

    /// The same noise with these parameters of [`Basis::Cellular`]; the other bases have no use for them. The jitter is
    /// clamped to 0…1.
    pub fn with_cellular(mut self, cellular: Cellular) -> Self {
        let jitter = if cellular.jitter > 0.0 { cellular.jitter.min(1.0) } else { 0.0 };
        self.cellular = Cellular { jitter, ..cellular };
        self
    }

    /// The least and the largest value.
    pub fn range(&self) -> [f64; 2] {
        let largest = match (self.basis, self.cellular.feature) {
            (Basis::Improved, _) => 1.04,
            (Basis::Classic, _) => 0.87,
            (Basis::Lattice | Basis::Value | Basis::Simplex | Basis::White, _) => 1.0,
            (Basis::Cellular, Feature::Cell) => 1.0,
            // The own cell's point is within the cell, and that of the nearest neighbour at most half a cell further.
            (Basis::Cellular, feature) => {
                let step = if feature == Feature::First { 1.0 } else { 1.5f64 };
                return match self.cellular.metric {
                    Metric::Euclidean => [0.0, (step * step + 2.0).sqrt()],
                    Metric::Manhattan => [0.0, step + 2.0],
                    Metric::Chebyshev => [0.0, step],
                };
            }
        };
        [-largest, largest]
    }

    /// The basis.
    pub fn basis(&self) -> Basis {
        self.basis
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The value at a point of two or three dimensions (two: the slice z = 0), in the precision of the number type.
    #[inline(always)]
    pub fn value<R: Real, const D: usize>(&self, point: [R; D]) -> R {
        self.octave(point, 1.0)
    }

    /// The value at a point, and its exact derivative along each axis.
    pub fn value_and_gradient<R: Real, const D: usize>(&self, point: [R; D]) -> (R, [R; D]) {
        let dual = self.value(Dual::point(point));
        (dual.value, dual.gradient)
    }

    /// The values at many points: one slice of coordinates per axis (two or three), one slice for the values. The same
    /// bits as [`Noise::value`] in single precision.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill<const D: usize>(&self, points: [&[f32]; D], values: &mut [f32]) {
        self.fill_at(simd::level(), points, values);
    }

    /// The value at one point in single precision, with the machine's vector instructions.
    #[inline]
    pub fn at<const D: usize>(&self, point: [f32; D]) -> f32 {
        let mut value = None;
        if D == 3 && self.has_kernel() {
            value = simd::improved_at(simd::level(), &self.tables, [point[0], point[1], point[D - 1]]);
        }
        value.unwrap_or_else(|| self.value(point))
    }

    /// [`Noise::fill`] with the instructions of a level, at most those of the machine. For tests and measurements.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_at<const D: usize>(&self, level: Level, points: [&[f32]; D], values: &mut [f32]) {
        self.sum_with(level, &Terms::ONE, points, values, |level, points, values| map(self, level, points, values));
    }

    /// Fills `values` with a sum of this noise, as far as there is a kernel made by hand for it, the rest by the generic
    /// evaluation `rest` of the same sum.
    pub(crate) fn sum_with<const D: usize>(
        &self,
        level: Level,
        terms: &Terms,
        points: [&[f32]; D],
        values: &mut [f32],
        rest: impl Fn(Level, [&[f32]; D], &mut [f32]),
    ) {
        let mut done = 0;
        if self.has_kernel() {
            done = simd::sum_improved(level, &self.tables, terms, points, values);
        }
        if values.len() - done <= simd::FEW {
            while done < values.len() {
                let Some(sum) = self.sum_at(level, terms, points.map(|coordinates| coordinates[done])) else { break };
                values[done] = sum;
                done += 1;
            }
        }
        if done < values.len() {
            rest(level, points.map(|coordinates| &coordinates[done..]), &mut values[done..]);
        }
    }

    /// Whether this is the noise that the kernels made by hand are for.
    #[inline]
    fn has_kernel(&self) -> bool {
        self.basis == Basis::Improved && self.period == [0.0; 3]
    }

    /// The sum at one point by the kernel made by hand, if there is one, or with its octaves in the lanes of vectors, if
    /// there are several (and no period, which would differ from octave to octave).
    pub(crate) fn sum_at<const D: usize>(&self, level: Level, terms: &Terms, point: [f32; D]) -> Option<f32> {
        if D == 3 && self.has_kernel() && level >= Level::Avx2 {
            return simd::sum_improved_at(level, &self.tables, terms, [point[0], point[1], point[D - 1]]);
        }
        if terms.octaves < 2 || self.period != [0.0; 3] || level == Level::Scalar {
            return None;
        }
        const LANES: usize = 16;
        let (mut frequency, mut sum) = (1.0, 0.0);
        for start in (0..terms.octaves).step_by(LANES) {
            let count = LANES.min((terms.octaves - start) as usize);
            let mut scaled = [[0.0; LANES]; D];
            for lane in 0..count {
                for (scaled, coordinate) in scaled.iter_mut().zip(point) {
                    scaled[lane] = coordinate * frequency as f32;
                }
                frequency *= terms.lacunarity;
            }
            let mut noises = [0.0; LANES];
            // (Whole vectors: what fills them up costs nothing.)
            let padded = if level == Level::Avx512 { LANES } else { count.next_multiple_of(8) };
            map(self, level, scaled.each_ref().map(|axis| &axis[..padded]), &mut noises[..padded]);
            for (octave, noise) in (start..).zip(&noises[..count]) {
                sum += terms.amplitude(octave) as f32 * if terms.absolute { noise.abs() } else { *noise };
            }
        }
        Some(sum)
    }

    /// The value at a point that has been multiplied by `frequency`, which lengthens the period (counted in cells).
    #[inline(always)]
    pub(crate) fn octave<R: Real, const D: usize>(&self, point: [R; D], frequency: f64) -> R {
        const { assert!(D == 2 || D == 3, "a noise has two or three dimensions") };
        let [x, y, z] = self.period;
        let period = [x * frequency, y * frequency, z * frequency];
        match self.basis {
            Basis::Improved => improved::value(&self.tables, point, &period),
            Basis::Classic => classic::value(&self.tables, point, &period),
            Basis::Lattice => lattice::value(&self.tables, point, &period),
            Basis::Value => value::value(&self.tables, point, &period),
            Basis::Simplex => simplex::value(&self.tables, point),
            Basis::Cellular => cellular::value(&self.tables, &self.cellular, point, &period),
            Basis::White => white::value(&self.tables, point, &period),
        }
    }
}

impl PartialEq for Noise {
    /// The tables follow from the seed.
    fn eq(&self, other: &Self) -> bool {
        (self.basis, self.seed, self.period, self.cellular) == (other.basis, other.seed, other.period, other.cellular)
    }
}

impl<const D: usize> Kernel<D> for Noise {
    #[inline(always)]
    fn run<R: Real>(&self, point: [R; D]) -> R {
        self.value(point)
    }
}

/// An evaluation of two and of three dimensions over slices. The two are compiled here, once, and not again in each crate
/// that evaluates noise.
pub(crate) trait Map {
    fn map_plane(&self, level: Level, points: [&[f32]; 2], values: &mut [f32]);
    fn map_space(&self, level: Level, points: [&[f32]; 3], values: &mut [f32]);
}

/// The one for this number of dimensions.
pub(crate) fn map<const D: usize>(map: &impl Map, level: Level, points: [&[f32]; D], values: &mut [f32]) {
    const { assert!(D == 2 || D == 3, "a noise has two or three dimensions") };
    match D {
        2 => map.map_plane(level, [points[0], points[1]], values),
        _ => map.map_space(level, [points[0], points[1], points[D - 1]], values),
    }
}

impl Map for Noise {
    #[inline(never)]
    fn map_plane(&self, level: Level, points: [&[f32]; 2], values: &mut [f32]) {
        simd::map_at(level, self, points, values);
    }

    #[inline(never)]
    fn map_space(&self, level: Level, points: [&[f32]; 3], values: &mut [f32]) {
        simd::map_at(level, self, points, values);
    }
}
