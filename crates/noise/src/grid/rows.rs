//! The evaluation of a grid, row by row.
//!
//! At one z, let each lattice point of a plane have the blend along z of what the lattice points below and above it
//! contribute: a value c and, for gradient noises, slopes bx and by. At an x between two of them with the offsets f and
//! f − 1 and the curve u, a row of lattice points contributes P + Q · (offset along y), where
//! P = lerp(u, c₀ + bx₀ f, c₁ + bx₁ (f − 1)) and Q = lerp(u, by₀, by₁). A point between two such rows, with the offsets g
//! and g − 1 and the curve v, then is (1 − v) P₀ + (1 − v) g Q₀ + v P₁ + v (g − 1) Q₁.
//!
//! The derivative along x is that of P and Q, the one along y that of the four factors, and the one along z that of c, bx and by.

use std::ops::Range;

use super::axis::{Axis, PADDING};
use crate::basis::corners::lerp;
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

/// A sum on a grid, with its derivatives along the first `D` axes: work for vectors of any width.
pub(super) struct Rows<'a, const D: usize> {
    pub combine: Combine,
    pub octaves: &'a [Octave],
    /// The number of points along x.
    pub width: usize,
    /// Which points along y and z.
    pub rows: [Range<usize>; 2],
    pub values: &'a mut [f32],
    pub gradient: [&'a mut [f32]; D],
}

/// So many rows of points are evaluated side by side, if they lie in the same cells.
const SIDE_BY_SIDE: usize = 4;

/// Grids of so many bytes do not stay in the caches, and are written past them.
const LARGE: usize = 16 << 20;

impl<const D: usize> Wide for Rows<'_, D> {
    #[inline(always)]
    fn run<V: Vector<LANES>, const LANES: usize>(self) {
        let (width, [rows, planes]) = (self.width, self.rows);
        let mut values = Output::to(self.values, width);
        let mut gradient = self.gradient.map(|part| Output::to(part, width));
        let mut states: Vec<State<V, LANES, D>> =
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
                let outputs = (values.next(), gradient.each_mut().map(Output::next));
                // (A loop for each way to combine: there is little else in it. Of what has a gradient and is folded, the
                // registers have room for one row.)
                let done = match (self.combine, count) {
                    (Combine::Plain, 4) => add::<V, LANES, D, 4>(&states, y, width, outputs),
                    (Combine::Plain, 2 | 3) => add::<V, LANES, D, 2>(&states, y, width, outputs),
                    (Combine::Plain, _) => add::<V, LANES, D, 1>(&states, y, width, outputs),
                    (combine @ Combine::Absolute, 4) if D == 0 => {
                        fold::<V, LANES, D, 4>(combine, &states, y, width, outputs)
                    }
                    (combine @ Combine::Absolute, 2 | 3) if D == 0 => {
                        fold::<V, LANES, D, 2>(combine, &states, y, width, outputs)
                    }
                    (combine, _) => fold::<V, LANES, D, 1>(combine, &states, y, width, outputs),
                };
                values.advance::<V, LANES>(done * width);
                for part in &mut gradient {
                    part.advance::<V, LANES>(done * width);
                }
                y += done;
            }
        }
        values.finish::<V, LANES>();
        for output in gradient {
            output.finish::<V, LANES>();
        }
    }
}

