//! Sums over slices, octave by octave: some points at a time, whose noise the fastest kernel for it computes, and whose
//! sums stay in the first cache.

use super::combine::{Combine, Partial};
use super::{Judge, Sum};
use crate::filter::{self, FAINT, FAR, Fade, NEAR};
use crate::noise::Octave;
use crate::number::Dual;
use crate::simd::{self, Level, Task};

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
        let mut buffers = Buffers::<D> { scaled: [[0.0; CHUNK]; D], noise: [0.0; CHUNK], slopes: [[0.0; CHUNK]; D] };
        let mut sides = [0.0; CHUNK];
        for start in (0..values.len()).step_by(CHUNK) {
            let at = start..values.len().min(start + CHUNK);
            let mut partials = [Partial::<f32, D>::new(); CHUNK];
            let mut averages;
            for (&frequency, &amplitude) in self.scales.frequencies.iter().zip(&self.scales.amplitudes) {
                for (scaled, axis) in buffers.scaled.iter_mut().zip(points) {
                    for (scaled, coordinate) in scaled.iter_mut().zip(&axis[at.clone()]) {
                        *scaled = coordinate * frequency as f32;
                    }
                }
                if let Some((footprints, _)) = footprints {
                    for (side, footprint) in sides.iter_mut().zip(&footprints[at.clone()]) {
                        *side = footprint * frequency as f32;
                    }
                }
                let octave = Octave { noise: &self.noise, frequency };
                let scaled = buffers.scaled.each_ref().map(|axis| &axis[..at.len()]);
                let noise = &mut buffers.noise[..at.len()];
                let far = |side: &f32| f64::from(*side) > FAR;
                if footprints.is_some() && sides[..at.len()].iter().all(far) {
                    // Nothing is left but the mean, whatever the noise is.
                    noise.fill(0.0);
                } else if G {
                    let mut slopes = buffers.slopes.each_mut().map(|axis| &mut axis[..at.len()]);
                    octave.fill(level, &scaled, noise, &mut slopes);
                } else {
                    octave.fill(level, &scaled, noise, &mut []);
                }
                let near = |side: &f32| f64::from(*side) <= FAINT;
                let filtered = match footprints {
                    None => Filtered::Not,
                    Some((_, Judge::Point)) if sides[..at.len()].iter().all(near) => Filtered::Not,
                    Some((_, Judge::Point)) => Filtered::Alone(&sides),
                    Some((_, Judge::Parts)) => {
                        averages = self.average_parts::<D>(level, &octave, fade, &sides[..at.len()], &buffers.scaled);
                        Filtered::Parts(&sides, &averages)
                    }
                };
                let (combine, buffers) = (self.combine, &buffers);
                let partials = &mut partials[..at.len()];
                simd::run(level, Add::<D, G> { combine, frequency, amplitude, fade, filtered, buffers, partials });
            }
            for (i, partial) in at.zip(&partials) {
                values[i] = partial.sum.value;
                for (axis, part) in gradient.iter_mut().zip(partial.sum.gradient) {
                    axis[i] = part;
                }
            }
        }
    }
}

impl Sum {
    /// The averages over footprints of these sides (in cells) around the points, from their parts; anything where all
    /// footprints are so small or so large that they are judged without.
    fn average_parts<const D: usize>(
        &self,
        level: Level,
        octave: &Octave,
        fade: Fade,
        sides: &[f32],
        points: &[[f32; CHUNK]; D],
    ) -> [f32; CHUNK] {
        let mut averages = [0.0; CHUNK];
        let judged_without = |side: &f32| f64::from(*side) < NEAR || f64::from(*side) > FAR;
        if sides.iter().all(judged_without) {
            return averages;
        }
        let (mut moved, mut noise) = (*points, [0.0; CHUNK]);
        let count = sides.len();
        for part in 0..filter::parts(D) {
            for (axis, (moved, points)) in moved.iter_mut().zip(points).enumerate() {
                let centre = filter::part_centre(part, axis) as f32;
                for ((moved, point), side) in moved.iter_mut().zip(points).zip(sides) {
                    *moved = point + side * centre;
                }
            }
            octave.fill(level, &moved.each_ref().map(|axis| &axis[..count]), &mut noise[..count], &mut []);
            let (combine, noise, averages) = (self.combine, &noise[..count], &mut averages[..count]);
            simd::run(level, AddPart { combine, fade, sides, noise, averages });
        }
        averages.map(|total| total * (1.0 / filter::parts(D) as f64) as f32)
    }
}

/// Adds the parts of footprints.
struct AddPart<'a> {
    combine: Combine,
    fade: Fade,
    sides: &'a [f32],
    noise: &'a [f32],
    averages: &'a mut [f32],
}

impl Task for AddPart<'_> {
    #[inline(always)]
    fn run(self) {
        for ((average, &noise), &side) in self.averages.iter_mut().zip(self.noise).zip(self.sides) {
            let noise = self.combine.fold::<f32, 0, false>(Dual { value: noise, gradient: [] });
            *average += self.fade.apply_to_part(noise.value, side);
        }
    }
}

/// Points times the frequency, their noise and its gradient.
struct Buffers<const D: usize> {
    scaled: [[f32; CHUNK]; D],
    noise: [f32; CHUNK],
    slopes: [[f32; CHUNK]; D],
}

/// The sides of footprints in cells, and what their noise is judged by.
#[derive(Clone, Copy)]
enum Filtered<'a> {
    Not,
    Alone(&'a [f32; CHUNK]),
    /// With the averages of the parts.
    Parts(&'a [f32; CHUNK], &'a [f32; CHUNK]),
}

/// Adds an octave at the points of a chunk.
struct Add<'a, const D: usize, const G: bool> {
    combine: Combine,
    frequency: f64,
    amplitude: f64,
    fade: Fade,
    filtered: Filtered<'a>,
    buffers: &'a Buffers<D>,
    partials: &'a mut [Partial<f32, D>],
}

impl<const D: usize, const G: bool> Task for Add<'_, D, G> {
    #[inline(always)]
    fn run(self) {
        for (i, partial) in self.partials.iter_mut().enumerate() {
            let mut noise = Dual { value: self.buffers.noise[i], gradient: [0.0; D] };
            for axis in 0..if G { D } else { 0 } {
                noise.gradient[axis] = self.buffers.slopes[axis][i];
            }
            let mut noise = self.combine.fold::<f32, D, G>(noise);
            match self.filtered {
                Filtered::Not => {}
                Filtered::Alone(sides) => noise.value = self.fade.apply_alone(noise.value, sides[i]),
                Filtered::Parts(sides, averages) => {
                    let whole = self.fade.apply(noise.value, sides[i]);
                    noise.value = self.fade.blend(whole, averages[i], sides[i]);
                }
            }
            partial.add::<G>(self.combine, self.frequency, self.amplitude, noise);
        }
    }
}
