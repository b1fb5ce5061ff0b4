//! What is baked: where each pixel of a map lies in the material, and which way its axes run there.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DVec2, DVec3};
use jaspe_noise::math::{cos, sin};

use crate::layout::Layout;
use crate::model::{Model, Vertex};

/// The surface that a bake unrolls into its maps. All but the plane are cut from the solid material.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Surface {
    /// A square that repeats along both sides.
    #[default]
    Plane,
    /// A ball: u is the longitude (the middle of the map looks along z), v the latitude with y upwards. Maps are twice as wide
    /// as high.
    Sphere,
    /// The side of an upright cylinder that is π/2 times as high as wide, so that its maps are twice as wide as high.
    Cylinder,
    /// The six sides as a cross of 4 × 3 squares: −x, +z, +x, −z side by side, +y above +z and −y below.
    Cube,
    /// A mesh in its own texture coordinates, padded around its charts.
    Mesh(Arc<Model>),
}

/// A pixel's place in the material, in noise cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frame {
    /// Its centre.
    pub point: DVec3,
    /// The way to the next pixel on the right.
    pub right: DVec3,
    /// The way to the next pixel above.
    pub up: DVec3,
    /// The unit vector along which red points in a normal map.
    pub tangent: DVec3,
    /// The unit vector along which green points in a normal map (OpenGL).
    pub bitangent: DVec3,
}

impl Surface {
    /// The words for those without a mesh, on the command line.
    pub const NAMES: &[&str] = &["plane", "sphere", "cube", "cylinder"];

    /// The surface of this name.
    pub fn from_name(name: &str) -> Option<Surface> {
        [Surface::Plane, Surface::Sphere, Surface::Cube, Surface::Cylinder].into_iter().find(|s| s.name() == name)
    }

    /// The word for it on the command line.
    pub fn name(&self) -> &'static str {
        match self {
            Surface::Plane => "plane",
            Surface::Sphere => "sphere",
            Surface::Cylinder => "cylinder",
            Surface::Cube => "cube",
            Surface::Mesh(_) => "mesh",
        }
    }

    /// Width and height of its maps, for the size that was asked for.
    pub fn extent(&self, size: u32) -> [u32; 2] {
        match self {
            Surface::Plane | Surface::Mesh(_) => [size, size],
            Surface::Sphere | Surface::Cylinder => [size, size.div_ceil(2)],
            Surface::Cube => [4 * size.div_ceil(4), 3 * size.div_ceil(4)],
        }
    }

    /// Whether the maps repeat along both sides.
    pub fn tiles(&self) -> bool {
        matches!(self, Surface::Plane)
    }

    /// The width of the surface in units of the texture, if nothing else is asked for: that of the unit sphere, or the mesh's
    /// own; `None` for a plane, whose material knows.
    pub(crate) fn own_width(&self) -> Option<f64> {
        match self {
            Surface::Plane => None,
            Surface::Sphere | Surface::Cylinder | Surface::Cube => Some(2.0),
            Surface::Mesh(model) => Some(model.side()),
        }
    }

    /// How wide a pixel is, in parts of the width of the surface.
    pub(crate) fn pixel(&self, [width, _]: [u32; 2]) -> f64 {
        let part = match self {
            Surface::Plane => 1.0,
            Surface::Sphere | Surface::Cylinder => PI,
            Surface::Cube => 4.0,
            Surface::Mesh(model) => {
                let areas = (0..model.triangles.len()).map(|triangle| {
                    let corners = model.corners(triangle);
                    let [a, b, c] = corners.map(|corner| DVec3::from(corner.point));
                    let [d, e, f] = corners.map(|corner| DVec2::from(corner.uv));
                    DVec2::new((b - a).cross(c - a).length(), (e - d).perp_dot(f - d).abs())
                });
                let total: DVec2 = areas.sum();
                (total.x / total.y).sqrt() / model.side()
            }
        };
        part / f64::from(width)
    }

    /// The frame of a pixel; `cells` is the width of the surface in noise cells. A mesh has a layout.
    pub(crate) fn frame(&self, [x, y]: [i64; 2], extent: [u32; 2], cells: f64, layout: Option<&Layout>) -> Frame {
        let [width, height] = extent.map(f64::from);
        // Pixels past the border are those of the next tile, which is the same.
        let part = |i: i64, side: u32| (i.rem_euclid(i64::from(side)) as f64 + 0.5) / f64::from(side);
        let (u, v) = (part(x, extent[0]), part(-1 - y, extent[1]));
        let radius = 0.5 * cells;
        match self {
            Surface::Plane => {
                let point = DVec3::new(cells * u, cells * v, SLICE);
                let (tangent, bitangent, step) = (DVec3::X, DVec3::Y, cells / width);
                Frame { point, right: step * tangent, up: step * bitangent, tangent, bitangent }
            }
            Surface::Sphere => {
                let (outward, tangent, bitangent, shrink) = around(u, v);
                let right = radius * TAU / width * shrink * tangent;
                Frame { point: radius * outward, right, up: radius * PI / height * bitangent, tangent, bitangent }
            }
            Surface::Cylinder => {
                let (outward, tangent, bitangent, _) = around(u, 0.5);
                let point = radius * (outward + PI * (v - 0.5) * bitangent);
                let (right, up) = (radius * TAU / width * tangent, radius * PI / height * bitangent);
                Frame { point, right, up, tangent, bitangent }
            }
            Surface::Cube => {
                let side = cube_side(4.0 * u, 3.0 * v);
                let (right, up) = (cells * 4.0 / width * side.tangent, cells * 3.0 / height * side.bitangent);
                let point = cells
                    * (side.corner + (4.0 * u - side.column) * side.tangent + (3.0 * v - side.row) * side.bitangent);
                Frame { point, right, up, tangent: side.tangent, bitangent: side.bitangent }
            }
            Surface::Mesh(model) => {
                let layout = layout.expect("the bake of a mesh has a layout");
                layout.frame(model, [x, y], cells / model.side())
            }
        }
    }

    /// The surface as triangles, so wide in units.
    pub(crate) fn model(&self, width: f64) -> Model {
        match self {
            Surface::Plane => sheet([1, 1], &|u, v| {
                let point = width * DVec3::new(u - 0.5, v - 0.5, 0.0);
                (point, DVec3::Z, DVec3::X)
            }),
            Surface::Sphere => sheet([96, 48], &|u, v| {
                let (outward, tangent, _, _) = around(u, v);
                (0.5 * width * outward, outward, tangent)
            }),
            Surface::Cylinder => sheet([96, 1], &|u, v| {
                let (outward, tangent, up, _) = around(u, 0.5);
                (0.5 * width * (outward + PI * (v - 0.5) * up), outward, tangent)
            }),
            Surface::Cube => {
                let mut cube = Model::default();
                for (column, row) in CUBE {
                    let face = cube_side(column + 0.5, row + 0.5);
                    let mut square = sheet([1, 1], &|s, t| {
                        let point = width * (face.corner + s * face.tangent + t * face.bitangent);
                        (point, face.tangent.cross(face.bitangent), face.tangent)
                    });
                    for vertex in &mut square.vertices {
                        vertex.uv = [(column + vertex.uv[0]) / 4.0, (row + vertex.uv[1]) / 3.0];
                    }
                    let first = cube.vertices.len() as u32;
                    cube.vertices.extend(square.vertices);
                    cube.triangles.extend(square.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
                }
                cube
            }
            Surface::Mesh(model) => model.scaled(width / model.side()),
        }
    }
}

