//! A noise ready to evaluate: a basis, the tables of a seed, a period.

use std::fmt;
use std::sync::Arc;

use crate::basis::cellular::{Cellular, Feature, Metric};
use crate::basis::{Basis, Period, Tables, cellular, classic, improved, lattice, simplex, value, white};
use crate::dispatch::{Evaluate, OverSlices, over_slices};
use crate::number::{Dual, Real};
use crate::simd::{self, AtPoint, FEW, InBatch, Level, Terms};

/// A noise: points in, numbers out. Cheap to clone; immutable.
#[derive(Debug, Clone)]
pub struct Noise {
    basis: Basis,
    seed: u64,
    period: Period,
    cellular: Cellular,
    tables: Arc<Tables>,
    /// Whether this is the noise that the kernels made by hand are for.
    has_kernel: bool,
    in_space: AtPoint<Noise>,
    in_plane: AtPoint<Noise>,
    in_batch: Option<InBatch>,
}

/// Why [`Noise::with_period`] refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PeriodError {
    /// The axis, from 0.
    pub axis: usize,
    /// The period that was asked for.
    pub period: u32,
    /// The longest one that the noise can have.
    pub longest: u32,
}

impl fmt::Display for PeriodError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let axis = ["x", "y", "z", "w"][self.axis.min(3)];
        write!(formatter, "expected a period up to {} along {axis}, found {}", self.longest, self.period)
    }
}

impl std::error::Error for PeriodError {}

impl Noise {
    /// The longest period that an axis may have: up to here single precision counts cells one by one. (Simplex noise,
    /// whose corners lie at sixths and eighths, an eighth of this.)
    pub const LONGEST_PERIOD: u32 = 1 << 24;

    /// The noise of this basis and seed. Seed 0 has the published permutation, other seeds a shuffle of it.
    pub fn new(basis: Basis, seed: u64) -> Self {
        let noise = Noise {
            basis,
            seed,
            period: [0.0; 4],
            cellular: Cellular::default(),
            tables: Arc::new(Tables::new(seed)),
            has_kernel: false,
            in_space: AtPoint::by(Noise::value_in_space),
            in_plane: AtPoint::by(Noise::value_in_plane),
            in_batch: None,
        };
        noise.with_kernels()
    }

    /// With the kernels for its basis and period.
    fn with_kernels(mut self) -> Self {
        self.has_kernel = self.basis == Basis::Improved && self.period == [0.0; 4];
        let level = simd::level();
        let kernels = if self.has_kernel { AtPoint::improved(level) } else { AtPoint::generic(level) };
        if let Some([in_space, in_plane]) = kernels {
            (self.in_space, self.in_plane) = (in_space, in_plane);
        }
        self.in_batch = if self.has_kernel { InBatch::improved(level) } else { None };
        self
    }

    /// The same noise, repeating after so many cells along each axis that is named, from x on: the value at p and at p + period are the same
    /// bits wherever single precision represents both points exactly. 0 leaves an axis at the 256 of the noises with a
    /// table, and without a period otherwise. (The cells of simplex noise are stretched along an axis with a period until a
    /// multiple of three of them fit, in four dimensions of four; so the noise is another one than without.)
    ///
    /// # Errors
    /// When a period is longer than [`Noise::LONGEST_PERIOD`].
    pub fn with_period<const D: usize>(mut self, period: [u32; D]) -> Result<Self, PeriodError> {
        let longest = Self::LONGEST_PERIOD / if self.basis == Basis::Simplex { 8 } else { 1 };
        if let Some(axis) = period.iter().position(|&cells| cells > longest) {
            return Err(PeriodError { axis, period: period[axis], longest });
        }
        const { assert!(D <= 4, "a noise has up to four dimensions") };
        self.period = [0.0; 4];
        for (cells, wanted) in self.period.iter_mut().zip(period) {
            *cells = f64::from(wanted);
        }
        Ok(self.with_kernels())
    }

    /// The same noise with these parameters of [`Basis::Cellular`]; the other bases have no use for them. The jitter is
    /// clamped to 0…1.
    pub fn with_cellular(mut self, cellular: Cellular) -> Self {
        let jitter = if cellular.jitter > 0.0 { cellular.jitter.min(1.0) } else { 0.0 };
        self.cellular = Cellular { jitter, ..cellular };
        self
    }

    /// Bounds of the values in up to three dimensions: see [`Basis::declaration`] for more.
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

