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
mod triples;

use std::sync::OnceLock;

use crate::basis::Tables;
use crate::noise::Noise;
use crate::number::{Integer, Real};
use crate::sum::Sum;

pub use triples::{deinterleave, deinterleave_at};

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
    map_outputs(level, &Alone(kernel), inputs, [outputs]);
}

/// An evaluation of `D` inputs to `N` values.
pub(crate) trait Outputs<const D: usize, const N: usize> {
    /// The values; as [`Kernel::run`].
    fn run<R: Real>(&self, inputs: [R; D]) -> [R; N];
}

/// A kernel has one value.
struct Alone<'a, K>(&'a K);

impl<K: Kernel<D>, const D: usize> Outputs<D, 1> for Alone<'_, K> {
    #[inline(always)]
    fn run<R: Real>(&self, inputs: [R; D]) -> [R; 1] {
        [self.0.run(inputs)]
    }
}

/// # Panics
/// When a slice has another length.
#[inline(always)]
#[track_caller]
pub(crate) fn assert_lengths<S: AsRef<[f32]>>(slices: &[S], length: usize) {
    assert!(slices.iter().all(|slice| slice.as_ref().len() == length), "all slices have the same length");
}

/// [`map_at`] for several values.
#[inline(always)]
pub(crate) fn map_outputs<K: Outputs<D, N>, const D: usize, const N: usize>(
    level: Level,
    kernel: &K,
    inputs: [&[f32]; D],
    outputs: [&mut [f32]; N],
) {
    let count = outputs[0].len();
    assert_lengths(&inputs, count);
    assert_lengths(&outputs, count);
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
pub(crate) struct Terms<'a> {
    /// Whether each octave adds its absolute value.
    pub absolute: bool,
    /// What the point is multiplied by, octave by octave.
    pub frequencies: &'a [f32],
    /// What the noise is multiplied by.
    pub amplitudes: &'a [f32],
    /// The products of both, by which the gradient is multiplied.
    pub slopes: &'a [f32],
}

/// Up to eight octaves of a sum, for the kernels that have them in lanes.
#[derive(Debug, Clone, PartialEq)]
#[repr(align(64))]
pub(crate) struct Lanes {
    /// The bits of each octave's noise that count: all, or all but the sign.
    pub mask: [u32; 8],
    /// Zeros after the last octave, here and below.
    pub frequencies: [f32; 8],
    pub amplitudes: [f32; 8],
    /// Two octaves at a time, each number four times.
    pub frequencies_of_pairs: [[f32; 8]; 4],
    pub amplitudes_of_pairs: [[f32; 8]; 4],
    /// How many octaves.
    pub count: usize,
}

impl Lanes {
    /// All octaves of a sum, eight at a time.
    pub fn of(absolute: bool, frequencies: &[f32], amplitudes: &[f32]) -> Vec<Lanes> {
        let mask = [if absolute { u32::MAX >> 1 } else { u32::MAX }; 8];
        let eight = |numbers: &[f32]| std::array::from_fn(|i| numbers.get(i).copied().unwrap_or(0.0));
        let pairs = |numbers: [f32; 8]| std::array::from_fn(|pair| std::array::from_fn(|i| numbers[2 * pair + i / 4]));
        let lanes = frequencies.chunks(8).zip(amplitudes.chunks(8)).map(|(some, amplitudes)| {
            let (count, frequencies, amplitudes) = (some.len(), eight(some), eight(amplitudes));
            let (frequencies_of_pairs, amplitudes_of_pairs) = (pairs(frequencies), pairs(amplitudes));
            Lanes { mask, frequencies, amplitudes, frequencies_of_pairs, amplitudes_of_pairs, count }
        });
        lanes.collect()
    }
}

impl Terms<'_> {
    /// How many octaves.
    #[inline(always)]
    pub fn octaves(&self) -> usize {
        self.amplitudes.len()
    }
}

/// How many points the kernels made by hand take at a time with the instructions of a level, and at most.
pub(crate) fn step(level: Level) -> usize {
    if level.min(machine_level()) == Level::Avx512 { MOST_STEP } else { 8 }
}
pub(crate) const MOST_STEP: usize = 64;