/// Numbers that are written row by row.
enum Output<'a> {
    Near(&'a mut [f32]),
    /// Past the caches, and from where.
    Away(Away<'a>, Vec<f32>),
}

impl<'a> Output<'a> {
    /// To these numbers, in rows of this length.
    fn to(numbers: &'a mut [f32], width: usize) -> Self {
        if size_of_val(numbers) > LARGE {
            Output::Away(Away::to(numbers), vec![0.0; SIDE_BY_SIDE * width])
        } else {
            Output::Near(numbers)
        }
    }

    /// Where the next rows are to be written.
    fn next(&mut self) -> &mut [f32] {
        match self {
            Output::Near(numbers) => numbers,
            Output::Away(_, rows) => rows,
        }
    }

    /// So many numbers have been written.
    #[inline(always)]
    fn advance<V: Vector<LANES>, const LANES: usize>(&mut self, count: usize) {
        match self {
            Output::Near(numbers) => *numbers = &mut std::mem::take(numbers)[count..],
            Output::Away(away, rows) => away.send::<V, LANES>(&rows[..count]),
        }
    }

    /// There are no more.
    #[inline(always)]
    fn finish<V: Vector<LANES>, const LANES: usize>(self) {
        if let Output::Away(away, _) = self {
            away.finish::<V, LANES>();
        }
    }
}

/// The sums of octaves at the points of some rows of the same cells, from y on; returns how many.
#[inline(always)]
fn add<V: Vector<LANES>, const LANES: usize, const D: usize, const ROWS: usize>(
    states: &[State<V, LANES, D>],
    y: usize,
    width: usize,
    (values, gradient): (&mut [f32], [&mut [f32]; D]),
) -> usize {
    add_part::<V, LANES, D, ROWS, 0>(states, y, width, values);
    if D > 0 {
        add_part::<V, LANES, D, ROWS, 1>(states, y, width, gradient[0]);
    }
    if D > 1 {
        add_part::<V, LANES, D, ROWS, 2>(states, y, width, gradient[1]);
    }
    if D > 2 {
        add_part::<V, LANES, D, ROWS, 3>(states, y, width, gradient[2]);
    }
    ROWS
}

/// The sums of a part: see [`State::blend`].
#[inline(always)]
fn add_part<V: Vector<LANES>, const LANES: usize, const D: usize, const ROWS: usize, const PART: usize>(
    states: &[State<V, LANES, D>],
    y: usize,
    width: usize,
    sums: &mut [f32],
) {
    for vector in 0..width.div_ceil(LANES) {
        let mut totals = [V::constant(0.0); ROWS];
        for state in states {
            let noises = state.blend::<ROWS, PART>(vector, y);
            for row in 0..ROWS {
                totals[row] = totals[row] + noises[row];
            }
        }
        for row in 0..ROWS {
            store(totals[row], &mut sums[row * width..][..width], vector);
        }
    }
}

/// [`add`] for sums that are not plain: whose octaves' slopes depend on their values.
#[inline(always)]
fn fold<V: Vector<LANES>, const LANES: usize, const D: usize, const ROWS: usize>(
    combine: Combine,
    states: &[State<V, LANES, D>],
    y: usize,
    width: usize,
    (values, gradient): (&mut [f32], [&mut [f32]; D]),
) -> usize {
    for vector in 0..width.div_ceil(LANES) {
        let mut partials = [Partial::<V, D>::new(); ROWS];
        for state in states {
            let zero = V::constant(0.0);
            let value = state.blend::<ROWS, 0>(vector, y);
            let dx = if D > 0 { state.blend::<ROWS, 1>(vector, y) } else { [zero; ROWS] };
            let dy = if D > 1 { state.blend::<ROWS, 2>(vector, y) } else { [zero; ROWS] };
            let dz = if D > 2 { state.blend::<ROWS, 3>(vector, y) } else { [zero; ROWS] };
            for row in 0..ROWS {
                let mut noise = Dual { value: value[row], gradient: [zero; D] };
                for axis in 0..D {
                    noise.gradient[axis] = [dx[row], dy[row], dz[row]][axis];
                }
                let Octave { frequency, amplitude, .. } = *state.octave;
                partials[row].add::<true>(combine, frequency, amplitude, combine.fold::<V, D, true>(noise));
            }
        }
        for row in 0..ROWS {
            let Dual { value, gradient: slopes } = partials[row].sum;
            store(value, &mut values[row * width..][..width], vector);
            for axis in 0..D {
                store(slopes[axis], &mut gradient[axis][row * width..][..width], vector);
            }
        }
    }
    ROWS
}

/// Writes a vector of a row, of the last one as many lanes as there are points.
#[inline(always)]
fn store<V: Vector<LANES>, const LANES: usize>(numbers: V, row: &mut [f32], vector: usize) {
    let row = &mut row[vector * LANES..];
    match row.first_chunk_mut() {
        Some(row) => numbers.store(row),
        None => {
            let mut lanes = [0.0; LANES];
            numbers.store(&mut lanes);
            row.copy_from_slice(&lanes[..row.len()]);
        }
    }
}

/// What a row of lattice points contributes: slopes along x and y, and the rest.
struct Lattice {
    bx: Vec<f32>,
    by: Vec<f32>,
    c: Vec<f32>,
}

impl Lattice {
    /// Of nothing, with room for so many points.
    fn new(room: usize) -> Self {
        Lattice { bx: vec![0.0; room], by: vec![0.0; room], c: vec![0.0; room] }
    }
}

/// An octave on its way through the rows.
struct State<'a, V: Real, const LANES: usize, const D: usize> {
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
    /// Its derivative along z, with three slopes.
    lattice_along_z: Lattice,
    /// For each vector of points where its window of lattice points begins, and where its points are in there.
    windows: Vec<(usize, V::Int)>,
    /// For each vector of points P and Q of the lower and of the upper row of lattice points.
    columns: Vec<[V; 4]>,
    /// Their derivatives along x, and along z, as far as there are slopes (in plain sums times the frequency).
    along_x: Vec<[V; 4]>,
    along_z: Vec<[V; 4]>,
    /// The lower row in `columns`, if there is one.
    row: Option<usize>,
    plane: usize,
    /// For each row of points what P and Q are multiplied by (in plain sums times the amplitude).
    factors: Vec<[f32; 4]>,
    /// Their derivatives along y, if there are slopes along it (in plain sums times the frequency).
    slope_factors: Vec<[f32; 4]>,
    /// What derivatives are multiplied by.
    steepness: f32,
}

