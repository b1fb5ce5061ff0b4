//! Points as most programs hold them, x y z x y z …, taken apart into the columns that the kernels read.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

use super::{Level, level, machine_level};

/// Takes points apart: each of `columns` gets one coordinate of all of them. Do it some hundred points at a time, just
/// before they are used: then nothing goes through memory twice.
///
/// # Panics
/// When a column is not as long as there are points.
pub fn deinterleave(points: &[[f32; 3]], columns: [&mut [f32]; 3]) {
    deinterleave_at(level(), points, columns);
}

/// [`deinterleave`] with the instructions of a level, at most those of the machine. For tests and measurements.
///
/// # Panics
/// When a column is not as long as there are points.
pub fn deinterleave_at(level: Level, points: &[[f32; 3]], mut columns: [&mut [f32]; 3]) {
    super::assert_lengths(&columns, points.len());
    let done = blockwise(level.min(machine_level()), points, columns.each_mut().map(|column| &mut **column));
    for (i, point) in points.iter().enumerate().skip(done) {
        for (column, &coordinate) in columns.iter_mut().zip(point) {
            column[i] = coordinate;
        }
    }
}

/// With vectors, as many points as fill them; returns how many.
#[cfg(target_arch = "x86_64")]
fn blockwise(level: Level, points: &[[f32; 3]], columns: [&mut [f32]; 3]) -> usize {
    match level {
        Level::Scalar => 0,
        // SAFETY, for the three: the machine has the instructions, its level says.
        Level::Sse => unsafe { sse(points, columns) },
        Level::Avx2 => unsafe { avx2(points, columns) },
        Level::Avx512 => unsafe { avx512(points, columns) },
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn blockwise(_: Level, _: &[[f32; 3]], _: [&mut [f32]; 3]) -> usize {
    0
}

/// Blocks of `N` points, which are three vectors, and their places in the columns. The rest is left; returns where it begins.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn blocks<const N: usize>(
    points: &[[f32; 3]],
    [x, y, z]: [&mut [f32]; 3],
    each: impl Fn(&[[f32; N]; 3], [&mut [f32; N]; 3]),
) -> usize {
    let numbers = points.as_flattened().as_chunks::<N>().0.as_chunks::<3>().0;
    let (x, y, z) = (x.as_chunks_mut::<N>().0, y.as_chunks_mut::<N>().0, z.as_chunks_mut::<N>().0);
    for (((numbers, x), y), z) in numbers.iter().zip(x).zip(y).zip(z) {
        each(numbers, [x, y, z]);
    }
    numbers.len() * N
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "sse4.1")]
fn sse(points: &[[f32; 3]], columns: [&mut [f32]; 3]) -> usize {
    blocks(points, columns, four)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn avx2(points: &[[f32; 3]], columns: [&mut [f32]; 3]) -> usize {
    blocks(points, columns, eight)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn avx512(points: &[[f32; 3]], columns: [&mut [f32]; 3]) -> usize {
    blocks(points, columns, sixteen)
}

// SAFETY, for the three below: they are inlined into code for machines that have the instructions, and the arrays have as many
// numbers as the vectors.

/// Four points: of x0 y0 z0 x1 and so on, pairs that stand as they are wanted are brought together first.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn four([a, b, c]: &[[f32; 4]; 3], [x, y, z]: [&mut [f32; 4]; 3]) {
    unsafe {
        let (a, b, c) = (_mm_loadu_ps(a.as_ptr()), _mm_loadu_ps(b.as_ptr()), _mm_loadu_ps(c.as_ptr()));
        // x2 y2 x3 y3, and y0 z0 y1 z1.
        let late = _mm_shuffle_ps::<0b10_01_11_10>(b, c);
        let early = _mm_shuffle_ps::<0b01_00_10_01>(a, b);
        _mm_storeu_ps(x.as_mut_ptr(), _mm_shuffle_ps::<0b10_00_11_00>(a, late));
        _mm_storeu_ps(y.as_mut_ptr(), _mm_shuffle_ps::<0b11_01_10_00>(early, late));
        _mm_storeu_ps(z.as_mut_ptr(), _mm_shuffle_ps::<0b11_00_11_01>(early, c));
    }
}

/// The same with the points 0 to 3 in one half of the vectors and 4 to 7 in the other.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(super) fn eight(numbers: &[[f32; 8]; 3], [x, y, z]: [&mut [f32; 8]; 3]) {
    let fours = numbers.as_flattened().as_chunks::<4>().0;
    unsafe {
        let a = _mm256_loadu2_m128(fours[3].as_ptr(), fours[0].as_ptr());
        let b = _mm256_loadu2_m128(fours[4].as_ptr(), fours[1].as_ptr());
        let c = _mm256_loadu2_m128(fours[5].as_ptr(), fours[2].as_ptr());
        let late = _mm256_shuffle_ps::<0b10_01_11_10>(b, c);
        let early = _mm256_shuffle_ps::<0b01_00_10_01>(a, b);
        _mm256_storeu_ps(x.as_mut_ptr(), _mm256_shuffle_ps::<0b10_00_11_00>(a, late));
        _mm256_storeu_ps(y.as_mut_ptr(), _mm256_shuffle_ps::<0b11_01_10_00>(early, late));
        _mm256_storeu_ps(z.as_mut_ptr(), _mm256_shuffle_ps::<0b11_00_11_01>(early, c));
    }
}

/// Sixteen points: any of 48 numbers in any lane, by two permutations.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(super) fn sixteen([a, b, c]: &[[f32; 16]; 3], [x, y, z]: [&mut [f32; 16]; 3]) {
    // Where a coordinate of the points stands: among the first 32 numbers, or else among the last.
    const fn places(axis: usize) -> [[i32; 16]; 2] {
        let mut places = [[0; 16]; 2];
        let mut lane = 0;
        while lane < 16 {
            let place = 3 * lane + axis;
            places[0][lane] = (place % 32) as i32;
            // The second permutation chooses from the result of the first and the last sixteen.
            places[1][lane] = if place < 32 { lane } else { place - 16 } as i32;
            lane += 1;
        }
        places
    }
    const PLACES: [[[i32; 16]; 2]; 3] = [places(0), places(1), places(2)];
    unsafe {
        let (a, b, c) = (_mm512_loadu_ps(a.as_ptr()), _mm512_loadu_ps(b.as_ptr()), _mm512_loadu_ps(c.as_ptr()));
        for (axis, column) in [x, y, z].into_iter().enumerate() {
            let [first, second] = &PLACES[axis];
            let (first, second) =
                (_mm512_loadu_si512(first.as_ptr().cast()), _mm512_loadu_si512(second.as_ptr().cast()));
            let found = _mm512_permutex2var_ps(_mm512_permutex2var_ps(a, first, b), second, c);
            _mm512_storeu_ps(column.as_mut_ptr(), found);
        }
    }
}