/// The sum of improved noise (without terms: the noise itself) without a period at the first points in space (and its gradient, where there are four
/// outputs), by a kernel made by hand; returns how many points it did, perhaps none. Same bits as the generic evaluation.
pub(crate) fn sum_improved<const N: usize>(
    level: Level,
    tables: &Tables,
    terms: Option<&Terms>,
    points: [&[f32]; 3],
    outputs: [&mut [f32]; N],
) -> usize {
    let count = outputs[0].len();
    assert_lengths(&points, count);
    assert_lengths(&outputs, count);
    match level.min(machine_level()) {
        // SAFETY, for both: the machine has the instructions, `machine_level` says.
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => unsafe { avx2::improved::sum(tables, terms, points, outputs) },
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => unsafe { avx512::improved::sum(tables, terms, points, outputs) },
        _ => 0,
    }
}

/// [`sum_improved`] in the plane (and its gradient, where there are three outputs).
pub(crate) fn sum_improved_in_plane<const N: usize>(
    level: Level,
    tables: &Tables,
    terms: Option<&Terms>,
    points: [&[f32]; 2],
    outputs: [&mut [f32]; N],
) -> usize {
    let count = outputs[0].len();
    assert_lengths(&points, count);
    assert_lengths(&outputs, count);
    match level.min(machine_level()) {
        // SAFETY, for both: the machine has the instructions, `machine_level` says.
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => unsafe { avx2::improved::sum_in_plane(tables, terms, points, outputs) },
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => unsafe { avx512::plane::sum(tables, terms, points, outputs) },
        _ => 0,
    }
}

/// Improved noise without a period at the first points in space, which are not in columns, by a kernel made by hand; returns how
/// many it did, perhaps none. Same bits as the generic evaluation.
pub(crate) fn improved_at_points(level: Level, tables: &Tables, points: &[[f32; 3]], values: &mut [f32]) -> usize {
    match level.min(machine_level()) {
        // SAFETY, for both: the machine has the instructions, `machine_level` says.
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => unsafe { avx2::improved::at_points(tables, points, values) },
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => unsafe { avx512::improved::at_points(tables, points, values) },
        _ => 0,
    }
}

/// The kernel of this path in the module of a level, at most that of the machine, if there is one.
macro_rules! kernel {
    ($level:expr, $of:ident, $module:ident::$name:ident) => {
        match $level.min(machine_level()) {
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => Some($of(avx2::$module::$name)),
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => Some($of(avx512::$module::$name)),
            _ => None,
        }
    };
}

/// A function of a point in space (or in the plane, where the last coordinate is not read), chosen when the noise or sum is made: the
/// fastest way for one point.
#[derive(Debug)]
pub(crate) struct AtPoint<T>(unsafe fn(&T, f32, f32, f32) -> f32);

impl<T> Clone for AtPoint<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for AtPoint<T> {}

/// It follows from the noise or sum.
impl<T> PartialEq for AtPoint<T> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl<T> AtPoint<T> {
    /// By any function.
    pub fn by(function: fn(&T, f32, f32, f32) -> f32) -> Self {
        AtPoint(function)
    }

    /// Its value.
    #[inline(always)]
    pub fn at(self, of: &T, [x, y, z]: [f32; 3]) -> f32 {
        // SAFETY: it is a function by itself, or the machine has the instructions that it needs.
        unsafe { (self.0)(of, alone(x), alone(y), alone(z)) }
    }
}

impl AtPoint<Noise> {
    /// Improved noise without a period in space and in the plane, which is the slice of space where z is 0, with the instructions of a
    /// level, at most those of the machine, if there is a kernel for them.
    pub fn improved(level: Level) -> Option<[Self; 2]> {
        kernel!(level, AtPoint, single::improved).map(|kernel| [kernel; 2])
    }

    /// Any noise in space and in the plane by its generic evaluation, with a level's instructions for single numbers, if it has
    /// others than all machines.
    pub fn generic(level: Level) -> Option<[Self; 2]> {
        let in_space = kernel!(level, AtPoint, single::in_space)?;
        Some([in_space, kernel!(level, AtPoint, single::in_plane)?])
    }
}

impl AtPoint<Sum> {
    /// Its octaves, added or their absolute values added: as [`AtPoint::improved`].
    pub fn improved_octaves(level: Level) -> Option<Self> {
        kernel!(level, AtPoint, single::sum)
    }
}

