//! Tables of 256 entries, laid out for the ways in which the number types read them.

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

/// Tables that hash the eight corners of a cell with seven reads, each entry with what stands after it, repeated so that
/// the sum of two bytes is an index.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CornerTables {
    /// The permutation: an entry in the low byte, the next one in the high byte.
    pairs: [u16; 512],
    /// The edge codes of the corners.
    pub edges: ColumnCodes,
    /// How their edges are chosen: see [`choice_code`].
    pub choices: ColumnCodes,
}

/// For the columns (x, y), (x, y + 1), (x + 1, y), (x + 1, y + 1), 512 entries each: the codes of an entry at the column's
/// lower end and of the next one at its upper end, four bits each, eight bits further up for each column.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ColumnCodes([u32; 2048]);

impl ColumnCodes {
    /// From the code of an entry at a corner, whose ends along x, y and z are 0 or 1.
    fn new(code: impl Fn(usize, [u32; 3]) -> u8) -> ColumnCodes {
        ColumnCodes(std::array::from_fn(|i| {
            let (entry, column) = (i % 256, i as u32 / 512);
            let [x, y] = [column >> 1, column & 1];
            let codes = code(entry, [x, y, 0]) | code((entry + 1) % 256, [x, y, 1]) << 4;
            u32::from(codes) << (8 * column)
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

impl CornerTables {
    /// From the permutation, and its edge codes as [`crate::basis::Tables`] has them.
    pub fn new(permutation: &PairTable, edges: &ByteTable) -> Self {
        let edge = |entry: usize| edges.bytes[entry] & 15;
        CornerTables {
            pairs: std::array::from_fn(|i| permutation.pairs[i % 256] as u16),
            edges: ColumnCodes::new(|entry, _| edge(entry)),
            choices: ColumnCodes::new(|entry, ends| choice_code(edge(entry), ends)),
        }
    }

    /// Codes of a cell's corners, four bits each: from the lowest on (0, 0, 0), (0, 0, 1), (0, 1, 0), … (1, 1, 1).
    #[inline(always)]
    pub fn hash(&self, codes: &ColumnCodes, [x, y, z]: [u8; 3]) -> u32 {
        // The tables from y on and from z on: the compiler sees that bytes are within, and adds no index twice.
        let pairs: &[u16; 256] = self.pairs[usize::from(y)..].first_chunk().expect("y is below 256");
        let codes: &[u32; 1792] = codes.0[usize::from(z)..].first_chunk().expect("z is below 256");
        let pair = self.pairs[usize::from(x)];
        let (left, right) = (pairs[usize::from(pair as u8)], pairs[usize::from(pair >> 8)]);
        codes[usize::from(left as u8)]
            | codes[512 + usize::from(left >> 8)]
            | codes[1024 + usize::from(right as u8)]
            | codes[1536 + usize::from(right >> 8)]
    }
}
