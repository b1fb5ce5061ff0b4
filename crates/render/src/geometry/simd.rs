//! Eight `f32` lanes for the intersection kernels: one portable form and one of AVX2 intrinsics.
//!
//! Both give the same bits: no fused multiply-add, and `min`/`max` return their second operand where one is not a
//! number, as the x86 instructions do.

#![allow(unsafe_code, reason = "intrinsics need `unsafe`, and so does the one call into a function compiled for AVX2")]

#[cfg(target_arch = "x86_64")]
use jaspe_noise::simd::Level;

/// Eight lanes and what the kernels do with them.
pub(crate) trait Simd: Copy {
    fn load(values: &[f32; 8]) -> Self;
    fn splat(value: f32) -> Self;
    fn store(self) -> [f32; 8];
    /// Lanes that hold bits and no numbers: for [`Simd::select`] and [`Simd::same_bits`].
    fn load_bits(bits: &[u32; 8]) -> Self;
    fn store_bits(self) -> [u32; 8];
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    fn min(self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
    fn sqrt(self) -> Self;
    /// `self` with the sign of `sign`.
    fn copysign(self, sign: Self) -> Self;
    /// Bit i is set where lane i of `self` is less than or equal to that of `other`; false for NaN.
    fn le(self, other: Self) -> u32;
    /// Bit i is set where lane i of `self` is less than that of `other`; false for NaN.
    fn lt(self, other: Self) -> u32;
    /// Lane i of `yes` where bit i of the comparison `self < limit` holds, else of `no`.
    fn select_lt(self, limit: Self, yes: Self, no: Self) -> Self;
    /// Lane i of `yes` where bit i of `mask` is set, else of `no`.
    fn select(mask: u32, yes: Self, no: Self) -> Self;
    /// Bit i is set where lane i of `self` has the bits of that of `other`.
    fn same_bits(self, other: Self) -> u32;
    /// The smallest lane.
    fn least(self) -> f32;
    /// The largest lane.
    fn most(self) -> f32;
}

/// Work that is compiled once for each form of [`Simd`]. Its `run` must be `#[inline(always)]`, and so must all that
/// it calls: what stays a function of its own is compiled without AVX2, and calls every intrinsic out of line.
pub(crate) trait Kernel {
    type Output;
    fn run<S: Simd>(self) -> Self::Output;
}

/// Runs a kernel in the widest form that the processor has.
pub(crate) fn run<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    match level() {
        // SAFETY: the processor was asked for AVX-512, and has AVX2 with it.
        Level::Avx512 => return unsafe { run_avx512(kernel) },
        // SAFETY: the processor was asked for AVX2.
        Level::Avx2 => return unsafe { run_avx2(kernel) },
        _ => {}
    }
    kernel.run::<Portable>()
}

/// The same eight lanes with the instructions of AVX-512: loops that the compiler vectorises become twice as wide, and
/// there are twice as many registers.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512bw,avx512dq,avx2,bmi1,lzcnt,popcnt")]
fn run_avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx2>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
fn run_avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx2>()
}

/// Plain arrays: compiled with whatever the target has at least (SSE2, NEON).
#[derive(Clone, Copy)]
pub(crate) struct Portable([f32; 8]);

impl Portable {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Portable(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }

    #[inline(always)]
    fn mask(self, other: Self, f: impl Fn(f32, f32) -> bool) -> u32 {
        (0..8).fold(0, |mask, i| mask | (u32::from(f(self.0[i], other.0[i])) << i))
    }
}

