//! Tables of 256 entries, laid out for the ways in which the number types read them.

use std::ops::{BitOr, Shl};

/// 256 bytes. [`crate::Real::lookup`] reads it.
#[derive(Debug, Clone, PartialEq)]
#[repr(C, align(64))]
pub struct ByteTable {
    /// For byte permutations, which hold the whole table in four registers of 64 bytes.
    pub(crate) bytes: [u8; 256],
    /// For gathers of 32-bit words.
    pub(crate) words: [i32; 256],
}

impl ByteTable {
    /// A table with these entries.
    pub fn new(bytes: [u8; 256]) -> Self {
        ByteTable { bytes, words: bytes.map(i32::from) }
    }
}

/// 256 bytes, each read together with the one after it. [`crate::Real::lookup_pair`] reads it.
#[derive(Debug, Clone, PartialEq)]
#[repr(C, align(64))]
pub struct PairTable {
    /// The entries.
    pub(crate) bytes: [u8; 256],
    /// For each entry the next one; the first follows the last.
    pub(crate) next: [u8; 256],
    /// Both in one word, the next in bits 8–15.
    pub(crate) pairs: [i32; 256],
}

impl PairTable {
    /// A table with these entries.
    pub fn new(bytes: [u8; 256]) -> Self {
        let next: [u8; 256] = std::array::from_fn(|i| bytes[(i + 1) % 256]);
        let pairs = std::array::from_fn(|i| i32::from(bytes[i]) | i32::from(next[i]) << 8);
        PairTable { bytes, next, pairs }
    }
}

/// 256 numbers. [`crate::Real::pick`] reads it.
#[derive(Debug, Clone, PartialEq)]
#[repr(C, align(64))]
pub struct FloatTable {
    /// The entries, rounded.
    pub(crate) singles: [f32; 256],
    /// The entries.
    pub(crate) doubles: [f64; 256],
}

impl FloatTable {
    /// A table with these entries.
    pub fn new(doubles: [f64; 256]) -> Self {
        FloatTable { singles: doubles.map(|entry| entry as f32), doubles }
    }
}

/// Tables that hash the eight corners of a cell with eight reads, none of which waits for more than one other.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CornerTables {
    /// What the permutation makes of y and of what it makes of x, in rows of y from 0 to 256 for each x from 0 to 256: with the
    /// neighbours of a column stand those of the columns beside it.
    pub columns: Box<[u8; Self::ROW * Self::ROW]>,
    /// The edge codes of the corners.
    pub edges: ColumnCodes,
    /// How their edges are chosen: see [`choice_code`].
    pub choices: ColumnCodes,
    /// Which parts of the offsets they add: see [`part_code`].
    pub parts: ColumnCodes<u64>,
}

/// For the columns (x, y), (x, y + 1), (x + 1, y), (x + 1, y + 1), 512 entries each: the codes of an entry at the column's
/// lower end and of the next one at its upper end, an eighth of the bits each, further up for each column.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ColumnCodes<T = u32>(pub [T; 2048]);

impl<T: From<u8> + BitOr<Output = T> + Shl<usize, Output = T>> ColumnCodes<T> {
    /// From the code of an entry at a corner, whose ends along x, y and z are 0 or 1.
    fn new(code: impl Fn(usize, [u32; 3]) -> u8) -> Self {
        let bits = size_of::<T>();
        ColumnCodes(std::array::from_fn(|i| {
            let (entry, column) = (i % 256, i / 512);
            let [x, y] = [column as u32 >> 1, column as u32 & 1];
            let (lower, upper) = (T::from(code(entry, [x, y, 0])), T::from(code((entry + 1) % 256, [x, y, 1])));
            (lower | upper << bits) << (2 * bits * column)
        }))
    }
}

/// How to get the two components of an edge's dot product with the offset from a corner, from the lengths of the offset
/// along each axis. The first component is that along x, if there is one, and else that along y; the second that along z, and
/// else that along y. Of the two bits for each (the second above the first), the lower says whether it is that along x or z,
/// the upper whether it is negative, where points see upper corners in the negative direction.
fn choice_code(edge_code: u8, [x, y, z]: [u32; 3]) -> u8 {
    let edge = <f32 as crate::Real>::edge(crate::Integer::constant(i32::from(edge_code)));
    let component = |outer: usize, end: u32| {
        let chosen = edge[outer] != 0.0;
        let negative = if chosen { (edge[outer] < 0.0) != (end == 1) } else { (edge[1] < 0.0) != (y == 1) };
        u8::from(chosen) | u8::from(negative) << 1
    };
    component(0, x) | component(2, z) << 2
}

/// Which two numbers the corner adds, four bits each. Of the first, the offset along x or y: bit 0 says whether it is that from the upper
/// corner, bit 1 whether it is along y, bit 2 whether it is negative. Of the second, along z or y, the same.
fn part_code(edge_code: u8, ends: [u32; 3]) -> u8 {
    let edge = <f32 as crate::Real>::edge(crate::Integer::constant(i32::from(edge_code)));
    let part = |outer: usize| {
        let axis = if edge[outer] == 0.0 { 1 } else { outer };
        ends[axis] as u8 | u8::from(axis == 1) << 1 | u8::from(edge[axis] < 0.0) << 2
    };
    part(0) | part(2) << 4
}

impl CornerTables {
    /// The columns of a row.
    pub const ROW: usize = 257;

    /// From the permutation, and its edge codes as [`crate::basis::Tables`] has them.
    pub fn new(permutation: &PairTable, edges: &ByteTable) -> Self {
        let edge = |entry: usize| edges.bytes[entry] & 15;
        let twice = [permutation.bytes, permutation.bytes];
        let row = |x: usize| &twice.as_flattened()[usize::from(permutation.bytes[x % 256])..][..Self::ROW];
        let columns = (0..Self::ROW).map(row).collect::<Vec<_>>().concat();
        CornerTables {
            columns: columns.into_boxed_slice().try_into().expect("whole rows"),
            edges: ColumnCodes::new(|entry, _| edge(entry)),
            choices: ColumnCodes::new(|entry, ends| choice_code(edge(entry), ends)),
            parts: ColumnCodes::new(|entry, ends| part_code(edge(entry), ends)),
        }
    }
}
