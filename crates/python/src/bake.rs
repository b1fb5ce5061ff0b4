//! Baked maps as arrays.

use jaspe_bake::{Bake, Map, NormalConvention, Settings};
use jaspe_texture::Texture;
use numpy::{PyArray1, PyArrayMethods as _};
use pyo3::exceptions::PyRuntimeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{unknown_word, value_error};
use crate::work::{self, interruptible};

/// Bakes maps of a material into a `jaspe.Maps`.
pub fn bake<'py>(
    py: Python<'py>,
    texture: Texture,
    settings: Settings,
    frame: u32,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let bake = Bake::new(texture, settings).map_err(value_error)?;
    if frame >= bake.frames() {
        let last = bake.frames() - 1;
        return Err(value_error(format!("frame: expected a number from 0 to {last}, found {frame}")));
    }
    let (tile, pool) = (bake.tile(), work::pool()?);
    let following = py.import(intern!(py, "jaspe._progress"))?.getattr(intern!(py, "following"))?;
    let following = following.call1((progress, "baking"))?;
    let report = following.call_method0(intern!(py, "__enter__"))?;
    let report = if report.is_none() { None } else { Some(&report) };
    let arrays = interruptible(py, report, move |watch| pool.install(|| bake.arrays(frame, watch)));
    following.call_method1(intern!(py, "__exit__"), (py.None(), py.None(), py.None()))?;
    let arrays = arrays?.map_err(|_| PyRuntimeError::new_err("the bake was stopped"))?;
    let [height, width] = [arrays.height as usize, arrays.width as usize];
    let maps = PyDict::new(py);
    for map in arrays.maps {
        let values = PyArray1::from_vec(py, map.values);
        let values = match map.map.declaration().channels {
            1 => values.reshape([height, width])?.into_any(),
            channels => values.reshape([height, width, channels])?.into_any(),
        };
        maps.set_item(map.map.name(), values)?;
    }
    let class = py.import(intern!(py, "jaspe._maps"))?.getattr(intern!(py, "Maps"))?;
    let [low, high] = arrays.height_range;
    class.call1((maps, tile, (low, high)))
}

/// The maps of these names.
pub fn maps_called(names: &[String]) -> PyResult<Vec<Map>> {
    let words = || Map::ALL.iter().map(|map| map.name());
    names.iter().map(|name| Map::from_name(name).ok_or_else(|| unknown_word("maps", name, words()))).collect()
}

/// The convention of this name.
pub fn convention_called(name: &str) -> PyResult<NormalConvention> {
    let all = [NormalConvention::OpenGl, NormalConvention::DirectX];
    let found = all.into_iter().find(|convention| convention.name() == name);
    found.ok_or_else(|| unknown_word("normal", name, all.into_iter().map(NormalConvention::name)))
}

/// What the maps declare.
pub fn declarations<'py>(py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
    let one = |map: &Map| -> PyResult<Bound<'py, PyDict>> {
        let entry = PyDict::new(py);
        let declaration = map.declaration();
        entry.set_item("name", declaration.name)?;
        entry.set_item("channels", declaration.channels)?;
        entry.set_item("summary", declaration.summary)?;
        Ok(entry)
    };
    Ok(Map::ALL.iter().map(one).collect::<PyResult<Vec<_>>>()?.into_pyobject(py)?.into_any())
}
