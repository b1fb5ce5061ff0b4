//! The evaluation of a grid, row by row.
//!
//! At one z, let each lattice point of a plane have the blend along z of what the lattice points below and above it
//! contribute: a value c and, for gradient noises, slopes bx and by. At an x between two of them with the offsets f and
//! f − 1 and the curve u, a row of lattice points contributes P + Q · (offset along y), where
//! P = lerp(u, c₀ + bx₀ f, c₁ + bx₁ (f − 1)) and Q = lerp(u, by₀, by₁). A point between two such rows, with the offsets g
//! and g − 1 and the curve v, then is (1 − v) P₀ + (1 − v) g Q₀ + v P₁ + v (g − 1) Q₁.

use std::ops::Range;

use super::axis::{Axis, PADDING};
use crate::basis::{Basis, Tables, hash};
use crate::noise::Noise;
use crate::number::{Dual, Integer, Real};
use crate::simd::{Away, Vector, Wide};
use crate::sum::{Combine, Partial};

/// An octave of a sum on a grid.
#[derive(Debug, Clone)]
pub(super) struct Octave {
    pub noise: Noise,
    pub frequency: f64,
    pub amplitude: f64,
    /// x, y and z.
    pub axes: [Axis; 3],
}

/// A sum on a grid: work for vectors of any width.
pub(super) struct Rows<'a> {
    pub combine: Combine,
    pub octaves: &'a [Octave],
    /// The number of points along x.
    pub width: usize,
    /// Which points along y and z.
    pub rows: [Range<usize>; 2],
    pub values: &'a mut [f32],
}

/// So many rows of points are evaluated side by side, if they lie in the same cells.
const SIDE_BY_SIDE: usize = 4;

/// Grids of so many bytes do not stay in the caches, and are written past them.
const LARGE: usize = 16 << 20;

impl Wide for Rows<'_> {
    #[inline(always)]
    fn run<V: Vector<LANES>, const LANES: usize>(self) {
        let (width, [rows, planes]) = (self.width, self.rows);
        let (mut near, mut away) = (self.values, None);
        if size_of_val(near) > LARGE {
            away = Some(Away::to(near));
            near = &mut [];
        }
        let mut buffer = vec![0.0; if away.is_some() { SIDE_BY_SIDE * width } else { 0 }];
        let mut states: Vec<State<V, LANES>> =
            self.octaves.iter().map(|octave| State::new(self.combine, octave)).collect();
        for z in planes {
            for state in &mut states {
                state.start_plane(z);
            }
            let mut y = rows.start;
            while y < rows.end {
                let mut count = SIDE_BY_SIDE.min(rows.end - y);
                for state in &mut states {
                    state.reach_row(y);
                    count = count.min(state.rows_in_cell(y));
                }
                let values = if away.is_some() { &mut buffer[..] } else { &mut near[..] };
                // (A loop for each way to combine: there is little else in it.)
                let done = match (self.combine, count) {
                    (Combine::Plain, 4) => add::<V, LANES, 4>(Combine::Plain, &states, y, width, values),
                    (Combine::Plain, 2 | 3) => add::<V, LANES, 2>(Combine::Plain, &states, y, width, values),
                    (Combine::Plain, _) => add::<V, LANES, 1>(Combine::Plain, &states, y, width, values),
                    (Combine::Absolute, 4) => add::<V, LANES, 4>(Combine::Absolute, &states, y, width, values),
                    (Combine::Absolute, 2 | 3) => add::<V, LANES, 2>(Combine::Absolute, &states, y, width, values),
                    (combine, _) => add::<V, LANES, 1>(combine, &states, y, width, values),
                };
                match &mut away {
                    Some(away) => away.send::<V, LANES>(&buffer[..done * width]),
                    None => near = &mut near[done * width..],
                }
                y += done;
            }
        }
        if let Some(away) = away {
            away.finish::<V, LANES>();
        }
    }
}

