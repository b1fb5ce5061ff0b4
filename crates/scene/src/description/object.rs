//! The `object` and `instance` blocks.

use super::{Name, Transform};
use crate::source::Span;

/// A geometry, and usually one instance of it.
#[derive(Debug, Clone)]
pub struct Object {
    /// What instances call it.
    pub name: Option<Name>,
    /// Shaders, by name; meshes may choose among them per triangle.
    pub shaders: Vec<Name>,
    /// Where it stands; absent means where it was modelled.
    pub transform: Option<Transform>,
    /// Its shape, in its own space.
    pub geometry: Geometry,
    /// False after `noinstance`: only [`Instance`]s of it are seen.
    pub visible: bool,
    /// The block.
    pub span: Span,
}

/// One more appearance of a geometry.
#[derive(Debug, Clone)]
pub struct Instance {
    /// Its name, if written.
    pub name: Option<Name>,
    /// The object whose shape it shows.
    pub geometry: Name,
    /// Shaders, by name.
    pub shaders: Vec<Name>,
    /// Where it stands (required by the format; identity where it was left out, with an error).
    pub transform: Option<Transform>,
    /// The block.
    pub span: Span,
}

/// The shapes that are supported so far.
#[derive(Debug, Clone)]
#[allow(missing_docs, reason = "the fields are the format's own words")]
pub enum Geometry {
    /// The unit sphere at the origin, moved to `c` and scaled by `r` where these are written.
    Sphere { center: [f32; 3], radius: f32 },
    /// An infinite plane.
    Plane(Plane),
    /// Triangles.
    Mesh(Mesh),
    /// An axis-aligned box between two corners; the unit cube around the origin where no `points` are written.
    Box { corners: [[f32; 3]; 2] },
}

/// The two forms of a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs, reason = "the fields are the format's own words")]
pub enum Plane {
    /// `p P n N`.
    Normal { point: [f32; 3], normal: [f32; 3] },
    /// `p P0 p P1 p P2`: texture coordinates run along P0→P1 and P0→P2.
    Points([[f32; 3]; 3]),
}

/// A triangle mesh. Indices are valid: they have been checked against the number of points.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// Vertex positions.
    pub points: Vec<[f32; 3]>,
    /// Vertex indices, three per triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Shading normals.
    pub normals: VertexData<[f32; 3]>,
    /// Texture coordinates.
    pub uvs: VertexData<[f32; 2]>,
    /// Index into the object's shaders, one per triangle.
    pub face_shaders: Option<Vec<u32>>,
}

/// Data that a mesh carries per vertex, per corner, or not at all.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum VertexData<T> {
    /// None.
    #[default]
    None,
    /// One per point.
    Vertex(Vec<T>),
    /// Three per triangle.
    FaceVarying(Vec<T>),
}
