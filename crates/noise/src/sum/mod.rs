//! Fractal sums: octaves of one noise, each of a higher frequency and a smaller amplitude than the one before.
//!
//! The multifractal sums follow F. K. Musgrave in Ebert et al., "Texturing and Modeling: A Procedural Approach", chapter
//! "Procedural Fractal Terrains", with his offsets and with the amplitudes as powers of the gain.

mod combine;
mod octaves;

use std::sync::Arc;

pub use combine::Combine;
use combine::HYBRID_OFFSET;
pub(crate) use combine::Partial;

use crate::basis::Basis;
use crate::filter::{self, Fade};
use crate::noise::Noise;
use crate::number::{Dual, Real};
use crate::simd::{self, AtPoint, FEW, Lanes, Level, MOST_STEP, Terms};

/// A sum over K octaves of a noise: Σ gᵏ n(lᵏ p) for k from 0 to K − 1, with the lacunarity l and the gain g; or the same
/// with another term for n: see [`Combine`].
///
/// The octaves are added in this order, in the precision of the number type; frequencies and amplitudes are rounded to
/// it from double precision. With the lacunarity 2 and the gain ½ they are exact.
#[derive(Debug, Clone, PartialEq)]
pub struct Sum {
    noise: Noise,
    combine: Combine,
    /// How many, with one that fades in counted as a whole one.
    octaves: u32,
    /// What the amplitude of the last octave is multiplied by.
    last: f64,
    lacunarity: f64,
    gain: f64,
    scales: Arc<Scales>,
    in_space: AtPoint<Sum>,
}

/// What follows from octaves, lacunarity and gain, octave by octave.
#[derive(Debug, Default, PartialEq)]
struct Scales {
    frequencies: Vec<f64>,
    amplitudes: Vec<f64>,
    /// The same in single precision, and the products of both.
    singles: [Vec<f32>; 3],
    lanes: Vec<Lanes>,
}

/// More would reach past every number's range.
const MOST_OCTAVES: u32 = 1024;

/// Coordinates or sums of a step. (Aligned, or vectors may straddle cache lines.)
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Step([f32; MOST_STEP]);

/// By what the noise over a footprint is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Judge {
    /// By the noise in each of its parts.
    Parts,
    /// By the noise at its centre.
    Point,
}

impl From<Noise> for Sum {
    /// One octave, which is the noise itself.
    fn from(noise: Noise) -> Sum {
        Sum::new(noise, Combine::Plain, 1)
    }
}

impl Sum {
    /// A sum of so many octaves (at most 1024), of lacunarity 2 and gain ½; of none it is zero.
    pub fn new(noise: Noise, combine: Combine, octaves: u32) -> Self {
        let octaves = octaves.min(MOST_OCTAVES);
        let scales = Arc::new(Scales::default());
        let level = (combine.is_plain() && noise.has_kernel()).then(simd::level);
        let in_space = level.and_then(AtPoint::improved_octaves).unwrap_or(AtPoint::by(Sum::sum_in_space));
        Sum { noise, combine, octaves, last: 1.0, lacunarity: 2.0, gain: 0.5, scales, in_space }.scaled()
    }

    /// The octaves, for kernels that have them in lanes.
    #[inline(always)]
    pub(crate) fn lanes(&self) -> &[Lanes] {
        &self.scales.lanes
    }

    /// With the scales that follow from the rest.
    fn scaled(mut self) -> Self {
        let powers = |factor: f64| std::iter::successors(Some(1.0), move |power| Some(power * factor));
        let count = self.octaves as usize;
        let frequencies: Vec<f64> = powers(self.lacunarity).take(count).collect();
        let mut amplitudes: Vec<f64> = powers(self.gain).take(count).collect();
        if let Some(amplitude) = amplitudes.last_mut() {
            *amplitude *= self.last;
        }
        let single = |numbers: &[f64]| -> Vec<f32> { numbers.iter().map(|&number| number as f32).collect() };
        let slopes: Vec<f64> = frequencies.iter().zip(&amplitudes).map(|(f, a)| f * a).collect();
        let singles = [single(&frequencies), single(&amplitudes), single(&slopes)];
        let lanes = Lanes::of(self.combine == Combine::Absolute, &singles[0], &singles[1]);
        self.scales = Arc::new(Scales { frequencies, amplitudes, singles, lanes });
        self
    }

