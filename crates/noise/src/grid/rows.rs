//! The evaluation of a grid, row by row.
//!
//! At one z, let each lattice point of a plane have the blend along z of what the lattice points below and above it
//! contribute: a value c and, for gradient noises, slopes bx and by. At an x between two of them with the offsets f and
//! f − 1 and the curve u, a row of lattice points contributes P + Q · (offset along y), where
//! P = lerp(u, c₀ + bx₀ f, c₁ + bx₁ (f − 1)) and Q = lerp(u, by₀, by₁). A point between two such rows, with the offsets g
//! and g − 1 and the curve v, then is (1 − v) P₀ + (1 − v) g Q₀ + v P₁ + v (g − 1) Q₁.

use super::axis::{Axis, PADDING};
use crate::basis::{Basis, Tables, hash};
use crate::noise::Noise;
use crate::number::{Dual, Real};
use crate::simd::{Vector, Wide};
use crate::sum::{Combine, Partial};

/// An octave of a sum on a grid.
pub(super) struct Octave<'a> {
    pub noise: &'a Noise,
    pub frequency: f64,
    pub amplitude: f64,
    /// x, y and z.
    pub axes: [Axis; 3],
}

/// A sum on a grid: work for vectors of any width.
pub(super) struct Rows<'a> {
    pub combine: Combine,
    pub octaves: Vec<Octave<'a>>,
    /// The number of points along x and y.
    pub counts: [usize; 2],
    pub values: &'a mut [f32],
}

impl Wide for Rows<'_> {
    #[inline(always)]
    fn run<V: Vector<LANES>, const LANES: usize>(self) {
        let [width, height] = self.counts;
        let mut states: Vec<State<V, LANES>> = self.octaves.iter().map(State::new).collect();
        let mut partials = vec![Partial::<V, 1>::new(); width.div_ceil(LANES)];
        for (row, values) in self.values.chunks_mut(width).enumerate() {
            let (y, z) = (row % height, row / height);
            for (index, state) in states.iter_mut().enumerate() {
                if y == 0 {
                    state.start_plane(z);
                }
                state.reach_row(y);
                // (A loop for each way to combine: there is little else in it.)
                match (self.combine, index) {
                    (Combine::Plain, 0) => state.add::<true>(Combine::Plain, &mut partials),
                    (Combine::Plain, _) => state.add::<false>(Combine::Plain, &mut partials),
                    (Combine::Absolute, 0) => state.add::<true>(Combine::Absolute, &mut partials),
                    (Combine::Absolute, _) => state.add::<false>(Combine::Absolute, &mut partials),
                    (combine, 0) => state.add::<true>(combine, &mut partials),
                    (combine, _) => state.add::<false>(combine, &mut partials),
                }
            }
            let (whole, rest) = values.as_chunks_mut();
            for (values, partial) in whole.iter_mut().zip(&partials) {
                partial.sum.value.store(values);
            }
            if let (false, Some(partial)) = (rest.is_empty(), partials.last()) {
                let mut lanes = [0.0; LANES];
                partial.sum.value.store(&mut lanes);
                rest.copy_from_slice(&lanes[..rest.len()]);
            }
        }
    }
}

/// What a row of lattice points contributes: slopes along x and y, and the rest.
struct Lattice {
    bx: Vec<f32>,
    by: Vec<f32>,
    c: Vec<f32>,
}

/// An octave on its way through the rows.
struct State<'a, V: Real, const LANES: usize> {
    octave: &'a Octave<'a>,
    /// The hashes of the lattice points along x, before those of y and z.
    hashes: Vec<i32>,
    /// Those of a row of lattice points, below and above z.
    below: Vec<i32>,
    above: Vec<i32>,
    lattice: Lattice,
    /// For each vector of points where its window of lattice points begins, and where its points are in there.
    windows: Vec<(usize, V::Int)>,
    /// For each vector of points P and Q of the lower and of the upper row of lattice points.
    columns: Vec<[V; 4]>,
    /// The lower row in `columns`, if there is one.
    row: Option<usize>,
    plane: usize,
    /// The factors of a row of points.
    factors: [V; 4],
}

