//! The `light` block.

use super::Color;
use crate::source::Span;

/// A light as written.
#[derive(Debug, Clone)]
pub struct Light {
    /// What shines.
    pub kind: LightKind,
    /// The block.
    pub span: Span,
}

/// The lights that are supported so far.
#[derive(Debug, Clone)]
#[allow(missing_docs, reason = "the fields are the format's own words")]
pub enum LightKind {
    /// `type point`: in Sunflow `color × power` is radiant power, in the report's dialect `power` is a range.
    /// The old form `point power COLOR` has power 1.
    Point { color: Color, power: f32, position: [f32; 3] },
    /// `type directional`: a parallel beam of the given radius; `intensity` is 1 where absent.
    Directional { source: [f32; 3], target: [f32; 3], radius: f32, emit: Color, intensity: f32 },
}