    /// The same sum with a number of octaves that need not be whole: the part past the point is the weight of one more
    /// octave, which fades in. Below 0 and NaN count as 0; more than 1024 as 1024.
    pub fn with_octaves(mut self, octaves: f64) -> Self {
        let octaves = if octaves > 0.0 { octaves.min(f64::from(MOST_OCTAVES)) } else { 0.0 };
        self.octaves = octaves.ceil() as u32;
        self.last = 1.0 - (octaves.ceil() - octaves);
        self.scaled()
    }

    /// The same sum with another ratio between the frequencies of neighbouring octaves. (With a period, the sum repeats
    /// if this is a whole number.)
    pub fn with_lacunarity(mut self, lacunarity: f64) -> Self {
        self.lacunarity = lacunarity;
        self.scaled()
    }

    /// The same sum with another ratio between the amplitudes of neighbouring octaves.
    pub fn with_gain(mut self, gain: f64) -> Self {
        self.gain = gain;
        self.scaled()
    }

    /// The noise that is summed.
    pub fn noise(&self) -> &Noise {
        &self.noise
    }

    /// What each octave adds.
    pub fn combine(&self) -> Combine {
        self.combine
    }

    /// The frequency and the amplitude of each octave.
    pub(crate) fn frequencies_and_amplitudes(&self) -> impl Iterator<Item = (f64, f64)> {
        self.scales.frequencies.iter().copied().zip(self.scales.amplitudes.iter().copied())
    }

    /// The number of octaves, with one that fades in counted as a whole one.
    pub fn octaves(&self) -> u32 {
        self.octaves
    }

    /// Bounds of the sum for gains from 0 to 1: no value is outside, though the nearest ones may be well within.
    pub fn range(&self) -> [f64; 2] {
        let [low, high] = self.noise.range();
        let largest = high.max(-low);
        let amplitudes: f64 = self.scales.amplitudes.iter().map(|amplitude| amplitude.abs()).sum();
        let [least, most] = match self.combine {
            Combine::Plain => [low, high],
            Combine::Absolute => [low.max(0.0), largest],
            Combine::Ridged => [0.0, (largest - 1.0).powi(2).max(1.0)],
            Combine::Hybrid if low + HYBRID_OFFSET >= 0.0 => [0.0, high + HYBRID_OFFSET],
            Combine::Hybrid => [-largest - HYBRID_OFFSET, largest + HYBRID_OFFSET],
        };
        [least * amplitudes, most * amplitudes]
    }

    /// The value at a point of one to four dimensions, in the precision of the number type.
    #[inline(always)]
    pub fn value<R: Real, const D: usize>(&self, point: [R; D]) -> R {
        self.evaluate::<R, D, false>(point, None).value
    }

    /// The value at a point, and its exact derivative along each axis.
    #[inline(always)]
    pub fn value_and_gradient<R: Real, const D: usize>(&self, point: [R; D]) -> (R, [R; D]) {
        let sample = self.evaluate::<R, D, true>(point, None);
        (sample.value, sample.gradient)
    }

    /// The sum as it looks through a sample of the side `footprint`, in the units of the point: each octave is averaged over
    /// the footprint, so that what a picture cannot resolve turns even rather than noisy. At a footprint of 0 this is
    /// [`Sum::value`]. Octaves whose cells the footprint neither shows as they are nor loses altogether cost as many times as
    /// much as the value alone as there are parts of the footprint, 3ᴰ.
    ///
    /// The root mean square of the difference from the true average over the footprint, for improved noise of five octaves
    /// in space, plain and absolute, is below 0.02 for footprints of any size.
    #[inline(always)]
    pub fn value_filtered<R: Real, const D: usize>(&self, point: [R; D], footprint: R) -> R {
        self.evaluate::<R, D, false>(point, Some((footprint, Judge::Parts))).value
    }

    /// [`Sum::value_filtered`], judged by the noise at the point alone: hardly slower than [`Sum::value`], and farther off the true
    /// average, by 0.08 at the most (root mean square). It is made for pictures, whose pixels hide that.
    #[inline(always)]
    pub fn value_faded<R: Real, const D: usize>(&self, point: [R; D], footprint: R) -> R {
        self.evaluate::<R, D, false>(point, Some((footprint, Judge::Point))).value
    }

    /// [`Sum::value_filtered`], and its exact derivative along each axis, where the footprint stays the same.
    #[inline]
    pub fn value_and_gradient_filtered<R: Real, const D: usize>(&self, point: [R; D], footprint: R) -> (R, [R; D]) {
        let sample = self.evaluate::<R, D, true>(point, Some((footprint, Judge::Parts)));
        (sample.value, sample.gradient)
    }

