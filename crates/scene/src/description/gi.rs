//! The blocks `gi` and `photons`: light that comes by way of other surfaces.

use super::Color;
use crate::source::Span;

/// How indirect light on matte surfaces is found.
#[derive(Debug, Clone)]
pub struct Gi {
    /// The method.
    pub kind: GiKind,
    /// The block.
    pub span: Span,
}

/// The methods (format reference, §2.4 and §3.14). Lengths are in world units.
#[derive(Debug, Clone)]
#[allow(missing_docs, reason = "the fields are the format's own words")]
pub enum GiKind {
    /// `path`: so many rays from what the camera sees, one from there on.
    Path { samples: u32 },
    /// `irr-cache`: so many rays at few points, blended between them as `tolerance` and the least and largest `spacing`
    /// allow. Without `global` there is one bounce; with it all further light comes from a photon map.
    IrradianceCache { samples: u32, tolerance: f32, spacing: [f32; 2], global: Option<GlobalPhotons> },
    /// `igi`: `sets` sets of `samples` virtual lights. `bias` (the keyword is `b` or `c`) limits what a near one gives,
    /// and `bias_samples` rays give back what the limit takes away.
    Instant { samples: u32, sets: u32, bias: f32, bias_samples: u32 },
    /// `ambocc`: `bright` from where nothing is met within `max_distance` (zero or less: at all), `dark` elsewhere.
    AmbientOcclusion { bright: Color, dark: Color, samples: u32, max_distance: f32 },
    /// `fake`: a colour by the slope of the surface.
    Fake { up: [f32; 3], sky: Color, ground: Color },
}

impl GiKind {
    /// Its `type` in a scene file.
    pub fn keyword(&self) -> &'static str {
        match self {
            GiKind::Path { .. } => "path",
            GiKind::IrradianceCache { .. } => "irr-cache",
            GiKind::Instant { .. } => "igi",
            GiKind::AmbientOcclusion { .. } => "ambocc",
            GiKind::Fake { .. } => "fake",
        }
    }
}

/// The photon map of [`GiKind::IrradianceCache`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GlobalPhotons {
    /// How many are emitted.
    pub emit: u32,
    /// How they are kept.
    pub map: PhotonMap,
    /// How many make an estimate.
    pub gather: u32,
    /// How far they may lie from its point.
    pub radius: f32,
}

/// The kinds of photon map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PhotonMap {
    /// A hashed grid.
    Grid,
    /// A balanced tree.
    Kd,
}

/// The caustic photons of the `photons` block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Caustics {
    /// How many are emitted.
    pub emit: u32,
    /// How many make an estimate.
    pub gather: u32,
    /// How far they may lie from its point.
    pub radius: f32,
    /// The block.
    pub span: Span,
}
