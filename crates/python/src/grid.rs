//! `jaspe.noise.Grid`: points that are every combination of coordinates along each axis.

use std::ops::Range;

use jaspe_noise::{Field, Raster};
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods as _};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::points;

/// So many points a thread takes on at a time, if planes are not larger.
const PIECE: usize = 1 << 16;

/// Points that are every combination of the coordinates along each axis, in single precision.
///
/// `Grid(x, y, z)` holds the points `(x[i], y[j], z[k])`; what is evaluated there has the shape `(len(z), len(y), len(x))`: rows
/// along x, as pictures have them. One axis to four. A noise on a grid needs no array of points, and takes a fraction of the time
/// where the grid is finer than the cells of the noise (there it may differ from the noise at `points()` by rounding, by 2e-6 times the sum
/// of the octaves' amplitudes at most, by ten times that for "ridged" and "hybrid"; gradients likewise, by 2e-6 times the sum of amplitudes
/// times frequencies).
///
/// - `axes`: one array of coordinates for each axis.
#[pyclass(frozen, module = "jaspe.noise")]
pub struct Grid {
    axes: Vec<Vec<f32>>,
}

#[pymethods]
impl Grid {
    #[new]
    #[pyo3(signature = (*axes))]
    fn new(axes: &Bound<'_, PyTuple>) -> PyResult<Self> {
        if !(1..=4).contains(&axes.len()) {
            let message = format!("a grid has one to four axes, found {}; for instance Grid(x, y, z)", axes.len());
            return Err(PyTypeError::new_err(message));
        }
        let axes: Vec<Vec<f32>> =
            axes.iter().enumerate().map(|(i, axis)| coordinates(i, &axis)).collect::<Result<_, _>>()?;
        let points = axes.iter().try_fold(1usize, |product, axis| product.checked_mul(axis.len()));
        // (An array has at most so many bytes.)
        if points
            .and_then(|points| points.checked_mul(4 * size_of::<f32>()))
            .is_none_or(|bytes| isize::try_from(bytes).is_err())
        {
            return Err(PyValueError::new_err("a grid of so many points is larger than any array"));
        }
        Ok(Grid { axes })
    }

    /// The coordinates along x, y, and so on.
    #[getter]
    fn axes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.axes.iter().map(|axis| PyArray1::from_slice(py, axis)))
    }

    /// The shape of what is evaluated on the grid: the length of the last axis first, that of x last.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.lengths())
    }

    /// The points one by one: an array of the grid's shape with one more axis, which holds the coordinates.
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let numpy = py.import(intern!(py, "numpy"))?;
        let reversed = PyTuple::new(py, self.axes.iter().rev().map(|axis| PyArray1::from_slice(py, axis)))?;
        let options = pyo3::types::PyDict::new(py);
        options.set_item("indexing", "ij")?;
        let columns: Vec<Bound<'py, PyAny>> =
            numpy.call_method("meshgrid", reversed, Some(&options))?.try_iter()?.collect::<Result<_, _>>()?;
        let columns = PyTuple::new(py, columns.into_iter().rev())?;
        numpy.call_method1(intern!(py, "stack"), (columns, -1))
    }

    #[pyo3(signature = (dtype = None, copy = None))]
    fn __array__<'py>(
        &self,
        py: Python<'py>,
        dtype: Option<&Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        points::copied("a grid", dtype, copy, || self.points(py))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        Ok((py.get_type::<Grid>().into_any(), self.axes(py)?))
    }

    fn __repr__(&self) -> String {
        let lengths: Vec<String> = self.axes.iter().map(|axis| axis.len().to_string()).collect();
        format!("<jaspe.noise.Grid of {} points>", lengths.join(" × "))
    }
}

impl Grid {
    /// The number of axes.
    pub fn dimensions(&self) -> usize {
        self.axes.len()
    }

    fn lengths(&self) -> Vec<usize> {
        self.axes.iter().rev().map(Vec::len).collect()
    }

