//! What is baked: where each pixel of a map lies in the material, and which way its axes run there.

/// A vector in the material, in noise cells.
pub(crate) type Vector = [f64; 3];

/// The surface that a bake unrolls into its maps.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Surface {
    /// A square that repeats along both sides.
    #[default]
    Plane,
}

/// A pixel's place in the material, in noise cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frame {
    /// Its centre.
    pub point: Vector,
    /// The way to the next pixel on the right.
    pub right: Vector,
    /// The way to the next pixel above.
    pub up: Vector,
    /// The unit vector along which red points in a normal map.
    pub tangent: Vector,
    /// The unit vector along which green points in a normal map (OpenGL).
    pub bitangent: Vector,
}

impl Surface {
    /// The word for it on the command line.
    pub fn name(&self) -> &'static str {
        match self {
            Surface::Plane => "plane",
        }
    }

    /// Width and height of its maps, for the size that was asked for.
    pub fn extent(&self, size: u32) -> [u32; 2] {
        match self {
            Surface::Plane => [size, size],
        }
    }

    /// Whether the maps repeat along both sides.
    pub fn tiles(&self) -> bool {
        matches!(self, Surface::Plane)
    }

    /// The frame of a pixel; `cells` is the width of the surface in noise cells.
    pub(crate) fn frame(&self, x: i64, y: i64, extent: [u32; 2], cells: f64) -> Frame {
        match self {
            Surface::Plane => {
                // Pixels past the border are those of the next tile, which is the same.
                let part = |i: i64, side: u32| (i.rem_euclid(i64::from(side)) as f64 + 0.5) / f64::from(side);
                let point = [cells * part(x, extent[0]), cells * part(-1 - y, extent[1]), SLICE];
                let step = cells / f64::from(extent[0]);
                let (right, up) = ([step, 0.0, 0.0], [0.0, step, 0.0]);
                Frame { point, right, up, tangent: [1.0, 0.0, 0.0], bitangent: [0.0, 1.0, 0.0] }
            }
        }
    }
}

/// Where a plane cuts the solid material along z, in cells. Gradient noise is poor on the planes of its lattice; a third of a
/// cell from one, every octave is a third of its own cell away, since 2ᵏ/3 is never near a whole number. (The third of a cell by
/// which most materials are moved makes two thirds of it.)
const SLICE: f64 = 1.0 / 3.0;
