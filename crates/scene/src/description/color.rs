//! Colours as written, in any of the format's colour spaces, and what they mean.
//!
//! Conversions follow the format reference, §1.7 and §3.1. Exponentials come from `libm`, so that the same
//! scene has the same colours, to the bit, on every machine.

use super::cie;
use crate::source::Span;
use crate::srgb::{srgb_decode, srgb_encode};

/// A colour and where it was written.
#[derive(Debug, Clone, PartialEq)]
pub struct Color {
    /// The colour.
    pub spec: ColorSpec,
    /// Where it was written.
    pub span: Span,
}

/// The forms that a colour may take (format reference, §1.7).
#[derive(Debug, Clone, PartialEq)]
pub enum ColorSpec {
    /// `r g b`, or `"sRGB linear"`: linear light, unbounded.
    Linear([f32; 3]),
    /// `"sRGB nonlinear"`: display-encoded.
    SrgbNonlinear([f32; 3]),
    /// `"XYZ"`: CIE 1931, white at Y = 1.
    Xyz([f32; 3]),
    /// `"blackbody" T`: kelvin.
    Blackbody(f32),
    /// `"spectrum λ0 λ1" N v…`: samples spread evenly over a range of wavelengths in nanometres.
    Spectrum {
        /// First and last wavelength in nanometres.
        range: [f32; 2],
        /// At least two samples.
        samples: Vec<f32>,
    },
}

impl Color {
    /// A colour in linear light.
    pub fn new_linear(rgb: [f32; 3], span: Span) -> Self {
        Color { spec: ColorSpec::Linear(rgb), span }
    }

    /// Linear sRGB: what light transport computes with. Unbounded, and negative outside of the gamut.
    pub fn linear(&self) -> [f32; 3] {
        match &self.spec {
            ColorSpec::Linear(rgb) => *rgb,
            ColorSpec::SrgbNonlinear(rgb) => rgb.map(|v| srgb_decode(f64::from(v)) as f32),
            ColorSpec::Xyz(xyz) => rgb_from_xyz(xyz.map(f64::from)),
            ColorSpec::Blackbody(kelvin) => {
                let kelvin = f64::from(*kelvin);
                rgb_from_xyz(xyz_from_spectrum(|wavelength| planck(wavelength, kelvin)))
            }
            ColorSpec::Spectrum { range, samples } => {
                let range = range.map(f64::from);
                rgb_from_xyz(xyz_from_spectrum(|wavelength| interpolate(range, samples, wavelength)))
            }
        }
    }

    /// Display-encoded sRGB, each from 0 to 1: what the colours of the procedural materials mean.
    pub fn display(&self) -> [f32; 3] {
        match &self.spec {
            ColorSpec::SrgbNonlinear(rgb) => rgb.map(|value| value.clamp(0.0, 1.0)),
            _ => self.linear().map(|v| srgb_encode(f64::from(v)) as f32),
        }
    }

    /// The three numbers as written, whatever their space: what the report's dialect computes with. The forms that do
    /// not consist of three numbers give their linear colour.
    pub fn raw(&self) -> [f32; 3] {
        match &self.spec {
            ColorSpec::Linear(numbers) | ColorSpec::SrgbNonlinear(numbers) | ColorSpec::Xyz(numbers) => *numbers,
            ColorSpec::Blackbody(_) | ColorSpec::Spectrum { .. } => self.linear(),
        }
    }
}

/// Rows of the matrix from CIE XYZ (white at Y = 1) to linear sRGB.
const RGB_FROM_XYZ: [[f64; 3]; 3] =
    [[3.2410042, -1.5373994, -0.49861607], [-0.9692241, 1.8759298, 0.041554242], [0.05563942, -0.20401107, 1.0571486]];

/// CIE 1931 XYZ (white at Y = 1) in linear sRGB; negative outside of the gamut.
pub fn rgb_from_xyz(xyz: [f64; 3]) -> [f32; 3] {
    RGB_FROM_XYZ.map(|row| (row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2]) as f32)
}

/// Integrates an intensity, a function of the wavelength in nanometres, against the CIE 1931 matching functions, in steps
/// of 5 nm from 360 to 830 nm.
pub fn xyz_from_spectrum(intensity: impl Fn(f64) -> f64) -> [f64; 3] {
    let mut xyz = [0.0; 3];
    for (i, matching) in cie::MATCHING.iter().enumerate() {
        let value = intensity(cie::FIRST + cie::STEP * i as f64);
        for (sum, weight) in xyz.iter_mut().zip(matching) {
            *sum += cie::STEP * value * weight;
        }
    }
    xyz
}

