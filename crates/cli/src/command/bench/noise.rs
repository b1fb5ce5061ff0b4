//! `jaspe bench noise`.

use std::cell::RefCell;
use std::hint::black_box;
use std::io::{self, Write};

use clap::Args;
use jaspe_noise::{Basis, Combine, Grid, Noise as Lattice, Sum, simd};

use super::stopwatch::{Work, time_in_turn};
use crate::Outcome;
use crate::failure::Failure;

/// Points in a slice: they and their values stay in the cache.
const COUNT: usize = 16_384;

/// Points along each side of a grid.
pub const SIDE: usize = 128;

/// Print how many million points per second the noises make on one thread, with ratios to other noise crates.
///
/// The other crates take part when the program was built with them: cargo run --release --features bench-peers -- bench
/// noise. A ratio says how many times as long as ours the other takes for the same number of points. Set
/// JASPE_SIMD=avx2 (or sse, scalar) to see ours with fewer instructions.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  jaspe bench noise
  JASPE_SIMD=avx2 jaspe bench noise")]
pub struct Noise {}

/// Coordinates within ±50, from a reproducible sequence, and room for values.
pub struct Points {
    pub columns: [Vec<f32>; 3],
    pub values: RefCell<Vec<f32>>,
}

impl Points {
    fn new() -> Points {
        let mut state = 1u64;
        let mut coordinate = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 40) as f32 / (1 << 23) as f32 - 1.0) * 50.0
        };
        let columns = [(); 3].map(|()| (0..COUNT).map(|_| coordinate()).collect());
        Points { columns, values: RefCell::new(vec![0.0; COUNT.max(SIDE * SIDE * SIDE)]) }
    }

    /// Fills the values by a function of one point.
    pub fn each(&self, value: impl Fn([f32; 3]) -> f32) {
        let [x, y, z] = &self.columns;
        for (i, out) in self.values.borrow_mut()[..COUNT].iter_mut().enumerate() {
            *out = value(black_box([x[i], y[i], z[i]]));
        }
    }
}

/// A row of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Row {
    Improved,
    Octaves,
    Batches,
    Single,
    SingleOctaves,
    Grid,
    GridOctaves,
    Gradient,
    Simplex,
    Cellular,
    Value,
}

impl Row {
    const ALL: [(Row, &'static str); 11] = [
        (Row::Improved, "improved, scattered"),
        (Row::Octaves, "  five octaves"),
        (Row::Batches, "  batches of 64"),
        (Row::Single, "  one point a call"),
        (Row::SingleOctaves, "  one point, five octaves"),
        (Row::Grid, "  grid, step 0.02"),
        (Row::GridOctaves, "  grid, five octaves"),
        (Row::Gradient, "  with exact gradient"),
        (Row::Simplex, "simplex, scattered"),
        (Row::Cellular, "cellular F1, scattered"),
        (Row::Value, "value, scattered"),
    ];

    fn points(self) -> usize {
        if matches!(self, Row::Grid | Row::GridOctaves) { SIDE * SIDE * SIDE } else { COUNT }
    }
}

/// The step of the grids.
pub const STEP: f32 = 0.02;

impl Noise {
    /// Prints the table.
    pub fn run(self) -> Result<Outcome, Failure> {
        let points = Points::new();
        let mut out = io::stdout().lock();
        writeln!(out, "million points per second, one thread, {}", simd::level().name())?;
        for (row, title) in Row::ALL {
            let mut works = vec![ours(row, &points)];
            #[cfg(feature = "bench-peers")]
            works.extend(super::peers::works(row, &points));
            let times = time_in_turn(&mut works);
            write!(out, "{title:26}")?;
            for (work, time) in works.iter().zip(&times) {
                let rate = row.points() as f64 / time.seconds * 1e-6;
                match work.name {
                    "jaspe" => write!(out, "{rate:9.1}")?,
                    name => write!(out, "   {name} {rate:.1} ({:.1} x)", time.ratio)?,
                }
            }
            writeln!(out)?;
            out.flush()?;
        }
        if cfg!(not(feature = "bench-peers")) {
            eprintln!("for ratios to other crates: cargo run --release --features bench-peers -- bench noise");
        }
        Ok(Outcome::Done)
    }
}

/// Our own work.
fn ours<'a>(row: Row, points: &'a Points) -> Work<'a> {
    let basis = match row {
        Row::Simplex => Basis::Simplex,
        Row::Cellular => Basis::Cellular,
        Row::Value => Basis::Value,
        _ => Basis::Improved,
    };
    let noise = Lattice::new(basis, 0);
    let sum = Sum::new(noise.clone(), Combine::Plain, 5);
    let [x, y, z] = points.columns.each_ref().map(Vec::as_slice);
    let grid = Grid { origin: [0.1, 0.2, 0.3], step: [STEP; 3], count: [SIDE; 3] };
    let mut slopes = [(); 3].map(|()| vec![0.0; COUNT]);
    let run: Box<dyn FnMut()> = match row {
        Row::Improved | Row::Simplex | Row::Cellular | Row::Value => {
            Box::new(move || noise.fill([x, y, z], &mut points.values.borrow_mut()[..COUNT]))
        }
        Row::Octaves => Box::new(move || sum.fill([x, y, z], &mut points.values.borrow_mut()[..COUNT])),
        Row::Batches => Box::new(move || {
            for (batch, values) in points.values.borrow_mut()[..COUNT].chunks_mut(64).enumerate() {
                let at = batch * 64..batch * 64 + values.len();
                noise.fill([&x[at.clone()], &y[at.clone()], &z[at]], black_box(values));
            }
        }),
        Row::Single => Box::new(move || points.each(|point| noise.at(point))),
        Row::SingleOctaves => Box::new(move || points.each(|point| sum.at(point))),
        Row::Grid => Box::new(move || noise.fill_grid(&grid, &mut points.values.borrow_mut()[..grid.len()])),
        Row::GridOctaves => Box::new(move || sum.fill_grid(&grid, &mut points.values.borrow_mut()[..grid.len()])),
        Row::Gradient => Box::new(move || {
            let gradient = slopes.each_mut().map(Vec::as_mut_slice);
            noise.fill_with_gradient([x, y, z], &mut points.values.borrow_mut()[..COUNT], gradient);
        }),
    };
    Work { name: "jaspe", run }
}