impl<'a, V: Vector<LANES>, const LANES: usize> State<'a, V, LANES> {
    #[inline(always)]
    fn new(octave: &'a Octave<'a>) -> Self {
        let [x, _, _] = &octave.axes;
        let tables = octave.noise.tables();
        let hash = |&coordinate: &i32| match octave.noise.basis() {
            Basis::Value => coordinate.wrapping_mul(hash::FACTORS[0]) ^ tables.hash_seed,
            _ => i32::from(tables.permutation.bytes[(coordinate & 255) as usize]),
        };
        let room = x.lattice.len().next_multiple_of(PADDING) + PADDING;
        let (chunks, _) = x.cell.as_chunks::<LANES>();
        let window = |cells: &[usize; LANES]| {
            let mut places = [0; LANES];
            for (place, cell) in places.iter_mut().zip(cells) {
                *place = (cell - cells[0]) as i32;
            }
            (cells[0], V::load_int(&places))
        };
        State {
            octave,
            hashes: x.lattice.iter().map(hash).collect(),
            below: vec![0; room],
            above: vec![0; room],
            lattice: Lattice { bx: vec![0.0; room], by: vec![0.0; room], c: vec![0.0; room] },
            windows: chunks.iter().map(window).collect(),
            columns: vec![[V::constant(0.0); 4]; chunks.len()],
            row: None,
            plane: 0,
            factors: [V::constant(0.0); 4],
        }
    }

    #[inline(always)]
    fn start_plane(&mut self, z: usize) {
        (self.plane, self.row) = (z, None);
    }

    /// Prepares the row of points y.
    #[inline(always)]
    fn reach_row(&mut self, y: usize) {
        let axis = &self.octave.axes[1];
        let row = axis.cell[y];
        if self.row != Some(row) {
            if self.row.is_none_or(|before| before + 1 != row) {
                self.blend_lattice(row);
                self.expand();
            }
            for column in &mut self.columns {
                (column[0], column[1]) = (column[2], column[3]);
            }
            self.blend_lattice(row + 1);
            self.expand();
            self.row = Some(row);
        }
        let v = axis.curve[y];
        let factors = [1.0 - v, (1.0 - v) * axis.from_low[y], v, v * axis.from_high[y]];
        for (factor, number) in self.factors.iter_mut().zip(factors) {
            *factor = V::splat(number);
        }
    }

    /// Adds the octave at the points of the row; the first one begins the sums.
    #[inline(always)]
    fn add<const FIRST: bool>(&self, combine: Combine, partials: &mut [Partial<V, 1>]) {
        let [a, b, c, d] = self.factors;
        let (frequency, amplitude) = (self.octave.frequency, self.octave.amplitude);
        for (partial, [p0, q0, p1, q1]) in partials.iter_mut().zip(&self.columns) {
            let value = (*p0 * a + *q0 * b) + (*p1 * c + *q1 * d);
            let noise = Dual { value, gradient: [V::constant(0.0)] };
            if FIRST {
                *partial = Partial::new();
            }
            partial.add::<false>(combine, frequency, amplitude, combine.fold::<V, 1, false>(noise));
        }
    }

    /// The contributions of a row of lattice points, blended along z.
    #[inline(always)]
    fn blend_lattice(&mut self, row: usize) {
        self.hash_row(row);
        let axis = &self.octave.axes[2];
        let w = axis.curve[self.plane];
        let (low, high) = (V::splat(1.0 - w), V::splat(w));
        let from_low = V::splat(axis.from_low[self.plane] * (1.0 - w));
        let from_high = V::splat(axis.from_high[self.plane] * w);
        let (basis, tables) = (self.octave.noise.basis(), self.octave.noise.tables());
        let Lattice { bx, by, c } = &mut self.lattice;
        let outputs = bx.as_chunks_mut().0.iter_mut().zip(by.as_chunks_mut().0).zip(c.as_chunks_mut().0);
        let hashes = self.below.as_chunks().0.iter().zip(self.above.as_chunks().0);
        for (((bx, by), c), (below, above)) in outputs.zip(hashes) {
            let (below, above) = (V::load_int(below), V::load_int(above));
            if basis == Basis::Lattice || basis == Basis::Value {
                (number::<V>(basis, below) * low + number::<V>(basis, above) * high).store(c);
            } else {
                let [x0, y0, z0] = gradient::<V>(basis, tables, below);
                let [x1, y1, z1] = gradient::<V>(basis, tables, above);
                (x0 * low + x1 * high).store(bx);
                (y0 * low + y1 * high).store(by);
                (z0 * from_low + z1 * from_high).store(c);
            }
        }
    }

