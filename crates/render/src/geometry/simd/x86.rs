//! Lanes of intrinsics.

#![allow(unsafe_code, reason = "intrinsics need `unsafe`, and so do the calls into functions compiled for them")]

use std::arch::x86_64::*;

use super::{Kernel, Lanes, Simd};

// SAFETY (of every block of this file but the last two): the types are only used inside functions compiled for their
// instructions, which are entered after the processor was asked for them.

/// Runs a kernel compiled for AVX-512, which the processor must have ([`super::level`]).
pub(super) fn run_avx512<K: Kernel>(kernel: K) -> K::Output {
    #[target_feature(enable = "avx512f,avx512vl,avx512bw,avx512dq,avx2,bmi1,lzcnt,popcnt")]
    fn run<K: Kernel>(kernel: K) -> K::Output {
        kernel.run::<Avx512>()
    }
    // SAFETY: the processor was asked.
    unsafe { run(kernel) }
}

/// Runs a kernel compiled for AVX2, which the processor must have ([`super::level`]).
pub(super) fn run_avx2<K: Kernel>(kernel: K) -> K::Output {
    #[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
    fn run<K: Kernel>(kernel: K) -> K::Output {
        kernel.run::<Avx2>()
    }
    // SAFETY: the processor was asked.
    unsafe { run(kernel) }
}

/// What is the same but for the names of the intrinsics.
macro_rules! arithmetic {
    ($count:literal, $loadu:ident, $storeu:ident, $set1:ident, $sqrt:ident,
     [$add:ident, $sub:ident, $mul:ident, $div:ident, $min:ident, $max:ident]) => {
        const COUNT: usize = $count;
        type Floats = [f32; $count];
        type Bits = [u32; $count];

        #[inline(always)]
        fn load(values: &[f32]) -> Self {
            let values: &[f32; $count] = values.first_chunk().expect("there are as many as lanes");
            Self(unsafe { $loadu(values.as_ptr()) })
        }
        #[inline(always)]
        fn splat(value: f32) -> Self {
            Self(unsafe { $set1(value) })
        }
        #[inline(always)]
        fn store(self) -> [f32; $count] {
            let mut out = [0.0; $count];
            unsafe { $storeu(out.as_mut_ptr(), self.0) };
            out
        }
        #[inline(always)]
        fn load_bits(bits: &[u32]) -> Self {
            let bits: &[u32; $count] = bits.first_chunk().expect("there are as many as lanes");
            Self(unsafe { $loadu(bits.as_ptr().cast()) })
        }
        #[inline(always)]
        fn store_bits(self) -> [u32; $count] {
            let mut out = [0; $count];
            unsafe { $storeu(out.as_mut_ptr().cast(), self.0) };
            out
        }
        #[inline(always)]
        fn add(self, other: Self) -> Self {
            Self(unsafe { $add(self.0, other.0) })
        }
        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            Self(unsafe { $sub(self.0, other.0) })
        }
        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            Self(unsafe { $mul(self.0, other.0) })
        }
        #[inline(always)]
        fn div(self, other: Self) -> Self {
            Self(unsafe { $div(self.0, other.0) })
        }
        #[inline(always)]
        fn min(self, other: Self) -> Self {
            Self(unsafe { $min(self.0, other.0) })
        }
        #[inline(always)]
        fn max(self, other: Self) -> Self {
            Self(unsafe { $max(self.0, other.0) })
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            Self(unsafe { $sqrt(self.0) })
        }
    };
}

/// Each of eight rows of eight lanes made one number, by an operation on two.
macro_rules! across {
    ($rows:expr, $both:ident) => {{
        // What is left of two rows in one, of four, and of eight.
        macro_rules! pair {
            ($x:expr, $y:expr, $low:literal, $high:literal) => {
                $both(_mm256_shuffle_ps::<$low>($x, $y), _mm256_shuffle_ps::<$high>($x, $y))
            };
        }
        let [a, b, c, d, e, f, g, h] = $rows;
        let (ab, cd) = (pair!(a, b, 0x44, 0xee), pair!(c, d, 0x44, 0xee));
        let (ef, gh) = (pair!(e, f, 0x44, 0xee), pair!(g, h, 0x44, 0xee));
        let (low, high) = (pair!(ab, cd, 0x88, 0xdd), pair!(ef, gh, 0x88, 0xdd));
        let all = $both(_mm256_permute2f128_ps::<0x20>(low, high), _mm256_permute2f128_ps::<0x31>(low, high));
        let mut out = [0.0; 8];
        _mm256_storeu_ps(out.as_mut_ptr(), all);
        out
    }};
}

