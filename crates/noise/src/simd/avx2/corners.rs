//! Hashing the corners of cells one cell at a time, by reads from tables: gathers are slower.

use std::arch::x86_64::*;
use std::ops::BitOr;

use crate::table::{ColumnCodes, CornerTables};

/// The columns of eight cells, for [`hash`].
#[inline]
#[target_feature(enable = "avx2")]
pub(super) fn columns(x: __m256i, y: __m256i) -> __m256i {
    const { assert!(CornerTables::ROW == 257) };
    let byte = _mm256_set1_epi32(255);
    let (x, y) = (_mm256_and_si256(x, byte), _mm256_and_si256(y, byte));
    _mm256_add_epi32(_mm256_add_epi32(_mm256_slli_epi32::<8>(x), x), y)
}

/// The column of one cell, for [`hash`].
#[inline(always)]
pub(in crate::simd) fn column(x: u8, y: u8) -> u32 {
    u32::from(x) * CornerTables::ROW as u32 + u32::from(y)
}

/// Codes of a cell's corners, an eighth of the bits each: from the lowest on (0, 0, 0), (0, 0, 1), (0, 1, 0), … (1, 1, 1).
///
/// # Safety
/// The column is one that [`columns`] or `column` returned.
#[inline(always)]
pub(super) unsafe fn hash<T: Copy + BitOr<Output = T>>(
    tables: &CornerTables,
    codes: &ColumnCodes<T>,
    column: u32,
    z: u8,
) -> T {
    // Two columns with one read: reads are what there is most of.
    // SAFETY: x and y are at most 255, and there are entries for 256.
    let (left, right) = unsafe {
        let columns = tables.columns.as_ptr().add(column as usize);
        (columns.cast::<u16>().read_unaligned(), columns.add(CornerTables::ROW).cast::<u16>().read_unaligned())
    };
    // The codes from z on: the compiler sees that bytes are within, and adds no index twice.
    let codes: &[T; 1792] = codes.0[usize::from(z)..].first_chunk().expect("z is below 256");
    codes[usize::from(left as u8)]
        | codes[512 + usize::from(left >> 8)]
        | codes[1024 + usize::from(right as u8)]
        | codes[1536 + usize::from(right >> 8)]
}