/// The hashes of so many lattice points are kept from plane to plane, where several planes lie between the same ones.
const KEPT: usize = 1 << 14;

impl<'a, V: Vector<LANES>, const LANES: usize, const D: usize> State<'a, V, LANES, D> {
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
        let (scale, steepness) = match combine {
            Combine::Plain => (octave.amplitude as f32, octave.frequency as f32),
            _ => (1.0, 1.0),
        };
        let (mut factors, mut slope_factors) = (Vec::new(), Vec::new());
        for (i, (low, high)) in y.from_low.iter().zip(&y.from_high).enumerate() {
            let (lower, upper) = (scale * (1.0 - y.curve[i]), scale * y.curve[i]);
            factors.push([lower, lower * low, upper, upper * high]);
            if D > 1 {
                let (slope, lower, upper) = (scale * steepness * y.slope[i], steepness * lower, steepness * upper);
                slope_factors.push([-slope, lower - slope * low, slope, upper + slope * high]);
            }
        }
        let mut hashes: Vec<i32> = x.lattice.iter().map(hash).collect();
        hashes.resize(room, 0);
        State {
            octave,
            hashes,
            below: vec![0; room * kept],
            above: vec![0; room * kept],
            hashed: vec![None; kept],
            room,
            lattice: Lattice::new(room),
            lattice_along_z: Lattice::new(if D > 2 { room } else { 0 }),
            windows: chunks.iter().map(window).collect(),
            columns: vec![[V::constant(0.0); 4]; chunks.len()],
            along_x: vec![[V::constant(0.0); 4]; if D > 0 { chunks.len() } else { 0 }],
            along_z: vec![[V::constant(0.0); 4]; if D > 2 { chunks.len() } else { 0 }],
            row: None,
            plane: 0,
            factors,
            slope_factors,
            steepness,
        }
    }

    #[inline(always)]
    fn start_plane(&mut self, z: usize) {
        (self.plane, self.row) = (z, None);
    }

    /// A part of the octave at a vector of points in each of some rows: the noise (0), or its derivative along an axis (1 to 3).
    #[inline(always)]
    fn blend<const ROWS: usize, const PART: usize>(&self, vector: usize, y: usize) -> [V; ROWS] {
        let columns = match PART {
            1 => &self.along_x,
            3 => &self.along_z,
            _ => &self.columns,
        };
        let [p0, q0, p1, q1] = columns[vector];
        let factors = if PART == 2 { &self.slope_factors } else { &self.factors };
        let factors: &[[f32; 4]; ROWS] = factors[y..].first_chunk().expect("there are so many rows");
        let mut blends = [p0; ROWS];
        for row in 0..ROWS {
            let [a, b, c, d] = factors[row];
            blends[row] = (p0 * V::splat(a) + q0 * V::splat(b)) + (p1 * V::splat(c) + q1 * V::splat(d));
        }
        blends
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
            for columns in [&mut self.columns, &mut self.along_x, &mut self.along_z] {
                for column in columns {
                    (column[0], column[1]) = (column[2], column[3]);
                }
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
        let (w, slope) = (axis.curve[self.plane], axis.slope[self.plane] * self.steepness);
        let (low, high) = (1.0 - w, w);
        let (from_low, from_high) = (axis.from_low[self.plane], axis.from_high[self.plane]);
        let (basis, tables) = (self.octave.noise.basis(), self.octave.noise.tables());
        let hashes = [&self.below[at..], &self.above[at..]];
        let weights = Weights { slopes: [low, high], rest: [from_low * low, from_high * high] };
        self.lattice.blend::<V, LANES>(basis, tables, hashes, weights);
        if D > 2 {
            let (low, high) = (low * self.steepness, high * self.steepness);
            let rest = [low - from_low * slope, high + from_high * slope];
            self.lattice_along_z.blend::<V, LANES>(basis, tables, hashes, Weights { slopes: [-slope, slope], rest });
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
        let steepness = V::splat(self.steepness);
        let offsets = x.from_low.as_chunks().0.iter().zip(x.from_high.as_chunks().0).zip(x.curve.as_chunks().0);
        let columns = self.columns.iter_mut().zip(&self.windows).enumerate();
        for ((i, (column, &window)), ((low, high), u)) in columns.zip(offsets) {
            let (offsets, u) = ([V::load(low), V::load(high)], V::load(u));
            let [p, q, bx] = self.lattice.ends(window, offsets);
            (column[2], column[3]) = (lerp(u, p[0], p[1]), lerp(u, q[0], q[1]));
            if D > 0 {
                let slope = V::load(&x.slope.as_chunks().0[i]);
                let along_x = &mut self.along_x[i];
                along_x[2] = steepness * (lerp(u, bx[0], bx[1]) + slope * (p[1] - p[0]));
                along_x[3] = steepness * (slope * (q[1] - q[0]));
            }
            if D > 2 {
                let [p, q, _] = self.lattice_along_z.ends(window, offsets);
                let along_z = &mut self.along_z[i];
                (along_z[2], along_z[3]) = (lerp(u, p[0], p[1]), lerp(u, q[0], q[1]));
            }
        }
    }
}

/// What the slopes of the lattice points below and above z are multiplied by, along x and y, and along z. (Numbers: as the slopes along x.)
struct Weights {
    slopes: [f32; 2],
    rest: [f32; 2],
}

impl Lattice {
    /// What lattice points below and above z contribute, from their hashes.
    #[inline(always)]
    fn blend<V: Vector<LANES>, const LANES: usize>(
        &mut self,
        basis: Basis,
        tables: &Tables,
        [below, above]: [&[i32]; 2],
        weights: Weights,
    ) {
        let [low, high] = [V::splat(weights.slopes[0]), V::splat(weights.slopes[1])];
        let [from_low, from_high] = [V::splat(weights.rest[0]), V::splat(weights.rest[1])];
        let Lattice { bx, by, c } = self;
        let outputs = bx.as_chunks_mut().0.iter_mut().zip(by.as_chunks_mut().0).zip(c.as_chunks_mut().0);
        let hashes = below.as_chunks().0.iter().zip(above.as_chunks().0);
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

    /// P, Q and the slopes along x at the lattice points left and right of points in a window, seen from these offsets.
    #[inline(always)]
    fn ends<V: Vector<LANES>, const LANES: usize>(
        &self,
        (start, places): (usize, V::Int),
        [low, high]: [V; 2],
    ) -> [[V; 2]; 3] {
        let Lattice { bx, by, c } = self;
        let (bx0, bx1) = (pick::<V, LANES>(bx, start, places), pick::<V, LANES>(bx, start + 1, places));
        let left = pick::<V, LANES>(c, start, places) + bx0 * low;
        let right = pick::<V, LANES>(c, start + 1, places) + bx1 * high;
        let (by0, by1) = (pick::<V, LANES>(by, start, places), pick::<V, LANES>(by, start + 1, places));
        [[left, right], [by0, by1], [bx0, bx1]]
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
