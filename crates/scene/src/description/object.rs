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
    /// Modifiers, by name; meshes choose among them as among the shaders.
    pub modifiers: Vec<Name>,
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
    /// Modifiers, by name.
    pub modifiers: Vec<Name>,
    /// Where it stands (required by the format; identity where it was left out, with an error).
    pub transform: Option<Transform>,
    /// The block.
    pub span: Span,
}

/// The shapes, in their own space (format reference, §2.10 and §3.13).
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
    /// Triangles of another file, looked for in [`super::Scene::include_folders`].
    FileMesh { file: Name, smooth_normals: bool },
    /// Bicubic Bézier patches.
    BezierMesh { net: BezierNet, tessellation: Tessellation },
    /// Newell's teapot.
    Teapot(Tessellation),
    /// Catmull's elephant.
    Gumbo(Tessellation),
    /// A ring of radius `ring` around the z axis, of a tube of radius `tube`.
    Torus { tube: f32, ring: f32 },
    /// The side of a cylinder of radius 1 around the z axis, from z = −1 to 1.
    Cylinder,
    /// Banchoff's surface: x⁴ + y⁴ + z⁴ − x² − y² − z² + 3/8 = 0.
    Banchoff,
    /// Spheres on spheres: nine on each, a third of its size, `level` times over, around `axis`.
    SphereFlake { level: u32, axis: [f32; 3], radius: f32 },
    /// The set of points that z ← z² + c keeps near, in quaternions w x y z, where w x y z starts as the point's x y z and 0.
    Julia { c: [f32; 4], iterations: u32, epsilon: f32 },
    /// Ribbons that face the viewer.
    Hair(Hair),
    /// Spheres of one size; `count` is how many of the points are used, all where absent.
    Particles { points: PointSource, count: Option<u32>, radius: f32 },
}

impl Geometry {
    /// Its `type` in a scene file.
    pub fn keyword(&self) -> &'static str {
        match self {
            Geometry::Sphere { .. } => "sphere",
            Geometry::Plane(_) => "plane",
            Geometry::Mesh(_) => "generic-mesh",
            Geometry::Box { .. } => "box",
            Geometry::FileMesh { .. } => "file-mesh",
            Geometry::BezierMesh { .. } => "bezier-mesh",
            Geometry::Teapot(_) => "teapot",
            Geometry::Gumbo(_) => "gumbo",
            Geometry::Torus { .. } => "torus",
            Geometry::Cylinder => "cylinder",
            Geometry::Banchoff => "banchoff",
            Geometry::SphereFlake { .. } => "sphereflake",
            Geometry::Julia { .. } => "julia",
            Geometry::Hair(_) => "hair",
            Geometry::Particles { .. } => "particles",
        }
    }
}

/// How patches become triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tessellation {
    /// Each patch becomes `subdivs` × `subdivs` pairs of triangles; at least 1.
    pub subdivs: u32,
    /// Whether normals are those of the patch and not of its triangles.
    pub smooth: bool,
}

impl Default for Tessellation {
    fn default() -> Self {
        Tessellation { subdivs: 8, smooth: true }
    }
}

/// Control points of bicubic patches that share their edges.
#[derive(Debug, Clone, PartialEq)]
pub struct BezierNet {
    /// Points along u and v, at least four each.
    pub size: [u32; 2],
    /// Whether the last patch along u and v ends where the first one begins.
    pub wrap: [bool; 2],
    /// `size[0] × size[1]` points, u running fastest.
    pub points: Vec<[f32; 3]>,
}

impl BezierNet {
    /// How many patches there are along u and v.
    pub fn patches(&self) -> [u32; 2] {
        std::array::from_fn(|axis| match self.wrap[axis] {
            true => self.size[axis] / 3,
            false => self.size[axis].saturating_sub(4) / 3 + u32::from(self.size[axis] >= 4),
        })
    }
}

/// Strands of ribbons.
#[derive(Debug, Clone, PartialEq)]
pub struct Hair {
    /// Segments per strand, at least 1: a strand has one point more.
    pub segments: u32,
    /// Width of the ribbons.
    pub width: f32,
    /// The points of all strands, one strand after the other; a multiple of `segments + 1`.
    pub points: Vec<[f32; 3]>,
}

/// Where points come from.
#[derive(Debug, Clone)]
pub enum PointSource {
    /// From the scene file.
    Points(Vec<[f32; 3]>),
    /// From a file of raw 32-bit floats, three per point, looked for in [`super::Scene::include_folders`].
    File {
        /// The file name as written.
        file: Name,
        /// In which order the bytes of a float stand.
        order: ByteOrder,
    },
}

/// The order of the bytes of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[allow(missing_docs, reason = "the names are the documentation")]
pub enum ByteOrder {
    #[default]
    BigEndian,
    LittleEndian,
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
