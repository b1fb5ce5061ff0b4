//! `jaspe.noise`: every noise and every sum over arrays of points.

use jaspe_noise::{Basis, Cellular, Combine, Feature, Field, Metric, Recipe};
use numpy::{PyArrayMethods as _, PyReadonlyArrayDyn, PyUntypedArrayMethods as _};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::unknown_word;
use crate::grid::Grid;
use crate::points::{self, CHUNK, Coordinate, Points};

/// The value of a noise, or of a sum over its octaves, at every point.
///
/// What the parameters are, the functions of `jaspe.noise` say.
#[pyfunction]
#[pyo3(signature = (
    points, *, basis, sum = None, seed = None, period = None, gradient = false, octaves = None, lacunarity = 2.0,
    gain = 0.5, feature = "f1", metric = "euclidean", jitter = 1.0, warp = None
))]
#[expect(clippy::too_many_arguments, reason = "they are named where this is called")]
pub fn noise<'py>(
    points: &Bound<'py, PyAny>,
    basis: &str,
    sum: Option<&str>,
    seed: Option<&Bound<'py, PyAny>>,
    period: Option<&Bound<'py, PyAny>>,
    gradient: bool,
    octaves: Option<f64>,
    lacunarity: f64,
    gain: f64,
    feature: &str,
    metric: &str,
    jitter: f64,
    warp: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = points.py();
    let place = match points.cast::<Grid>() {
        Ok(grid) => Place::Grid(grid.get()),
        Err(_) => Place::Points(Points::new(points, &[1, 2, 3, 4])?),
    };
    let recipe = Recipe {
        basis: word("basis", basis, Basis::from_name(basis), Basis::ALL.iter().map(|basis| basis.name()))?,
        seed: seed.map_or(Ok(0), seed_of)?,
        period: periods(period, place.dimensions())?,
        cellular: Cellular {
            metric: word("metric", metric, Metric::from_name(metric), Metric::ALL.iter().map(|m| m.name()))?,
            feature: word("feature", feature, Feature::from_name(feature), Feature::ALL.iter().map(|f| f.name()))?,
            jitter,
        },
        sum: match sum {
            None => None,
            Some(name) => {
                let terms = Combine::ALL.iter().map(|sum| sum.declaration().term);
                Some(word("sum", name, Combine::from_name(name), terms)?)
            }
        },
        octaves,
        lacunarity,
        gain,
        warp: amounts(warp)?,
    };
    let field = recipe.field().map_err(|error| PyValueError::new_err(error.to_string()))?;
    match place {
        Place::Points(Points::Single(points)) => over_dimensions(&points, &field, gradient),
        Place::Points(Points::Double(points)) => over_dimensions(&points, &field, gradient),
        Place::Grid(grid) => grid.evaluate(py, field, gradient),
    }
}

