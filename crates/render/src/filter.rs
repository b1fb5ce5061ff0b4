//! Reconstruction filters: how much of its neighbours' light a pixel takes.
//!
//! Samples lie in their own pixel, whose mean they make, so that tiles never write into each other. When the picture is
//! complete, every pixel takes from its neighbours what the filter says. A mean over a pixel has been filtered by a box already:
//! the weights are such that both together have the moments of the filter up to the fifth, and so do to whatever is wider than
//! a pixel what the filter does. Neighbours share their noise so, and a wide filter makes pictures as calm as it promises.

use jaspe_scene::description::Filter;
use rayon::prelude::*;

use crate::film::{Film, Pixel};
use crate::math;

/// Weights of a pixel, of those next to it and of those next but one, in a row or column; together 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Taps([f32; 3]);

/// Rows that one thread filters at a time.
const BAND: usize = 64;

impl Taps {
    /// Every pixel for itself.
    pub const NONE: Taps = Taps([1.0, 0.0, 0.0]);

    /// For pixels that are means over their area.
    pub fn over_areas(kind: Filter) -> Taps {
        let width = width(kind);
        let steps = 4096;
        let [mut area, mut second, mut fourth] = [0.0; 3];
        for i in 0..steps {
            let x = ((f64::from(i) + 0.5) / f64::from(steps) - 0.5) * width;
            let (value, square) = (value(kind, x), x * x);
            area += value;
            second += value * square;
            fourth += value * square * square;
        }
        // A box at distance k has the moments k² + 1/12 and k⁴ + k²/2 + 1/80.
        let (second, fourth) = (second / area - 1.0 / 12.0, fourth / area - 1.0 / 80.0);
        let far = (fourth - 1.5 * second) / 24.0;
        let near = 0.5 * second - 4.0 * far;
        Taps::new(near, far)
    }

    /// For pixels that are single samples at their centre.
    pub fn over_points(kind: Filter) -> Taps {
        let at = |x: f64| if x <= 0.5 * width(kind) { value(kind, x) } else { 0.0 };
        let total = at(0.0) + 2.0 * (at(1.0) + at(2.0));
        Taps::new(at(1.0) / total, at(2.0) / total)
    }

    fn new(near: f64, far: f64) -> Taps {
        // What is nothing but rounding should not cost a pass over the picture.
        let [near, far] = [near, far].map(|tap| if tap.abs() < 1e-4 { 0.0 } else { tap as f32 });
        Taps([1.0 - 2.0 * (near + far), near, far])
    }

    /// How many pixels on either side count.
    pub fn reach(self) -> u32 {
        let Taps([_, near, far]) = self;
        if far != 0.0 { 2 } else { u32::from(near != 0.0) }
    }

    /// Filters a picture in place, band by band on all threads. At its borders only what is inside counts.
    pub fn apply(self, film: &mut Film) {
        let reach = self.reach() as usize;
        if reach == 0 {
            return;
        }
        let (width, height) = (film.width as usize, film.height as usize);
        // What a band takes from those above and below it, before they change.
        let rows = |from: usize, to: usize| film.pixels[from * width..to * width].to_vec();
        let around = |y0: usize| {
            let y1 = (y0 + BAND).min(height);
            [rows(y0.saturating_sub(reach), y0), rows(y1, (y1 + reach).min(height))]
        };
        let halos: Vec<[Vec<Pixel>; 2]> = (0..height).step_by(BAND).map(around).collect();
        let bands = film.pixels.par_chunks_mut(BAND * width).zip(&halos).enumerate();
        bands.for_each(|(i, (band, halo))| self.apply_to_band(band, halo, i * BAND, [width, height]));
    }

    /// Filters the rows from `y0` on; those above and below are given.
    fn apply_to_band(
        self,
        band: &mut [Pixel],
        [above, below]: &[Vec<Pixel>; 2],
        y0: usize,
        [width, height]: [usize; 2],
    ) {
        let y1 = y0 + band.len() / width;
        let (first, end) = (y0 - above.len() / width, y1 + below.len() / width);
        let reach = self.reach() as usize;
        // Rows that are filtered along themselves and wait for those below.
        let mut rows: [Vec<Pixel>; 5] = std::array::from_fn(|_| vec![[0.0; 4]; width]);
        for next in first..end + reach {
            if next < end {
                let (from, start) = match next {
                    _ if next < y0 => (&above[..], first),
                    _ if next < y1 => (&*band, y0),
                    _ => (&below[..], y1),
                };
                let row = &from[(next - start) * width..][..width];
                rows[next % 5].iter_mut().enumerate().for_each(|(x, out)| *out = self.weigh(x, width, |at| row[at]));
            }
            if let Some(y) = next.checked_sub(reach).filter(|y| (y0..y1).contains(y)) {
                let row = &mut band[(y - y0) * width..][..width];
                row.iter_mut().enumerate().for_each(|(x, out)| *out = self.weigh(y, height, |at| rows[at % 5][x]));
            }
        }
    }

