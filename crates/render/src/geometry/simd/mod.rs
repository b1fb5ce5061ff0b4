//! Lanes of `f32` for the intersection kernels: one portable form, and one each of AVX2 and AVX-512 intrinsics.
//!
//! All give the same bits: no fused multiply-add, and `min`/`max` return their second operand where one is not a
//! number, as the x86 instructions do.

mod portable;
#[cfg(target_arch = "x86_64")]
mod x86;

use jaspe_noise::simd::Level;

pub(crate) use portable::Portable;

/// Some lanes and what the kernels do with them.
pub(crate) trait Lanes: Copy {
    /// How many lanes there are: 8 or 16.
    const COUNT: usize;
    /// `[f32; COUNT]`.
    type Floats: Copy + AsRef<[f32]>;
    /// `[u32; COUNT]`.
    type Bits: Copy + AsRef<[u32]>;

    /// The first of the values, of which there must be enough.
    fn load(values: &[f32]) -> Self;
    fn splat(value: f32) -> Self;
    fn store(self) -> Self::Floats;
    /// Lanes that hold bits and no numbers: for [`Lanes::select`] and [`Lanes::same_bits`].
    fn load_bits(bits: &[u32]) -> Self;
    fn store_bits(self) -> Self::Bits;
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
    #[inline(always)]
    fn select_lt(self, limit: Self, yes: Self, no: Self) -> Self {
        Self::select(self.lt(limit), yes, no)
    }
    /// Lane i of `yes` where bit i of `mask` is set, else of `no`.
    fn select(mask: u32, yes: Self, no: Self) -> Self;
    /// What is in lane i of sixteen rows, as line i of the result; as many lines as there are lanes mean anything.
    fn lines(rows: [Self; 16]) -> [[f32; 16]; 16];
    /// The lanes of `mask`, one after the other from the first on; the others hold anything.
    fn compress(self, mask: u32) -> Self;
    /// Bit i is set where lane i of `self` has the bits of that of `other`.
    fn same_bits(self, other: Self) -> u32;
    /// Writes the lanes to the first of the values, of which there must be enough.
    #[inline(always)]
    fn write(self, values: &mut [f32]) {
        values[..Self::COUNT].copy_from_slice(self.store().as_ref());
    }
    /// The smallest lane of each of eight rows.
    fn leasts(rows: [Self; 8]) -> [f32; 8];
    /// The largest lane of each of eight rows.
    fn mosts(rows: [Self; 8]) -> [f32; 8];
    /// The smallest lane.
    fn least(self) -> f32;
    /// The largest lane.
    fn most(self) -> f32;

    /// The mask of all lanes.
    const ALL: u32 = (1 << Self::COUNT) - 1;
}

/// Eight lanes: those of a node or a block.
pub(crate) trait Simd: Lanes<Floats = [f32; 8], Bits = [u32; 8]> {
    /// As many lanes as the machine likes best, for packets of rays.
    type Wide: Lanes;

    /// Takes the lanes in the order of `order` (three bits each, from `shift` on), drops those that are not in the mask of
    /// `self <= limit`, and writes what is left: the lanes' values, and the `codes` of the same lanes. Returns how many
    /// those are; what lies behind them is overwritten by anything.
    fn pack(
        self,
        limit: Self,
        order: &[u32; 8],
        shift: u32,
        codes: &[u32; 8],
        values: &mut [f32; 8],
        out: &mut [u32; 8],
    ) -> usize;

    /// Asks for the 320 bytes from an address on, which need not be one.
    fn prefetch(address: *const u8);
}

/// Work that is compiled once for each form of [`Simd`]. Its `run` must be `#[inline(always)]`, and so must all that
/// it calls: what stays a function of its own is compiled without AVX2, and calls every intrinsic out of line.
///
/// No closure may handle lanes either: it is a function of its own, which is compiled without the instruction set and not
/// always inlined.
pub(crate) trait Kernel {
    type Output;
    fn run<S: Simd>(self) -> Self::Output;
}

/// Runs a kernel in the widest form that the processor has.
pub(crate) fn run<K: Kernel>(kernel: K) -> K::Output {
    run_at(level(), kernel)
}

