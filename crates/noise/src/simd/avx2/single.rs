//! Improved noise at one point: an octave's eight corners in the lanes of one vector, and two octaves side by side where they are blended.
//!
//! A call overlaps with the next ones as far as the machine has room for what waits. Hence little waits for the hash of a cell, which is
//! worked out with integers, and constants are read where they are used: each one in a register would take room.

use std::arch::asm;
use std::arch::x86_64::*;

use super::{F32x8, corners};
use crate::basis::Tables;
use crate::basis::corners::{lerp, quintic};
use crate::noise::Noise;
use crate::number::Real;
use crate::simd::sse::F32x4;
use crate::simd::{Lanes, Vector};
use crate::sum::Sum;
use crate::table::CornerTables;

/// The noise at a point. (The coordinates come one by one, in registers: reading them as a vector, just after they were
/// written one by one, would stall.)
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn improved(of: &Noise, x: f32, y: f32, z: f32) -> f32 {
    let point = point(x, y, z);
    noise(&of.tables().corners, point, point.cells()).first_lanes()[0]
}

/// Any noise at a point in space, one number at a time: what rounds down, say, is an instruction here and a call on older machines.
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn in_space(of: &Noise, x: f32, y: f32, z: f32) -> f32 {
    of.value_in_space(x, y, z)
}

/// [`in_space`] in the plane.
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn in_plane(of: &Noise, x: f32, y: f32, z: f32) -> f32 {
    of.value_in_plane(x, y, z)
}

/// The sum at a point.
#[target_feature(enable = "avx2,fma")]
pub(in crate::simd) fn sum(of: &Sum, x: f32, y: f32, z: f32) -> f32 {
    add_octaves(0.0, of.noise().tables(), of.lanes(), x, y, z)
}

/// The sum and some octaves at a point, two at a time. (A sum that began with 0 is never −0.)
#[target_feature(enable = "avx2,fma")]
fn add_octaves(mut sum: f32, tables: &Tables, octaves: &[Lanes], x: f32, y: f32, z: f32) -> f32 {
    let Some((lanes, others)) = octaves.split_first() else { return sum };
    let point = point(x, y, z);
    let twice = F32x8::from_register(_mm256_set_m128(point.register(), point.register()));
    // (No loop: before one, the compiler would put constants into registers.)
    macro_rules! from_pair {
        ($pair:literal) => {
            let (frequencies, amplitudes) = (&lanes.frequencies_of_pairs[$pair], &lanes.amplitudes_of_pairs[$pair]);
            if lanes.count == 2 * $pair + 1 {
                sum = add::<F32x4, 1>(sum, &tables.corners, point, [frequencies, amplitudes], &lanes.mask);
            } else if lanes.count > 2 * $pair + 1 {
                sum = add::<F32x8, 2>(sum, &tables.corners, twice, [frequencies, amplitudes], &lanes.mask);
            }
        };
    }
    from_pair!(0);
    from_pair!(1);
    from_pair!(2);
    from_pair!(3);
    if others.is_empty() { sum } else { add_others(sum, tables, others, x, y, z) }
}

/// Octaves after the first eight. (Apart: few sums have them.)
#[inline(never)]
#[target_feature(enable = "avx2,fma")]
fn add_others(sum: f32, tables: &Tables, octaves: &[Lanes], x: f32, y: f32, z: f32) -> f32 {
    add_octaves(sum, tables, octaves, x, y, z)
}

/// The sum and as many octaves as there is room for, one after the other.
#[inline(always)]
fn add<V: Octaves<N>, const N: usize>(
    mut sum: f32,
    tables: &CornerTables,
    point: V,
    [frequencies, amplitudes]: [&[f32; 8]; 2],
    mask: &[u32; 8],
) -> f32 {
    let position = point * V::first(frequencies);
    let parts = noise(tables, position, position.cells()).masked(mask) * V::first(amplitudes);
    for part in parts.first_lanes() {
        sum += part;
    }
    sum
}

/// A point's coordinates along z, y, x, so that what is blended last comes first.
#[inline]
#[target_feature(enable = "avx2")]
pub(in crate::simd) fn point(x: f32, y: f32, z: f32) -> F32x4 {
    F32x4::from_register(_mm_setr_ps(z, y, x, 0.0))
}

/// A cell's [`corners::column`], and the lowest byte of its z.
#[derive(Clone, Copy)]
pub(in crate::simd) struct Cell {
    pub column: u32,
    pub z: u8,
}

