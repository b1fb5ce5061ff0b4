//! The `light` block.

use super::{Color, Name};
use crate::source::Span;

/// A light as written.
#[derive(Debug, Clone)]
pub struct Light {
    /// What shines.
    pub kind: LightKind,
    /// The block.
    pub span: Span,
}

/// The lights (format reference, §2.13 and §3.7). `samples` are rays per shading point.
#[derive(Debug, Clone)]
#[allow(missing_docs, reason = "the fields are the format's own words")]
pub enum LightKind {
    /// `type point`: in Sunflow `color × power` is radiant power, in the report's dialect `power` is a range.
    /// The old form `point power COLOR` has power 1.
    Point { color: Color, power: f32, position: [f32; 3] },
    /// `type directional`: a parallel beam of the given radius; `intensity` is 1 where absent.
    Directional { source: [f32; 3], target: [f32; 3], radius: f32, emit: Color, intensity: f32 },
    /// `type spherical`: a shining sphere, of radiance `color × radiance`.
    Spherical { color: Color, radiance: f32, center: [f32; 3], radius: f32, samples: u32 },
    /// `type meshlight`, or in the old form `mesh`: triangles that shine to their front, the side from which their
    /// corners run counter-clockwise, with radiance `emit × radiance` (1 where absent); `samples` for each of them.
    Mesh { name: Option<Name>, emit: Color, radiance: f32, samples: u32, shape: Triangles },
    /// `type sunsky`: sun and sky after Preetham. `up` and `east` give the frame, `sundir` points to the sun.
    SunSky { up: [f32; 3], east: [f32; 3], sundir: [f32; 3], turbidity: f32, samples: u32, ground: Ground },
    /// `type ibl`: a picture of the surroundings by longitude and latitude, looked for in
    /// [`super::Scene::texture_folders`]: `center` points to its middle, `up` to its top edge. With `lock` all points see
    /// the same `samples` directions; `low_samples` is their number for indirect light.
    Ibl { image: Name, center: [f32; 3], up: [f32; 3], lock: bool, samples: u32, low_samples: u32 },
    /// `type cornellbox`: a room without front wall, and the light in its ceiling.
    CornellBox(CornellBox),
}

impl LightKind {
    /// Its `type` in a scene file.
    pub fn keyword(&self) -> &'static str {
        match self {
            LightKind::Point { .. } => "point",
            LightKind::Directional { .. } => "directional",
            LightKind::Spherical { .. } => "spherical",
            LightKind::Mesh { .. } => "meshlight",
            LightKind::SunSky { .. } => "sunsky",
            LightKind::Ibl { .. } => "ibl",
            LightKind::CornellBox(_) => "cornellbox",
        }
    }
}

/// Bare triangles. Indices are valid: they have been checked against the number of points.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Triangles {
    /// Vertex positions.
    pub points: Vec<[f32; 3]>,
    /// Vertex indices, three per triangle.
    pub triangles: Vec<[u32; 3]>,
}

/// What lies below the horizon of a sky.
#[derive(Debug, Clone)]
pub enum Ground {
    /// The sky of the horizon goes on (`ground.extendsky true`).
    Sky,
    /// `ground.color`; black where neither is written.
    Color(Color),
}

/// A room between two corners: left at the least x, right at the largest, back at the largest y, bottom and top at the
/// ends of z, all matte, the front open (format reference, §3.13).
#[derive(Debug, Clone)]
#[allow(missing_docs, reason = "the fields are the format's own words")]
pub struct CornellBox {
    pub corners: [[f32; 3]; 2],
    pub left: Color,
    pub right: Color,
    pub top: Color,
    pub bottom: Color,
    pub back: Color,
    /// Radiance of the middle ninth of the ceiling, downwards.
    pub emit: Color,
    /// Rays per shading point.
    pub samples: u32,
}
