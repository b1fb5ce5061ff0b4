//! Film → Image: the display curve, rounding and straight alpha. Nothing else in the project knows sRGB as a curve.
//!
//! The curve is the one of the format reference (§3.1), whose constants differ from the standard's in the sixth
//! digit. It is built from additions, multiplications, divisions and square roots alone, which every machine rounds
//! alike: no platform `pow` comes near a pixel. Bytes are not computed but looked up ([`Steps`]), to the same result.

use std::sync::OnceLock;

use crate::film::{Encoding, Film, Pixel};
use jaspe_scene::srgb_encode;

/// How finely the samples of an [`Image`] are rounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Depth {
    /// 8 bits per sample.
    #[default]
    Eight,
    /// 16 bits per sample.
    Sixteen,
}

/// What becomes of pixels that are not fully covered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Alpha {
    /// Colours are divided by the coverage, which is kept beside them unless every pixel is covered.
    Straight,
    /// The picture stands on black.
    OnBlack,
}

/// The samples of an [`Image`], row by row from the top left, channels interleaved.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Samples {
    /// 0 to 255.
    Eight(Vec<u8>),
    /// 0 to 65535.
    Sixteen(Vec<u16>),
}

/// A display-encoded picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// 3 (red, green, blue) or 4 (and straight alpha).
    pub channel_count: usize,
    /// `width × height × channel_count` of them.
    pub samples: Samples,
}

/// Encodes a film for display.
pub fn develop(film: &Film, depth: Depth, alpha: Alpha) -> Image {
    let keeps_alpha = alpha == Alpha::Straight && is_transparent(film);
    let samples = match depth {
        Depth::Eight => {
            let steps = Steps::get();
            Samples::Eight(interleave(film, keeps_alpha, |v| steps.byte(v), |v| round_display(v, 255.0) as u8))
        }
        Depth::Sixteen => Samples::Sixteen(interleave(
            film,
            keeps_alpha,
            |v| (65535.0 * srgb_encode(f64::from(v)) + 0.5) as u16,
            |v| round_display(v, 65535.0) as u16,
        )),
    };
    Image { width: film.width, height: film.height, channel_count: if keeps_alpha { 4 } else { 3 }, samples }
}

/// Whether any pixel of the film shows what is behind it. Display films never do: their background is black.
pub fn is_transparent(film: &Film) -> bool {
    film.encoding == Encoding::Linear && film.pixels.iter().any(|pixel| round_display(pixel[3], 65535.0) < 65535.0)
}

/// All samples of a film; `curve` rounds linear light, `straight` rounds display values and coverage.
fn interleave<T>(film: &Film, keeps_alpha: bool, curve: impl Fn(f32) -> T, straight: impl Fn(f32) -> T) -> Vec<T> {
    let mut samples = Vec::with_capacity(film.pixels.len() * if keeps_alpha { 4 } else { 3 });
    match (film.encoding, keeps_alpha) {
        (Encoding::Display, _) => {
            film.pixels.iter().for_each(|p| samples.extend([straight(p[0]), straight(p[1]), straight(p[2])]));
        }
        (Encoding::Linear, false) => {
            film.pixels.iter().for_each(|p| samples.extend([curve(p[0]), curve(p[1]), curve(p[2])]));
        }
        (Encoding::Linear, true) => {
            for pixel in &film.pixels {
                let [red, green, blue] = uncovered(pixel);
                samples.extend([curve(red), curve(green), curve(blue), straight(pixel[3])]);
            }
        }
    }
    samples
}

/// The colour of the covered part of a pixel: black where nothing is covered.
fn uncovered(pixel: &Pixel) -> [f32; 3] {
    let [red, green, blue, alpha] = *pixel;
    if alpha > 0.0 { [red / alpha, green / alpha, blue / alpha] } else { [0.0; 3] }
}

/// `v` clamped to 0…1, times `top`, rounded; not a number counts as 0.
fn round_display(v: f32, top: f32) -> f32 {
    if v > 0.0 { (top * v.min(1.0) + 0.5).trunc() } else { 0.0 }
}

/// The curve as the 255 values at which the rounded byte steps up, sorted into buckets of equal leading bits.
///
/// A bucket covers 1/128 of its value, over which the curve rises by less than one byte: it holds at most one step.
struct Steps {
    /// For each bucket the byte at its start, and the value from which on it is one more.
    buckets: Vec<(u8, f32)>,
}

impl Steps {
    /// Everything up to here is byte 0.
    const LOWEST: f32 = 1.0 / 8192.0;
    /// Bits of an `f32` that do not choose the bucket.
    const SHIFT: u32 = 16;

