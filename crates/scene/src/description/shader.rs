//! The `shader` block.

use jaspe_texture::declare::Declaration;

use super::{Color, Name};
use crate::source::Span;

/// A shader as written.
#[derive(Debug, Clone)]
pub struct Shader {
    /// What objects call it.
    pub name: Name,
    /// What it does.
    pub kind: ShaderKind,
    /// The block.
    pub span: Span,
}

/// A plain colour, or a picture in its place.
#[derive(Debug, Clone)]
pub enum ColorOrTexture {
    /// A colour.
    Color(Color),
    /// The file name as written, looked for in [`super::Scene::texture_folders`].
    Texture(Name),
}

/// The shaders that are supported so far.
#[derive(Debug, Clone)]
#[allow(missing_docs, reason = "the fields are the format's own words")]
pub enum ShaderKind {
    /// Shines by itself, the same in all directions (in the report's dialect: matte).
    Constant { color: Color },
    /// Matte.
    Diffuse { diffuse: ColorOrTexture },
    /// Matte with a glossy lobe of exponent `power`, `samples` rays into it.
    Phong { diffuse: ColorOrTexture, specular: Color, power: f32, samples: u32 },
    /// A perfect mirror.
    Mirror { color: Color },
    /// Clear glass; absorption is off where the distance is zero or less.
    Glass { eta: f32, color: Color, absorption_distance: f32, absorption_color: Color },
    /// One of the procedural materials.
    Procedural { declaration: &'static Declaration, settings: Vec<Setting> },
    /// A valid Sunflow shader that is not supported yet; a warning has been given, and a grey stands in.
    Unsupported,
}

/// One parameter of a procedural material, as written and checked against its declaration.
#[derive(Debug, Clone)]
pub struct Setting {
    /// The declared name.
    pub name: &'static str,
    /// What was written.
    pub value: SettingValue,
    /// The key and its value.
    pub span: Span,
}

/// The value of a [`Setting`].
#[derive(Debug, Clone, PartialEq)]
pub enum SettingValue {
    /// A whole number.
    Int(i64),
    /// A number.
    Float(f64),
    /// A colour, still in the space it was written in.
    Color(Color),
    /// One of the declared words.
    Choice(&'static str),
}