/// Where a noise is evaluated.
enum Place<'a, 'py> {
    Points(Points<'py>),
    Grid(&'a Grid),
}

impl Place<'_, '_> {
    fn dimensions(&self) -> usize {
        match self {
            Place::Points(points) => points.dimensions(),
            Place::Grid(grid) => grid.dimensions(),
        }
    }
}

/// One of the words that a parameter takes.
fn word<T>(
    parameter: &str,
    found: &str,
    meaning: Option<T>,
    words: impl Iterator<Item = &'static str> + Clone,
) -> PyResult<T> {
    meaning.ok_or_else(|| unknown_word(parameter, found, words))
}

/// A seed from any whole number that fits.
fn seed_of(seed: &Bound<'_, PyAny>) -> PyResult<u64> {
    let whole: Option<i128> = seed.extract().ok();
    let expected = || format!("seed: expected a whole number from 0 to {}, found {}", u64::MAX, shown(seed));
    let whole = whole.ok_or_else(|| PyTypeError::new_err(expected()))?;
    u64::try_from(whole).map_err(|_| PyValueError::new_err(expected()))
}

/// A period for each axis, from one number for all or a sequence of them.
fn periods(period: Option<&Bound<'_, PyAny>>, dimensions: usize) -> PyResult<[u32; 4]> {
    let Some(period) = period else { return Ok([0; 4]) };
    let refused = |reason: String| {
        let message = format!("period: expected a whole number of cells, or one for each axis, {reason}");
        message + "; for instance period=4 or period=(4, 4, 0), where 0 leaves an axis without"
    };
    let several = if period.extract::<f64>().is_ok() { None } else { period.extract::<Vec<Bound<'_, PyAny>>>().ok() };
    let numbers = match &several {
        Some(numbers) if numbers.len() > dimensions => {
            let found = format!("found {} for points of {dimensions} coordinates", numbers.len());
            return Err(PyValueError::new_err(refused(found)));
        }
        Some(numbers) => numbers.clone(),
        None => vec![period.clone(); dimensions],
    };
    let mut periods = [0; 4];
    for (cells, number) in periods.iter_mut().zip(numbers) {
        let found = || refused(format!("found {}", shown(&number)));
        let whole: i128 = number.extract().map_err(|_| PyTypeError::new_err(found()))?;
        *cells = u32::try_from(whole).map_err(|_| PyValueError::new_err(found()))?;
    }
    Ok(periods)
}

/// A value as Python writes it.
pub fn shown(value: &Bound<'_, PyAny>) -> String {
    value.repr().map_or_else(|_| "?".to_owned(), |text| text.to_string_lossy().into_owned())
}

/// Amounts of warp, from one number or a sequence of them.
fn amounts(warp: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<f64>> {
    let Some(warp) = warp else { return Ok(Vec::new()) };
    let amounts = warp.extract::<f64>().map(|amount| vec![amount]).or_else(|_| warp.extract::<Vec<f64>>());
    amounts.map_err(|_| PyTypeError::new_err("warp: expected a number, or a sequence of numbers"))
}

/// A number in which noise is evaluated.
trait Number: Coordinate {
    /// The values at some points, and with `gradient` the derivatives along each axis.
    fn fill<const D: usize>(
        field: &Field,
        points: [&[Self]; D],
        values: &mut [Self],
        gradient: Option<[&mut [Self]; D]>,
    );
    /// The values at points in space that lie one after the other.
    fn fill_points(field: &Field, points: &[[Self; 3]], values: &mut [Self]);
}

impl Number for f32 {
    fn fill<const D: usize>(field: &Field, points: [&[f32]; D], values: &mut [f32], gradient: Option<[&mut [f32]; D]>) {
        match gradient {
            None => field.fill(points, values),
            Some(gradient) => field.fill_with_gradient(points, values, gradient),
        }
    }

    fn fill_points(field: &Field, points: &[[f32; 3]], values: &mut [f32]) {
        field.fill_points(points, values);
    }
}

impl Number for f64 {
    fn fill<const D: usize>(field: &Field, points: [&[f64]; D], values: &mut [f64], gradient: Option<[&mut [f64]; D]>) {
        let point = |i: usize| points.map(|column| column[i]);
        match gradient {
            None => values.iter_mut().enumerate().for_each(|(i, value)| *value = field.value(point(i))),
            Some(mut gradient) => {
                for (i, value) in values.iter_mut().enumerate() {
                    let slope;
                    (*value, slope) = field.value_and_gradient(point(i));
                    gradient.iter_mut().zip(slope).for_each(|(column, slope)| column[i] = slope);
                }
            }
        }
    }

    fn fill_points(field: &Field, points: &[[f64; 3]], values: &mut [f64]) {
        values.iter_mut().zip(points).for_each(|(value, &point)| *value = field.value(point));
    }
}

fn over_dimensions<'py, T: Number>(
    points: &PyReadonlyArrayDyn<'py, T>,
    field: &Field,
    gradient: bool,
) -> PyResult<Bound<'py, PyAny>> {
    match points.shape().last() {
        Some(1) => evaluate::<T, 1>(points, field, gradient),
        Some(2) => evaluate::<T, 2>(points, field, gradient),
        Some(3) => evaluate::<T, 3>(points, field, gradient),
        _ => evaluate::<T, 4>(points, field, gradient),
    }
}

fn evaluate<'py, T: Number, const D: usize>(
    points: &PyReadonlyArrayDyn<'py, T>,
    field: &Field,
    gradient: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let py = points.py();
    let values = points::results::<T>(py, points.shape(), &[])?;
    let place = points.as_array();
    if let (3, false, Some(numbers)) = (D, gradient, place.to_slice()) {
        let fill = |points: &[[T; 3]], values: &mut [T]| T::fill_points(field, points, values);
        points::evaluate_points(py, numbers.as_chunks().0, values.readwrite().as_slice_mut()?, fill)?;
        return points::array_or_number(values);
    }
    let slopes = if gradient { Some(points::results::<T>(py, points.shape(), &[D])?) } else { None };
    {
        let mut values = values.readwrite();
        let mut slopes = slopes.as_ref().map(|slopes| slopes.readwrite());
        let more = slopes.as_mut().map_or(Ok(&mut [][..]), |slopes| slopes.as_slice_mut())?;
        let widths = [1, if gradient { D } else { 0 }];
        points::evaluate(py, points.as_array(), values.as_slice_mut()?, more, widths, |points, values, slopes| {
            if !gradient {
                return T::fill(field, points, values, None);
            }
            let mut columns = [[T::default(); CHUNK]; D];
            let parts = columns.each_mut().map(|column| &mut column[..values.len()]);
            T::fill(field, points, values, Some(parts));
            points::interleave(columns.each_ref().map(|column| &column[..values.len()]), slopes);
        })?;
    }
    points::with_slopes(py, points::array_or_number(values)?, slopes)
}

/// What the libraries declare of the noises: for each basis and each sum its name, its term, a sentence, the formula and the
/// source.
pub fn declarations<'py>(py: Python<'py>) -> PyResult<[Bound<'py, PyAny>; 2]> {
    fn list<'py, T>(
        py: Python<'py>,
        declarations: impl Iterator<Item = &'static jaspe_noise::Declaration<T>>,
    ) -> PyResult<Bound<'py, PyAny>>
    where
        T: 'static,
    {
        let one = |declaration: &jaspe_noise::Declaration<T>| -> PyResult<Bound<'py, PyDict>> {
            let entry = PyDict::new(py);
            entry.set_item("name", declaration.name)?;
            entry.set_item("term", declaration.term)?;
            entry.set_item("sentence", declaration.sentence)?;
            entry.set_item("formula", declaration.formula)?;
            entry.set_item("source", declaration.source)?;
            let statistics = declaration.statistics.iter().map(|s| (s.least, s.largest, s.mean, s.variance));
            entry.set_item("statistics", statistics.collect::<Vec<_>>())?;
            Ok(entry)
        };
        Ok(declarations.map(one).collect::<PyResult<Vec<_>>>()?.into_pyobject(py)?.into_any())
    }
    Ok([
        list(py, Basis::ALL.iter().map(|basis| basis.declaration()))?,
        list(py, Combine::ALL.iter().map(|sum| sum.declaration()))?,
    ])
}