    /// The cells after which each axis repeats, or 0.
    pub(crate) fn period(&self) -> &Period {
        &self.period
    }

    /// Whether this is the noise that the kernels made by hand are for.
    pub(crate) fn has_kernel(&self) -> bool {
        self.has_kernel
    }

    /// What follows from the seed.
    #[inline(always)]
    pub(crate) fn tables(&self) -> &Tables {
        &self.tables
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The value at a point of one to four dimensions, in the precision of the number type. (Below three, but for
    /// cellular noise: the slice of three in which the other coordinates are 0.)
    #[inline(always)]
    pub fn value<R: Real, const D: usize>(&self, point: [R; D]) -> R {
        self.octave::<R, D, false>(point, 1.0).value
    }

    /// The value at a point, and its exact derivative along each axis.
    #[inline(always)]
    pub fn value_and_gradient<R: Real, const D: usize>(&self, point: [R; D]) -> (R, [R; D]) {
        let sample = self.octave::<R, D, true>(point, 1.0);
        (sample.value, sample.gradient)
    }

    /// The values at many points: one slice of coordinates per axis (one to four), one slice for the values. The same
    /// bits as [`Noise::value`] in single precision.
    ///
    /// # Panics
    /// When the slices differ in length.
    #[inline(always)]
    pub fn fill<const D: usize>(&self, points: [&[f32]; D], values: &mut [f32]) {
        if let (&[x, y, z], Some(kernel)) = (&points[..], self.in_batch)
            && let (Ok(x), Ok(y), Ok(z), Ok(values)) =
                (x.try_into(), y.try_into(), z.try_into(), (&mut *values).try_into())
        {
            kernel.fill(&self.tables, [x, y, z], values);
        } else {
            self.fill_at(simd::level(), points, values);
        }
    }

    /// [`Noise::fill`] with the instructions of a level, at most those of the machine. For tests and measurements.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_at<const D: usize>(&self, level: Level, points: [&[f32]; D], values: &mut [f32]) {
        simd::assert_lengths(&points, values.len());
        if values.len() <= FEW && level == simd::level() {
            for (i, value) in values.iter_mut().enumerate() {
                *value = self.at(points.map(|coordinates| coordinates[i]));
            }
            return;
        }
        // (What most callers want, at once: of short slices the way here would be a tenth.)
        let done = self.sum_fast(level, None, &points, values, &mut []);
        if done < values.len() {
            let rest = points.map(|axis| &axis[done..]);
            Octave { noise: self, frequency: 1.0 }.fill(level, &rest, &mut values[done..], &mut []);
        }
    }

    /// The values at the first points, x y z x y z …, by a kernel made by hand, if there is one for this noise; returns how many.
    pub(crate) fn fill_points_fast(&self, level: Level, points: &[[f32; 3]], values: &mut [f32]) -> usize {
        if self.has_kernel { simd::improved_at_points(level, &self.tables, points, values) } else { 0 }
    }

    /// The values at many points, and the exact derivatives along each axis: the same bits as
    /// [`Noise::value_and_gradient`] in single precision.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_with_gradient<const D: usize>(
        &self,
        points: [&[f32]; D],
        values: &mut [f32],
        gradient: [&mut [f32]; D],
    ) {
        self.fill_with_gradient_at(simd::level(), points, values, gradient);
    }

