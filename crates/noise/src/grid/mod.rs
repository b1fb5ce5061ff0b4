//! Uniform grids of points, and how they are evaluated by cells.
//!
//! Between two lattice planes along y, the noise at one z is, for each x, a polynomial in y of four coefficients; and those
//! follow from the lattice points left and right of x. So the coefficients are computed once for each row of cells, and a
//! point costs four products and their sum: see [`rows`].

mod axis;
mod rows;

use std::ops::Range;

use crate::basis::Basis;
use crate::noise::Noise;
use crate::simd::{self, Level};
use crate::sum::{Combine, Sum};
use crate::warp::Field;
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

    /// The coordinates along each axis.
    fn axes(&self) -> Vec<Vec<f32>> {
        let along = |axis| (0..self.count[axis]).map(|index| self.coordinate(axis, index)).collect();
        (0..D).map(along).collect()
    }
}

/// A field on a grid of any coordinates along each axis, made ready once to be evaluated as a whole or in parts: by several
/// threads, say.
///
/// Sums of improved, classic, lattice and value noise in up to three dimensions, on axes that rise from point to point by less than a
/// cell of every octave, are evaluated by cells: within 2e-6 times the sum of the amplitudes of [`Field::fill`] (multifractals: ten times
/// that), from which they differ by rounding (the bits are the same with every set of instructions, and in whatever
/// parts). Derivatives likewise: within 2e-6 times the sum of amplitudes times frequencies (multifractals: ten times that) of
/// [`Field::fill_with_gradient`], but for kinks, where a value within rounding of zero may fold to the other side. All else
/// has the bits of [`Field::fill`] and [`Field::fill_with_gradient`].
#[derive(Debug, Clone)]
pub struct Raster {
    source: Source,
    axes: Vec<Vec<f32>>,
    /// The octaves prepared for an evaluation by cells, if each of them can be.
    by_cells: Option<(Combine, Vec<Octave>)>,
}

/// What is evaluated at the points of a grid.
#[derive(Debug, Clone)]
enum Source {
    Field(Field),
    /// A sum seen through footprints of this side.
    Filtered(Sum, f32),
}

impl Raster {
    /// The field at every combination of these coordinates along x, y, and so on.
    ///
    /// # Panics
    /// Unless there are one to four axes.
    pub fn new(field: impl Into<Field>, axes: Vec<Vec<f32>>) -> Self {
        let field = field.into();
        let by_cells = match &field {
            Field::Noise(noise) => by_cells(&noise.clone().into(), &axes),
            Field::Sum(sum) => by_cells(sum, &axes),
            Field::Warp(_) => None,
        };
        Raster { by_cells, ..Raster::of_points(Source::Field(field), axes) }
    }

    /// The sum (or noise) at every combination of these coordinates, as it looks through a sample of the side `footprint`:
    /// point by point, with the bits of [`Sum::fill_filtered`] and [`Sum::fill_filtered_with_gradient`].
    ///
    /// # Panics
    /// Unless there are one to four axes.
    pub fn filtered(sum: impl Into<Sum>, axes: Vec<Vec<f32>>, footprint: f32) -> Self {
        Raster::of_points(Source::Filtered(sum.into(), footprint), axes)
    }

    /// To be evaluated point by point.
    fn of_points(source: Source, axes: Vec<Vec<f32>>) -> Self {
        assert!((1..=4).contains(&axes.len()), "a grid has one to four axes");
        Raster { source, axes, by_cells: None }
    }

    /// The number of parts that can be evaluated by themselves: the length of the last axis (of one axis alone, 1).
    pub fn planes(&self) -> usize {
        if self.axes.len() == 1 { 1 } else { self.axes[self.axes.len() - 1].len() }
    }

    /// The number of points in each of those.
    ///
    /// # Panics
    /// When it is beyond `usize`.
    pub fn plane_len(&self) -> usize {
        let inner = &self.axes[..(self.axes.len() - 1).max(1)];
        let product = inner.iter().try_fold(1usize, |product, axis| product.checked_mul(axis.len()));
        product.expect("a plane has at most `usize::MAX` points")
    }

    /// The values in some planes, x first, then y, and so on.
    ///
    /// # Panics
    /// When there are no such planes, or `values` has another length than they have points.
    pub fn fill(&self, planes: Range<usize>, values: &mut [f32]) {
        self.fill_at(simd::level(), planes, values);
    }