/// Sums all octaves at the points of some rows of the same cells, from y on; returns how many.
#[inline(always)]
fn add<V: Vector<LANES>, const LANES: usize, const ROWS: usize>(
    combine: Combine,
    states: &[State<V, LANES>],
    y: usize,
    width: usize,
    values: &mut [f32],
) -> usize {
    for vector in 0..width.div_ceil(LANES) {
        let mut partials = [Partial::<V, 1>::new(); ROWS];
        for state in states {
            let [p0, q0, p1, q1] = state.columns[vector];
            let (frequency, amplitude) = (state.octave.frequency, state.octave.amplitude);
            let factors: &[[f32; 4]; ROWS] = state.factors[y..].first_chunk().expect("there are so many rows");
            for row in 0..ROWS {
                let [a, b, c, d] = factors[row];
                let (low, high) = (p0 * V::splat(a) + q0 * V::splat(b), p1 * V::splat(c) + q1 * V::splat(d));
                if combine == Combine::Plain {
                    // (The factors have the amplitude.)
                    partials[row].sum.value = partials[row].sum.value + (low + high);
                    continue;
                }
                let noise = Dual { value: low + high, gradient: [V::constant(0.0)] };
                partials[row].add::<false>(combine, frequency, amplitude, combine.fold::<V, 1, false>(noise));
            }
        }
        let x = vector * LANES;
        for row in 0..ROWS {
            let values = &mut values[row * width..][x..width];
            let sums = partials[row].sum.value;
            match values.first_chunk_mut() {
                Some(values) => sums.store(values),
                None => {
                    let mut lanes = [0.0; LANES];
                    sums.store(&mut lanes);
                    values.copy_from_slice(&lanes[..values.len()]);
                }
            }
        }
    }
    ROWS
}

/// What a row of lattice points contributes: slopes along x and y, and the rest.
struct Lattice {
    bx: Vec<f32>,
    by: Vec<f32>,
    c: Vec<f32>,
}

/// An octave on its way through the rows.
struct State<'a, V: Real, const LANES: usize> {
    octave: &'a Octave,
    /// The hashes of the lattice points along x, before those of y and z.
    hashes: Vec<i32>,
    /// Those of rows of lattice points, below and above z: of all rows, if the plane is small, or of one.
    below: Vec<i32>,
    above: Vec<i32>,
    /// For each of those rows the cell of the plane and the row for which it was hashed, if it was.
    hashed: Vec<Option<(usize, usize)>>,
    /// How long a row of lattice points is, with some space after it.
    room: usize,
    lattice: Lattice,
    /// For each vector of points where its window of lattice points begins, and where its points are in there.
    windows: Vec<(usize, V::Int)>,
    /// For each vector of points P and Q of the lower and of the upper row of lattice points.
    columns: Vec<[V; 4]>,
    /// The lower row in `columns`, if there is one.
    row: Option<usize>,
    plane: usize,
    /// For each row of points what P and Q are multiplied by (in plain sums times the amplitude).
    factors: Vec<[f32; 4]>,
}

/// The hashes of so many lattice points are kept from plane to plane, where several planes lie between the same ones.
const KEPT: usize = 1 << 14;

impl<'a, V: Vector<LANES>, const LANES: usize> State<'a, V, LANES> {
    #[inline(always)]
    fn new(combine: Combine, octave: &'a Octave) -> Self {
        let [x, y, z] = &octave.axes;
        let tables = octave.noise.tables();
        let hash = |&coordinate: &i32| match octave.noise.basis() {
            Basis::Value => coordinate.wrapping_mul(hash::FACTORS[0]) ^ tables.hash_seed,
            _ => i32::from(tables.permutation.bytes[(coordinate & 255) as usize]),
        };
        let room = x.lattice.len().next_multiple_of(PADDING) + PADDING;
        let repeats = z.cell.len() >= 2 * z.lattice.len() && y.lattice.len() * room <= KEPT;
        let kept = if repeats { y.lattice.len() } else { 1 };
        let (chunks, _) = x.cell.as_chunks::<LANES>();
        let window = |cells: &[usize; LANES]| {
            let mut places = [0; LANES];
            for (place, cell) in places.iter_mut().zip(cells) {
                *place = (cell - cells[0]) as i32;
            }
            (cells[0], V::load_int(&places))
        };
        let factors = y.curve.iter().zip(y.from_low.iter().zip(&y.from_high));
        let scale = if combine == Combine::Plain { octave.amplitude as f32 } else { 1.0 };
        let factors = factors.map(|(v, (low, high))| {
            let (lower, upper) = (scale * (1.0 - v), scale * v);
            [lower, lower * low, upper, upper * high]
        });
        let mut hashes: Vec<i32> = x.lattice.iter().map(hash).collect();
        hashes.resize(room, 0);
        State {
            octave,
            hashes,
            below: vec![0; room * kept],
            above: vec![0; room * kept],
            hashed: vec![None; kept],
            room,
            lattice: Lattice { bx: vec![0.0; room], by: vec![0.0; room], c: vec![0.0; room] },
            windows: chunks.iter().map(window).collect(),
            columns: vec![[V::constant(0.0); 4]; chunks.len()],
            row: None,
            plane: 0,
            factors: factors.collect(),
        }
    }

