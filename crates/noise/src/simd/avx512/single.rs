//! The sum of improved noise at one point: the octaves in eight lanes, hashed by byte permutations.

use std::arch::x86_64::*;

use super::I32x16;
use crate::basis::Tables;
use crate::basis::improved::blend_codes;
use crate::number::{Integer, Real};
use crate::simd::avx2::{F32x8, I32x8};
use crate::simd::{Terms, Vector};

/// The sum at a point. Same bits as the generic evaluation.
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
pub(in crate::simd) fn sum(tables: &Tables, terms: &Terms, x: f32, y: f32, z: f32) -> f32 {
    let mut sum = 0.0;
    let mut rest = terms.octaves();
    for lanes in terms.lanes {
        let noises = octaves(tables, F32x8::load(&lanes.frequencies), [x, y, z]);
        let noises = if terms.absolute { noises.abs() } else { noises };
        let mut parts = [0.0; 8];
        (noises * F32x8::load(&lanes.amplitudes)).store(&mut parts);
        for part in &parts[..rest.min(8)] {
            sum += part;
        }
        rest = rest.saturating_sub(8);
    }
    sum
}

/// The noise at the point times each frequency.
#[inline]
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
fn octaves(tables: &Tables, frequencies: F32x8, point: [f32; 3]) -> F32x8 {
    let mut offset = [frequencies; 3];
    let mut cells = [I32x16(_mm512_setzero_si512()); 3];
    for axis in 0..3 {
        let position = F32x8::splat(point[axis]) * frequencies;
        let floor = position.floor();
        offset[axis] = position - floor;
        // (Eight lanes of sixteen: half registers hold half a table.)
        cells[axis] = I32x16(_mm512_castsi256_si512(floor.to_int().bits()));
    }
    let [x, y, z] = cells;
    let permutation = &tables.permutation;
    let (left, right) = (x.permuted(&permutation.bytes) + y, x.permuted(&permutation.next) + y);
    let columns = [
        left.permuted(&permutation.bytes),
        right.permuted(&permutation.bytes),
        left.permuted(&permutation.next),
        right.permuted(&permutation.next),
    ];
    let mut codes = [I32x8::constant(0); 16];
    for i in 0..4 {
        let column = (columns[i] + z).permuted(&tables.edges.bytes);
        codes[i] = I32x8::from_bits(_mm512_castsi512_si256(column.0));
        codes[i + 4] = codes[i].shift_right(4);
    }
    blend_codes::<F32x8, 3, false>(codes, offset).value + F32x8::constant(0.0)
}