    /// [`Raster::fill`] with the instructions of a level, at most those of the machine. For tests and measurements.
    ///
    /// # Panics
    /// When there are no such planes, or `values` has another length than they have points.
    pub fn fill_at(&self, level: Level, planes: Range<usize>, values: &mut [f32]) {
        self.assert_planes(&planes, values.len());
        if values.is_empty() {
            return;
        }
        match (&self.by_cells, self.axes.len()) {
            (Some(_), _) => self.fill_by_cells(level, planes, values, []),
            (None, 1) => self.fill_points::<1>(level, planes, values),
            (None, 2) => self.fill_points::<2>(level, planes, values),
            (None, 3) => self.fill_points::<3>(level, planes, values),
            (None, _) => self.fill_points::<4>(level, planes, values),
        }
    }

    /// The values, and the derivatives along the first axes, by cells.
    fn fill_by_cells<const D: usize>(
        &self,
        level: Level,
        planes: Range<usize>,
        values: &mut [f32],
        gradient: [&mut [f32]; D],
    ) {
        let (combine, octaves) = self.by_cells.as_ref().expect("it was found to be possible");
        let rows = match self.axes.len() {
            1 => [0..1, 0..1],
            2 => [planes, 0..1],
            _ => [0..self.axes[1].len(), planes],
        };
        let width = self.axes[0].len();
        simd::run_wide(level, Rows { combine: *combine, octaves, width, rows, values, gradient });
    }

    /// The values in some planes, with the bits of [`Raster::fill`], and the exact derivatives along each axis.
    ///
    /// # Panics
    /// When there are no such planes or not D axes, or a slice has another length than they have points.
    pub fn fill_with_gradient<const D: usize>(
        &self,
        planes: Range<usize>,
        values: &mut [f32],
        gradient: [&mut [f32]; D],
    ) {
        self.fill_with_gradient_at(simd::level(), planes, values, gradient);
    }

    /// [`Raster::fill_with_gradient`] with the instructions of a level, at most those of the machine. For tests and measurements.
    ///
    /// # Panics
    /// When there are no such planes or not D axes, or a slice has another length than they have points.
    pub fn fill_with_gradient_at<const D: usize>(
        &self,
        level: Level,
        planes: Range<usize>,
        values: &mut [f32],
        mut gradient: [&mut [f32]; D],
    ) {
        assert_eq!(self.axes.len(), D, "there is a derivative for each axis");
        simd::assert_lengths(&gradient, values.len());
        self.assert_planes(&planes, values.len());
        if values.is_empty() {
            return;
        }
        match (&self.by_cells, &mut gradient[..]) {
            (Some(_), [x]) => return self.fill_by_cells(level, planes, values, [x]),
            (Some(_), [x, y]) => return self.fill_by_cells(level, planes, values, [x, y]),
            (Some(_), [x, y, z]) => return self.fill_by_cells(level, planes, values, [x, y, z]),
            _ => {}
        }
        let footprints = self.footprints();
        self.for_each_row::<D>(planes, values.len(), |points, row| {
            let gradient = gradient.each_mut().map(|part| &mut part[row.clone()]);
            let values = &mut values[row];
            match &self.source {
                Source::Field(field) => field.fill_with_gradient_at(level, points, values, gradient),
                Source::Filtered(sum, _) => {
                    sum.fill_filtered_with_gradient_at(level, points, &footprints, values, gradient);
                }
            }
        });
    }

    /// The footprints of the points of a row, if they have any.
    fn footprints(&self) -> Vec<f32> {
        match self.source {
            Source::Field(_) => Vec::new(),
            Source::Filtered(_, footprint) => vec![footprint; self.axes[0].len()],
        }
    }

    /// # Panics
    /// When there are no such planes, or another number of values than they have points.
    #[track_caller]
    fn assert_planes(&self, planes: &Range<usize>, values: usize) {
        assert!(planes.end <= self.planes(), "there are so many planes");
        assert_eq!(values, planes.len() * self.plane_len(), "there is a value for each point of the planes");
    }

    /// The values point by point.
    fn fill_points<const D: usize>(&self, level: Level, planes: Range<usize>, values: &mut [f32]) {
        let footprints = self.footprints();
        self.for_each_row::<D>(planes, values.len(), |points, row| match &self.source {
            Source::Field(field) => field.fill_at(level, points, &mut values[row]),
            Source::Filtered(sum, _) => sum.fill_filtered_at(level, points, &footprints, &mut values[row]),
        });
    }

