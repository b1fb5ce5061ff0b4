//! The `camera` block.

use super::Transform;
use crate::source::{Span, Spanned};

/// A camera as written.
#[derive(Debug, Clone)]
pub struct Camera {
    /// How rays leave it.
    pub lens: Lens,
    /// Where it stands.
    pub view: View,
    /// Times at which the shutter opens and closes.
    pub shutter: Option<Spanned<[f32; 2]>>,
    /// The block.
    pub span: Span,
}

/// How rays leave the camera. Angles are in degrees, lengths in world units.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs, reason = "the fields are the format's own words")]
pub enum Lens {
    /// A perspective camera, sharp everywhere. `fov` is the full horizontal angle.
    Pinhole { fov: f32, aspect: f32, shift: [f32; 2] },
    /// A perspective camera with a lens of radius `lensr`, sharp at distance `fdist`.
    Thinlens { fov: f32, aspect: f32, shift: [f32; 2], fdist: f32, lensr: f32, sides: u32, rotation: f32 },
    /// All directions.
    Spherical,
    /// Orthographic fisheye.
    Fisheye,
}

/// Where the camera stands.
#[derive(Debug, Clone)]
#[allow(missing_docs, reason = "the fields are the format's own words")]
pub enum View {
    /// `eye`, `target`, `up`.
    LookAt { eye: [f32; 3], target: [f32; 3], up: [f32; 3] },
    /// `transform`: camera space (down −Z, +X right, +Y up) to world.
    Transform(Transform),
}
