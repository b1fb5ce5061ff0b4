//! The lattice noises, one per file, and what they share: corners, periods and blends.

pub(crate) mod cellular;
pub(crate) mod classic;
pub(crate) mod corners;
pub(crate) mod hash;
pub(crate) mod improved;
pub(crate) mod lattice;
pub(crate) mod simplex;
pub(crate) mod value;
pub(crate) mod white;

use crate::declaration::{BASES, Declaration};
use crate::number::Real;
use crate::seed;
use crate::table::{ByteTable, CornerTables, FloatTable, PairTable};

/// A lattice noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Basis {
    /// Gradient noise of \[Perlin 2002\], exactly his listing: twelve edge directions, the curve 6t⁵ − 15t⁴ + 10t³.
    Improved,
    /// Gradient noise of \[Perlin 1985\]: random unit gradients, the curve 3t² − 2t³.
    Classic,
    /// Random values at the lattice points, interpolated by the curve 3t² − 2t³.
    Lattice,
    /// Random values at the lattice points, from a hash, interpolated by the curve 6t⁵ − 15t⁴ + 10t³.
    Value,
    /// Gradient noise on tetrahedra instead of cubes. \[Perlin 2001\], \[Gustavson 2005\]
    Simplex,
    /// Distances to random feature points: see [`Cellular`](crate::Cellular). \[Worley 1996\]
    Cellular,
    /// A random value per cell, the same all over it.
    White,
}

impl Basis {
    /// Every basis.
    pub const ALL: &[Basis] =
        &[Basis::Improved, Basis::Classic, Basis::Lattice, Basis::Value, Basis::Simplex, Basis::Cellular, Basis::White];

    /// The word for it in scenes and on the command line.
    pub fn name(self) -> &'static str {
        self.declaration().name
    }

    /// The basis of this name or term.
    pub fn from_name(name: &str) -> Option<Basis> {
        Declaration::find(BASES, name)
    }
}

/// What a seed determines.
#[derive(Debug, PartialEq)]
pub(crate) struct Tables {
    /// The permutation.
    pub(crate) permutation: PairTable,
    /// Edge codes (see [`Real::edge_dot`]): of the entry in bits 0–3, of the next in bits 4–7.
    pub(crate) edges: ByteTable,
    /// Edge codes in the plane, by the entry of a column along y: of that entry's own entry in bits 0–3, of the next one's in
    /// bits 4–7.
    pub(crate) plane: ByteTable,
    /// Both, for reading all corners of a cell at once.
    pub(crate) corners: CornerTables,
    /// The components of the unit gradients of classic noise: on the sphere, and on that of four dimensions.
    pub(crate) gradients: [FloatTable; 3],
    gradients_four: [FloatTable; 4],
    /// What the hash of cells starts from.
    pub(crate) hash_seed: i32,
}

impl Tables {
    pub(crate) fn new(seed: u64) -> Self {
        let permutation = seed::permutation(seed);
        let code = |i: usize| improved::EDGE_CODES[usize::from(permutation[i % 256] & 15)];
        let edges = std::array::from_fn(|i| code(i) | code(i + 1) << 4);
        let in_plane = |i: usize| code(usize::from(permutation[i % 256]));
        let plane = ByteTable::new(std::array::from_fn(|i| in_plane(i) | in_plane(i + 1) << 4));
        let (permutation, edges) = (PairTable::new(permutation), ByteTable::new(edges));
        Tables {
            plane,
            corners: CornerTables::new(&permutation, &edges),
            permutation,
            edges,
            gradients: seed::unit_vectors(seed).map(FloatTable::new),
            gradients_four: seed::unit_vectors(seed).map(FloatTable::new),
            hash_seed: seed::Random::new(seed).bits() as i32,
        }
    }
}

/// The number of cells after which each axis repeats; 0 for the 256 of the table.
pub(crate) type Period = [f64; 4];

/// A cell's coordinate within the period of its axis, if it has one.
#[inline(always)]
pub(crate) fn wrap<R: Real>(cell: R, period: f64) -> R {
    if period == 0.0 {
        return cell;
    }
    // The quotient's rounding may put the remainder one period off; then it is outside [0, period).
    let period = R::constant(period);
    let rest = cell - (cell / period).floor() * period;
    let rest = R::select(rest.less(R::constant(0.0)), rest + period, rest);
    R::select(rest.less(period), rest, rest - period)
}

/// Each coordinate's cell, and the offset in it. (Closures and the methods of arrays are not sure to be inlined, and code
/// that is not inlined is not compiled with the machine's vector instructions; hence the loops here and elsewhere.)
#[inline(always)]
fn split<R: Real, const D: usize>(point: [R; D]) -> ([R; D], [R; D]) {
    let (mut cell, mut offset) = (point, point);
    for axis in 0..D {
        cell[axis] = point[axis].floor();
        offset[axis] = point[axis] - cell[axis];
    }
    (cell, offset)
}

/// The value, or NaN where a coordinate is none.
#[inline(always)]
fn nan_where_none<R: Real, const D: usize>(value: R, offset: &[R; D]) -> R {
    let mut value = value;
    for &part in offset {
        value = value + part * R::constant(0.0);
    }
    value
}