    /// [`Noise::fill_with_gradient`] with the instructions of a level, at most those of the machine. For tests and
    /// measurements.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_with_gradient_at<const D: usize>(
        &self,
        level: Level,
        points: [&[f32]; D],
        values: &mut [f32],
        mut gradient: [&mut [f32]; D],
    ) {
        simd::assert_lengths(&points, values.len());
        simd::assert_lengths(&gradient, values.len());
        Octave { noise: self, frequency: 1.0 }.fill(level, &points, values, &mut gradient);
    }

    /// The value at one point in single precision, with the machine's vector instructions.
    #[inline]
    pub fn at<const D: usize>(&self, point: [f32; D]) -> f32 {
        match point[..] {
            [x, y, z] => self.in_space.at(self, [x, y, z]),
            [x, y] => self.in_plane.at(self, [x, y, 0.0]),
            // (A slice of space, with the same bits.)
            [x] if self.has_kernel => self.in_space.at(self, [x, 0.0, 0.0]),
            _ => self.value_at(&point),
        }
    }

    /// The value at one point in space in single precision, by the generic evaluation, compiled with the instructions of the caller.
    /// (The coordinates one by one: an array would go through memory, written by parts and read as a whole, for which the machine
    /// waits.)
    #[inline(always)]
    pub(crate) fn value_in_space(&self, x: f32, y: f32, z: f32) -> f32 {
        self.octave_here::<f32, 3, false>([x, y, z], 1.0).value
    }

    /// [`Noise::value_in_space`] in the plane. (The last coordinate is not read.)
    #[inline(always)]
    pub(crate) fn value_in_plane(&self, x: f32, y: f32, _: f32) -> f32 {
        self.octave_here::<f32, 2, false>([x, y], 1.0).value
    }

    /// The value at one point of one or four dimensions in single precision, by the generic evaluation.
    #[inline(never)]
    fn value_at(&self, point: &[f32]) -> f32 {
        match *point {
            [x] => self.value([x]),
            [x, y, z, w] => self.value([x, y, z, w]),
            _ => unreachable!("two and three have functions of their own"),
        }
    }

    /// The sums (without terms: the noise itself) at the first points and, if there are slices for it, their gradient, by a kernel
    /// made by hand, if there is one for this noise; returns how many.
    #[inline(always)]
    pub(crate) fn sum_fast(
        &self,
        level: Level,
        terms: Option<&Terms>,
        points: &[&[f32]],
        values: &mut [f32],
        gradient: &mut [&mut [f32]],
    ) -> usize {
        let tables = &self.tables;
        match (points, gradient) {
            _ if !self.has_kernel => 0,
            (&[x, y, z], []) => simd::sum_improved(level, tables, terms, [x, y, z], [values]),
            (&[x, y, z], [dx, dy, dz]) => simd::sum_improved(level, tables, terms, [x, y, z], [values, dx, dy, dz]),
            (&[x, y], []) => simd::sum_improved_in_plane(level, tables, terms, [x, y], [values]),
            (&[x, y], [dx, dy]) => simd::sum_improved_in_plane(level, tables, terms, [x, y], [values, dx, dy]),
            _ => 0,
        }
    }

    /// [`Noise::sum_fast`] of the noise alone, and of those that have a faster way for many points.
    fn fill_fast(&self, level: Level, points: &[&[f32]], values: &mut [f32], gradient: &mut [&mut [f32]]) -> usize {
        match (points, &mut *gradient) {
            _ if self.basis != Basis::Simplex || self.period != [0.0; 4] => {
                self.sum_fast(level, None, points, values, gradient)
            }
            (&[x, y, z], []) => simplex::fill(level, &self.tables, [x, y, z], [values]),
            (&[x, y, z], [dx, dy, dz]) => simplex::fill(level, &self.tables, [x, y, z], [values, dx, dy, dz]),
            _ => 0,
        }
    }

    /// The sum at one point with its octaves in the lanes of vectors, if there are several (and no period, which would
    /// differ from octave to octave).
    pub(crate) fn sum_at<const D: usize>(&self, level: Level, terms: &Terms, point: [f32; D]) -> Option<f32> {
        let level = level.min(simd::machine_level());
        if terms.octaves() < 2 || self.period != [0.0; 4] || level == Level::Scalar {
            return None;
        }
        const LANES: usize = 16;
        let mut sum = 0.0;
        for (frequencies, amplitudes) in terms.frequencies.chunks(LANES).zip(terms.amplitudes.chunks(LANES)) {
            let mut scaled = [[0.0; LANES]; D];
            for (scaled, coordinate) in scaled.iter_mut().zip(point) {
                for (scaled, frequency) in scaled.iter_mut().zip(frequencies) {
                    *scaled = coordinate * frequency;
                }
            }
            let mut noises = [0.0; LANES];
            // (Whole vectors: what fills them up costs nothing.)
            let padded = if level == Level::Avx512 { LANES } else { frequencies.len().next_multiple_of(8) };
            let points = scaled.each_ref().map(|axis| &axis[..padded]);
            Octave { noise: self, frequency: 1.0 }.values(level, &points, &mut noises[..padded]);
            for (amplitude, noise) in amplitudes.iter().zip(noises) {
                sum += amplitude * if terms.absolute { noise.abs() } else { noise };
            }
        }
        Some(sum)
    }

    /// The value (and with `G` the gradient) at a point that has been multiplied by `frequency`, which lengthens the period
    /// (counted in cells).
    #[inline(always)]
    pub(crate) fn octave<R: Real, const D: usize, const G: bool>(&self, point: [R; D], frequency: f64) -> Dual<R, D> {
        const { assert!(D >= 1 && D <= 4, "a noise has one to four dimensions") };
        // Vectors must be inlined, one copy for each place; of the rest one copy is enough.
        if R::SCALAR {
            let mut coordinates = [R::constant(0.0); 4];
            coordinates[..D].copy_from_slice(&point);
            let [x, y, z, w] = coordinates;
            self.octave_once::<R, D, G>(x, y, z, w, frequency)
        } else {
            self.octave_here::<R, D, G>(point, frequency)
        }
    }

    /// (The coordinates one by one, in registers: an array would be written to memory by parts and read as a whole, for which the
    /// machine waits as long as for the rest.)
    #[inline(never)]
    fn octave_once<R: Real, const D: usize, const G: bool>(
        &self,
        x: R,
        y: R,
        z: R,
        w: R,
        frequency: f64,
    ) -> Dual<R, D> {
        let coordinates = [x, y, z, w];
        let mut point = [x; D];
        point.copy_from_slice(&coordinates[..D]);
        self.octave_here::<R, D, G>(point, frequency)
    }

    #[inline(always)]
    fn octave_here<R: Real, const D: usize, const G: bool>(&self, point: [R; D], frequency: f64) -> Dual<R, D> {
        let [x, y, z, w] = self.period;
        let period = [x * frequency, y * frequency, z * frequency, w * frequency];
        match self.basis {
            Basis::Improved => improved::evaluate::<R, D, G>(&self.tables, point, &period),
            Basis::Classic => classic::evaluate::<R, D, G>(&self.tables, point, &period),
            Basis::Lattice => lattice::evaluate::<R, D, G>(&self.tables, point, &period),
            Basis::Value => value::evaluate::<R, D, G>(&self.tables, point, &period),
            Basis::Simplex if self.period == [0.0; 4] => simplex::evaluate::<R, D, G>(&self.tables, point),
            Basis::Simplex => {
                let stretched = period.map(|cells| simplex::stretched(D, cells));
                simplex::evaluate_periodic::<R, D, G>(&self.tables, point, &period, &stretched)
            }
            Basis::Cellular => cellular::evaluate::<R, D, G>(&self.tables, &self.cellular, point, &period),
            Basis::White => white::evaluate::<R, D>(&self.tables, point, &period),
        }
    }
}

