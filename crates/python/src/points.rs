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

/// Points that are worked on at a time where their columns have to be made, or there is more than values: all of it stays in
/// the first cache, and the next points arrive from memory meanwhile.
pub const CHUNK: usize = 512;

/// Points that are worked on at a time where their columns lie ready: what it takes to begin is spread over more of them.
const LONG_CHUNK: usize = 4 * CHUNK;

/// Points that a thread takes on at a time.
const PIECE: usize = 4 * LONG_CHUNK;

/// So few points are done before anybody presses Ctrl-C.
const SHORT: usize = 16 * PIECE;

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
pub fn tuple(shape: &[usize]) -> String {
    match shape {
        [side] => format!("({side},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// An array for results, of the shape of the points without their last axis, with these axes added: see [`array()`].
pub fn results<'py, T: Element>(
    py: Python<'py>,
    points: &[usize],
    added: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    array(py, &[&points[..points.len() - 1], added].concat())
}

/// An array of this shape for results. What it holds is left over from elsewhere, until all of it is written. (NumPy asks for large
/// pages where it need not clear them: with zeros, the system would take longer for the pages than the noise for the values.)
pub fn array<'py, T: Element>(py: Python<'py>, shape: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let numpy = py.import(intern!(py, "numpy"))?;
    let array = numpy.call_method1(intern!(py, "empty"), (PyTuple::new(py, shape)?, T::get_dtype(py)))?;
    Ok(array.cast_into()?)
}

/// What `__array__` returns: a new array, of the dtype that is asked for.
pub fn copied<'py>(
    what: &str,
    dtype: Option<&Bound<'py, PyAny>>,
    copy: Option<bool>,
    make: impl FnOnce() -> PyResult<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    if copy == Some(false) {
        let message = format!("{what} cannot be seen as an array without a copy; leave `copy` out");
        return Err(PyValueError::new_err(message));
    }
    let array = make()?;
    match dtype {
        None => Ok(array),
        Some(dtype) => array.call_method1(intern!(array.py(), "astype"), (dtype,)),
    }
}

/// The array, or the number if it has no axes.
pub fn array_or_number<'py, T: Element>(array: Bound<'py, PyArrayDyn<T>>) -> PyResult<Bound<'py, PyAny>> {
    if array.ndim() == 0 { array.get_item(()) } else { Ok(array.into_any()) }
}

/// Values, and with them their gradients, if there are any.
pub fn with_slopes<'py, T: Element>(
    py: Python<'py>,
    values: Bound<'py, PyAny>,
    slopes: Option<Bound<'py, PyArrayDyn<T>>>,
) -> PyResult<Bound<'py, PyAny>> {
    match slopes {
        None => Ok(values),
        Some(slopes) => Ok((values, slopes).into_pyobject(py)?.into_any()),
    }
}

/// A coordinate of a point.
pub trait Coordinate: Element + Copy + Default {
    /// Takes points apart into columns of as many numbers.
    fn deinterleave<const D: usize>(points: &[[Self; D]], columns: [&mut [Self]; D]) {
        gather(points, columns);
    }
}

/// The columns as points: the first entry of each, the second of each, and so on.
pub fn interleave<T: Copy, const D: usize>(columns: [&[T]; D], points: &mut [T]) {
    for (i, point) in points.as_chunks_mut::<D>().0.iter_mut().enumerate() {
        *point = columns.map(|column| column[i]);
    }
}

/// One coordinate after the other.
fn gather<T: Copy, const D: usize>(points: &[[T; D]], columns: [&mut [T]; D]) {
    for (axis, column) in columns.into_iter().enumerate() {
        column.iter_mut().zip(points).for_each(|(number, point)| *number = point[axis]);
    }
}

impl Coordinate for f64 {}

impl Coordinate for f32 {
    fn deinterleave<const D: usize>(points: &[[f32; D]], mut columns: [&mut [f32]; D]) {
        match &mut columns[..] {
            [x, y, z] => jaspe_noise::simd::deinterleave(points.as_flattened().as_chunks().0, [x, y, z]),
            _ => gather(points, columns),
        }
    }
}

/// What one thread does before it looks for more, and where the results go.
struct Piece<'a, U> {
    start: usize,
    point_count: usize,
    values: &'a mut [U],
    more: &'a mut [U],
}

/// Evaluates `work` for all points: it is given columns of coordinates, and the results for them: `widths[0]` numbers for
/// each point in `values`, and `widths[1]` in `more` (which is empty for none; if not, there are [`CHUNK`] points at most). On all cores and without the interpreter's
/// lock; Ctrl-C ends it. Which thread does which chunk leaves no trace.
///
/// (Another thread of the program may write to the points meanwhile, as with any function of NumPy that releases the lock;
/// it gets values of the old points or the new ones.)
pub fn evaluate<T: Coordinate, U: Send, const D: usize>(
    py: Python<'_>,
    points: ArrayViewD<'_, T>,
    values: &mut [U],
    more: &mut [U],
    widths: [usize; 2],
    work: impl Fn([&[T]; D], &mut [U], &mut [U]) + Sync,
) -> PyResult<()> {
    let rows = Rows::<T, D>::new(points);
    let chunk = if rows.dense.is_some() || widths[1] > 0 { CHUNK } else { LONG_CHUNK };
    each_piece(py, rows.point_count, values, more, widths, |piece| {
        let mut room = [[T::default(); LONG_CHUNK]; D];
        let mut values = piece.values.chunks_mut(chunk * widths[0]);
        let mut more = piece.more.chunks_mut((chunk * widths[1]).max(1));
        for start in (0..piece.point_count).step_by(chunk) {
            let points = piece.start + start..piece.start + piece.point_count.min(start + chunk);
            let columns = rows.columns(points, &mut room);
            work(columns, values.next().unwrap_or_default(), more.next().unwrap_or_default());
        }
    })
}

