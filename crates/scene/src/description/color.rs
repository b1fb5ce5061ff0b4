//! Colours as written, in any of the format's colour spaces.

use crate::source::Span;

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