/// The octaves' noises, in their first lanes, at positions whose cells are known. (Cell and offset are found apart: everything else
/// waits for the cell.)
#[inline(always)]
pub(in crate::simd) fn noise<V: Octaves<N>, const N: usize>(tables: &CornerTables, position: V, cells: [Cell; N]) -> V {
    let mut codes = [0; N];
    for i in 0..N {
        // SAFETY: the column is that of a cell.
        codes[i] = unsafe { corners::hash(tables, &tables.parts, cells[i].column, cells[i].z) };
    }
    let offset = position - position.floor();
    let [left, right] = offset.corners(codes);
    let curve = curve(offset, |numbers| V::first(numbers.first_chunk().expect("eight of sixteen")));
    let sides = lerp(curve.shuffled::<0b10_10_10_10>(), left, right);
    let edges = lerp(curve.shuffled::<0b01_01_01_01>(), sides, sides.shuffled::<0b11_10_11_10>());
    lerp(curve, edges, edges.shuffled::<0b01_01_01_01>())
}

/// The curve at each lane, with its coefficients from memory.
#[inline(always)]
pub(in crate::simd) fn curve<R: Real>(offset: R, load: impl Fn(&'static [f32; 16]) -> R) -> R {
    let constants = constants();
    quintic(offset, [load(&constants.six), load(&constants.fifteen), load(&constants.ten)])
}

/// What is read as whole vectors.
#[repr(C, align(64))]
struct Constants {
    signs: [f32; 8],
    ends: [f32; 8],
    x_and_y: [i32; 8],
    z_and_y: [i32; 8],
    six: [f32; 16],
    fifteen: [f32; 16],
    ten: [f32; 16],
}

static CONSTANTS: Constants = Constants {
    signs: [0.0, 0.0, 0.0, 0.0, -0.0, -0.0, -0.0, -0.0],
    ends: [0.0, -1.0, 0.0, -1.0, 0.0, 1.0, 0.0, 1.0],
    x_and_y: [2, 2, 1, 1, 2, 2, 1, 1],
    z_and_y: [0, 0, 1, 1, 0, 0, 1, 1],
    six: [6.0; 16],
    fifteen: [15.0; 16],
    ten: [10.0; 16],
};

/// The constants. (If the compiler knew them, it would put them into registers first.)
#[inline(always)]
fn constants() -> &'static Constants {
    let mut constants: *const Constants = &CONSTANTS;
    // SAFETY: this is no instruction, and the pointer stays what it is.
    unsafe {
        asm!("/* {0} */", inout(reg) constants, options(readonly, nostack, preserves_flags));
        &*constants
    }
}

/// Octaves side by side, four lanes each: coordinates along z, y, x, or corners.
pub(in crate::simd) trait Octaves<const N: usize>: Real {
    /// From the first numbers.
    fn first(numbers: &[f32; 8]) -> Self;
    /// Of the lanes, the bits of a mask.
    fn masked(self, mask: &[u32; 8]) -> Self;
    /// The cells of positions.
    fn cells(self) -> [Cell; N];
    /// What the corners of cells at the lower and at the upper end along x add, from the offset in the cell. In each octave: at
    /// the ends (0, 0), (0, 1), (1, 0), (1, 1) along y and z.
    fn corners(self, codes: [u64; N]) -> [Self; 2];
    /// The lanes of each octave in another order, two bits for each, as in the instruction.
    fn shuffled<const ORDER: i32>(self) -> Self;
    /// The first lane of each octave.
    fn first_lanes(self) -> [f32; N];
}

// SAFETY, for all `unsafe` blocks of the two: values of these types arise only in functions entered after the machine was found
// to have AVX2.
impl Octaves<1> for F32x4 {
    #[inline(always)]
    fn first(numbers: &[f32; 8]) -> Self {
        F32x4::load(numbers.first_chunk().expect("four of eight"))
    }
    #[inline(always)]
    fn masked(self, mask: &[u32; 8]) -> Self {
        let mut register = self.register();
        // SAFETY: the mask is longer. (The compiler would rather do this to one lane, with integers.)
        unsafe {
            asm!("vandps {0}, {0}, xmmword ptr [{1}]", inout(xmm_reg) register, in(reg) mask.as_ptr(), options(pure, readonly, nostack, preserves_flags));
        }
        F32x4::from_register(register)
    }
    #[inline(always)]
    fn cells(self) -> [Cell; 1] {
        unsafe { [cell(_mm_cvttps_epi32(self.floor().register()))] }
    }
    #[inline(always)]
    fn corners(self, [codes]: [u64; 1]) -> [Self; 2] {
        unsafe {
            let corners = corners(codes, _mm256_set_m128(self.register(), self.register()));
            let (left, right) = (_mm256_castps256_ps128(corners), _mm256_extractf128_ps::<1>(corners));
            [F32x4::from_register(left), F32x4::from_register(right)]
        }
    }
    #[inline(always)]
    fn shuffled<const ORDER: i32>(self) -> Self {
        F32x4::from_register(unsafe { _mm_permute_ps::<ORDER>(self.register()) })
    }
    #[inline(always)]
    fn first_lanes(self) -> [f32; 1] {
        unsafe { [_mm_cvtss_f32(self.register())] }
    }
}