/// Runs a kernel in one form, which must be none beyond [`level`].
pub(super) fn run_at<K: Kernel>(level: Level, kernel: K) -> K::Output {
    debug_assert!(level <= self::level());
    match level {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => x86::run_avx512(kernel),
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => x86::run_avx2(kernel),
        _ => kernel.run::<Portable>(),
    }
}

/// The forms that the processor has.
#[cfg(test)]
pub(super) fn levels() -> impl Iterator<Item = Level> {
    [Level::Scalar, Level::Avx2, Level::Avx512].into_iter().filter(|&form| form <= level())
}

/// What the kernels may use: the processor has it with all that comes with it, and `JASPE_SIMD` does not forbid it.
#[cfg(not(target_arch = "x86_64"))]
pub(super) fn level() -> Level {
    Level::Scalar
}

/// What the kernels may use: the processor has it with all that comes with it, and `JASPE_SIMD` does not forbid it.
#[cfg(target_arch = "x86_64")]
pub(super) fn level() -> Level {
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

/// Three coordinates in lanes.
#[derive(Clone, Copy)]
pub(crate) struct Vec3s<S> {
    pub x: S,
    pub y: S,
    pub z: S,
}

impl<S: Lanes> Vec3s<S> {
    #[inline(always)]
    pub fn splat(v: glam::Vec3) -> Self {
        Vec3s { x: S::splat(v.x), y: S::splat(v.y), z: S::splat(v.z) }
    }
    /// Three numbers, each in all lanes.
    #[inline(always)]
    pub fn of([x, y, z]: [f32; 3]) -> Self {
        Vec3s { x: S::splat(x), y: S::splat(y), z: S::splat(z) }
    }
    /// The components along these axes.
    #[inline(always)]
    pub fn turned(self, [i, j, k]: [usize; 3]) -> Self {
        let all = [self.x, self.y, self.z];
        Vec3s { x: all[i % 3], y: all[j % 3], z: all[k % 3] }
    }
    #[inline(always)]
    pub fn load(v: &[[f32; 8]; 3]) -> Self {
        Vec3s { x: S::load(&v[0]), y: S::load(&v[1]), z: S::load(&v[2]) }
    }
    /// Vectors of unit length, and others where that cannot be.
    #[inline(always)]
    pub fn unit_or(self, others: Self) -> Self {
        let scale = S::splat(1.0).div(self.dot(self).sqrt());
        let sane = S::splat(0.0).lt(scale) & scale.lt(S::splat(f32::INFINITY));
        Self::select(sane, self.scale(scale), others)
    }
    /// [`Lanes::select`] of each component.
    #[inline(always)]
    pub fn select(mask: u32, yes: Self, no: Self) -> Self {
        Vec3s { x: S::select(mask, yes.x, no.x), y: S::select(mask, yes.y, no.y), z: S::select(mask, yes.z, no.z) }
    }
    #[inline(always)]
    pub fn store(self) -> [S::Floats; 3] {
        [self.x.store(), self.y.store(), self.z.store()]
    }
    #[inline(always)]
    pub fn add(self, o: Self) -> Self {
        Vec3s { x: self.x.add(o.x), y: self.y.add(o.y), z: self.z.add(o.z) }
    }
    #[inline(always)]
    pub fn sub(self, o: Self) -> Self {
        Vec3s { x: self.x.sub(o.x), y: self.y.sub(o.y), z: self.z.sub(o.z) }
    }
    /// Component by component.
    #[inline(always)]
    pub fn mul(self, o: Self) -> Self {
        Vec3s { x: self.x.mul(o.x), y: self.y.mul(o.y), z: self.z.mul(o.z) }
    }
    /// Component by component.
    #[inline(always)]
    pub fn min(self, o: Self) -> Self {
        Vec3s { x: self.x.min(o.x), y: self.y.min(o.y), z: self.z.min(o.z) }
    }
    /// Component by component.
    #[inline(always)]
    pub fn max(self, o: Self) -> Self {
        Vec3s { x: self.x.max(o.x), y: self.y.max(o.y), z: self.z.max(o.z) }
    }
    #[inline(always)]
    pub fn scale(self, s: S) -> Self {
        Vec3s { x: self.x.mul(s), y: self.y.mul(s), z: self.z.mul(s) }
    }
    #[inline(always)]
    pub fn dot(self, o: Self) -> S {
        self.x.mul(o.x).add(self.y.mul(o.y)).add(self.z.mul(o.z))
    }
}
