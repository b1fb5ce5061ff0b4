//! Eight lanes in plain arrays: compiled with whatever the target has at least (SSE2, NEON).

use super::{Lanes, Simd};

/// Eight lanes in an array.
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

impl Lanes for Portable {
    const COUNT: usize = 8;
    type Floats = [f32; 8];
    type Bits = [u32; 8];

    #[inline(always)]
    fn load(values: &[f32]) -> Self {
        let values: &[f32; 8] = values.first_chunk().expect("there are eight");
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
    fn load_bits(bits: &[u32]) -> Self {
        let bits: &[u32; 8] = bits.first_chunk().expect("there are eight");
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
    fn lines(rows: [Self; 16]) -> [[f32; 16]; 16] {
        let mut lines = [[0.0; 16]; 16];
        for (i, row) in rows.iter().enumerate() {
            for (line, &value) in lines.iter_mut().zip(&row.0) {
                line[i] = value;
            }
        }
        lines
    }
    #[inline(always)]
    fn compress(self, mask: u32) -> Self {
        let (mut out, mut count) = ([0.0; 8], 0);
        for i in 0..8 {
            out[count & 7] = self.0[i];
            count += (mask >> i & 1) as usize;
        }
        Portable(out)
    }
    #[inline(always)]
    fn same_bits(self, other: Self) -> u32 {
        self.mask(other, |a, b| a.to_bits() == b.to_bits())
    }
    #[inline(always)]
    fn leasts(rows: [Self; 8]) -> [f32; 8] {
        rows.map(Lanes::least)
    }
    #[inline(always)]
    fn mosts(rows: [Self; 8]) -> [f32; 8] {
        rows.map(Lanes::most)
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

impl Simd for Portable {
    type Wide = Portable;

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
        let mask = self.le(limit);
        let mut count = 0;
        for place in order {
            let lane = (place >> shift & 7) as usize;
            (values[count & 7], out[count & 7]) = (self.0[lane], codes[lane]);
            count += (mask >> lane & 1) as usize;
        }
        count
    }

    #[inline(always)]
    fn prefetch(_: *const u8) {}
}