impl Simd for Portable {
    #[inline(always)]
    fn load(values: &[f32; 8]) -> Self {
        Portable(*values)
    }
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Portable([value; 8])
    }
    #[inline(always)]
    fn store(self) -> [f32; 8] {
        self.0
    }
    #[inline(always)]
    fn load_bits(bits: &[u32; 8]) -> Self {
        Portable(bits.map(f32::from_bits))
    }
    #[inline(always)]
    fn store_bits(self) -> [u32; 8] {
        self.0.map(f32::to_bits)
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Portable(self.0.map(f32::sqrt))
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        self.zip(sign, f32::copysign)
    }
    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        self.mask(other, |a, b| a <= b)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        self.mask(other, |a, b| a < b)
    }
    #[inline(always)]
    fn select_lt(self, limit: Self, yes: Self, no: Self) -> Self {
        Portable(std::array::from_fn(|i| if self.0[i] < limit.0[i] { yes.0[i] } else { no.0[i] }))
    }
    #[inline(always)]
    fn select(mask: u32, yes: Self, no: Self) -> Self {
        Portable(std::array::from_fn(|i| if mask >> i & 1 != 0 { yes.0[i] } else { no.0[i] }))
    }
    #[inline(always)]
    fn same_bits(self, other: Self) -> u32 {
        self.mask(other, |a, b| a.to_bits() == b.to_bits())
    }
    #[inline(always)]
    fn least(self) -> f32 {
        self.0.into_iter().fold(f32::INFINITY, f32::min)
    }
    #[inline(always)]
    fn most(self) -> f32 {
        self.0.into_iter().fold(f32::NEG_INFINITY, f32::max)
    }
}

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2;

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::*;

    use super::Simd;

    /// One 256-bit register. Only code reached through [`super::run`] may make one.
    #[derive(Clone, Copy)]
    pub(crate) struct Avx2(__m256);

    // SAFETY (of every block below): the type is only used inside functions compiled for AVX2, which are entered
    // after the processor was asked for it.
    impl Simd for Avx2 {
        #[inline(always)]
        fn load(values: &[f32; 8]) -> Self {
            Avx2(unsafe { _mm256_loadu_ps(values.as_ptr()) })
        }
        #[inline(always)]
        fn splat(value: f32) -> Self {
            Avx2(unsafe { _mm256_set1_ps(value) })
        }
        #[inline(always)]
        fn store(self) -> [f32; 8] {
            let mut out = [0.0; 8];
            unsafe { _mm256_storeu_ps(out.as_mut_ptr(), self.0) };
            out
        }
        #[inline(always)]
        fn load_bits(bits: &[u32; 8]) -> Self {
            Avx2(unsafe { _mm256_loadu_ps(bits.as_ptr().cast()) })
        }
        #[inline(always)]
        fn store_bits(self) -> [u32; 8] {
            let mut out = [0; 8];
            unsafe { _mm256_storeu_ps(out.as_mut_ptr().cast(), self.0) };
            out
        }
        #[inline(always)]
        fn add(self, other: Self) -> Self {
            Avx2(unsafe { _mm256_add_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            Avx2(unsafe { _mm256_sub_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            Avx2(unsafe { _mm256_mul_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn div(self, other: Self) -> Self {
            Avx2(unsafe { _mm256_div_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn min(self, other: Self) -> Self {
            Avx2(unsafe { _mm256_min_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn max(self, other: Self) -> Self {
            Avx2(unsafe { _mm256_max_ps(self.0, other.0) })
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            Avx2(unsafe { _mm256_sqrt_ps(self.0) })
        }
        #[inline(always)]
        fn copysign(self, sign: Self) -> Self {
            unsafe {
                let bit = _mm256_set1_ps(-0.0);
                Avx2(_mm256_or_ps(_mm256_andnot_ps(bit, self.0), _mm256_and_ps(bit, sign.0)))
            }
        }
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
        fn same_bits(self, other: Self) -> u32 {
            unsafe {
                let same = _mm256_cmpeq_epi32(_mm256_castps_si256(self.0), _mm256_castps_si256(other.0));
                _mm256_movemask_ps(_mm256_castsi256_ps(same)) as u32
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
    }
}

/// What the kernels may use: the processor has it with all that comes with it, and `JASPE_SIMD` does not forbid it.
#[cfg(target_arch = "x86_64")]
fn level() -> Level {
    use std::sync::OnceLock;
    static LEVEL: OnceLock<Level> = OnceLock::new();
    *LEVEL.get_or_init(|| {
        let companions =
            is_x86_feature_detected!("bmi1") && is_x86_feature_detected!("lzcnt") && is_x86_feature_detected!("popcnt");
        let wide = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("avx512dq");
        match jaspe_noise::simd::level() {
            Level::Avx512 if companions && wide => Level::Avx512,
            Level::Avx512 | Level::Avx2 if companions => Level::Avx2,
            _ => Level::Scalar,
        }
    })
}

/// Three times eight lanes.
#[derive(Clone, Copy)]
pub(crate) struct Vec3x8<S> {
    pub x: S,
    pub y: S,
    pub z: S,
}

impl<S: Simd> Vec3x8<S> {
    #[inline(always)]
    pub fn splat(v: glam::Vec3) -> Self {
        Vec3x8 { x: S::splat(v.x), y: S::splat(v.y), z: S::splat(v.z) }
    }
    #[inline(always)]
    pub fn load(v: &[[f32; 8]; 3]) -> Self {
        Vec3x8 { x: S::load(&v[0]), y: S::load(&v[1]), z: S::load(&v[2]) }
    }
    #[inline(always)]
    pub fn add(self, o: Self) -> Self {
        Vec3x8 { x: self.x.add(o.x), y: self.y.add(o.y), z: self.z.add(o.z) }
    }
    #[inline(always)]
    pub fn sub(self, o: Self) -> Self {
        Vec3x8 { x: self.x.sub(o.x), y: self.y.sub(o.y), z: self.z.sub(o.z) }
    }
    /// Component by component.
    #[inline(always)]
    pub fn mul(self, o: Self) -> Self {
        Vec3x8 { x: self.x.mul(o.x), y: self.y.mul(o.y), z: self.z.mul(o.z) }
    }
    #[inline(always)]
    pub fn scale(self, s: S) -> Self {
        Vec3x8 { x: self.x.mul(s), y: self.y.mul(s), z: self.z.mul(s) }
    }
    #[inline(always)]
    pub fn dot(self, o: Self) -> S {
        self.x.mul(o.x).add(self.y.mul(o.y)).add(self.z.mul(o.z))
    }
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        Vec3x8 {
            x: self.y.mul(o.z).sub(self.z.mul(o.y)),
            y: self.z.mul(o.x).sub(self.x.mul(o.z)),
            z: self.x.mul(o.y).sub(self.y.mul(o.x)),
        }
    }
}
