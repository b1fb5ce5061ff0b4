//! The lattice noises, one per file, and what they share: corners, periods and blends.

pub(crate) mod cellular;
pub(crate) mod classic;
mod hash;
pub(crate) mod improved;
pub(crate) mod lattice;
pub(crate) mod simplex;
pub(crate) mod value;
pub(crate) mod white;

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
        match self {
            Basis::Improved => "improved",
            Basis::Classic => "classic",
            Basis::Lattice => "lattice",
            Basis::Value => "value",
            Basis::Simplex => "simplex",
            Basis::Cellular => "cellular",
            Basis::White => "white",
        }
    }

    /// The basis of this name.
    pub fn from_name(name: &str) -> Option<Basis> {
        Basis::ALL.iter().copied().find(|basis| basis.name() == name)
    }
}

/// What a seed determines.
#[derive(Debug, PartialEq)]
pub(crate) struct Tables {
    /// The permutation.
    pub(crate) permutation: PairTable,
    /// Edge codes (see [`Real::edge_dot`]): of the entry in bits 0–3, of the next in bits 4–7.
    pub(crate) edges: ByteTable,
    /// Both, for reading all corners of a cell at once.
    pub(crate) corners: CornerTables,
    /// The components of the unit gradients.
    gradients: [FloatTable; 3],
    /// What the hash of cells starts from.
    hash_seed: i32,
}

impl Tables {
    pub(crate) fn new(seed: u64) -> Self {
        let permutation = seed::permutation(seed);
        let code = |i: usize| improved::EDGE_CODES[usize::from(permutation[i % 256] & 15)];
        let edges = std::array::from_fn(|i| code(i) | code(i + 1) << 4);
        let (permutation, edges) = (PairTable::new(permutation), ByteTable::new(edges));
        Tables {
            corners: CornerTables::new(&permutation, &edges),
            permutation,
            edges,
            gradients: seed::unit_vectors(seed).map(FloatTable::new),
            hash_seed: seed::Random::new(seed).bits() as i32,
        }
    }
}

/// The number of cells after which each axis repeats; 0 for the 256 of the table.
pub(crate) type Period = [f64; 3];

/// A cell's coordinate within the period of its axis, if it has one.
#[inline(always)]
fn wrap<R: Real>(cell: R, period: f64) -> R {
    if period == 0.0 {
        return cell;
    }
    // The quotient's rounding may put the remainder one period off; then it is outside [0, period).
    let period = R::constant(period);
    let rest = cell - (cell / period).floor() * period;
    let rest = R::select(rest.less(R::constant(0.0)), rest + period, rest);
    R::select(rest.less(period), rest, rest - period)
}

/// The lattice coordinates below and above along one axis.
#[inline(always)]
fn corners<R: Real>(cell: R, period: f64) -> (R::Int, R::Int) {
    (wrap(cell, period).to_int(), wrap(cell + R::constant(1.0), period).to_int())
}

/// The table's entry alone.
#[inline(always)]
fn hash_byte<R: Real>(table: &PairTable, index: R::Int) -> R::Int {
    R::lookup_pair(table, index).0
}

/// The hashes of the four columns over the cell: (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1).
#[inline(always)]
fn columns<R: Real>(tables: &Tables, x: R, y: R, period: &Period) -> [R::Int; 4] {
    let table = &tables.permutation;
    if period[0] == 0.0 && period[1] == 0.0 {
        let (x, y) = (x.to_int(), y.to_int());
        let (left, right) = R::lookup_pair(table, x);
        let (left_low, left_high) = R::lookup_pair(table, left + y);
        let (right_low, right_high) = R::lookup_pair(table, right + y);
        return [left_low, right_low, left_high, right_high];
    }
    let (x0, x1) = corners(x, period[0]);
    let (y0, y1) = corners(y, period[1]);
    let (left, right) = (hash_byte::<R>(table, x0), hash_byte::<R>(table, x1));
    let low = [hash_byte::<R>(table, left + y0), hash_byte::<R>(table, right + y0)];
    [low[0], low[1], hash_byte::<R>(table, left + y1), hash_byte::<R>(table, right + y1)]
}

/// The hashes at the lower and upper end of a column.
#[inline(always)]
fn ends<R: Real>(tables: &Tables, column: R::Int, z: R, period: f64) -> (R::Int, R::Int) {
    if period == 0.0 {
        return R::lookup_pair(&tables.permutation, column + z.to_int());
    }
    let (low, high) = corners(z, period);
    (hash_byte::<R>(&tables.permutation, column + low), hash_byte::<R>(&tables.permutation, column + high))
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

/// From `a` (at t = 0) to `b` (at t = 1).
#[inline(always)]
fn lerp<R: Real>(t: R, a: R, b: R) -> R {
    a + t * (b - a)
}

/// Four corners in the order of [`columns`], blended.
#[inline(always)]
fn bilinear<R: Real>(u: R, v: R, corners: [R; 4]) -> R {
    lerp(v, lerp(u, corners[0], corners[1]), lerp(u, corners[2], corners[3]))
}

/// The curve 3t² − 2t³, whose slope vanishes at both ends. \[Perlin 1985\]
#[inline(always)]
fn cubic<R: Real>(t: R) -> R {
    t * t * (R::constant(3.0) - R::constant(2.0) * t)
}

/// The same value; a zero becomes `+0`. The number types may disagree on the sign of a zero until here.
#[inline(always)]
fn plus_zero<R: Real>(value: R) -> R {
    value + R::constant(0.0)
}
