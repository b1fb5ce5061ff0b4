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
    /// The name of a [`super::Texture`] of the scene if there is one, otherwise a file name as written, looked for in
    /// [`super::Scene::texture_folders`].
    Texture(Name),
}

/// A colour and a picture over it, mixed: what the parts of [`ShaderKind::Uber`] take.
#[derive(Debug, Clone)]
pub struct Blend {
    /// The colour.
    pub color: Color,
    /// What lies over it, named as in [`ColorOrTexture::Texture`].
    pub texture: Option<Name>,
    /// How much of the texture is seen, from 0 (none) to 1; without a texture it means nothing.
    pub blend: f32,
}

/// The shaders (format reference, §2.8 and §3.10).
#[derive(Debug, Clone)]
#[allow(missing_docs, reason = "the fields are the format's own words")]
pub enum ShaderKind {
    /// Shines by itself, the same in all directions (in the report's dialect: matte). A texture is ours: Sunflow's is of one colour.
    Constant { color: ColorOrTexture },
    /// Matte.
    Diffuse { diffuse: ColorOrTexture },
    /// Matte with a glossy lobe of exponent `power`, `samples` rays into it.
    Phong { diffuse: ColorOrTexture, specular: Color, power: f32, samples: u32 },
    /// A perfect mirror.
    Mirror { color: Color },
    /// Clear glass; absorption is off where the distance is zero or less.
    Glass { eta: f32, color: Color, absorption_distance: f32, absorption_color: Color },
    /// Matte with a mirror over it, tinted by the diffuse colour; `reflection` is the part that it mirrors where seen
    /// straight on, and may exceed 1.
    Shiny { diffuse: ColorOrTexture, reflection: f32 },
    /// Matte with Ward's anisotropic highlight: `roughness` along both directions of the surface, above zero, and
    /// `samples` rays into it.
    Ward { diffuse: ColorOrTexture, specular: Color, roughness: [f32; 2], samples: u32 },
    /// How much of the surroundings is open, as a mix of `dark` and `bright`: `samples` rays that reach as far as
    /// `distance` (zero or less: without end).
    AmbientOcclusion { bright: ColorOrTexture, dark: Color, samples: u32, distance: f32 },
    /// Matte with a mirror (`glossy` 0) or a glossy lobe (up to 1) of `samples` rays.
    Uber { diffuse: Blend, specular: Blend, glossy: f32, samples: u32 },
    /// Lines of colour `line` along the edges of triangles, `width` radians thick as seen from the camera, on `fill`.
    /// Ours in `.sc`; Sunflow has it in its programming interface only.
    Wireframe { line: Color, fill: Color, width: f32 },
    /// The light of the caustic photons alone.
    ViewCaustics,
    /// The indirect light that arrives.
    ViewIrradiance,
    /// What the global illumination keeps of the surface.
    ViewGlobal,
    /// A colour of its own for each object.
    Id,
    /// One of the procedural materials.
    Procedural { declaration: &'static Declaration, settings: Vec<Setting> },
    /// A shader that could not be read, or is written in Java; that has been reported, and a grey stands in.
    Unsupported,
}

impl ShaderKind {
    /// Its `type` in a scene file.
    pub fn keyword(&self) -> &'static str {
        match self {
            ShaderKind::Constant { .. } => "constant",
            ShaderKind::Diffuse { .. } => "diffuse",
            ShaderKind::Phong { .. } => "phong",
            ShaderKind::Mirror { .. } => "mirror",
            ShaderKind::Glass { .. } => "glass",
            ShaderKind::Shiny { .. } => "shiny",
            ShaderKind::Ward { .. } => "ward",
            ShaderKind::AmbientOcclusion { .. } => "amb-occ",
            ShaderKind::Uber { .. } => "uber",
            ShaderKind::Wireframe { .. } => "wireframe",
            ShaderKind::ViewCaustics => "view-caustics",
            ShaderKind::ViewIrradiance => "view-irradiance",
            ShaderKind::ViewGlobal => "view-global",
            ShaderKind::Id => "id",
            ShaderKind::Procedural { declaration, .. } => declaration.name,
            ShaderKind::Unsupported => "janino",
        }
    }
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
