//! Arrays of points: of any shape, strides and kind of number, as columns of coordinates, a chunk at a time.

use std::ops::Range;
use std::sync::atomic::Ordering;

use numpy::ndarray::{ArrayView2, ArrayViewD, Axis, Slice};
use numpy::{Element, PyArrayDyn, PyArrayMethods as _, PyReadonlyArrayDyn, PyUntypedArrayMethods as _};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use rayon::prelude::*;

use crate::work;

/// Points that are worked on at a time by one thread: their columns stay in the fastest caches.
pub const CHUNK: usize = 2048;

/// So few points are done before anybody presses Ctrl-C.
const SHORT: usize = 64 * CHUNK;

/// The coordinates of points along the last axis, in single or double precision.
pub enum Points<'py> {
    Single(PyReadonlyArrayDyn<'py, f32>),
    Double(PyReadonlyArrayDyn<'py, f64>),
}

impl<'py> Points<'py> {
    /// Anything that NumPy makes an array of. Single precision stays as it is, and half precision becomes it; all other
    /// real numbers are taken as double precision. `dimensions` are the numbers of coordinates that a point may have.
    pub fn new(points: &Bound<'py, PyAny>, dimensions: &[usize]) -> PyResult<Self> {
        let py = points.py();
        let numpy = py.import(intern!(py, "numpy"))?;
        let array = numpy.call_method1(intern!(py, "asarray"), (points,))?;
        let dtype = array.getattr(intern!(py, "dtype"))?;
        let kind: String = dtype.getattr(intern!(py, "kind"))?.extract()?;
        let size: usize = dtype.getattr(intern!(py, "itemsize"))?.extract()?;
        let wanted = match (kind.as_str(), size) {
            ("f", 2 | 4) => "float32",
            ("f" | "i" | "u", _) => "float64",
            _ => {
                let name: String = dtype.str()?.extract()?;
                let message = format!("points are real numbers, found an array of dtype {name}");
                return Err(PyTypeError::new_err(message + "; convert it first: points.astype(numpy.float32)"));
            }
        };
        // A copy only where the byte order, the alignment or the kind of number asks for one.
        let array = numpy.call_method1(intern!(py, "require"), (array, wanted, intern!(py, "A")))?;
        let shape: Vec<usize> = array.getattr(intern!(py, "shape"))?.extract()?;
        check_shape(&shape, dimensions)?;
        Ok(match wanted {
            "float32" => Points::Single(array.cast::<PyArrayDyn<f32>>()?.readonly()),
            _ => Points::Double(array.cast::<PyArrayDyn<f64>>()?.readonly()),
        })
    }

    /// The number of coordinates of a point.
    pub fn dimensions(&self) -> usize {
        let shape = match self {
            Points::Single(array) => array.shape(),
            Points::Double(array) => array.shape(),
        };
        shape.last().copied().unwrap_or(0)
    }
}

fn check_shape(shape: &[usize], dimensions: &[usize]) -> PyResult<()> {
    let hint = match shape {
        [.., last] if dimensions.contains(last) => return Ok(()),
        [] => "a single number is no point: give an array whose last axis holds the coordinates",
        [_] if dimensions.contains(&1) => "for points on a line add an axis: points[..., None]",
        _ if shape.iter().any(|side| dimensions.contains(side)) => {
            "move the coordinates to the last axis: numpy.moveaxis, or numpy.stack((x, y, z), axis=-1)"
        }
        _ => "for instance numpy.stack((x, y, z), axis=-1)",
    };
    let (expected, found) = (listed(dimensions), tuple(shape));
    Err(PyValueError::new_err(format!(
        "the last axis of points holds {expected} coordinates, found an array of shape {found}; {hint}"
    )))
}

/// `1, 2 or 3`.
fn listed(numbers: &[usize]) -> String {
    let words: Vec<String> = numbers.iter().map(usize::to_string).collect();
    match words.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => words.concat(),
    }
}

/// A shape as Python writes it.
fn tuple(shape: &[usize]) -> String {
    match shape {
        [side] => format!("({side},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// An array for results, of the shape of the points without their last axis, with these axes added. What it holds is left over
/// from elsewhere, until all of it is written. (NumPy asks for large pages where it need not clear them: with zeros, the system would
/// take longer for the pages than the noise for the values.)
pub fn results<'py, T: Element>(
    py: Python<'py>,
    points: &[usize],
    added: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let shape = [&points[..points.len() - 1], added].concat();
    let numpy = py.import(intern!(py, "numpy"))?;
    let array = numpy.call_method1(intern!(py, "empty"), (PyTuple::new(py, shape)?, T::get_dtype(py)))?;
    Ok(array.cast_into()?)
}

/// The array, or the number if it has no axes.
pub fn array_or_number<'py, T: Element>(array: Bound<'py, PyArrayDyn<T>>) -> PyResult<Bound<'py, PyAny>> {
    if array.ndim() == 0 { array.get_item(()) } else { Ok(array.into_any()) }
}

/// A chunk of the points, and where its results go.
struct Piece<'a, U> {
    points: Range<usize>,
    values: &'a mut [U],
    more: &'a mut [U],
}