    /// The coordinates of so many points in some planes row by row, and which of those points they are.
    fn for_each_row<const D: usize>(
        &self,
        planes: Range<usize>,
        count: usize,
        mut evaluate: impl FnMut([&[f32]; D], Range<usize>),
    ) {
        if count == 0 {
            return;
        }
        let width = self.axes[0].len();
        let mut columns: [Vec<f32>; D] = std::array::from_fn(|_| vec![0.0; width]);
        columns[0].copy_from_slice(&self.axes[0]);
        let first = planes.start * (self.plane_len() / width);
        for row in 0..count / width {
            let mut rest = first + row;
            for (column, coordinates) in columns.iter_mut().zip(&self.axes).skip(1) {
                column.fill(coordinates[rest % coordinates.len()]);
                rest /= coordinates.len();
            }
            evaluate(columns.each_ref().map(Vec::as_slice), row * width..(row + 1) * width);
        }
    }
}

/// The octaves of a sum prepared for an evaluation by cells, if each of them can be.
fn by_cells(sum: &Sum, axes: &[Vec<f32>]) -> Option<(Combine, Vec<Octave>)> {
    let noise = sum.noise();
    let may_be = matches!(noise.basis(), Basis::Improved | Basis::Classic | Basis::Lattice | Basis::Value);
    if !may_be || axes.len() > 3 {
        return None;
    }
    let prepare = |(frequency, amplitude): (f64, f64)| {
        let axis = |index: usize| {
            let coordinates = axes.get(index).map_or(&[0.0][..], Vec::as_slice);
            Axis::new(noise, index, coordinates, frequency)
        };
        Some(Octave { noise: noise.clone(), frequency, amplitude, axes: [axis(0)?, axis(1)?, axis(2)?] })
    };
    let octaves: Option<Vec<Octave>> = sum.frequencies_and_amplitudes().map(prepare).collect();
    Some((sum.combine(), octaves?))
}

impl Noise {
    /// The values on a grid, x first, then y, and so on: as [`Raster`] says.
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
        fill_all(&Raster::new(self.clone(), grid.axes()), level, grid, values);
    }

    /// [`Noise::fill_grid`], and the exact derivatives along each axis.
    ///
    /// # Panics
    /// When a slice has another length than the grid.
    pub fn fill_grid_with_gradient<const D: usize>(
        &self,
        grid: &Grid<D>,
        values: &mut [f32],
        gradient: [&mut [f32]; D],
    ) {
        fill_all_with_gradient(&Raster::new(self.clone(), grid.axes()), values, gradient);
    }
}

impl Sum {
    /// The sums on a grid, x first, then y, and so on: as [`Raster`] says.
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
        fill_all(&Raster::new(self.clone(), grid.axes()), level, grid, values);
    }

    /// [`Sum::fill_grid`], and the exact derivatives along each axis.
    ///
    /// # Panics
    /// When a slice has another length than the grid.
    pub fn fill_grid_with_gradient<const D: usize>(
        &self,
        grid: &Grid<D>,
        values: &mut [f32],
        gradient: [&mut [f32]; D],
    ) {
        fill_all_with_gradient(&Raster::new(self.clone(), grid.axes()), values, gradient);
    }

    /// The sums on a grid as they look through samples of the side `footprint`, x first, then y, and so on: as
    /// [`Raster::filtered`] says.
    ///
    /// # Panics
    /// When `values` has another length than the grid.
    pub fn fill_grid_filtered<const D: usize>(&self, grid: &Grid<D>, footprint: f32, values: &mut [f32]) {
        fill_all(&Raster::filtered(self.clone(), grid.axes(), footprint), simd::level(), grid, values);
    }

    /// [`Sum::fill_grid_filtered`], and the exact derivatives along each axis.
    ///
    /// # Panics
    /// When a slice has another length than the grid.
    pub fn fill_grid_filtered_with_gradient<const D: usize>(
        &self,
        grid: &Grid<D>,
        footprint: f32,
        values: &mut [f32],
        gradient: [&mut [f32]; D],
    ) {
        fill_all_with_gradient(&Raster::filtered(self.clone(), grid.axes(), footprint), values, gradient);
    }
}

/// The values in all planes of the raster of a grid.
#[track_caller]
fn fill_all<const D: usize>(raster: &Raster, level: Level, grid: &Grid<D>, values: &mut [f32]) {
    assert_eq!(values.len(), grid.len(), "there is a value for each point of the grid");
    raster.fill_at(level, 0..raster.planes(), values);
}

/// [`fill_all`], and the derivatives.
#[track_caller]
fn fill_all_with_gradient<const D: usize>(raster: &Raster, values: &mut [f32], gradient: [&mut [f32]; D]) {
    raster.fill_with_gradient(0..raster.planes(), values, gradient);
}
