//! How far apart two pictures are.

use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageReader};
use jaspe_render::{Encoding, Film, flip, srgb_decode, srgb_encode};

use crate::failure::Failure;

/// A picture as a display shows it: values from 0 to 1, on black.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Row by row from the top left.
    pub pixels: Vec<[f32; 3]>,
}

impl Shown {
    /// Reads a picture file of any kind that `image` knows.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let bytes = std::fs::read(path).map_err(|error| Failure::reading(path, &error))?;
        let unusable = |error: &dyn std::fmt::Display| {
            let message = format!("cannot read `{}` as a picture: {error}", path.display());
            Failure::new(message).hint("expected PNG, JPEG, EXR, HDR, TIFF, BMP, GIF or TGA")
        };
        let mut reader =
            ImageReader::new(Cursor::new(&bytes)).with_guessed_format().map_err(|error| unusable(&error))?;
        if let (None, Some(extension)) = (reader.format(), path.extension()) {
            // TGA has no mark of its own.
            image::ImageFormat::from_extension(extension).into_iter().for_each(|format| reader.set_format(format));
        }
        let image = reader.decode().map_err(|error| unusable(&error))?;
        if image.width() == 0 || image.height() == 0 {
            return Err(unusable(&"it has no pixels"));
        }
        Ok(Self::new(image))
    }

    fn new(image: DynamicImage) -> Self {
        let is_light = matches!(image, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_));
        let (width, height) = (image.width(), image.height());
        let encode = |light: f64| srgb_encode(light) as f32;
        let shown = |[r, g, b, alpha]: [f32; 4]| match (is_light, alpha < 1.0) {
            // Files of light have their colours multiplied by alpha already.
            (true, _) => [r, g, b].map(|v| encode(f64::from(v))),
            (false, true) => [r, g, b].map(|v| encode(srgb_decode(f64::from(v)) * f64::from(alpha))),
            (false, false) => [r, g, b],
        };
        let pixels = image.into_rgba32f().pixels().map(|pixel| shown(pixel.0)).collect();
        Shown { width, height, pixels }
    }
}

/// What `jaspe compare` reports.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Comparison {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Mean of the absolute differences of all channels, in steps of 1/255.
    pub mean_error: f64,
    /// The largest of them.
    pub max_error: f64,
    /// Pixels with a channel that differs by more than 1/255.
    pub pixels_past_one_step: usize,
    /// Peak signal-to-noise ratio in dB; none for equal pictures.
    pub psnr_db: Option<f64>,
    /// Mean FLIP error, 0 to 1.
    pub flip: f64,
}

/// Compares two pictures of the same size. The second result is the FLIP error of each pixel.
pub fn compare(a: &Shown, b: &Shown) -> (Comparison, Vec<f32>) {
    let (mut sum, mut square_sum, mut largest, mut past) = (0.0, 0.0, 0.0_f64, 0);
    for (a, b) in a.pixels.iter().zip(&b.pixels) {
        let errors = [0, 1, 2].map(|i| 255.0 * f64::from((a[i] - b[i]).abs()));
        let largest_here = errors.into_iter().fold(0.0, f64::max);
        sum += errors.iter().sum::<f64>();
        square_sum += errors.iter().map(|error| error * error).sum::<f64>();
        largest = largest.max(largest_here);
        // Values of eight bits differ by whole steps, but for rounding.
        past += usize::from(largest_here > 1.001);
    }
    let count = 3.0 * a.pixels.len() as f64;
    let errors = flip(&a.pixels, &b.pixels, a.width as usize);
    let comparison = Comparison {
        width: a.width,
        height: a.height,
        mean_error: rounded(sum / count),
        max_error: (largest * 1e3).round() / 1e3,
        pixels_past_one_step: past,
        psnr_db: (square_sum > 0.0).then(|| rounded(10.0 * (255.0 * 255.0 * count / square_sum).log10())),
        flip: rounded(errors.iter().map(|error| f64::from(*error)).sum::<f64>() / errors.len() as f64),
    };
    (comparison, errors)
}

/// To six decimals: differences below that are rounding.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// FLIP errors as colours, from black through purple and orange to pale yellow.
pub fn heat(errors: &[f32], width: u32, height: u32) -> Film {
    const STOPS: [[f32; 3]; 6] = [
        [0.0, 0.0, 0.02],
        [0.23, 0.06, 0.44],
        [0.55, 0.16, 0.51],
        [0.87, 0.29, 0.41],
        [1.0, 0.62, 0.43],
        [0.99, 0.99, 0.75],
    ];
    let color = |error: &f32| {
        let at = error.clamp(0.0, 1.0) * (STOPS.len() - 1) as f32;
        let below = (at as usize).min(STOPS.len() - 2);
        let part = at - below as f32;
        let mix = |i: usize| STOPS[below][i] + part * (STOPS[below + 1][i] - STOPS[below][i]);
        [mix(0), mix(1), mix(2), 1.0]
    };
    Film { width, height, pixels: errors.iter().map(color).collect(), encoding: Encoding::Display }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern(shift: f32) -> Shown {
        let pixel = |i: u32| {
            let (x, y) = ((i % 40) as f32, (i / 40) as f32);
            [(x + shift).rem_euclid(8.0) / 8.0, y / 30.0, 0.5]
        };
        Shown { width: 40, height: 30, pixels: (0..1200).map(pixel).collect() }
    }

    #[test]
    fn equal_pictures_have_no_error() {
        let (comparison, errors) = compare(&pattern(0.0), &pattern(0.0));
        assert_eq!((comparison.mean_error, comparison.psnr_db, comparison.flip), (0.0, None, 0.0));
        assert!(errors.iter().all(|error| *error == 0.0));
    }

    #[test]
    fn a_step_of_ten_has_the_psnr_that_follows() {
        let gray = |v: f32| Shown { width: 4, height: 4, pixels: vec![[v / 255.0; 3]; 16] };
        let (comparison, _) = compare(&gray(100.0), &gray(110.0));
        assert!((comparison.mean_error - 10.0).abs() < 1e-3 && comparison.pixels_past_one_step == 16);
        assert!((comparison.psnr_db.expect("they differ") - 20.0 * 25.5_f64.log10()).abs() < 1e-3);
    }

    #[test]
    fn black_and_white_are_as_far_apart_as_can_be() {
        let plain = |v: f32| Shown { width: 9, height: 9, pixels: vec![[v; 3]; 81] };
        let (comparison, _) = compare(&plain(0.0), &plain(1.0));
        assert!(comparison.flip > 0.95 && comparison.flip <= 1.0, "{comparison:?}");
    }
}