/// Evaluates `work` for all points: it is given columns of coordinates, and the results for them: `widths[0]` numbers for
/// each point in `values`, and `widths[1]` in `more` (which is empty for none). On all cores and without the interpreter's
/// lock; Ctrl-C ends it. Which thread does which chunk leaves no trace.
///
/// (Another thread of the program may write to the points meanwhile, as with any function of NumPy that releases the lock;
/// it gets values of the old points or the new ones.)
pub fn evaluate<T: Element + Copy + Default, U: Send, const D: usize>(
    py: Python<'_>,
    points: ArrayViewD<'_, T>,
    values: &mut [U],
    more: &mut [U],
    widths: [usize; 2],
    work: impl Fn([&[T]; D], &mut [U], &mut [U]) + Sync,
) -> PyResult<()> {
    let rows = Rows::<T, D>::new(points);
    let mut values = values.chunks_mut(CHUNK * widths[0]);
    let mut more = more.chunks_mut((CHUNK * widths[1]).max(1));
    let pieces = (0..rows.point_count).step_by(CHUNK).map(|start| Piece {
        points: start..rows.point_count.min(start + CHUNK),
        values: values.next().unwrap_or_default(),
        more: more.next().unwrap_or_default(),
    });
    let evaluate = |room: &mut Room<T, D>, piece: Piece<'_, U>| {
        work(rows.columns(piece.points, room), piece.values, piece.more);
    };
    if rows.point_count <= CHUNK {
        pieces.for_each(|piece| evaluate(&mut Room::default(), piece));
        return Ok(());
    }
    let pool = work::pool()?;
    let pieces: Vec<Piece<'_, U>> = pieces.collect();
    if rows.point_count <= SHORT {
        py.detach(|| pool.install(|| pieces.into_par_iter().for_each_init(Room::default, evaluate)));
        return py.check_signals();
    }
    work::watched(py, |stopped| {
        let evaluate = |room: &mut Room<T, D>, piece: Piece<'_, U>| {
            if !stopped.load(Ordering::Relaxed) {
                evaluate(room, piece);
            }
        };
        pool.install(|| pieces.into_par_iter().for_each_init(Room::default, evaluate));
    })
}

/// One thread's room for columns.
struct Room<T, const D: usize>([Vec<T>; D]);

impl<T: Copy + Default, const D: usize> Default for Room<T, D> {
    fn default() -> Self {
        Room(std::array::from_fn(|_| Vec::new()))
    }
}

/// Points in rows, each of one stride, as long as they can be.
struct Rows<'a, T, const D: usize> {
    view: ArrayViewD<'a, T>,
    row_length: usize,
    point_count: usize,
}

impl<'a, T: Copy + Default, const D: usize> Rows<'a, T, D> {
    fn new(points: ArrayViewD<'a, T>) -> Self {
        let point_count = points.len() / D;
        let is_standard = points.is_standard_layout() && point_count > 0;
        let mut view = match points.to_slice().filter(|_| is_standard) {
            Some(numbers) => ArrayView2::from_shape((point_count, D), numbers).expect("as many numbers").into_dyn(),
            None if points.ndim() == 1 => points.insert_axis(Axis(0)),
            None => points,
        };
        // Axes that lie one after the other make longer rows.
        let inner = view.ndim() - 2;
        for axis in (0..inner).rev() {
            if !view.merge_axes(Axis(axis), Axis(inner)) {
                break;
            }
        }
        let row_length = view.shape()[view.ndim() - 2];
        Rows { view, row_length, point_count }
    }

    fn row(&self, index: usize) -> ArrayView2<'a, T> {
        let mut view = self.view.clone();
        let mut place = index;
        // From the innermost of the outer axes to the outermost.
        for axis in (0..self.view.ndim() - 2).rev() {
            let side = self.view.shape()[axis];
            view = view.index_axis_move(Axis(axis), place % side);
            place /= side;
        }
        view.into_dimensionality().expect("two axes are left")
    }

    /// The coordinates of some points, one slice for each axis: in place where they lie so.
    fn columns<'r>(&'r self, points: Range<usize>, room: &'r mut Room<T, D>) -> [&'r [T]; D] {
        let row_of = |point: usize| (point / self.row_length, point % self.row_length);
        let (first, start) = row_of(points.start);
        if start + points.len() <= self.row_length {
            let part = self.part(first, start..start + points.len());
            let columns: [Option<&[T]>; D] = std::array::from_fn(|axis| part.index_axis_move(Axis(1), axis).to_slice());
            if columns.iter().all(Option::is_some) {
                return columns.map(Option::unwrap_or_default);
            }
        }
        room.0.iter_mut().for_each(Vec::clear);
        let mut point = points.start;
        while point < points.end {
            let (row, start) = row_of(point);
            let end = self.row_length.min(start + points.end - point);
            gather(self.part(row, start..end), room);
            point += end - start;
        }
        room.0.each_ref().map(Vec::as_slice)
    }

    fn part(&self, row: usize, points: Range<usize>) -> ArrayView2<'a, T> {
        let mut row = self.row(row);
        row.slice_axis_inplace(Axis(0), Slice::from(points));
        row
    }
}

/// Adds points to the columns.
fn gather<T: Copy, const D: usize>(points: ArrayView2<'_, T>, room: &mut Room<T, D>) {
    match points.to_slice() {
        Some(numbers) => {
            for (axis, column) in room.0.iter_mut().enumerate() {
                column.extend(numbers.chunks_exact(D).map(|point| point[axis]));
            }
        }
        None => {
            for (column, numbers) in room.0.iter_mut().zip(points.columns()) {
                column.extend(numbers.iter().copied());
            }
        }
    }
}