impl PartialEq for Noise {
    /// The tables follow from the seed.
    fn eq(&self, other: &Self) -> bool {
        (self.basis, self.seed, self.period, self.cellular) == (other.basis, other.seed, other.period, other.cellular)
    }
}

/// One octave of a sum: the noise at points that have been multiplied by the frequency.
pub(crate) struct Octave<'a> {
    pub noise: &'a Noise,
    pub frequency: f64,
}

impl Octave<'_> {
    /// The values at many points and, if there are slices for it, their gradient, as fast as can be.
    pub fn fill(&self, level: Level, points: &[&[f32]], values: &mut [f32], gradient: &mut [&mut [f32]]) {
        let noise = self.noise;
        let done = noise.fill_fast(level, points, values, gradient);
        if done == values.len() {
            return;
        }
        let mut rest: [&[f32]; 4] = [&[]; 4];
        for (rest, coordinates) in rest.iter_mut().zip(points) {
            *rest = &coordinates[done..];
        }
        let (points, values) = (&rest[..points.len()], &mut values[done..]);
        match gradient {
            [] => self.values(level, points, values),
            [x] => self.gradients(level, points, values, &mut [&mut x[done..]]),
            [x, y] => self.gradients(level, points, values, &mut [&mut x[done..], &mut y[done..]]),
            [x, y, z] => self.gradients(level, points, values, &mut [&mut x[done..], &mut y[done..], &mut z[done..]]),
            [x, y, z, w] => {
                let gradient = &mut [&mut x[done..], &mut y[done..], &mut z[done..], &mut w[done..]];
                self.gradients(level, points, values, gradient);
            }
            _ => unreachable!("there are one to four dimensions"),
        }
    }
}

impl Evaluate for Octave<'_> {
    #[inline(always)]
    fn evaluate<R: Real, const D: usize, const G: bool>(&self, point: [R; D]) -> Dual<R, D> {
        self.noise.octave::<R, D, G>(point, self.frequency)
    }
}
over_slices!(Octave<'_>);