    #[inline(always)]
    fn start_plane(&mut self, z: usize) {
        (self.plane, self.row) = (z, None);
    }

    /// How many rows of points lie in the same row of cells, from y on (as far as they are of interest).
    #[inline(always)]
    fn rows_in_cell(&self, y: usize) -> usize {
        let cells = &self.octave.axes[1].cell[y..];
        cells.iter().take(SIDE_BY_SIDE).take_while(|&&cell| cell == cells[0]).count()
    }

    /// Prepares the row of points y.
    #[inline(always)]
    fn reach_row(&mut self, y: usize) {
        let row = self.octave.axes[1].cell[y];
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
    }

    /// The contributions of a row of lattice points, blended along z.
    #[inline(always)]
    fn blend_lattice(&mut self, row: usize) {
        let at = self.hash_row(row);
        let axis = &self.octave.axes[2];
        let w = axis.curve[self.plane];
        let (low, high) = (V::splat(1.0 - w), V::splat(w));
        let from_low = V::splat(axis.from_low[self.plane] * (1.0 - w));
        let from_high = V::splat(axis.from_high[self.plane] * w);
        let (basis, tables) = (self.octave.noise.basis(), self.octave.noise.tables());
        let Lattice { bx, by, c } = &mut self.lattice;
        let outputs = bx.as_chunks_mut().0.iter_mut().zip(by.as_chunks_mut().0).zip(c.as_chunks_mut().0);
        let hashes = self.below[at..].as_chunks().0.iter().zip(self.above[at..].as_chunks().0);
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

    /// The hashes of a row of lattice points, below and above z (for improved noise its edge codes): where they begin.
    #[inline(always)]
    fn hash_row(&mut self, row: usize) -> usize {
        let [_, y, z] = &self.octave.axes;
        let cell = z.cell[self.plane];
        let slot = row % self.hashed.len();
        let at = slot * self.room;
        if self.hashed[slot] == Some((cell, row)) {
            return at;
        }
        self.hashed[slot] = Some((cell, row));
        let (y, low, high) = (y.lattice[row], z.lattice[cell], z.lattice[cell + 1]);
        let (basis, tables) = (self.octave.noise.basis(), self.octave.noise.tables());
        let outputs = self.below[at..].as_chunks_mut().0.iter_mut().zip(self.above[at..].as_chunks_mut().0);
        let hashes = self.hashes.as_chunks().0;
        if basis == Basis::Value {
            let [y, low, high] = [(1, y), (2, low), (2, high)].map(|(axis, c)| c.wrapping_mul(hash::FACTORS[axis]));
            for ((below, above), x) in outputs.zip(hashes) {
                let column = V::load_int(x) ^ V::Int::constant(y);
                V::store_int(column ^ V::Int::constant(low), below);
                V::store_int(column ^ V::Int::constant(high), above);
            }
            return at;
        }
        if !V::TABLES_IN_REGISTERS {
            let last = if basis == Basis::Improved { &tables.edges.bytes } else { &tables.permutation.bytes };
            let rows = self.below[at..].iter_mut().zip(&mut self.above[at..]).zip(&self.hashes);
            for ((below, above), x) in rows {
                let column = tables.permutation.bytes[((x + y) & 255) as usize];
                *below = i32::from(last[usize::from(column.wrapping_add(low as u8))]);
                *above = i32::from(last[usize::from(column.wrapping_add(high as u8))]);
            }
            return at;
        }
        for ((below, above), x) in outputs.zip(hashes) {
            let column = V::lookup_pair(&tables.permutation, V::load_int(x) + V::Int::constant(y)).0;
            for (z, hashes) in [(low, below), (high, above)] {
                let index = column + V::Int::constant(z);
                let hash = if basis == Basis::Improved {
                    V::lookup(&tables.edges, index)
                } else {
                    V::lookup_pair(&tables.permutation, index).0 & V::Int::constant(255)
                };
                V::store_int(hash, hashes);
            }
        }
        at
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
