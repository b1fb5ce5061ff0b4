//! Surfaces as triangles: what a mesh file holds, and what the `.gltf` file shows.

use std::fmt;

use glam::{DVec2, DVec3};

/// Triangles with all that a map needs: points, directions, texture coordinates.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Model {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// A corner of a [`Model`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Vertex {
    pub point: [f64; 3],
    /// A unit vector.
    pub normal: [f64; 3],
    /// A unit vector along u, at right angles to the normal.
    pub tangent: [f64; 3],
    /// 1 where v runs along normal × tangent, −1 where it runs the other way: in mirrored charts.
    pub hand: f64,
    /// Texture coordinates: v runs upwards from the lower left corner of the picture.
    pub uv: [f64; 2],
}

/// Why a mesh cannot be baked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ModelError {
    /// The file cannot be read; why.
    File(String),
    /// It has no texture coordinates, or none that span a surface.
    NoLayout,
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ModelError::File(reason) => f.write_str(reason),
            ModelError::NoLayout => f.write_str("it has no texture coordinates into which maps could be baked"),
        }
    }
}

impl std::error::Error for ModelError {}

/// Faces that meet at a smaller angle than this (its cosine: 50°) are one smooth surface.
const SMOOTH: f64 = 0.643;

impl Model {
    /// The mesh in the bytes of an OBJ file, by its name's extension. Where its faces meet at less than 50°, it is smooth.
    ///
    /// # Errors
    /// When the file cannot be read, or has no texture coordinates.
    pub fn from_mesh_file(bytes: &[u8], path: &std::path::Path) -> Result<Model, ModelError> {
        let mesh = jaspe_render::read_mesh(bytes, path).map_err(ModelError::File)?;
        let point = |index: u32| DVec3::from(mesh.points[index as usize].map(f64::from));
        let faces: Vec<DVec3> = mesh
            .triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(point);
                (b - a).cross(c - a)
            })
            .collect();
        let mut around: Vec<Vec<u32>> = vec![Vec::new(); mesh.points.len()];
        for (face, corners) in mesh.triangles.iter().enumerate() {
            corners.iter().for_each(|&corner| around[corner as usize].push(face as u32));
        }
        let mut model = Model::default();
        for (face, corners) in mesh.triangles.iter().enumerate() {
            let Some(uvs) = mesh.uvs.get(face) else { return Err(ModelError::NoLayout) };
            let own = faces[face].normalize_or_zero();
            let uvs = uvs.map(|uv| DVec2::from(uv.map(f64::from)));
            let Some(chart) = Chart::new(corners.map(point), uvs).filter(|_| own != DVec3::ZERO) else { continue };
            let first = model.vertices.len() as u32;
            for (corner, uv) in corners.iter().zip(uvs) {
                let near = around[*corner as usize].iter().map(|&face| faces[face as usize]);
                let smooth: DVec3 = near.filter(|normal| normal.normalize_or_zero().dot(own) > SMOOTH).sum();
                let normal = smooth.normalize_or(own);
                let tangent = chart.tangent(normal).to_array();
                let (point, normal) = (point(*corner).to_array(), normal.to_array());
                model.vertices.push(Vertex { point, normal, tangent, hand: chart.hand, uv: uv.to_array() });
            }
            model.triangles.push([first, first + 1, first + 2]);
        }
        if model.triangles.is_empty() { Err(ModelError::NoLayout) } else { Ok(model) }
    }

    /// The longest side of the box around it.
    pub(crate) fn side(&self) -> f64 {
        let points = || self.vertices.iter().map(|vertex| DVec3::from(vertex.point));
        let least = points().fold(DVec3::INFINITY, DVec3::min);
        let most = points().fold(DVec3::NEG_INFINITY, DVec3::max);
        (most - least).max_element()
    }

    /// The same, so many times as large.
    pub(crate) fn scaled(&self, factor: f64) -> Model {
        let scale = |vertex: &Vertex| Vertex { point: vertex.point.map(|part| part * factor), ..*vertex };
        Model { vertices: self.vertices.iter().map(scale).collect(), triangles: self.triangles.clone() }
    }

    /// The corners of a triangle.
    pub(crate) fn corners(&self, triangle: usize) -> [Vertex; 3] {
        self.triangles[triangle].map(|index| self.vertices[index as usize])
    }
}

/// A triangle as a map of the plane of texture coordinates.
pub(crate) struct Chart {
    corner: DVec3,
    uv: DVec2,
    /// The way of the point when u grows by 1, and v.
    pub by_u: DVec3,
    pub by_v: DVec3,
    pub hand: f64,
}

impl Chart {
    /// None where the texture coordinates span nothing.
    pub fn new(points: [DVec3; 3], uvs: [DVec2; 3]) -> Option<Chart> {
        let (e, f) = (points[1] - points[0], points[2] - points[0]);
        let (d, g) = (uvs[1] - uvs[0], uvs[2] - uvs[0]);
        let area = d.perp_dot(g);
        let (by_u, by_v) = ((e * g.y - f * d.y) / area, (f * d.x - e * g.x) / area);
        let usable = area != 0.0 && by_u.is_finite() && by_v.is_finite();
        usable.then_some(Chart { corner: points[0], uv: uvs[0], by_u, by_v, hand: area.signum() })
    }

    /// The point at texture coordinates; outside of the triangle, on its plane.
    pub fn point(&self, uv: DVec2) -> DVec3 {
        let way = uv - self.uv;
        self.corner + way.x * self.by_u + way.y * self.by_v
    }

    /// The direction along u, at right angles to a normal.
    pub fn tangent(&self, normal: DVec3) -> DVec3 {
        (self.by_u - normal * normal.dot(self.by_u)).normalize_or(normal.any_orthonormal_vector())
    }
}
