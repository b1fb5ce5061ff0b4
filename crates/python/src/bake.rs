//! Baked maps: as arrays, or as a set of files.

use std::path::PathBuf;
use std::sync::Arc;

use jaspe_bake::{
    Bake, BakeError, Loop, Map, MapFormat, Model, NormalConvention, PREVIEW_SIZE, Preview, SetError, SetFolder,
    SetOptions, Settings, Surface, write_set,
};
use jaspe_edge::plain;
use jaspe_texture::Texture;
use numpy::{PyArray1, PyArrayMethods as _};
use pyo3::exceptions::{PyOSError, PyRuntimeError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{unknown_word, value_error};
use crate::image::Image;
use crate::work::{self, Watch, interruptible};

/// What is baked, as users say it.
pub struct Wanted {
    pub size: u32,
    pub maps: Option<Vec<String>>,
    pub tile: Option<f64>,
    pub surface: String,
    pub mesh: Option<PathBuf>,
    pub normal: String,
    pub animation: Option<Loop>,
}

impl Wanted {
    fn bake(self, texture: Texture) -> PyResult<Bake> {
        let maps = match &self.maps {
            None => Settings::maps_of(&texture),
            Some(names) => names.iter().map(|name| map_called(name)).collect::<PyResult<_>>()?,
        };
        let surface = match &self.mesh {
            None => {
                let found = Surface::from_name(&self.surface);
                found.ok_or_else(|| unknown_word("surface", &self.surface, Surface::NAMES.iter().copied()))?
            }
            Some(path) => {
                let model = Model::from_mesh_file(&std::fs::read(path)?, path);
                Surface::Mesh(Arc::new(model.map_err(|error| value_error(format!("mesh: {error}")))?))
            }
        };
        let normal = convention_called(&self.normal)?;
        let settings = Settings { size: self.size, tile: self.tile, surface, maps, normal, animation: self.animation };
        Bake::new(texture, settings).map_err(|error| match error {
            BakeError::TooFine { .. } => value_error(format!("{error}; choose a larger size or a smaller tile")),
            _ => value_error(error),
        })
    }
}

/// Bakes maps of a material into a `jaspe.Maps`.
pub fn arrays<'py>(
    py: Python<'py>,
    texture: Texture,
    wanted: Wanted,
    frame: u32,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let bake = wanted.bake(texture)?;
    check_frame(&bake, frame)?;
    let tile = bake.tile();
    let arrays = followed(py, progress, move |watch| bake.arrays(frame, watch))?;
    let arrays = arrays.map_err(|_| PyRuntimeError::new_err("the bake was stopped"))?;
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

/// The picture of a set on a ball and a cloth.
pub fn preview(
    py: Python<'_>,
    texture: Texture,
    wanted: Wanted,
    frame: u32,
    resolution: [u32; 2],
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Image> {
    let bake = wanted.bake(texture)?;
    check_frame(&bake, frame)?;
    let film = followed(py, progress, move |watch| jaspe_bake::preview(&bake, frame, resolution, watch))?;
    Ok(Image::new(film.map_err(|_| PyRuntimeError::new_err("the preview was stopped"))?, Vec::new()))
}

fn check_frame(bake: &Bake, frame: u32) -> PyResult<()> {
    if frame < bake.frames() {
        return Ok(());
    }
    let last = bake.frames() - 1;
    Err(value_error(format!("frame: expected a number from 0 to {last}, found {frame}")))
}

/// Bakes a set of files into a folder, and returns their names.
pub fn set(
    py: Python<'_>,
    texture: Texture,
    wanted: Wanted,
    folder: PathBuf,
    options: SetOptions,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<String>> {
    let bake = wanted.bake(texture)?;
    let folder = SetFolder::new(&folder).map_err(unwritable)?;
    let written = followed(py, progress, move |watch| write_set(&bake, &options, folder, watch))?;
    Ok(written.map_err(unwritable)?.files.into_iter().map(|(name, _)| name).collect())
}

/// Work on all cores, with a bar where one is wanted.
fn followed<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Watch) -> T + Send + 'static,
) -> PyResult<T> {
    let pool = work::pool()?;
    let following = py.import(intern!(py, "jaspe._progress"))?.getattr(intern!(py, "following"))?;
    let following = following.call1((progress, "baking"))?;
    let report = following.call_method0(intern!(py, "__enter__"))?;
    let report = if report.is_none() { None } else { Some(&report) };
    let result = interruptible(py, report, move |watch| pool.install(|| work(watch)));
    following.call_method1(intern!(py, "__exit__"), (py.None(), py.None(), py.None()))?;
    result
}

/// How a set is written: `format` is the extension of its files.
pub fn set_options(format: &str, bits: Option<u32>, preview: bool) -> PyResult<SetOptions> {
    let words = || MapFormat::ALL.iter().map(|format| format.extension());
    if !words().any(|word| word == format) {
        let mut words: Vec<&str> = words().collect();
        words.dedup();
        return Err(unknown_word("format", format, words.into_iter()));
    }
    let fits = |found: &&MapFormat| found.extension() == format && bits.is_none_or(|bits| found.bits() == bits);
    let chosen = MapFormat::ALL.iter().find(fits).copied().ok_or_else(|| {
        let bits = bits.unwrap_or_default();
        value_error(format!(
            "bits: {bits} does not go with \"{format}\"; png takes 8 or 16, exr 16 or 32, jpg and webp 8"
        ))
    })?;
    let mut options = SetOptions::new(chosen);
    if bits == Some(8) {
        // Whoever says so shall have it.
        options.height_format = chosen;
    }
    if preview {
        options.preview = Preview::Rendered(PREVIEW_SIZE);
    }
    Ok(options)
}

fn unwritable(error: SetError) -> PyErr {
    match error {
        SetError::Cancelled => PyRuntimeError::new_err("the bake was stopped"),
        SetError::Write { path, error } => {
            let message = format!("cannot write `{}`: {}", path.display(), plain(&error));
            PyOSError::new_err(message + "; nothing was left behind")
        }
        SetError::Occupied { .. } => PyOSError::new_err(format!(
            "{error}; what is written replaces its folder: choose a new one, or one that was written so"
        )),
        SetError::TooLarge { .. } => value_error(format!("{error}; choose another format or a smaller size")),
    }
}

fn map_called(name: &str) -> PyResult<Map> {
    Map::from_name(name).ok_or_else(|| unknown_word("maps", name, Map::ALL.iter().map(|map| map.name())))
}

fn convention_called(name: &str) -> PyResult<NormalConvention> {
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