/// [`evaluate`] for points that lie one after the other, by work that takes them as they are: one value for each.
pub fn evaluate_points<T: Coordinate, const D: usize>(
    py: Python<'_>,
    points: &[[T; D]],
    values: &mut [T],
    work: impl Fn(&[[T; D]], &mut [T]) + Sync,
) -> PyResult<()> {
    each_piece(py, points.len(), values, &mut [], [1, 0], |piece| {
        work(&points[piece.start..][..piece.point_count], piece.values);
    })
}

/// Does pieces of so many points on all cores.
fn each_piece<U: Send>(
    py: Python<'_>,
    point_count: usize,
    values: &mut [U],
    more: &mut [U],
    widths: [usize; 2],
    evaluate: impl Fn(Piece<'_, U>) + Sync,
) -> PyResult<()> {
    let [mut values, mut more] =
        [(values, widths[0]), (more, widths[1])].map(|(all, width)| all.chunks_mut((PIECE * width).max(1)));
    let pieces = (0..point_count).step_by(PIECE).map(|start| Piece {
        start,
        point_count: PIECE.min(point_count - start),
        values: values.next().unwrap_or_default(),
        more: more.next().unwrap_or_default(),
    });
    spread(py, pieces.collect(), point_count, evaluate)
}

/// Does pieces of so many points together on all cores and without the interpreter's lock; Ctrl-C ends it.
pub fn spread<P: Send>(
    py: Python<'_>,
    pieces: Vec<P>,
    point_count: usize,
    evaluate: impl Fn(P) + Sync,
) -> PyResult<()> {
    if point_count <= PIECE {
        pieces.into_iter().for_each(evaluate);
        return Ok(());
    }
    let pool = work::pool()?;
    if point_count <= SHORT {
        py.detach(|| pool.install(|| pieces.into_par_iter().for_each(&evaluate)));
        return py.check_signals();
    }
    work::watched(py, |stopped| {
        let evaluate = |piece: P| {
            if !stopped.load(Ordering::Relaxed) {
                evaluate(piece);
            }
        };
        pool.install(|| pieces.into_par_iter().for_each(evaluate));
    })
}

/// Points in rows, each of one stride, as long as they can be.
struct Rows<'a, T, const D: usize> {
    view: ArrayViewD<'a, T>,
    /// All of them, where they lie one after the other.
    dense: Option<&'a [[T; D]]>,
    row_length: usize,
    point_count: usize,
}

impl<'a, T: Coordinate, const D: usize> Rows<'a, T, D> {
    fn new(points: ArrayViewD<'a, T>) -> Self {
        let point_count = points.len() / D;
        // (Points on a line are columns already.)
        let dense = points.to_slice().filter(|_| D > 1).map(|numbers| numbers.as_chunks().0);
        let mut view = if points.ndim() == 1 { points.insert_axis(Axis(0)) } else { points };
        // Axes that lie one after the other make longer rows.
        let inner = view.ndim() - 2;
        for axis in (0..inner).rev() {
            if !view.merge_axes(Axis(axis), Axis(inner)) {
                break;
            }
        }
        let row_length = view.shape()[view.ndim() - 2];
        Rows { view, dense, row_length, point_count }
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
    fn columns<'r>(&'r self, points: Range<usize>, room: &'r mut [[T; LONG_CHUNK]; D]) -> [&'r [T]; D] {
        let count = points.len();
        if let Some(dense) = self.dense {
            T::deinterleave(&dense[points], room.each_mut().map(|column| &mut column[..count]));
            return room.each_ref().map(|column| &column[..count]);
        }
        let row_of = |point: usize| (point / self.row_length, point % self.row_length);
        let (first, start) = row_of(points.start);
        if start + count <= self.row_length {
            let part = self.part(first, start..start + count);
            let columns: [Option<&[T]>; D] = std::array::from_fn(|axis| part.index_axis_move(Axis(1), axis).to_slice());
            if columns.iter().all(Option::is_some) {
                return columns.map(Option::unwrap_or_default);
            }
        }
        let mut done = 0;
        while done < count {
            let (row, start) = row_of(points.start + done);
            let end = self.row_length.min(start + count - done);
            for (column, numbers) in room.iter_mut().zip(self.part(row, start..end).columns()) {
                column[done..].iter_mut().zip(numbers).for_each(|(number, &found)| *number = found);
            }
            done += end - start;
        }
        room.each_ref().map(|column| &column[..count])
    }

    fn part(&self, row: usize, points: Range<usize>) -> ArrayView2<'a, T> {
        let mut row = self.row(row);
        row.slice_axis_inplace(Axis(0), Slice::from(points));
        row
    }
}
