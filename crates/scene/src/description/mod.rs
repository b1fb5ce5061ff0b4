//! What the author of a scene wrote, one struct per block: names are still text, units are the file's (degrees,
//! world units), optional fields are still absent, and everything carries the span that diagnostics point at.
//! Resolving names, baking transforms and filling in defaults is the work of the renderer's `compile`.

mod camera;
mod cie;
mod color;
mod gi;
mod image;
mod light;
mod modifier;
mod object;
mod shader;
mod transform;

pub use camera::{Camera, Lens, View};
pub use color::{Color, ColorSpec, rgb_from_xyz, xyz_from_spectrum};
pub use gi::{Caustics, Gi, GiKind, GlobalPhotons, PhotonMap};
pub use image::{Filter, Image, Sampler};
pub use light::{CornellBox, Ground, Light, LightKind, Triangles};
pub use modifier::{Modifier, ModifierKind, Texture};
pub use object::{
    BezierNet, ByteOrder, Geometry, Hair, Instance, Mesh, Object, Plane, PointSource, Tessellation, VertexData,
};
pub use shader::{Blend, ColorOrTexture, Setting, SettingValue, Shader, ShaderKind};
pub use transform::{Matrix, Op, Transform, TransformKind};

use std::path::PathBuf;

use crate::source::{Sources, Span, Spanned};

/// A name as written, with its place.
pub type Name = Spanned<String>;

/// Whose meaning the words of a scene have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Dialect {
    /// Sunflow's: inverse-square lights, linear light, display encoding at the end.
    #[default]
    Sunflow,
    /// That of the 2010 program: linear light ranges, display values throughout, its own camera and mirrors.
    Report,
}

impl Dialect {
    /// Every dialect.
    pub const ALL: &[Dialect] = &[Dialect::Sunflow, Dialect::Report];

    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Dialect::Sunflow => "sunflow",
            Dialect::Report => "report",
        }
    }

    /// The dialect of this name.
    pub fn from_name(name: &str) -> Option<Dialect> {
        Dialect::ALL.iter().copied().find(|dialect| dialect.name() == name)
    }
}

/// A whole scene, with everything that it includes.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    /// The files it was read from; spans point into them.
    pub sources: Sources,
    /// The line `dialect NAME`, if there is one.
    pub dialect: Option<Spanned<Dialect>>,
    /// All `image` blocks, merged; later values win.
    pub image: Image,
    /// The first `background` block.
    pub background: Option<Background>,
    /// All `trace-depths` blocks, merged.
    pub trace_depths: TraceDepths,
    /// The last `gi` block, unless it says `none`.
    pub gi: Option<Gi>,
    /// The last `photons` block, unless its map is `none`.
    pub caustics: Option<Caustics>,
    /// In order of appearance; the last one is used.
    pub cameras: Vec<Camera>,
    /// In order of appearance.
    pub lights: Vec<Light>,
    /// In order of appearance; the first of a name counts.
    pub shaders: Vec<Shader>,
    /// In order of appearance; the first of a name counts.
    pub textures: Vec<Texture>,
    /// In order of appearance; the first of a name counts.
    pub modifiers: Vec<Modifier>,
    /// In order of appearance; the first of a name counts.
    pub objects: Vec<Object>,
    /// In order of appearance.
    pub instances: Vec<Instance>,
    /// The line `override NAME BOOL`: this shader replaces every other.
    pub override_shader: Option<Name>,
    /// Whether photons are scattered by the replacement too.
    pub override_photons: bool,
    /// All `include` lines that were followed, in order of appearance.
    pub includes: Vec<Include>,
    /// Folders in which included files, meshes and points are looked for, in this order.
    pub include_folders: Vec<PathBuf>,
    /// Folders in which textures are looked for, in this order.
    pub texture_folders: Vec<PathBuf>,
}

/// A line `include FILE`.
#[derive(Debug, Clone)]
pub struct Include {
    /// The file name as written.
    pub name: Name,
    /// Which of [`Scene::sources`] it is.
    pub file: u32,
    /// The line.
    pub span: Span,
}

/// A uniform backdrop, seen by camera rays only.
#[derive(Debug, Clone)]
pub struct Background {
    /// Its colour.
    pub color: Color,
    /// The block.
    pub span: Span,
}

/// How often a path may bounce, by kind; `None` stands for Sunflow's defaults 1, 4, 4.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct TraceDepths {
    /// Diffuse bounces.
    pub diffuse: Option<Spanned<u32>>,
    /// Mirror and glossy bounces.
    pub reflection: Option<Spanned<u32>>,
    /// Refractions.
    pub refraction: Option<Spanned<u32>>,
}
