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
