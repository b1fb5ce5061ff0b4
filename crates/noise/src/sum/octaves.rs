//! Sums over slices, octave by octave: some points at a time, whose noise the fastest kernel for it computes, and whose
//! sums stay in the first cache.

use super::combine::{Combine, Partial};
use super::{Judge, Sum};
use crate::filter::{self, FAINT, FAR, Fade, NEAR};
use crate::noise::Octave;
use crate::number::Dual;
use crate::simd::{self, Level, Task, Vector, Wide};

/// How many points at a time.
const CHUNK: usize = 256;

impl Sum {
    /// The sums at many points, seen through their footprints if there are any, and, if there are slices for it, their
    /// gradients.
    pub(super) fn fill_by_octaves(
        &self,
        level: Level,
        points: &[&[f32]],
        footprints: Option<(&[f32], Judge)>,
        values: &mut [f32],
        gradient: &mut [&mut [f32]],
    ) {
        simd::assert_lengths(points, values.len());
        simd::assert_lengths(gradient, values.len());
        simd::assert_lengths(footprints.as_ref().map(|(sides, _)| sides).as_slice(), values.len());
        match (points.len(), gradient.is_empty()) {
            (1, true) => self.chunks::<1, false>(level, points, footprints, values, gradient),
            (2, true) => self.chunks::<2, false>(level, points, footprints, values, gradient),
            (3, true) => self.chunks::<3, false>(level, points, footprints, values, gradient),
            (_, true) => self.chunks::<4, false>(level, points, footprints, values, gradient),
            (1, false) => self.chunks::<1, true>(level, points, footprints, values, gradient),
            (2, false) => self.chunks::<2, true>(level, points, footprints, values, gradient),
            (3, false) => self.chunks::<3, true>(level, points, footprints, values, gradient),
            (_, false) => self.chunks::<4, true>(level, points, footprints, values, gradient),
        }
    }

    fn chunks<const D: usize, const G: bool>(
        &self,
        level: Level,
        points: &[&[f32]],
        footprints: Option<(&[f32], Judge)>,
        values: &mut [f32],
        gradient: &mut [&mut [f32]],
    ) {
        let fade = Fade::of(self.noise.basis(), self.combine.folds(), D);
        let mut scaled = [[0.0; CHUNK]; D];
        let mut sides = [0.0; CHUNK];
        let (mut noise, mut weight) = (Samples::<D>::of(0.0), Samples::of(1.0));
        for start in (0..values.len()).step_by(CHUNK) {
            let at = start..values.len().min(start + CHUNK);
            let count = at.len();
            let mut sum = Samples::of(0.0);
            if !self.combine.is_plain() {
                weight = Samples::of(1.0);
            }
            let mut averages;
            for (&frequency, &amplitude) in self.scales.frequencies.iter().zip(&self.scales.amplitudes) {
                for (scaled, axis) in scaled.iter_mut().zip(points) {
                    simd::run(level, Scale { numbers: &axis[at.clone()], factor: frequency as f32, scaled });
                }
                if let Some((footprints, _)) = footprints {
                    simd::run(
                        level,
                        Scale { numbers: &footprints[at.clone()], factor: frequency as f32, scaled: &mut sides },
                    );
                }
                let octave = Octave { noise: &self.noise, frequency };
                let points = scaled.each_ref().map(|axis| &axis[..count]);
                let far = |side: &f32| f64::from(*side) > FAR;
                if footprints.is_some() && sides[..count].iter().all(far) {
                    // Nothing is left but the mean, whatever the noise is.
                    noise.value[..count].fill(0.0);
                } else {
                    noise.fill::<G>(level, &octave, &points);
                }
                let near = |side: &f32| f64::from(*side) <= FAINT;
                let filtered = match footprints {
                    None => Filtered::Not,
                    Some((_, Judge::Point)) if sides[..count].iter().all(near) => Filtered::Not,
                    Some((_, Judge::Point)) => Filtered::Alone(&sides),
                    Some((_, Judge::Parts)) => {
                        averages = self.average_parts::<D, G>(level, &octave, &sides[..count], &scaled);
                        Filtered::Parts(&sides, &averages)
                    }
                };
                let (combine, noise, sum, weight) = (self.combine, &noise, &mut sum, &mut weight);
                let add = Add::<D, G> { count, combine, frequency, amplitude, fade, filtered, noise, sum, weight };
                simd::run_wide(level, add);
            }
            values[at.clone()].copy_from_slice(&sum.value[..count]);
            for (axis, sums) in gradient.iter_mut().zip(&sum.gradient) {
                axis[at.clone()].copy_from_slice(&sums[..count]);
            }
        }
    }
}

impl Sum {
    /// The averages over footprints of these sides (in cells) around the points, from their parts; anything where all
    /// footprints are so small or so large that they are judged without.
    fn average_parts<const D: usize, const G: bool>(
        &self,
        level: Level,
        octave: &Octave,
        sides: &[f32],
        points: &[[f32; CHUNK]; D],
    ) -> Samples<D> {
        let mut averages = Samples::of(0.0);
        let judged_without = |side: &f32| f64::from(*side) < NEAR || f64::from(*side) > FAR;
        if sides.iter().all(judged_without) {
            return averages;
        }
        let (mut moved, mut noise) = (*points, averages);
        let count = sides.len();
        for part in 0..filter::parts(D) {
            for (axis, (moved, points)) in moved.iter_mut().zip(points).enumerate() {
                let centre = filter::part_centre(part, axis) as f32;
                for ((moved, point), side) in moved.iter_mut().zip(points).zip(sides) {
                    *moved = point + side * centre;
                }
            }
            noise.fill::<G>(level, octave, &moved.each_ref().map(|axis| &axis[..count]));
            let (combine, noise, averages) = (self.combine, &noise, &mut averages);
            simd::run_wide(level, AddPart::<D, G> { count, combine, noise, averages });
        }
        averages
    }
}