    #[inline(always)]
    fn evaluate<R: Real, const D: usize, const G: bool>(
        &self,
        point: [R; D],
        footprint: Option<(R, Judge)>,
    ) -> Dual<R, D> {
        let fade = Fade::of(self.noise.basis(), self.combine.folds(), D);
        let mut partial = Partial::new();
        for (&frequency, &amplitude) in self.scales.frequencies.iter().zip(&self.scales.amplitudes) {
            let mut scaled = point;
            for coordinate in &mut scaled {
                *coordinate = *coordinate * R::constant(frequency);
            }
            let mut noise = self.combine.fold::<R, D, G>(self.noise.octave::<R, D, G>(scaled, frequency));
            if let Some((footprint, judge)) = footprint {
                let footprint = footprint * R::constant(frequency);
                noise = match judge {
                    Judge::Point => fade.apply_alone::<R, D, G>(noise, footprint),
                    Judge::Parts => {
                        let parts = self.average_of_parts::<R, D, G>(scaled, footprint, frequency);
                        fade.blend::<R, D, G>(noise, parts, footprint)
                    }
                };
            }
            partial.add::<G>(self.combine, frequency, amplitude, noise);
        }
        partial.sum
    }

    /// The average of an octave's noises at the centres of the parts of a footprint around a point, both in cells.
    #[inline(always)]
    fn average_of_parts<R: Real, const D: usize, const G: bool>(
        &self,
        point: [R; D],
        footprint: R,
        frequency: f64,
    ) -> Dual<R, D> {
        let zero = R::constant(0.0);
        let mut average = Dual { value: zero, gradient: [zero; D] };
        for part in 0..filter::parts(D) {
            let mut moved = point;
            for (axis, coordinate) in moved.iter_mut().enumerate() {
                *coordinate = *coordinate + footprint * R::constant(filter::part_centre(part, axis));
            }
            let noise = self.combine.fold::<R, D, G>(self.noise.octave::<R, D, G>(moved, frequency));
            filter::add_part::<R, D, G>(&mut average, noise);
        }
        average
    }

