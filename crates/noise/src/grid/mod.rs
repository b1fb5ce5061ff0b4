//! Uniform grids of points, and how they are evaluated by cells.
//!
//! Between two lattice planes along y, the noise at one z is, for each x, a polynomial in y of four coefficients; and those
//! follow from the lattice points left and right of x. So the coefficients are computed once for each row of cells, and a
//! point costs four products and their sum: see [`rows`].

mod axis;
mod rows;

use crate::basis::Basis;
use crate::noise::Noise;
use crate::simd::{self, Level};
use crate::sum::{Combine, Sum};
use axis::Axis;
use rows::{Octave, Rows};

/// A uniform grid of points in one to four dimensions: the point (i, j, k) is origin + (i, j, k) · step, in single
/// precision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid<const D: usize> {
    /// The first point.
    pub origin: [f32; D],
    /// The distance of neighbours along each axis.
    pub step: [f32; D],
    /// The number of points along each axis.
    pub count: [usize; D],
}

impl<const D: usize> Grid<D> {
    /// The number of points.
    ///
    /// # Panics
    /// When it is beyond `usize`.
    pub fn len(&self) -> usize {
        let product = self.count.iter().try_fold(1usize, |product, &count| product.checked_mul(count));
        product.expect("a grid has at most `usize::MAX` points")
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.count.contains(&0)
    }

    /// A coordinate of the grid. (The sum in double precision, rounded once.)
    pub fn coordinate(&self, axis: usize, index: usize) -> f32 {
        (f64::from(self.origin[axis]) + index as f64 * f64::from(self.step[axis])) as f32
    }

    /// The coordinates along an axis.
    fn coordinates(&self, axis: usize) -> Vec<f32> {
        (0..self.count[axis]).map(|index| self.coordinate(axis, index)).collect()
    }
}

impl Noise {
    /// The values on a grid, x first, then y, and so on.
    ///
    /// Improved, classic, lattice and value noise in up to three dimensions, on grids finer than their cells, are evaluated
    /// by cells: within 2e-6 of [`Noise::fill`], from which they differ by rounding (the bits are the same with every
    /// set of instructions). All else has the bits of [`Noise::fill`].
    ///
    /// # Panics
    /// When `values` has another length than the grid.
    pub fn fill_grid<const D: usize>(&self, grid: &Grid<D>, values: &mut [f32]) {
        self.fill_grid_at(simd::level(), grid, values);
    }

    /// [`Noise::fill_grid`] with the instructions of a level, at most those of the machine. For tests and measurements.
    ///
    /// # Panics
    /// When `values` has another length than the grid.
    pub fn fill_grid_at<const D: usize>(&self, level: Level, grid: &Grid<D>, values: &mut [f32]) {
        Sum::new(self.clone(), Combine::Plain, 1).fill_grid_at(level, grid, values);
    }
}

impl Sum {
    /// The sums on a grid, x first, then y, and so on: by cells as [`Noise::fill_grid`] where every octave can be, within
    /// 2e-6 times the sum of the amplitudes of [`Sum::fill`] (multifractals: ten times that).
    ///
    /// # Panics
    /// When `values` has another length than the grid.
    pub fn fill_grid<const D: usize>(&self, grid: &Grid<D>, values: &mut [f32]) {
        self.fill_grid_at(simd::level(), grid, values);
    }

    /// [`Sum::fill_grid`] with the instructions of a level, at most those of the machine. For tests and measurements.
    ///
    /// # Panics
    /// When `values` has another length than the grid.
    pub fn fill_grid_at<const D: usize>(&self, level: Level, grid: &Grid<D>, values: &mut [f32]) {
        assert_eq!(values.len(), grid.len(), "there is a value for each point of the grid");
        if values.is_empty() {
            return;
        }
        let coordinates: [Vec<f32>; D] = std::array::from_fn(|axis| grid.coordinates(axis));
        match self.octaves_by_cells(&coordinates) {
            Some(octaves) => {
                let count = |axis: usize| coordinates.get(axis).map_or(1, Vec::len);
                let counts = [count(0), count(1)];
                simd::run_wide(level, Rows { combine: self.combine(), octaves, counts, values });
            }
            None => self.fill_points(level, &coordinates, values),
        }
    }

    /// The octaves prepared for an evaluation by cells, if each of them can be.
    fn octaves_by_cells(&self, coordinates: &[Vec<f32>]) -> Option<Vec<Octave<'_>>> {
        let noise = self.noise();
        let by_cells = matches!(noise.basis(), Basis::Improved | Basis::Classic | Basis::Lattice | Basis::Value);
        if !by_cells || coordinates.len() > 3 {
            return None;
        }
        let zero = vec![0.0];
        let prepare = |(frequency, amplitude): (f64, f64)| {
            let axis = |index: usize| {
                let coordinates = coordinates.get(index).unwrap_or(&zero);
                Axis::new(noise, index, coordinates, frequency)
            };
            Some(Octave { noise, frequency, amplitude, axes: [axis(0)?, axis(1)?, axis(2)?] })
        };
        self.frequencies_and_amplitudes().map(prepare).collect()
    }

    /// The sums point by point, row by row.
    fn fill_points<const D: usize>(&self, level: Level, coordinates: &[Vec<f32>; D], values: &mut [f32]) {
        let width = coordinates[0].len();
        let mut columns: [Vec<f32>; D] = std::array::from_fn(|_| vec![0.0; width]);
        columns[0].copy_from_slice(&coordinates[0]);
        for (row, values) in values.chunks_mut(width).enumerate() {
            let mut rest = row;
            for axis in 1..D {
                let count = coordinates[axis].len();
                columns[axis].fill(coordinates[axis][rest % count]);
                rest /= count;
            }
            self.fill_at(level, columns.each_ref().map(Vec::as_slice), values);
        }
    }
}
