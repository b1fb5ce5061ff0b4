//! The machine's instructions: which there are, and how an evaluation runs over slices with them.
//!
//! [`map`] takes an evaluation written over [`Real`] (a [`Kernel`]) and slices of inputs, chooses the widest vectors that
//! the machine has, once, and runs the evaluation over the slices. The vector types are private: a kernel meets them as
//! `R: Real`, and only in functions that were entered after the machine was asked. That is why their methods may use
//! the instructions, and why all the `unsafe` code of this crate is in this module.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "x86_64")]
mod pipeline;
#[cfg(target_arch = "x86_64")]
mod sse;

use std::sync::OnceLock;

use crate::basis::Tables;
use crate::number::Real;

/// An evaluation of `D` inputs to one value.
pub trait Kernel<const D: usize> {
    /// The value. Mark it `#[inline(always)]`, and what it calls: only code that is inlined into [`map`] is compiled with
    /// the machine's vector instructions. (Else it is as right, and slow.)
    fn run<R: Real>(&self, inputs: [R; D]) -> R;
}

/// A set of vector instructions. Later ones are wider.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Level {
    /// One number at a time.
    Scalar,
    /// SSE 4.1: four at a time.
    Sse,
    /// AVX2 and FMA: eight at a time.
    Avx2,
    /// AVX-512 with the foundation, BW, DQ, VL, VBMI and VBMI2: sixteen at a time, and tables of bytes in registers.
    Avx512,
}

impl Level {
    /// Every level.
    pub const ALL: [Level; 4] = [Level::Scalar, Level::Sse, Level::Avx2, Level::Avx512];

    /// The word for it in `JASPE_SIMD` and in statistics.
    pub fn name(self) -> &'static str {
        match self {
            Level::Scalar => "scalar",
            Level::Sse => "sse",
            Level::Avx2 => "avx2",
            Level::Avx512 => "avx512",
        }
    }

    /// The level of this name.
    pub fn from_name(name: &str) -> Option<Level> {
        Level::ALL.into_iter().find(|level| level.name() == name)
    }
}

/// The highest level of this machine.
#[inline]
pub fn machine_level() -> Level {
    static LEVEL: OnceLock<Level> = OnceLock::new();
    *LEVEL.get_or_init(detect)
}

/// The level in use: the machine's, capped by the environment variable `JASPE_SIMD` (a level's name; other words are
/// ignored), which is read once.
#[inline]
pub fn level() -> Level {
    static LEVEL: OnceLock<Level> = OnceLock::new();
    *LEVEL.get_or_init(|| {
        let cap = std::env::var("JASPE_SIMD").ok().and_then(|name| Level::from_name(&name));
        cap.unwrap_or(Level::Avx512).min(machine_level())
    })
}