    /// The values at many points: one slice of coordinates per axis (one to four), one slice for the values. The same
    /// bits as [`Sum::value`] in single precision.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill<const D: usize>(&self, points: [&[f32]; D], values: &mut [f32]) {
        self.fill_at(simd::level(), points, values);
    }

    /// [`Sum::fill`] with the instructions of a level, at most those of the machine. For tests and measurements.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_at<const D: usize>(&self, level: Level, points: [&[f32]; D], values: &mut [f32]) {
        simd::assert_lengths(&points, values.len());
        let mut done = 0;
        if self.combine.is_plain() {
            if values.len() > FEW {
                done = self.noise.sum_fast(level, Some(&self.terms()), &points, values, &mut []);
            }
            done += self.fill_last(level, points.map(|coordinates| &coordinates[done..]), &mut values[done..]);
            if done == values.len() {
                return;
            }
            while values.len() - done <= FEW && done < values.len() {
                let point = points.map(|coordinates| coordinates[done]);
                values[done] = if level == simd::level() && self.noise.has_kernel() {
                    self.at(point)
                } else {
                    let Some(sum) = self.noise.sum_at(level, &self.terms(), point) else { break };
                    sum
                };
                done += 1;
            }
        }
        let points = points.map(|coordinates| &coordinates[done..]);
        self.fill_by_octaves(level, &points, None, &mut values[done..], &mut []);
    }

    /// The values at the last points, fewer than a step of the kernel made by hand, if there is one: among as many as fill the
    /// step, since it takes less time for these than the generic evaluation for a few. Returns how many it did: all or none.
    fn fill_last<const D: usize>(&self, level: Level, points: [&[f32]; D], values: &mut [f32]) -> usize {
        let (count, length) = (values.len(), simd::step(level));
        if count <= FEW || count > length {
            return 0;
        }
        let (mut step, mut sums) = ([Step([0.0; MOST_STEP]); D], Step([0.0; MOST_STEP]));
        for (step, points) in step.iter_mut().zip(points) {
            step.0[..count].copy_from_slice(points);
        }
        let step = step.each_ref().map(|axis| &axis.0[..length]);
        let done = self.noise.sum_fast(level, Some(&self.terms()), &step, &mut sums.0[..length], &mut []).min(count);
        values[..done].copy_from_slice(&sums.0[..done]);
        done
    }

    /// The values at many points, and the exact derivatives along each axis: the same bits as
    /// [`Sum::value_and_gradient`] in single precision.
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

    /// [`Sum::fill_with_gradient`] with the instructions of a level, at most those of the machine. For tests and
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
        let mut done = 0;
        if self.combine.is_plain() {
            done = self.noise.sum_fast(level, Some(&self.terms()), &points, values, &mut gradient);
        }
        let points = points.map(|coordinates| &coordinates[done..]);
        let mut gradient = gradient.map(|part| &mut part[done..]);
        self.fill_by_octaves(level, &points, None, &mut values[done..], &mut gradient);
    }

    /// The value at one point in single precision, with the machine's vector instructions.
    #[inline]
    pub fn at<const D: usize>(&self, point: [f32; D]) -> f32 {
        match point[..] {
            [x, y, z] => self.in_space.at(self, [x, y, z]),
            // (A slice of space, with the same bits.)
            [x, y] if self.noise.has_kernel() => self.in_space.at(self, [x, y, 0.0]),
            [x] if self.noise.has_kernel() => self.in_space.at(self, [x, 0.0, 0.0]),
            _ => self.sum_at(point),
        }
    }

    /// [`Sum::sum_at`] in space.
    fn sum_in_space(&self, x: f32, y: f32, z: f32) -> f32 {
        self.sum_at([x, y, z])
    }

    /// The sum at one point: with its octaves in lanes if they can be, or else one by one.
    #[inline(never)]
    fn sum_at<const D: usize>(&self, point: [f32; D]) -> f32 {
        let noise = &self.noise;
        // (Classic noise would gather in lanes, which takes longer.)
        if self.combine.is_plain()
            && (noise.basis() != Basis::Classic || D == 4)
            && let Some(sum) = noise.sum_at(simd::level(), &self.terms(), point)
        {
            return sum;
        }
        if D == 4 || *noise.period() != [0.0; 4] {
            return self.value(point);
        }
        // (Single points have faster ways than the generic evaluation, with the same bits.)
        let mut partial = Partial::<f32, D>::new();
        for (frequency, amplitude) in self.frequencies_and_amplitudes() {
            let value = noise.at(point.map(|coordinate| coordinate * frequency as f32));
            let octave = self.combine.fold::<f32, D, false>(Dual { value, gradient: [0.0; D] });
            partial.add::<false>(self.combine, frequency, amplitude, octave);
        }
        partial.sum.value
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
        self.fill_by_octaves(level, &points, Some((footprints, Judge::Parts)), values, &mut []);
    }

    /// The values at many points, each with its footprint, and the exact derivatives along each axis: the same bits as
    /// [`Sum::value_and_gradient_filtered`] in single precision.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_filtered_with_gradient<const D: usize>(
        &self,
        points: [&[f32]; D],
        footprints: &[f32],
        values: &mut [f32],
        gradient: [&mut [f32]; D],
    ) {
        self.fill_filtered_with_gradient_at(simd::level(), points, footprints, values, gradient);
    }

    /// [`Sum::fill_filtered_with_gradient`] with the instructions of a level, at most those of the machine. For tests and
    /// measurements.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_filtered_with_gradient_at<const D: usize>(
        &self,
        level: Level,
        points: [&[f32]; D],
        footprints: &[f32],
        values: &mut [f32],
        mut gradient: [&mut [f32]; D],
    ) {
        self.fill_by_octaves(level, &points, Some((footprints, Judge::Parts)), values, &mut gradient);
    }

    /// The values at many points, each with its footprint: the same bits as [`Sum::value_faded`] in single precision.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_faded<const D: usize>(&self, points: [&[f32]; D], footprints: &[f32], values: &mut [f32]) {
        self.fill_faded_at(simd::level(), points, footprints, values);
    }

    /// [`Sum::fill_faded`] with the instructions of a level, at most those of the machine. For tests and measurements.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_faded_at<const D: usize>(
        &self,
        level: Level,
        points: [&[f32]; D],
        footprints: &[f32],
        values: &mut [f32],
    ) {
        self.fill_by_octaves(level, &points, Some((footprints, Judge::Point)), values, &mut []);
    }

    #[inline(always)]
    fn terms(&self) -> Terms<'_> {
        let [frequencies, amplitudes, slopes] = &self.scales.singles;
        let absolute = self.combine == Combine::Absolute;
        Terms { absolute, frequencies, amplitudes, slopes }
    }
}