macro_rules! arithmetic256 {
    () => {
        arithmetic!(
            8,
            _mm256_loadu_ps,
            _mm256_storeu_ps,
            _mm256_set1_ps,
            _mm256_sqrt_ps,
            [_mm256_add_ps, _mm256_sub_ps, _mm256_mul_ps, _mm256_div_ps, _mm256_min_ps, _mm256_max_ps]
        );

        #[inline(always)]
        fn lines(rows: [Self; 16]) -> [[f32; 16]; 16] {
            let mut lines = [[0.0; 16]; 16];
            for (half, rows) in rows.chunks_exact(8).enumerate() {
                // Four rows in each quarter of a register, then of eight.
                let mut fours = [rows[0].0; 8];
                for (i, four) in rows.chunks_exact(4).enumerate() {
                    let [a, b, c, d] = [four[0].0, four[1].0, four[2].0, four[3].0];
                    unsafe {
                        let (ab, cd) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
                        fours[4 * i] = _mm256_shuffle_ps::<0x44>(ab, cd);
                        fours[4 * i + 1] = _mm256_shuffle_ps::<0xee>(ab, cd);
                        let (ab, cd) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
                        fours[4 * i + 2] = _mm256_shuffle_ps::<0x44>(ab, cd);
                        fours[4 * i + 3] = _mm256_shuffle_ps::<0xee>(ab, cd);
                    }
                }
                for j in 0..4 {
                    let (a, b) = (fours[j], fours[4 + j]);
                    let (low, high) =
                        unsafe { (_mm256_permute2f128_ps::<0x20>(a, b), _mm256_permute2f128_ps::<0x31>(a, b)) };
                    lines[j][8 * half..][..8].copy_from_slice(&Self(low).store());
                    lines[4 + j][8 * half..][..8].copy_from_slice(&Self(high).store());
                }
            }
            lines
        }
        #[inline(always)]
        fn leasts([a, b, c, d, e, f, g, h]: [Self; 8]) -> [f32; 8] {
            unsafe { across!([a.0, b.0, c.0, d.0, e.0, f.0, g.0, h.0], _mm256_min_ps) }
        }
        #[inline(always)]
        fn mosts([a, b, c, d, e, f, g, h]: [Self; 8]) -> [f32; 8] {
            unsafe { across!([a.0, b.0, c.0, d.0, e.0, f.0, g.0, h.0], _mm256_max_ps) }
        }
        #[inline(always)]
        fn copysign(self, sign: Self) -> Self {
            unsafe {
                let bit = _mm256_set1_ps(-0.0);
                Self(_mm256_or_ps(_mm256_andnot_ps(bit, self.0), _mm256_and_ps(bit, sign.0)))
            }
        }
        #[inline(always)]
        fn least(self) -> f32 {
            unsafe {
                let four = _mm_min_ps(_mm256_castps256_ps128(self.0), _mm256_extractf128_ps::<1>(self.0));
                let two = _mm_min_ps(four, _mm_movehl_ps(four, four));
                _mm_cvtss_f32(_mm_min_ss(two, _mm_movehdup_ps(two)))
            }
        }
        #[inline(always)]
        fn most(self) -> f32 {
            unsafe {
                let four = _mm_max_ps(_mm256_castps256_ps128(self.0), _mm256_extractf128_ps::<1>(self.0));
                let two = _mm_max_ps(four, _mm_movehl_ps(four, four));
                _mm_cvtss_f32(_mm_max_ss(two, _mm_movehdup_ps(two)))
            }
        }
    };
}

/// One 256-bit register.
#[derive(Clone, Copy)]
pub(crate) struct Avx2(__m256);

impl Lanes for Avx2 {
    arithmetic256!();

    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)) as u32 }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)) as u32 }
    }
    #[inline(always)]
    fn select_lt(self, limit: Self, yes: Self, no: Self) -> Self {
        unsafe { Avx2(_mm256_blendv_ps(no.0, yes.0, _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, limit.0))) }
    }
    #[inline(always)]
    fn select(mask: u32, yes: Self, no: Self) -> Self {
        unsafe {
            let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            let set = _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(mask as i32), bits), bits);
            Avx2(_mm256_blendv_ps(no.0, yes.0, _mm256_castsi256_ps(set)))
        }
    }
    #[inline(always)]
    fn compress(self, mask: u32) -> Self {
        unsafe {
            let packed = _mm256_loadu_si256(PACKED[mask as usize & 255].as_ptr().cast());
            Avx2(_mm256_permutevar8x32_ps(self.0, packed))
        }
    }
    #[inline(always)]
    fn same_bits(self, other: Self) -> u32 {
        unsafe {
            let same = _mm256_cmpeq_epi32(_mm256_castps_si256(self.0), _mm256_castps_si256(other.0));
            _mm256_movemask_ps(_mm256_castsi256_ps(same)) as u32
        }
    }
}