/// Outward, along the longitude, and along the latitude, at a point of the unit sphere; and the radius of its parallel.
fn around(u: f64, v: f64) -> (DVec3, DVec3, DVec3, f64) {
    let (longitude, latitude) = (TAU * (u - 0.5), PI * (v - 0.5));
    let (a, b, c, d) = (sin(longitude), cos(longitude), sin(latitude), cos(latitude));
    (DVec3::new(d * a, c, d * b), DVec3::new(b, 0.0, -a), DVec3::new(-c * a, d, -c * b), d.max(0.0))
}

/// A grid over u and v, from the point, the normal and the direction along u at each of its knots.
pub(crate) fn sheet([columns, rows]: [u32; 2], at: &dyn Fn(f64, f64) -> (DVec3, DVec3, DVec3)) -> Model {
    let mut model = Model::default();
    for j in 0..=rows {
        for i in 0..=columns {
            let uv = [f64::from(i) / f64::from(columns), f64::from(j) / f64::from(rows)];
            let (point, normal, tangent) = at(uv[0], uv[1]);
            let [point, normal, tangent] = [point, normal, tangent].map(|vector| vector.to_array());
            model.vertices.push(Vertex { point, normal, tangent, hand: 1.0, uv });
        }
    }
    for j in 0..rows {
        for i in 0..columns {
            let corner = |i: u32, j: u32| j * (columns + 1) + i;
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            model.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    model
}

/// A side of the unit cube around the origin, and its square of the cross.
struct Side {
    column: f64,
    row: f64,
    corner: DVec3,
    tangent: DVec3,
    bitangent: DVec3,
}

/// The squares of the cross: columns from the left, rows from below.
const CUBE: [(f64, f64); 6] = [(0.0, 1.0), (1.0, 1.0), (2.0, 1.0), (3.0, 1.0), (1.0, 2.0), (1.0, 0.0)];

/// The side that a place of the cross belongs to; the empty squares beside the upper and lower ones continue their planes.
fn cube_side(u: f64, v: f64) -> Side {
    let row = v.floor().clamp(0.0, 2.0);
    let column = if row == 1.0 { u.floor().clamp(0.0, 3.0) } else { 1.0 };
    let (tangent, bitangent) = match (column as u32, row as u32) {
        (1, 2) => (DVec3::X, DVec3::NEG_Z),
        (1, 0) => (DVec3::X, DVec3::Z),
        (0, _) => (DVec3::Z, DVec3::Y),
        (1, _) => (DVec3::X, DVec3::Y),
        (2, _) => (DVec3::NEG_Z, DVec3::Y),
        _ => (DVec3::NEG_X, DVec3::Y),
    };
    let corner = 0.5 * (tangent.cross(bitangent) - tangent - bitangent);
    Side { column, row, corner, tangent, bitangent }
}

/// Where a plane cuts the solid material along z, in cells. Gradient noise is poor on the planes of its lattice; a third of a
/// cell from one, every octave is a third of its own cell away, since 2ᵏ/3 is never near a whole number. (The third of a cell by
/// which most materials are moved makes two thirds of it.)
const SLICE: f64 = 1.0 / 3.0;