    fn get() -> &'static Steps {
        static STEPS: OnceLock<Steps> = OnceLock::new();
        STEPS.get_or_init(Steps::new)
    }

    fn new() -> Steps {
        let steps: Vec<f32> = (1..=255).map(first_with_byte).collect();
        let first = Self::LOWEST.to_bits() >> Self::SHIFT;
        let last = (1.0_f32.to_bits() - 1) >> Self::SHIFT;
        let bucket = |index: u32| {
            let start = f32::from_bits(index << Self::SHIFT);
            let base = steps.partition_point(|&step| step <= start);
            (base as u8, steps.get(base).copied().unwrap_or(f32::INFINITY))
        };
        Steps { buckets: (first..=last).map(bucket).collect() }
    }

    fn byte(&self, linear: f32) -> u8 {
        if linear >= 1.0 {
            255
        } else if linear > Self::LOWEST {
            let bucket = (linear.to_bits() - Self::LOWEST.to_bits()) >> Self::SHIFT;
            let (base, step) = self.buckets[bucket as usize];
            base + u8::from(linear >= step)
        } else {
            0
        }
    }
}

/// The byte of a linear value, computed the long way.
fn byte_by_curve(linear: f32) -> u8 {
    (255.0 * srgb_encode(f64::from(linear)) + 0.5) as u8
}

/// The smallest `f32` that rounds to `byte` or more. Positive floats are ordered as their bits are.
fn first_with_byte(byte: u8) -> f32 {
    let (mut below, mut at) = (0, 1.0_f32.to_bits());
    while at - below > 1 {
        let middle = below + (at - below) / 2;
        if byte_by_curve(f32::from_bits(middle)) >= byte { at = middle } else { below = middle }
    }
    f32::from_bits(at)
}

#[cfg(test)]
mod tests {
    use jaspe_scene::srgb_decode;

    use super::*;

    fn film(encoding: Encoding, pixels: &[Pixel]) -> Film {
        Film { width: pixels.len() as u32, height: 1, pixels: pixels.to_vec(), encoding }
    }

    fn bytes(image: &Image) -> &[u8] {
        match &image.samples {
            Samples::Eight(bytes) => bytes,
            Samples::Sixteen(_) => panic!("8 bits were asked for"),
        }
    }

    #[test]
    fn looked_up_bytes_equal_computed_ones() {
        let steps = Steps::get();
        let every = (0..1.1_f32.to_bits()).step_by(997).map(f32::from_bits);
        let around_steps = (1..=255).map(first_with_byte).flat_map(|step| [step.next_down(), step, step.next_up()]);
        for v in every.chain(around_steps) {
            assert_eq!(steps.byte(v), byte_by_curve(v), "at {v:e}");
        }
        assert_eq!(steps.byte(f32::NAN), 0);
        assert_eq!(steps.byte(f32::NEG_INFINITY), 0);
        assert_eq!(steps.byte(f32::INFINITY), 255);
    }

    #[test]
    fn every_byte_survives_decoding_and_encoding() {
        for byte in 0..=255 {
            assert_eq!(byte_by_curve(srgb_decode(f64::from(byte) / 255.0) as f32), byte);
        }
    }

    #[test]
    fn display_films_are_clamped_and_rounded_only() {
        let image = develop(
            &film(Encoding::Display, &[[0.5, -1.0, 7.0, 0.25], [0.01, f32::NAN, 1.0, 0.0]]),
            Depth::Eight,
            Alpha::Straight,
        );
        assert_eq!(image.channel_count, 3);
        assert_eq!(bytes(&image), [128, 0, 255, 3, 0, 255]);
    }

    #[test]
    fn alpha_is_straight_and_absent_when_all_is_covered() {
        let pixels = [[0.25, 0.5, 0.0, 0.5], [1.0, 0.0, 0.0, 0.0], [1.0, 1.0, 1.0, 1.0]];
        let image = develop(&film(Encoding::Linear, &pixels), Depth::Eight, Alpha::Straight);
        assert_eq!(bytes(&image), [188, 255, 0, 128, 0, 0, 0, 0, 255, 255, 255, 255]);
        let image = develop(&film(Encoding::Linear, &pixels), Depth::Eight, Alpha::OnBlack);
        assert_eq!(bytes(&image)[..3], [137, 188, 0]);
        let image = develop(&film(Encoding::Linear, &pixels[2..]), Depth::Sixteen, Alpha::Straight);
        assert_eq!((image.channel_count, image.samples), (3, Samples::Sixteen(vec![65535; 3])));
    }
}