    /// The weighted mean around place `at` of `count`.
    #[inline(always)]
    fn weigh(self, at: usize, count: usize, pixel: impl Fn(usize) -> Pixel) -> Pixel {
        let reach = self.reach() as usize;
        let (mut sum, mut total) = ([0.0; 4], 0.0);
        for from in at.saturating_sub(reach)..(at + reach + 1).min(count) {
            let weight = self.0[from.abs_diff(at)];
            let pixel = pixel(from);
            (0..4).for_each(|k| sum[k] += weight * pixel[k]);
            total += weight;
        }
        if at >= reach && at + reach < count { sum } else { sum.map(|sum| sum / total) }
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
    use crate::film::Encoding;

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

    fn cosine(turns: f64) -> f64 {
        math::sin_cos_degrees(360.0 * turns).1
    }

    /// What a filter makes of a wave of so many turns per pixel.
    fn response(kind: Filter, frequency: f64) -> f64 {
        let (mut area, mut wave) = (0.0, 0.0);
        for i in 0..4000 {
            let x = ((f64::from(i) + 0.5) / 4000.0 - 0.5) * width(kind);
            area += value(kind, x);
            wave += value(kind, x) * cosine(frequency * x);
        }
        wave / area
    }

    #[test]
    fn pixels_and_taps_do_to_a_wave_what_the_filter_does() {
        for kind in ALL {
            let Taps([own, near, far]) = Taps::over_areas(kind);
            assert!((own + 2.0 * (near + far) - 1.0).abs() < 1e-6);
            for frequency in [0.05, 0.1, 0.15] {
                let [own, near, far] = [own, near, far].map(f64::from);
                let taps = own + 2.0 * (near * cosine(frequency) + far * cosine(2.0 * frequency));
                let (ours, exact) = (taps * response(Filter::Box, frequency), response(kind, frequency));
                assert!((ours - exact).abs() < 0.01, "{kind:?} at {frequency}: {ours} against {exact}");
            }
        }
        assert_eq!(Taps::over_areas(Filter::Box), Taps::NONE);
    }

    #[test]
    fn points_are_weighted_by_the_filter_itself() {
        assert_eq!(Taps::over_points(Filter::Box), Taps::NONE);
        // Hats, cardinal splines and sines pass through the samples.
        for kind in [Filter::Triangle, Filter::CatmullRom, Filter::Sinc] {
            assert_eq!(Taps::over_points(kind), Taps::NONE, "{kind:?}");
        }
        let Taps([own, near, far]) = Taps::over_points(Filter::Bspline);
        assert!((own - 2.0 / 3.0).abs() < 1e-6 && (near - 1.0 / 6.0).abs() < 1e-6 && far == 0.0);
        let Taps([own, near, far]) = Taps::over_points(Filter::Gaussian);
        assert!((near / own - 1.0 / std::f32::consts::E).abs() < 1e-3 && far == 0.0);
    }

    #[test]
    fn bands_leave_no_seams() {
        for (kind, height) in
            ALL.into_iter().flat_map(|kind| [1, BAND, BAND + 1, 3 * BAND - 1].map(|rows| (kind, rows)))
        {
            let (taps, width) = (Taps::over_areas(kind), 7);
            let mut film = Film::new(width as u32, height as u32, Encoding::Linear);
            for (i, pixel) in film.pixels.iter_mut().enumerate() {
                *pixel = [1, 3, 5, 7].map(|k| ((i * i * k + 11 * i) % 97) as f32);
            }
            let old = film.pixels.clone();
            taps.apply(&mut film);
            if taps.reach() == 0 {
                assert_eq!(film.pixels, old);
                continue;
            }
            let along = |x: usize, y: usize| taps.weigh(x, width, |at| old[y * width + at]);
            for (i, pixel) in film.pixels.iter().enumerate() {
                let (x, y) = (i % width, i / width);
                assert_eq!(*pixel, taps.weigh(y, height, |at| along(x, at)), "{kind:?} at {x}, {y} of {height}");
            }
        }
    }

    #[test]
    fn light_is_spread_and_kept() {
        for kind in ALL {
            let taps = Taps::over_areas(kind);
            let mut film = Film::new(9, 9, Encoding::Linear);
            film.pixels[4 * 9 + 4] = [1.0; 4];
            taps.apply(&mut film);
            let total: f32 = film.pixels.iter().map(|pixel| pixel[1]).sum();
            assert!((total - 1.0).abs() < 1e-5, "{kind:?}: {total}");
            let Taps([own, near, far]) = taps;
            for (x, y, wanted) in [(4, 4, own * own), (5, 4, own * near), (4, 2, own * far), (3, 5, near * near)] {
                assert_eq!(film.pixels[y * 9 + x][0], wanted, "{kind:?} at {x}, {y}");
            }
            let mut even = Film::new(3, 1, Encoding::Linear);
            even.pixels.fill([0.25, 0.5, 0.75, 1.0]);
            taps.apply(&mut even);
            let near = |pixel: &Pixel| pixel.iter().zip([0.25, 0.5, 0.75, 1.0]).all(|(a, b)| (a - b).abs() < 1e-6);
            assert!(even.pixels.iter().all(near), "{kind:?}: {:?}", even.pixels);
        }
    }
}