/// Adds a part of the footprints of a chunk.
struct AddPart<'a, const D: usize, const G: bool> {
    count: usize,
    combine: Combine,
    noise: &'a Samples<D>,
    averages: &'a mut Samples<D>,
}

impl<const D: usize, const G: bool> Wide for AddPart<'_, D, G> {
    #[inline(always)]
    fn run<V: Vector<LANES>, const LANES: usize>(self) {
        for vector in 0..self.count.div_ceil(LANES) {
            let noise = self.combine.fold::<V, D, G>(self.noise.load::<V, LANES, G>(vector));
            let mut average = self.averages.load::<V, LANES, G>(vector);
            filter::add_part::<V, D, G>(&mut average, noise);
            self.averages.store::<V, LANES, G>(vector, average);
        }
    }
}

/// Multiplies numbers.
struct Scale<'a> {
    numbers: &'a [f32],
    factor: f32,
    scaled: &'a mut [f32; CHUNK],
}

impl Task for Scale<'_> {
    #[inline(always)]
    fn run(self) {
        for (scaled, number) in self.scaled.iter_mut().zip(self.numbers) {
            *scaled = number * self.factor;
        }
    }
}

/// Values at the points of a chunk, and gradients.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Samples<const D: usize> {
    value: [f32; CHUNK],
    gradient: [[f32; CHUNK]; D],
}

impl<const D: usize> Samples<D> {
    /// The same value everywhere.
    fn of(value: f32) -> Self {
        Samples { value: [value; CHUNK], gradient: [[0.0; CHUNK]; D] }
    }

    /// The first ones: those of an octave at so many points.
    fn fill<const G: bool>(&mut self, level: Level, octave: &Octave, points: &[&[f32]; D]) {
        let count = points[0].len();
        if G {
            let mut gradient = self.gradient.each_mut().map(|axis| &mut axis[..count]);
            octave.fill(level, points, &mut self.value[..count], &mut gradient);
        } else {
            octave.fill(level, points, &mut self.value[..count], &mut []);
        }
    }

    /// Those of one vector.
    #[inline(always)]
    fn load<V: Vector<LANES>, const LANES: usize, const G: bool>(&self, vector: usize) -> Dual<V, D> {
        let mut sample = Dual { value: V::load(&self.value.as_chunks().0[vector]), gradient: [V::constant(0.0); D] };
        for axis in 0..if G { D } else { 0 } {
            sample.gradient[axis] = V::load(&self.gradient[axis].as_chunks().0[vector]);
        }
        sample
    }

    #[inline(always)]
    fn store<V: Vector<LANES>, const LANES: usize, const G: bool>(&mut self, vector: usize, sample: Dual<V, D>) {
        sample.value.store(&mut self.value.as_chunks_mut().0[vector]);
        for axis in 0..if G { D } else { 0 } {
            sample.gradient[axis].store(&mut self.gradient[axis].as_chunks_mut().0[vector]);
        }
    }
}

/// The sides of footprints in cells, and what their noise is judged by.
#[derive(Clone, Copy)]
enum Filtered<'a, const D: usize> {
    Not,
    Alone(&'a [f32; CHUNK]),
    /// With the averages of the parts.
    Parts(&'a [f32; CHUNK], &'a Samples<D>),
}

/// Adds an octave at the points of a chunk.
struct Add<'a, const D: usize, const G: bool> {
    count: usize,
    combine: Combine,
    frequency: f64,
    amplitude: f64,
    fade: Fade,
    filtered: Filtered<'a, D>,
    noise: &'a Samples<D>,
    sum: &'a mut Samples<D>,
    /// What a multifractal sum multiplies the octave by.
    weight: &'a mut Samples<D>,
}

impl<const D: usize, const G: bool> Wide for Add<'_, D, G> {
    #[inline(always)]
    fn run<V: Vector<LANES>, const LANES: usize>(self) {
        // (The last vector may be longer than the points; there is room for it.)
        for vector in 0..self.count.div_ceil(LANES) {
            let mut noise = self.combine.fold::<V, D, G>(self.noise.load::<V, LANES, G>(vector));
            let load = |numbers: &[f32; CHUNK]| V::load(&numbers.as_chunks().0[vector]);
            noise = match self.filtered {
                Filtered::Not => noise,
                Filtered::Alone(sides) => self.fade.apply_alone::<V, D, G>(noise, load(sides)),
                Filtered::Parts(sides, averages) => {
                    self.fade.blend::<V, D, G>(noise, averages.load::<V, LANES, G>(vector), load(sides))
                }
            };
            let mut partial = Partial::<V, D>::new();
            partial.sum = self.sum.load::<V, LANES, G>(vector);
            if !self.combine.is_plain() {
                partial.weight = self.weight.load::<V, LANES, G>(vector);
            }
            partial.add::<G>(self.combine, self.frequency, self.amplitude, noise);
            self.sum.store::<V, LANES, G>(vector, partial.sum);
            if !self.combine.is_plain() {
                self.weight.store::<V, LANES, G>(vector, partial.weight);
            }
        }
    }
}