/// So many points at once have a shorter way to their kernel, which would be a tenth of their time.
pub(crate) const BATCH: usize = MOST_STEP;

/// Improved noise without a period at a batch of points in space.
#[derive(Debug, Clone, Copy)]
pub(crate) struct InBatch(unsafe fn(&Tables, &Batch, &Batch, &Batch, &mut Batch));
type Batch = [f32; BATCH];

impl InBatch {
    /// By a kernel made by hand with the instructions of a level, at most those of the machine, if there is one for them.
    pub fn improved(level: Level) -> Option<Self> {
        kernel!(level, InBatch, improved::batch)
    }

    /// Writes the values.
    #[inline(always)]
    pub fn fill(self, tables: &Tables, [x, y, z]: [&Batch; 3], values: &mut Batch) {
        // SAFETY: the machine has the instructions, or there would be no such kernel.
        unsafe { (self.0)(tables, x, y, z, values) }
    }
}

/// The coordinate, in a register of its own. The compiler would read two of them as one number, for which the machine waits if
/// they were written one by one just before: twenty nanoseconds.
#[inline(always)]
fn alone(coordinate: f32) -> f32 {
    #[cfg(target_arch = "x86_64")]
    let coordinate = {
        let mut coordinate = coordinate;
        // SAFETY: this is no instruction.
        unsafe {
            std::arch::asm!("/* {0} */", inout(xmm_reg) coordinate, options(pure, nomem, nostack, preserves_flags))
        };
        coordinate
    };
    coordinate
}

/// Work on slices that the compiler makes vectors of.
pub(crate) trait Task {
    /// Does it. Mark it `#[inline(always)]`, as a kernel.
    fn run(self);
}

