//! The `image` block.

use crate::source::Spanned;

/// Size and sampling of the picture; absent fields take Sunflow's defaults.
#[derive(Debug, Clone, Default)]
pub struct Image {
    /// Width and height in pixels, each from 1 to 16384 (default 640 × 480).
    pub resolution: Option<Spanned<[u32; 2]>>,
    /// Logarithm (base 2) of the least and most samples per pixel edge (default 0 0).
    pub aa: Option<Spanned<[i32; 2]>>,
    /// Lens, time and shading samples per anti-aliasing sample, 1 to 256 (default 1).
    pub samples: Option<Spanned<u32>>,
    /// Threshold of the adaptive refinement, 0 to 1 (default 0.1).
    pub contrast: Option<Spanned<f32>>,
    /// Reconstruction filter (default box).
    pub filter: Option<Spanned<Filter>>,
    /// Whether sample positions are random within their cells (default false).
    pub jitter: Option<Spanned<bool>>,
    /// How samples are placed (default `bucket`).
    pub sampler: Option<Spanned<Sampler>>,
    /// Whether `multipass` may share the shading of near points (default false).
    pub cache: Option<Spanned<bool>>,
    /// `bucket SIZE ORDER`: the size in pixels of the squares in which Sunflow renders, from 16 to 512.
    pub bucket: Option<Spanned<u32>>,
}

/// How samples are placed in the picture (format reference, §3.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Sampler {
    /// Adaptive, and filtered by `filter`.
    #[default]
    Bucket,
    /// One sample for each pixel, at once (`fast`, `ipr`).
    Fast,
    /// `samples` samples (16 where they are not given) spread by a cubic B-spline; `aa` and `filter` mean nothing.
    Multipass,
}

/// Reconstruction filters, by their names in the format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[allow(missing_docs, reason = "the names are the documentation")]
pub enum Filter {
    #[default]
    Box,
    Triangle,
    Gaussian,
    Mitchell,
    CatmullRom,
    BlackmanHarris,
    Sinc,
    Lanczos,
    Bspline,
}