#[cfg(target_arch = "x86_64")]
fn detect() -> Level {
    macro_rules! all { ($($feature:tt)*) => { $(is_x86_feature_detected!($feature))&&* }; }
    let sse = all!("sse4.1");
    let avx2 = sse && all!("avx2" "fma");
    let avx512 = avx2 && all!("avx512f" "avx512bw" "avx512dq" "avx512vl" "avx512vbmi" "avx512vbmi2");
    match (avx512, avx2, sse) {
        (true, _, _) => Level::Avx512,
        (_, true, _) => Level::Avx2,
        (_, _, true) => Level::Sse,
        _ => Level::Scalar,
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn detect() -> Level {
    Level::Scalar
}

/// Runs an evaluation over slices: `outputs[i]` is its value for `inputs[0][i]`, `inputs[1][i]`, …
///
/// # Panics
/// When the slices differ in length.
pub fn map<K: Kernel<D>, const D: usize>(kernel: &K, inputs: [&[f32]; D], outputs: &mut [f32]) {
    map_at(level(), kernel, inputs, outputs);
}

/// [`map`] with the instructions of a level, at most those of the machine.
///
/// # Panics
/// When the slices differ in length.
pub fn map_at<K: Kernel<D>, const D: usize>(level: Level, kernel: &K, inputs: [&[f32]; D], outputs: &mut [f32]) {
    for input in inputs {
        assert_eq!(input.len(), outputs.len(), "all slices have the same length");
    }
    match level.min(machine_level()) {
        Level::Scalar => map_scalar(kernel, inputs, outputs),
        // SAFETY, for the three: the machine has the instructions, `machine_level` says.
        #[cfg(target_arch = "x86_64")]
        Level::Sse => unsafe { map_sse(kernel, inputs, outputs) },
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => unsafe { map_avx2(kernel, inputs, outputs) },
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => unsafe { map_avx512(kernel, inputs, outputs) },
        #[cfg(not(target_arch = "x86_64"))]
        _ => map_scalar(kernel, inputs, outputs),
    }
}

/// A sum over octaves, for the kernels made by hand.
pub(crate) struct Terms {
    /// How many.
    pub octaves: u32,
    /// Whether each adds its absolute value.
    pub absolute: bool,
    /// The ratio between the frequencies of neighbouring octaves.
    pub lacunarity: f64,
    /// The ratio between the amplitudes of neighbouring octaves.
    pub gain: f64,
    /// What the amplitude of the last octave is multiplied by.
    pub last: f64,
}

impl Terms {
    /// The noise alone.
    pub const ONE: Terms = Terms { octaves: 1, absolute: false, lacunarity: 1.0, gain: 1.0, last: 1.0 };

    /// The amplitude of an octave. (The powers of ½ are exact.)
    #[inline(always)]
    pub fn amplitude(&self, octave: u32) -> f64 {
        let mut amplitude = 1.0;
        for _ in 0..octave {
            amplitude *= self.gain;
        }
        if octave + 1 == self.octaves { amplitude * self.last } else { amplitude }
    }
}

/// The sum of improved noise without a period at the first points, by a kernel made by hand; returns how many points it
/// did, perhaps none. Same bits as the generic evaluation.
pub(crate) fn sum_improved<const D: usize>(
    level: Level,
    tables: &Tables,
    terms: &Terms,
    points: [&[f32]; D],
    values: &mut [f32],
) -> usize {
    for coordinates in points {
        assert_eq!(coordinates.len(), values.len(), "all slices have the same length");
    }
    if D != 3 {
        return 0;
    }
    let points = [points[0], points[1], points[D - 1]];
    match level.min(machine_level()) {
        _ if values.len() <= FEW => 0,
        // SAFETY, for both: the machine has the instructions, `machine_level` says.
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => unsafe { avx2::improved::sum(tables, terms, points, values) },
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => unsafe { avx512::improved::sum(tables, terms, points, values) },
        _ => 0,
    }
}

/// The sum of improved noise at one point, if there is a kernel made by hand. Same bits as the generic evaluation.
pub(crate) fn sum_improved_at(level: Level, tables: &Tables, terms: &Terms, [x, y, z]: [f32; 3]) -> Option<f32> {
    match level.min(machine_level()) {
        // SAFETY: the machine has the instructions, `machine_level` says.
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 | Level::Avx512 => Some(unsafe { avx2::single::sum(tables, terms, x, y, z) }),
        _ => None,
    }
}

/// Improved noise at one point, if there is a kernel made by hand. Same bits as the generic evaluation.
#[inline(always)]
pub(crate) fn improved_at(level: Level, tables: &Tables, [x, y, z]: [f32; 3]) -> Option<f32> {
    match level.min(machine_level()) {
        // SAFETY: the machine has the instructions, `machine_level` says.
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 | Level::Avx512 => Some(unsafe { avx2::single::improved(tables, x, y, z) }),
        _ => None,
    }
}

/// So few points are evaluated one by one, with their corners or octaves in the lanes, rather than in a vector that they
/// would not fill.
pub(crate) const FEW: usize = 3;

fn map_scalar<K: Kernel<D>, const D: usize>(kernel: &K, inputs: [&[f32]; D], outputs: &mut [f32]) {
    for (i, output) in outputs.iter_mut().enumerate() {
        *output = kernel.run(inputs.map(|input| input[i]));
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "sse4.1")]
fn map_sse<K: Kernel<D>, const D: usize>(kernel: &K, inputs: [&[f32]; D], outputs: &mut [f32]) {
    map_vectors::<sse::F32x4, K, D, 4>(kernel, inputs, outputs);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn map_avx2<K: Kernel<D>, const D: usize>(kernel: &K, inputs: [&[f32]; D], outputs: &mut [f32]) {
    map_vectors::<avx2::F32x8, K, D, 8>(kernel, inputs, outputs);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
fn map_avx512<K: Kernel<D>, const D: usize>(kernel: &K, inputs: [&[f32]; D], outputs: &mut [f32]) {
    map_vectors::<avx512::F32x16, K, D, 16>(kernel, inputs, outputs);
}

/// A number made of `LANES` lanes.
trait Vector<const LANES: usize>: Real {
    fn load(lanes: &[f32; LANES]) -> Self;
    fn store(self, lanes: &mut [f32; LANES]);
}

/// Whole vectors first, then the rest in a vector filled up with zeros.
#[inline(always)]
fn map_vectors<V: Vector<LANES>, K: Kernel<D>, const D: usize, const LANES: usize>(
    kernel: &K,
    inputs: [&[f32]; D],
    outputs: &mut [f32],
) {
    let (whole, rest) = outputs.as_chunks_mut::<LANES>();
    let chunks = inputs.map(|input| input.as_chunks::<LANES>());
    for (i, output) in whole.iter_mut().enumerate() {
        let mut vectors = [V::constant(0.0); D];
        for (vector, (lanes, _)) in vectors.iter_mut().zip(&chunks) {
            *vector = V::load(&lanes[i]);
        }
        kernel.run(vectors).store(output);
    }
    if !rest.is_empty() {
        let mut lanes = [0.0; LANES];
        let mut vectors = [V::constant(0.0); D];
        for (vector, (_, tail)) in vectors.iter_mut().zip(&chunks) {
            lanes[..tail.len()].copy_from_slice(tail);
            *vector = V::load(&lanes);
        }
        kernel.run(vectors).store(&mut lanes);
        rest.copy_from_slice(&lanes[..rest.len()]);
    }
}

/// The operators of a vector type, each one instruction. Calls to intrinsics are sound where the type exists: see the
/// module's description.
#[cfg(target_arch = "x86_64")]
macro_rules! operators {
    ($type:ident: $($operator:ident $method:ident $intrinsic:ident;)*) => {$(
        impl std::ops::$operator for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: a value of this type exists only where the machine has its instructions.
                $type(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    )*};
}
#[cfg(target_arch = "x86_64")]
use operators;