/// Planck's law; wavelength in nanometres, temperature in kelvin.
fn planck(wavelength: f64, kelvin: f64) -> f64 {
    // The radiation constants 2πhc² in W m² and hc/k in m K.
    const C1: f64 = 3.74183e-16;
    const C2: f64 = 1.4388e-2;
    let metres = wavelength * 1e-9;
    C1 / (metres * metres * metres * metres * metres) / (libm::exp(C2 / (metres * kelvin)) - 1.0)
}

/// Samples spread evenly over `range`, linear between them, zero outside.
fn interpolate(range: [f64; 2], samples: &[f32], wavelength: f64) -> f64 {
    let [first, last] = range;
    if samples.is_empty() || wavelength < first || wavelength > last {
        return 0.0;
    }
    let at = (wavelength - first) / (last - first) * (samples.len() - 1) as f64;
    let lower = (at as usize).min(samples.len() - 1);
    let upper = (lower + 1).min(samples.len() - 1);
    let t = at - lower as f64;
    (1.0 - t) * f64::from(samples[lower]) + t * f64::from(samples[upper])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn color(spec: ColorSpec) -> Color {
        Color { spec, span: Span { file: 0, start: 0, end: 0 } }
    }

    #[track_caller]
    fn assert_near(actual: [f32; 3], expected: [f32; 3]) {
        for (a, e) in actual.iter().zip(expected) {
            assert!((a - e).abs() <= 2e-6 * e.abs().max(1.0), "{actual:?} is not {expected:?}");
        }
    }

    // Check values: format reference, end of §7.1.

    #[test]
    fn nonlinear_colours_are_decoded() {
        let color = color(ColorSpec::SrgbNonlinear([0.5, 0.2, 0.8]));
        assert_near(color.linear(), [0.214041, 0.0331049, 0.603828]);
        assert_eq!(color.display(), [0.5, 0.2, 0.8]);
        assert_eq!(color.raw(), [0.5, 0.2, 0.8]);
    }

    #[test]
    fn nonlinear_colours_are_clamped_and_linear_ones_are_not() {
        assert_eq!(color(ColorSpec::SrgbNonlinear([1.9, -0.5, 1.0])).linear(), [1.0, 0.0, 1.0]);
        assert_eq!(color(ColorSpec::Linear([1.9, -0.5, 1.0])).linear(), [1.9, -0.5, 1.0]);
        assert_eq!(color(ColorSpec::Linear([1.9, -0.5, 1.0])).display(), [1.0, 0.0, 1.0]);
    }

    #[test]
    fn xyz_goes_through_the_matrix() {
        let color = color(ColorSpec::Xyz([0.3, 0.4, 0.5]));
        assert_near(color.linear(), [0.108033, 0.480382, 0.463662]);
        assert_eq!(color.raw(), [0.3, 0.4, 0.5]);
    }

    #[test]
    fn spectra_are_integrated() {
        let samples = vec![0.1, 0.5, 1.0, 0.5];
        let color = color(ColorSpec::Spectrum { range: [400.0, 700.0], samples });
        let linear = color.linear();
        for (value, expected) in linear.iter().zip([124.596, 74.5022, 23.7366]) {
            assert!((value - expected).abs() < 1e-5 * expected, "{linear:?}");
        }
        let flat = xyz_from_spectrum(|wavelength| interpolate([360.0, 830.0], &[1.0, 1.0], wavelength));
        assert!((flat[1] - 106.86).abs() < 0.05, "{flat:?}");
    }

    #[test]
    fn a_black_body_of_daylight_is_nearly_white() {
        let [r, g, b] = color(ColorSpec::Blackbody(6500.0)).linear();
        assert!((1.2e16..1.6e16).contains(&g), "{g}");
        assert!((r / g - 1.0).abs() < 0.1 && (b / g - 1.0).abs() < 0.1, "{r} {g} {b}");
        let [r, _, b] = color(ColorSpec::Blackbody(2000.0)).linear();
        assert!(r > 5.0 * b.max(0.0));
    }
}
