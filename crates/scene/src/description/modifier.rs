//! The blocks `modifier` and `texture`: what changes a surface, and procedural textures that others name.

use jaspe_texture::declare::Declaration;

use super::{Name, Setting};
use crate::source::Span;

/// A modifier as written: it turns the normal of the surfaces that name it.
#[derive(Debug, Clone)]
pub struct Modifier {
    /// What objects call it.
    pub name: Name,
    /// What it does.
    pub kind: ModifierKind,
    /// The block.
    pub span: Span,
}

/// The modifiers (format reference, §2.9 and §3.11).
#[derive(Debug, Clone)]
#[allow(missing_docs, reason = "the fields are the format's own words")]
pub enum ModifierKind {
    /// Heights from the brightness of a texture, which is named as in [`super::ColorOrTexture::Texture`]. For a picture,
    /// `scale` multiplies the difference of neighbouring texels; for a procedural texture, the gradient in world units.
    Bump { texture: Name, scale: f32 },
    /// Normals from the colours of a picture.
    NormalMap { texture: Name },
    /// Heights from Sunflow's variant of Perlin's noise: `function` 0, 1 or any other number, at points `size` times as
    /// large, `scale` times as high.
    Perlin { function: i32, size: f32, scale: f32 },
}

impl ModifierKind {
    /// Its `type` in a scene file.
    pub fn keyword(&self) -> &'static str {
        match self {
            ModifierKind::Bump { .. } => "bump",
            ModifierKind::NormalMap { .. } => "normalmap",
            ModifierKind::Perlin { .. } => "perlin",
        }
    }
}

/// A procedural texture by itself, for shaders and modifiers that name it in place of a picture. Ours.
#[derive(Debug, Clone)]
pub struct Texture {
    /// What shaders and modifiers call it.
    pub name: Name,
    /// Which of the procedural materials it is.
    pub declaration: &'static Declaration,
    /// Its parameters as far as they were written.
    pub settings: Vec<Setting>,
    /// The block.
    pub span: Span,
}
