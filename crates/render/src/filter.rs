//! Reconstruction filters, sampled: a sample position is drawn from the filter's own shape, so that every sample counts
//! for one pixel only ([Ernst, Stamminger, Greiner 2006] "Filter Importance Sampling").

use jaspe_scene::description::Filter;

use crate::math;

/// Steps of the tabulated distribution over the filter's width.
const STEPS: usize = 1024;

/// A filter ready to be sampled, separable in x and y.
#[derive(Debug, Clone)]
pub(crate) struct FilterSampler {
    /// Offset in pixels for a uniform number, at `STEPS + 1` even steps.
    inverse: Vec<f32>,
    kind: Filter,
    /// What a sample counts: one over the share of the positive lobes.
    gain: f32,
}

impl FilterSampler {
    pub fn new(kind: Filter) -> Self {
        let width = width(kind);
        let at = |i: usize| ((i as f64 + 0.5) / STEPS as f64 - 0.5) * width;
        let values: Vec<f64> = (0..STEPS).map(|i| value(kind, at(i))).collect();
        let (signed, total) = values.iter().fold((0.0, 0.0), |(s, t), v| (s + v, t + v.abs()));
        let mut inverse = Vec::with_capacity(STEPS + 1);
        let mut bin = 0;
        let mut below = 0.0;
        for step in 0..=STEPS {
            let target = total * step as f64 / STEPS as f64;
            while bin < STEPS - 1 && below + values[bin].abs() < target {
                below += values[bin].abs();
                bin += 1;
            }
            let inside = if values[bin] == 0.0 { 0.0 } else { ((target - below) / values[bin].abs()).clamp(0.0, 1.0) };
            inverse.push((((bin as f64 + inside) / STEPS as f64 - 0.5) * width) as f32);
        }
        FilterSampler { inverse, kind, gain: (total / signed) as f32 }
    }

    /// The offset from the pixel's centre for two uniform numbers, and what the sample counts (negative in the
    /// negative lobes; 1 on average).
    #[inline]
    pub fn sample(&self, [u, v]: [f32; 2]) -> ([f32; 2], f32) {
        if self.kind == Filter::Box {
            return ([u - 0.5, v - 0.5], 1.0);
        }
        let ((x, wx), (y, wy)) = (self.sample_axis(u), self.sample_axis(v));
        ([x, y], wx * wy)
    }

    fn sample_axis(&self, u: f32) -> (f32, f32) {
        let at = u * STEPS as f32;
        let i = (at as usize).min(STEPS - 1);
        let x = self.inverse[i] + (self.inverse[i + 1] - self.inverse[i]) * (at - i as f32);
        let negative = value(self.kind, f64::from(x)) < 0.0;
        (x, if negative { -self.gain } else { self.gain })
    }
}

/// Full width in pixels (format reference, §3.4).
fn width(kind: Filter) -> f64 {
    match kind {
        Filter::Box => 1.0,
        Filter::Triangle => 2.0,
        Filter::Gaussian => 3.0,
        _ => 4.0,
    }
}

/// The filter's value at an offset in pixels within its width.
fn value(kind: Filter, x: f64) -> f64 {
    let x = x.abs();
    match kind {
        Filter::Box => 1.0,
        Filter::Triangle => (1.0 - x).max(0.0),
        Filter::Gaussian => jaspe_noise::math::exp(-x * x) - jaspe_noise::math::exp(-9.0),
        Filter::Mitchell => cubic(x, 1.0 / 3.0, 1.0 / 3.0),
        Filter::CatmullRom => cubic(x, 0.0, 0.5),
        Filter::Bspline => cubic(x, 1.0, 0.0),
        Filter::BlackmanHarris => {
            let turn = |k: f64| math::sin_cos_degrees(360.0 * k * (x / 4.0 + 0.5)).1;
            0.35875 - 0.48829 * turn(1.0) + 0.14128 * turn(2.0) - 0.01168 * turn(3.0)
        }
        Filter::Sinc => sinc(x),
        // Sunflow: LanczosFilter; three lobes squeezed into the width of 4.
        Filter::Lanczos => sinc(1.5 * x) * sinc(0.5 * x),
    }
}

/// sin(πx) / (πx).
fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { math::sin_cos_degrees(180.0 * x).0 / (std::f64::consts::PI * x) }
}

/// The cubic family of [Mitchell, Netravali 1988] "Reconstruction Filters in Computer Graphics", eq. 8.
fn cubic(x: f64, b: f64, c: f64) -> f64 {
    let value = if x < 1.0 {
        ((12.0 - 9.0 * b - 6.0 * c) * x + (-18.0 + 12.0 * b + 6.0 * c)) * x * x + (6.0 - 2.0 * b)
    } else if x < 2.0 {
        (((-b - 6.0 * c) * x + (6.0 * b + 30.0 * c)) * x + (-12.0 * b - 48.0 * c)) * x + (8.0 * b + 24.0 * c)
    } else {
        0.0
    };
    value / 6.0
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Filter; 9] = [
        Filter::Box,
        Filter::Triangle,
        Filter::Gaussian,
        Filter::Mitchell,
        Filter::CatmullRom,
        Filter::BlackmanHarris,
        Filter::Sinc,
        Filter::Lanczos,
        Filter::Bspline,
    ];

    #[test]
    fn a_sampled_filter_integrates_a_wave_as_the_filter_does() {
        for kind in ALL {
            let sampler = FilterSampler::new(kind);
            let n = 512;
            let (mut mean, mut wave) = (0.0, 0.0);
            for i in 0..n {
                let ([x, _], weight) = sampler.sample([(i as f32 + 0.5) / n as f32, 0.5]);
                // The weight of the other axis at its centre is the gain alone.
                let weight = f64::from(weight / if kind == Filter::Box { 1.0 } else { sampler.gain });
                mean += weight / n as f64;
                wave += weight * math::sin_cos_degrees(90.0 + 70.0 * f64::from(x)).0 / n as f64;
            }
            let (mut area, mut exact) = (0.0, 0.0);
            for i in 0..4000 {
                let x = ((i as f64 + 0.5) / 4000.0 - 0.5) * width(kind);
                area += value(kind, x);
                exact += value(kind, x) * math::sin_cos_degrees(90.0 + 70.0 * x).0;
            }
            assert!((mean - 1.0).abs() < 0.01, "{kind:?}: mean {mean}");
            assert!((wave - exact / area).abs() < 0.01, "{kind:?}: {wave} against {}", exact / area);
        }
    }
}