    /// The values of a field on the grid, and with `gradient` the derivatives along each axis: on all cores and without the
    /// interpreter's lock; Ctrl-C ends it.
    pub fn evaluate<'py>(&self, py: Python<'py>, field: Field, gradient: bool) -> PyResult<Bound<'py, PyAny>> {
        let lengths = self.lengths();
        let values: Bound<'py, PyArrayDyn<f32>> = points::array(py, &lengths)?;
        let width = if gradient { self.dimensions() } else { 0 };
        let slopes: Option<Bound<'py, PyArrayDyn<f32>>> =
            if gradient { Some(points::array(py, &[&lengths[..], &[width]].concat())?) } else { None };
        {
            let mut values = values.readwrite();
            let values = values.as_slice_mut()?;
            let mut slopes = slopes.as_ref().map(|slopes| slopes.readwrite());
            let slopes = slopes.as_mut().map_or(Ok(&mut [][..]), |slopes| slopes.as_slice_mut())?;
            if !values.is_empty() {
                let raster = Raster::new(field, self.axes.clone());
                let plane = raster.plane_len();
                let planes = PIECE.div_ceil(plane);
                let count = values.len();
                let mut slopes = slopes.chunks_mut((planes * plane * width).max(1));
                let pieces = values.chunks_mut(planes * plane).enumerate();
                let pieces = pieces.map(|(piece, values)| {
                    let first = piece * planes;
                    (first..first + values.len() / plane, values, slopes.next().unwrap_or_default())
                });
                points::spread(py, pieces.collect(), count, |(planes, values, slopes)| match width {
                    0 => raster.fill(planes, values),
                    1 => fill_with_gradient::<1>(&raster, planes, values, slopes),
                    2 => fill_with_gradient::<2>(&raster, planes, values, slopes),
                    3 => fill_with_gradient::<3>(&raster, planes, values, slopes),
                    _ => fill_with_gradient::<4>(&raster, planes, values, slopes),
                })?;
            }
        }
        points::with_slopes(py, values.into_any(), slopes)
    }
}

/// The values in some planes, and the derivatives along all axes, point by point.
fn fill_with_gradient<const D: usize>(raster: &Raster, planes: Range<usize>, values: &mut [f32], slopes: &mut [f32]) {
    let mut columns: [Vec<f32>; D] = std::array::from_fn(|_| vec![0.0; values.len()]);
    raster.fill_with_gradient(planes, values, columns.each_mut().map(Vec::as_mut_slice));
    points::interleave(columns.each_ref().map(Vec::as_slice), slopes);
}

/// The coordinates along an axis.
fn coordinates(axis: usize, numbers: &Bound<'_, PyAny>) -> PyResult<Vec<f32>> {
    let py = numbers.py();
    let numpy = py.import(intern!(py, "numpy"))?;
    let array = numpy.call_method1(intern!(py, "asarray"), (numbers,))?;
    let name = ["x", "y", "z", "w"][axis];
    let kind: String = array.getattr(intern!(py, "dtype"))?.getattr(intern!(py, "kind"))?.extract()?;
    if !matches!(kind.as_str(), "f" | "i" | "u") {
        let found: String = array.getattr(intern!(py, "dtype"))?.str()?.extract()?;
        return Err(PyTypeError::new_err(format!(
            "{name}: coordinates are real numbers, found an array of dtype {found}"
        )));
    }
    let shape: Vec<usize> = array.getattr(intern!(py, "shape"))?.extract()?;
    let [_] = shape[..] else {
        let message = format!(
            "{name}: expected the coordinates along one axis, found an array of shape {}; for instance numpy.arange(256) / 32",
            points::tuple(&shape)
        );
        return Err(PyValueError::new_err(message));
    };
    let array = numpy.call_method1(intern!(py, "ascontiguousarray"), (array, "float32"))?;
    Ok(array.cast::<PyArray1<f32>>()?.readonly().as_slice()?.to_vec())
}