impl Octaves<2> for F32x8 {
    #[inline(always)]
    fn first(numbers: &[f32; 8]) -> Self {
        F32x8::load(numbers)
    }
    #[inline(always)]
    fn masked(self, mask: &[u32; 8]) -> Self {
        F32x8(unsafe { _mm256_and_ps(self.0, _mm256_loadu_ps(mask.as_ptr().cast())) })
    }
    #[inline(always)]
    fn cells(self) -> [Cell; 2] {
        unsafe {
            let cells = _mm256_cvttps_epi32(_mm256_floor_ps(self.0));
            [cell(_mm256_castsi256_si128(cells)), cell(_mm256_extracti128_si256::<1>(cells))]
        }
    }
    #[inline(always)]
    fn corners(self, codes: [u64; 2]) -> [Self; 2] {
        unsafe {
            let first = corners(codes[0], _mm256_permute2f128_ps::<0x00>(self.0, self.0));
            let second = corners(codes[1], _mm256_permute2f128_ps::<0x11>(self.0, self.0));
            let left = _mm256_permute2f128_ps::<0x20>(first, second);
            [F32x8(left), F32x8(_mm256_permute2f128_ps::<0x31>(first, second))]
        }
    }
    #[inline(always)]
    fn shuffled<const ORDER: i32>(self) -> Self {
        F32x8(unsafe { _mm256_permute_ps::<ORDER>(self.0) })
    }
    #[inline(always)]
    fn first_lanes(self) -> [f32; 2] {
        unsafe { [_mm256_cvtss_f32(self.0), _mm_cvtss_f32(_mm256_extractf128_ps::<1>(self.0))] }
    }
}

/// The cell with these coordinates along z, y, x.
#[inline]
#[target_feature(enable = "avx2")]
fn cell(coordinates: __m128i) -> Cell {
    let lowest = _mm_setr_epi8(4, 8, 0, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1);
    let mut bytes = _mm_cvtsi128_si32(_mm_shuffle_epi8(coordinates, lowest)) as u32;
    // SAFETY: this is no instruction. (The compiler would rather work on with them in vectors, which is slower.)
    unsafe { asm!("/* {0:e} */", inout(reg) bytes, options(pure, nomem, nostack, preserves_flags)) };
    // 256 x + y, and x once more.
    const { assert!(CornerTables::ROW == 257) };
    let (x_and_y, z) = (bytes & 0xffff, bytes >> 16);
    Cell { column: x_and_y + (x_and_y >> 8), z: z as u8 }
}

/// What the corners of an octave's cell add: each one of eight numbers, offsets along x and y, and one of eight others, along z and y. (None of
/// them is −0, and so the noise is not.)
#[inline]
#[target_feature(enable = "avx2")]
fn corners(codes: u64, offset_twice: __m256) -> __m256 {
    let constants = constants();
    let (offset, ends) = (_mm256_xor_ps(offset_twice, load(&constants.signs)), load(&constants.ends));
    let x_and_y = _mm256_add_ps(_mm256_permutevar_ps(offset, load_order(&constants.x_and_y)), ends);
    let z_and_y = _mm256_add_ps(_mm256_permutevar_ps(offset, load_order(&constants.z_and_y)), ends);
    let first = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(codes as i64));
    let second = _mm256_srli_epi32::<4>(first);
    _mm256_add_ps(_mm256_permutevar8x32_ps(x_and_y, first), _mm256_permutevar8x32_ps(z_and_y, second))
}

#[inline]
#[target_feature(enable = "avx2")]
fn load(numbers: &[f32; 8]) -> __m256 {
    // SAFETY: there are eight.
    unsafe { _mm256_loadu_ps(numbers.as_ptr()) }
}

#[inline]
#[target_feature(enable = "avx2")]
fn load_order(order: &[i32; 8]) -> __m256i {
    // SAFETY: there are eight.
    unsafe { _mm256_loadu_si256(order.as_ptr().cast()) }
}