    /// The hashes of a row of lattice points, below and above z: for improved noise its edge codes.
    #[inline(always)]
    fn hash_row(&mut self, row: usize) {
        let [_, y, z] = &self.octave.axes;
        let cell = z.cell[self.plane];
        let (y, low, high) = (y.lattice[row], z.lattice[cell], z.lattice[cell + 1]);
        let (basis, tables) = (self.octave.noise.basis(), self.octave.noise.tables());
        let outputs = self.below.iter_mut().zip(&mut self.above);
        if basis == Basis::Value {
            let [y, low, high] = [(1, y), (2, low), (2, high)].map(|(axis, c)| c.wrapping_mul(hash::FACTORS[axis]));
            for ((below, above), x) in outputs.zip(&self.hashes) {
                (*below, *above) = (x ^ y ^ low, x ^ y ^ high);
            }
            return;
        }
        let last = if basis == Basis::Improved { &tables.edges.bytes } else { &tables.permutation.bytes };
        let table = &tables.permutation.bytes;
        for ((below, above), x) in outputs.zip(&self.hashes) {
            let column = table[((x + y) & 255) as usize];
            *below = i32::from(last[usize::from(column.wrapping_add(low as u8))]);
            *above = i32::from(last[usize::from(column.wrapping_add(high as u8))]);
        }
    }

    /// P and Q of the upper row, from the lattice to the points.
    #[inline(always)]
    fn expand(&mut self) {
        let [x, _, _] = &self.octave.axes;
        let Lattice { bx, by, c } = &self.lattice;
        let offsets = x.from_low.as_chunks().0.iter().zip(x.from_high.as_chunks().0).zip(x.curve.as_chunks().0);
        let columns = self.columns.iter_mut().zip(&self.windows);
        for ((column, &(start, places)), ((low, high), u)) in columns.zip(offsets) {
            let (low, high, u) = (V::load(low), V::load(high), V::load(u));
            let left = pick::<V, LANES>(c, start, places) + pick::<V, LANES>(bx, start, places) * low;
            let right = pick::<V, LANES>(c, start + 1, places) + pick::<V, LANES>(bx, start + 1, places) * high;
            let (by0, by1) = (pick::<V, LANES>(by, start, places), pick::<V, LANES>(by, start + 1, places));
            column[2] = left + u * (right - left);
            column[3] = by0 + u * (by1 - by0);
        }
    }
}

/// The numbers at some places of the window that begins at `start`. (Rows are padded.)
#[inline(always)]
fn pick<V: Vector<LANES>, const LANES: usize>(numbers: &[f32], start: usize, places: V::Int) -> V {
    V::expand(numbers[start..].first_chunk().expect("rows are padded"), places)
}

/// The values of lattice points, for noises of values.
#[inline(always)]
fn number<V: Real>(basis: Basis, hash: V::Int) -> V {
    match basis {
        Basis::Value => hash::signed(hash::bits::<V>(hash)),
        _ => V::from_int(hash) * V::constant(2.0 / 255.0) - V::constant(1.0),
    }
}

/// The gradients of lattice points, for noises of gradients.
#[inline(always)]
fn gradient<V: Real>(basis: Basis, tables: &Tables, hash: V::Int) -> [V; 3] {
    match basis {
        Basis::Classic => {
            let [x, y, z] = &tables.gradients;
            [V::pick(x, hash), V::pick(y, hash), V::pick(z, hash)]
        }
        _ => V::edge(hash),
    }
}