/// Five lines of the cache.
#[inline(always)]
fn prefetch_lines(address: *const u8) {
    // SAFETY: nothing is read.
    unsafe {
        _mm_prefetch::<_MM_HINT_T0>(address.cast());
        _mm_prefetch::<_MM_HINT_T0>(address.wrapping_add(64).cast());
        _mm_prefetch::<_MM_HINT_T0>(address.wrapping_add(128).cast());
        _mm_prefetch::<_MM_HINT_T0>(address.wrapping_add(192).cast());
        _mm_prefetch::<_MM_HINT_T0>(address.wrapping_add(256).cast());
    }
}

/// For each mask the lanes that are in it, one after the other.
static PACKED: [[u32; 8]; 256] = {
    let mut all = [[0; 8]; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut count, mut lane) = (0, 0);
        while lane < 8 {
            if mask >> lane & 1 == 1 {
                all[mask][count] = lane as u32;
                count += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    all
};

impl Simd for Avx2 {
    type Wide = Avx2;

    #[inline(always)]
    fn pack(
        self,
        limit: Self,
        order: &[u32; 8],
        shift: u32,
        codes: &[u32; 8],
        values: &mut [f32; 8],
        out: &mut [u32; 8],
    ) -> usize {
        unsafe {
            let order = _mm256_loadu_si256(order.as_ptr().cast());
            let order = _mm256_srl_epi32(order, _mm_cvtsi32_si128(shift as i32));
            let within = _mm256_cmp_ps::<_CMP_LE_OQ>(self.0, limit.0);
            let mask = _mm256_movemask_ps(_mm256_permutevar8x32_ps(within, order)) as u32;
            let packed = _mm256_loadu_si256(PACKED[mask as usize & 255].as_ptr().cast());
            let order = _mm256_permutevar8x32_epi32(order, packed);
            _mm256_storeu_ps(values.as_mut_ptr(), _mm256_permutevar8x32_ps(self.0, order));
            let codes = _mm256_loadu_si256(codes.as_ptr().cast());
            _mm256_storeu_si256(out.as_mut_ptr().cast(), _mm256_permutevar8x32_epi32(codes, order));
            mask.count_ones() as usize
        }
    }

    #[inline(always)]
    fn prefetch(address: *const u8) {
        prefetch_lines(address);
    }
}

/// One 256-bit register, with masks as AVX-512 has them.
#[derive(Clone, Copy)]
pub(crate) struct Avx512(__m256);

impl Lanes for Avx512 {
    arithmetic256!();

    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        unsafe { u32::from(_mm256_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        unsafe { u32::from(_mm256_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn select(mask: u32, yes: Self, no: Self) -> Self {
        Avx512(unsafe { _mm256_mask_blend_ps(mask as u8, no.0, yes.0) })
    }
    #[inline(always)]
    fn compress(self, mask: u32) -> Self {
        Avx512(unsafe { _mm256_maskz_compress_ps(mask as u8, self.0) })
    }
    #[inline(always)]
    fn same_bits(self, other: Self) -> u32 {
        unsafe { u32::from(_mm256_cmpeq_epi32_mask(_mm256_castps_si256(self.0), _mm256_castps_si256(other.0))) }
    }
}

impl Simd for Avx512 {
    type Wide = Wide;

    #[inline(always)]
    fn pack(
        self,
        limit: Self,
        order: &[u32; 8],
        shift: u32,
        codes: &[u32; 8],
        values: &mut [f32; 8],
        out: &mut [u32; 8],
    ) -> usize {
        unsafe {
            let order = _mm256_loadu_si256(order.as_ptr().cast());
            let order = _mm256_srl_epi32(order, _mm_cvtsi32_si128(shift as i32));
            let (entry, limit) = (_mm256_permutevar8x32_ps(self.0, order), _mm256_permutevar8x32_ps(limit.0, order));
            let mask = _mm256_cmp_ps_mask::<_CMP_LE_OQ>(entry, limit);
            let codes = _mm256_permutevar8x32_epi32(_mm256_loadu_si256(codes.as_ptr().cast()), order);
            _mm256_storeu_ps(values.as_mut_ptr(), _mm256_maskz_compress_ps(mask, entry));
            _mm256_storeu_si256(out.as_mut_ptr().cast(), _mm256_maskz_compress_epi32(mask, codes));
            mask.count_ones() as usize
        }
    }

    #[inline(always)]
    fn prefetch(address: *const u8) {
        prefetch_lines(address);
    }
}

/// One 512-bit register.
#[derive(Clone, Copy)]
pub(crate) struct Wide(__m512);

impl Wide {
    #[inline(always)]
    fn halves(self) -> [__m256; 2] {
        unsafe { [_mm512_castps512_ps256(self.0), _mm512_extractf32x8_ps::<1>(self.0)] }
    }
}

impl Lanes for Wide {
    arithmetic!(
        16,
        _mm512_loadu_ps,
        _mm512_storeu_ps,
        _mm512_set1_ps,
        _mm512_sqrt_ps,
        [_mm512_add_ps, _mm512_sub_ps, _mm512_mul_ps, _mm512_div_ps, _mm512_min_ps, _mm512_max_ps]
    );

    #[inline(always)]
    fn lines(rows: [Self; 16]) -> [[f32; 16]; 16] {
        // Four rows in each quarter of a register.
        let mut fours = [rows[0].0; 16];
        for (i, four) in rows.chunks_exact(4).enumerate() {
            let [a, b, c, d] = [four[0].0, four[1].0, four[2].0, four[3].0];
            unsafe {
                let (ab, cd) = (_mm512_unpacklo_ps(a, b), _mm512_unpacklo_ps(c, d));
                fours[4 * i] = _mm512_shuffle_ps::<0x44>(ab, cd);
                fours[4 * i + 1] = _mm512_shuffle_ps::<0xee>(ab, cd);
                let (ab, cd) = (_mm512_unpackhi_ps(a, b), _mm512_unpackhi_ps(c, d));
                fours[4 * i + 2] = _mm512_shuffle_ps::<0x44>(ab, cd);
                fours[4 * i + 3] = _mm512_shuffle_ps::<0xee>(ab, cd);
            }
        }
        let mut lines = [[0.0; 16]; 16];
        for j in 0..4 {
            let [a, b, c, d] = [fours[j], fours[4 + j], fours[8 + j], fours[12 + j]];
            unsafe {
                let (even, odd) = (_mm512_shuffle_f32x4::<0x88>(a, b), _mm512_shuffle_f32x4::<0xdd>(a, b));
                let (next_even, next_odd) = (_mm512_shuffle_f32x4::<0x88>(c, d), _mm512_shuffle_f32x4::<0xdd>(c, d));
                lines[j] = Wide(_mm512_shuffle_f32x4::<0x88>(even, next_even)).store();
                lines[4 + j] = Wide(_mm512_shuffle_f32x4::<0x88>(odd, next_odd)).store();
                lines[8 + j] = Wide(_mm512_shuffle_f32x4::<0xdd>(even, next_even)).store();
                lines[12 + j] = Wide(_mm512_shuffle_f32x4::<0xdd>(odd, next_odd)).store();
            }
        }
        lines
    }
    #[inline(always)]
    fn leasts(rows: [Self; 8]) -> [f32; 8] {
        unsafe {
            let mut lanes = [_mm256_setzero_ps(); 8];
            for i in 0..8 {
                let [low, high] = rows[i].halves();
                lanes[i] = _mm256_min_ps(low, high);
            }
            across!(lanes, _mm256_min_ps)
        }
    }
    #[inline(always)]
    fn mosts(rows: [Self; 8]) -> [f32; 8] {
        unsafe {
            let mut lanes = [_mm256_setzero_ps(); 8];
            for i in 0..8 {
                let [low, high] = rows[i].halves();
                lanes[i] = _mm256_max_ps(low, high);
            }
            across!(lanes, _mm256_max_ps)
        }
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        unsafe {
            let bit = _mm512_set1_ps(-0.0);
            Wide(_mm512_or_ps(_mm512_andnot_ps(bit, self.0), _mm512_and_ps(bit, sign.0)))
        }
    }
    #[inline(always)]
    fn least(self) -> f32 {
        unsafe { _mm512_reduce_min_ps(self.0) }
    }
    #[inline(always)]
    fn most(self) -> f32 {
        unsafe { _mm512_reduce_max_ps(self.0) }
    }
    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        unsafe { u32::from(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        unsafe { u32::from(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn select(mask: u32, yes: Self, no: Self) -> Self {
        Wide(unsafe { _mm512_mask_blend_ps(mask as u16, no.0, yes.0) })
    }
    #[inline(always)]
    fn compress(self, mask: u32) -> Self {
        Wide(unsafe { _mm512_maskz_compress_ps(mask as u16, self.0) })
    }
    #[inline(always)]
    fn same_bits(self, other: Self) -> u32 {
        unsafe { u32::from(_mm512_cmpeq_epi32_mask(_mm512_castps_si512(self.0), _mm512_castps_si512(other.0))) }
    }
}