/// Does the work with the instructions of a level, at most those of the machine.
pub(crate) fn run<T: Task>(level: Level, task: T) {
    match level.min(machine_level()) {
        Level::Scalar | Level::Sse => task.run(),
        // SAFETY, for both: the machine has the instructions, `machine_level` says.
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => unsafe { run_avx2(task) },
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => unsafe { run_avx512(task) },
        #[cfg(not(target_arch = "x86_64"))]
        _ => task.run(),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn run_avx2<T: Task>(task: T) {
    task.run();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl")]
fn run_avx512<T: Task>(task: T) {
    task.run();
}

/// So few points are evaluated one by one, with their corners or octaves in the lanes, rather than in a vector that they
/// would not fill.
pub(crate) const FEW: usize = 3;

fn map_scalar<K: Outputs<D, N>, const D: usize, const N: usize>(
    kernel: &K,
    inputs: [&[f32]; D],
    mut outputs: [&mut [f32]; N],
) {
    for i in 0..outputs[0].len() {
        for (output, value) in outputs.iter_mut().zip(kernel.run(inputs.map(|input| input[i]))) {
            output[i] = value;
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "sse4.1")]
fn map_sse<K: Outputs<D, N>, const D: usize, const N: usize>(
    kernel: &K,
    inputs: [&[f32]; D],
    outputs: [&mut [f32]; N],
) {
    map_vectors::<sse::F32x4, K, D, N, 4>(kernel, inputs, outputs);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn map_avx2<K: Outputs<D, N>, const D: usize, const N: usize>(
    kernel: &K,
    inputs: [&[f32]; D],
    outputs: [&mut [f32]; N],
) {
    map_vectors::<avx2::F32x8, K, D, N, 8>(kernel, inputs, outputs);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
fn map_avx512<K: Outputs<D, N>, const D: usize, const N: usize>(
    kernel: &K,
    inputs: [&[f32]; D],
    outputs: [&mut [f32]; N],
) {
    map_vectors::<avx512::F32x16, K, D, N, 16>(kernel, inputs, outputs);
}

/// A number made of `LANES` lanes.
pub(crate) trait Vector<const LANES: usize>: Real {
    /// Whether tables of bytes are read from registers, so that many reads at once are fast.
    const TABLES_IN_REGISTERS: bool = false;
    fn load(lanes: &[f32; LANES]) -> Self;
    fn store(self, lanes: &mut [f32; LANES]);
    /// The same number in every lane.
    fn splat(value: f32) -> Self;
    fn load_int(lanes: &[i32; LANES]) -> Self::Int;
    fn store_int(integers: Self::Int, lanes: &mut [i32; LANES]);
    /// [`Vector::store`] past the caches, if the machine can; `lanes` are aligned to their size.
    fn store_away(self, lanes: &mut [f32; LANES]) {
        self.store(lanes);
    }
    /// Makes what was stored away visible to other threads.
    fn after_stores_away() {}
    /// The window's numbers at these places, which are below `LANES`.
    fn expand(window: &[f32; LANES], places: Self::Int) -> Self;
}

/// Numbers on their way past the caches to where they are not needed soon, in their order.
///
/// Lines of memory go there as a whole. One of which a part was written the usual way would first be read, and until then
/// everything that is written later would wait: hence parts of a line wait here for the others.
pub(crate) struct Away<'a> {
    /// Where the next numbers go.
    rest: &'a mut [f32],
    /// How many of them lie before the first whole line.
    before: usize,
    line: Line,
    /// How many numbers wait in the line.
    waiting: usize,
}

/// A line of memory.
#[repr(align(64))]
struct Line([f32; LINE]);
const LINE: usize = 16;

impl<'a> Away<'a> {
    /// To these numbers.
    pub fn to(rest: &'a mut [f32]) -> Self {
        let before = rest.as_ptr().align_offset(size_of::<Line>());
        Away { rest, before, line: Line([0.0; LINE]), waiting: 0 }
    }

    /// The next numbers.
    ///
    /// # Panics
    /// When there is no room for them.
    #[inline(always)]
    pub fn send<V: Vector<LANES>, const LANES: usize>(&mut self, mut numbers: &[f32]) {
        assert!(self.waiting + numbers.len() <= self.rest.len(), "there is room for the numbers");
        if self.before > 0 {
            let (first, others) = numbers.split_at(self.before.min(numbers.len()));
            self.take(first.len()).copy_from_slice(first);
            (self.before, numbers) = (self.before - first.len(), others);
        }
        if self.waiting > 0 {
            let (first, others) = numbers.split_at((LINE - self.waiting).min(numbers.len()));
            self.line.0[self.waiting..][..first.len()].copy_from_slice(first);
            (self.waiting, numbers) = (self.waiting + first.len(), others);
            if self.waiting < LINE {
                return;
            }
            let line = self.take(LINE);
            store_away::<V, LANES>(&self.line.0, line);
            self.waiting = 0;
        }
        let whole = numbers.len() / LINE * LINE;
        let (lines, last) = numbers.split_at(whole);
        store_away::<V, LANES>(lines, self.take(whole));
        self.line.0[..last.len()].copy_from_slice(last);
        self.waiting = last.len();
    }

    /// Writes what waits: there are no more numbers.
    #[inline(always)]
    pub fn finish<V: Vector<LANES>, const LANES: usize>(mut self) {
        let waiting = self.waiting;
        self.take(waiting).copy_from_slice(&self.line.0[..waiting]);
        V::after_stores_away();
    }

    /// Where so many numbers go.
    #[inline(always)]
    fn take(&mut self, count: usize) -> &'a mut [f32] {
        let (taken, rest) = std::mem::take(&mut self.rest).split_at_mut(count);
        self.rest = rest;
        taken
    }
}

/// Copies whole lines.
#[inline(always)]
fn store_away<V: Vector<LANES>, const LANES: usize>(from: &[f32], to: &mut [f32]) {
    for (from, to) in from.as_chunks().0.iter().zip(to.as_chunks_mut().0) {
        V::load(from).store_away(to);
    }
}

impl Vector<1> for f32 {
    #[inline(always)]
    fn load(lanes: &[f32; 1]) -> Self {
        lanes[0]
    }
    #[inline(always)]
    fn store(self, lanes: &mut [f32; 1]) {
        lanes[0] = self;
    }
    #[inline(always)]
    fn splat(value: f32) -> Self {
        value
    }
    #[inline(always)]
    fn load_int(lanes: &[i32; 1]) -> Self::Int {
        Self::Int::constant(lanes[0])
    }
    #[inline(always)]
    fn store_int(integers: Self::Int, lanes: &mut [i32; 1]) {
        lanes[0] = integers.0;
    }
    #[inline(always)]
    fn expand(window: &[f32; 1], _places: Self::Int) -> Self {
        window[0]
    }
}

/// Work written for vectors of any width.
pub(crate) trait Wide {
    /// Does it. Mark it `#[inline(always)]`, as a kernel.
    fn run<V: Vector<LANES>, const LANES: usize>(self);
}

/// Does the work with the instructions of a level, at most those of the machine.
pub(crate) fn run_wide<W: Wide>(level: Level, work: W) {
    match level.min(machine_level()) {
        Level::Scalar => work.run::<f32, 1>(),
        // SAFETY, for the three: the machine has the instructions, `machine_level` says.
        #[cfg(target_arch = "x86_64")]
        Level::Sse => unsafe { run_wide_sse(work) },
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => unsafe { run_wide_avx2(work) },
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => unsafe { run_wide_avx512(work) },
        #[cfg(not(target_arch = "x86_64"))]
        _ => work.run::<f32, 1>(),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "sse4.1")]
fn run_wide_sse<W: Wide>(work: W) {
    work.run::<sse::F32x4, 4>();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn run_wide_avx2<W: Wide>(work: W) {
    work.run::<avx2::F32x8, 8>();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi,avx512vbmi2")]
fn run_wide_avx512<W: Wide>(work: W) {
    work.run::<avx512::F32x16, 16>();
}

/// Whole vectors first, then the rest in a vector filled up with zeros.
#[inline(always)]
fn map_vectors<V: Vector<LANES>, K: Outputs<D, N>, const D: usize, const N: usize, const LANES: usize>(
    kernel: &K,
    inputs: [&[f32]; D],
    mut outputs: [&mut [f32]; N],
) {
    let count = outputs[0].len();
    let mut vectors = [V::constant(0.0); D];
    for start in (0..count / LANES * LANES).step_by(LANES) {
        for (vector, input) in vectors.iter_mut().zip(inputs) {
            *vector = V::load(input[start..].first_chunk().expect("whole vectors"));
        }
        let values = kernel.run(vectors);
        for (output, value) in outputs.iter_mut().zip(values) {
            value.store(output[start..].first_chunk_mut().expect("whole vectors"));
        }
    }
    let rest = count % LANES;
    if rest != 0 {
        let mut lanes = [0.0; LANES];
        for (vector, input) in vectors.iter_mut().zip(inputs) {
            lanes[..rest].copy_from_slice(&input[count - rest..]);
            *vector = V::load(&lanes);
        }
        let values = kernel.run(vectors);
        for (output, value) in outputs.iter_mut().zip(values) {
            value.store(&mut lanes);
            output[count - rest..].copy_from_slice(&lanes[..rest]);
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Sends pieces of these lengths to a slice that begins so many numbers after a line of memory does.
    struct Pieces<'a> {
        lengths: &'a [usize],
        offset: usize,
    }

    impl Wide for Pieces<'_> {
        #[inline(always)]
        fn run<V: Vector<LANES>, const LANES: usize>(self) {
            let count: usize = self.lengths.iter().sum();
            let numbers: Vec<f32> = (0..count).map(|i| i as f32).collect();
            let mut memory = vec![-1.0; count + 3 * LINE];
            let start = memory.as_ptr().align_offset(size_of::<Line>()) + self.offset;
            let mut away = Away::to(&mut memory[start..]);
            let mut rest = &numbers[..];
            for &length in self.lengths {
                let (piece, later) = rest.split_at(length);
                away.send::<V, LANES>(piece);
                rest = later;
            }
            away.finish::<V, LANES>();
            assert_eq!(memory[start..][..count], numbers);
            assert!(memory[..start].iter().chain(&memory[start + count..]).all(|&number| number == -1.0));
        }
    }

    #[test]
    fn numbers_on_their_way_past_the_caches_arrive_and_nothing_else_is_written() {
        for level in Level::ALL {
            for offset in 0..=LINE {
                for lengths in [&[][..], &[1, 2, 3], &[16, 16], &[100, 5, 7, 0, 4, 64, 33], &[3; 40], &[15, 17, 31, 1]]
                {
                    run_wide(level, Pieces { lengths, offset });
                }
            }
        }
    }
}
