//! Scenes: read, changed, rendered. `jaspe.Scene` in python/jaspe/_scene.py is what users see of this.

use std::collections::{BTreeSet, HashMap};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use jaspe_render::{Cancelled, CompileOptions, CompiledScene, Film, Look, Observer, RenderOptions, compile, render};
use jaspe_scene::{Diagnostics, Dialect, DiskLoader, Includes, Loader, MemoryLoader, Parameter, Scene as Description};
use pyo3::exceptions::{PyKeyError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList, PyString, PyTuple};

use crate::error::{self, scene_error, unknown_word, value_error};
use crate::image::Image;
use crate::work::{Watch, interruptible};

/// The files of a scene: some in memory, others perhaps on disk. It knows which ones were asked for and found.
struct Files {
    memory: HashMap<PathBuf, Arc<[u8]>>,
    disk: bool,
    found: Mutex<BTreeSet<PathBuf>>,
}

impl Loader for Files {
    fn load(&self, path: &Path) -> io::Result<Arc<[u8]>> {
        let bytes = match self.memory.get(path) {
            Some(bytes) => Ok(Arc::clone(bytes)),
            None if self.disk => DiskLoader.load(path),
            None => MemoryLoader::default().load(path),
        };
        if bytes.is_ok() {
            self.found.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned());
        }
        bytes
    }
}

/// A scene: what was read, what was changed since, and what was compiled of it.
#[pyclass(frozen, module = "jaspe._jaspe")]
pub struct Scene {
    path: PathBuf,
    text: Arc<[u8]>,
    files: Arc<Files>,
    state: Mutex<State>,
}

struct State {
    description: Arc<Description>,
    /// What was said when it was read.
    diagnostics: Diagnostics,
    /// What was changed, in order.
    assignments: Vec<String>,
    /// What was compiled last, with which options, and what was said about it.
    compiled: Option<(CompileOptions, Arc<CompiledScene>, Diagnostics)>,
}

impl Scene {
    fn state<T>(&self, look: impl FnOnce(&mut State) -> T) -> T {
        look(&mut self.state.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn description(&self) -> Arc<Description> {
        self.state(|state| Arc::clone(&state.description))
    }

    /// The scene ready to render, as it is now.
    fn compiled(&self, py: Python<'_>, options: &CompileOptions) -> PyResult<Arc<CompiledScene>> {
        let known = self.state(|state| match &state.compiled {
            Some((of, scene, _)) if of == options => Some(Arc::clone(scene)),
            _ => None,
        });
        if let Some(scene) = known {
            return Ok(scene);
        }
        let (description, files) = (self.description(), Arc::clone(&self.files));
        let wanted = (Arc::clone(&description), options.clone());
        let compilation = interruptible(py, None, move |_| compile(&wanted.0, &*files, &wanted.1))?;
        let Some(scene) = compilation.scene else {
            return Err(scene_error(py, &compilation.diagnostics, &description.sources));
        };
        let scene = Arc::new(scene);
        self.state(|state| {
            // Unless it was changed meanwhile.
            if Arc::ptr_eq(&state.description, &description) {
                state.compiled = Some((options.clone(), Arc::clone(&scene), compilation.diagnostics));
            }
        });
        Ok(scene)
    }
}

#[pymethods]
impl Scene {
    /// Reads a scene: `text`, or the file `path` if there is none. Files are looked for in `files` first, and then, with
    /// `disk`, on disk.
    #[new]
    #[pyo3(signature = (path, text, files, disk, assignments))]
    fn new(
        py: Python<'_>,
        path: PathBuf,
        text: Option<Vec<u8>>,
        files: HashMap<PathBuf, Vec<u8>>,
        disk: bool,
        assignments: Vec<String>,
    ) -> PyResult<Self> {
        let memory = files.into_iter().map(|(path, bytes)| (path, Arc::from(bytes))).collect();
        let files = Arc::new(Files { memory, disk, found: Mutex::default() });
        let (reader, name) = (Arc::clone(&files), path.clone());
        let (text, description, diagnostics) = interruptible(py, None, move |_| -> io::Result<_> {
            let text: Arc<[u8]> = match text {
                Some(text) => text.into(),
                None => reader.load(&name)?,
            };
            let (description, diagnostics) = jaspe_scene::parse(&name, Arc::clone(&text), &*reader);
            Ok((text, description, diagnostics))
        })??;
        if diagnostics.has_errors() {
            return Err(scene_error(py, &diagnostics, &description.sources));
        }
        let state = State { description: Arc::new(description), diagnostics, assignments: Vec::new(), compiled: None };
        let scene = Scene { path, text, files, state: Mutex::new(state) };
        assignments.into_iter().try_for_each(|assignment| scene.set(py, assignment))?;
        Ok(scene)
    }

    /// What messages call the scene.
    #[getter]
    fn path(&self) -> String {
        self.path.to_string_lossy().into_owned()
    }

    /// Changes a parameter of a shader or texture: `NAME.KEY=VALUE`, as on the command line.
    fn set(&self, py: Python<'_>, assignment: String) -> PyResult<()> {
        self.state(|state| {
            let description = Arc::make_mut(&mut state.description);
            jaspe_scene::set(description, &assignment)
                .map_err(|refused| scene_error(py, &refused, &description.sources))?;
            state.assignments.push(assignment);
            state.compiled = None;
            Ok(())
        })
    }

    /// The parameters of a shader, or else of a texture, with their values.
    fn parameters<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyDict>> {
        let parameters = jaspe_scene::parameters(&self.description(), name);
        let parameters = parameters.ok_or_else(|| PyKeyError::new_err(name.to_owned()))?;
        let values = PyDict::new(py);
        for (key, value) in parameters {
            let value = match value {
                Parameter::Int(value) => value.into_pyobject(py)?.into_any(),
                Parameter::Float(value) => value.into_pyobject(py)?.into_any(),
                Parameter::Floats(values) => PyTuple::new(py, values)?.into_any(),
                Parameter::Color(color) => PyTuple::new(py, color)?.into_any(),
                Parameter::Word(word) => PyString::new(py, &word).into_any(),
                Parameter::Auto => py.None().into_bound(py),
            };
            values.set_item(key, value)?;
        }
        Ok(values)
    }

    /// The names of all shaders with their types.
    fn shaders(&self) -> Vec<(String, &'static str)> {
        let description = self.description();
        let shaders = description.shaders.iter();
        shaders.map(|shader| (shader.name.value.clone(), shader.kind.keyword())).collect()
    }

    /// The names of all textures with their types.
    fn textures(&self) -> Vec<(String, &'static str)> {
        let description = self.description();
        let textures = description.textures.iter();
        textures.map(|texture| (texture.name.value.clone(), texture.declaration.name)).collect()
    }

    /// All that was said about the scene so far, when it was read and when it was last compiled.
    fn diagnostics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let (mut all, compiled, description) = self.state(|state| {
            let compiled = state.compiled.as_ref().map(|(_, _, diagnostics)| diagnostics.clone());
            (state.diagnostics.clone(), compiled, Arc::clone(&state.description))
        });
        all.extend(compiled.unwrap_or_default());
        error::list(py, &all, &description.sources)
    }

    /// The scene as text, tidy, in one file.
    fn text<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let mut text = Vec::new();
        jaspe_scene::write(&self.description(), Includes::Inline, Path::new(""), &mut text)?;
        Ok(PyBytes::new(py, &text))
    }

    /// From what the scene can be made again anywhere: its path, text, files and changes.
    fn parts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        if self.state(|state| state.compiled.is_none()) {
            // What it needs, the compiler knows.
            self.compiled(py, &CompileOptions::default())?;
        }
        let found = self.files.found.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let files = PyDict::new(py);
        for path in found {
            let bytes = self.files.load(&path)?;
            files.set_item(path.to_string_lossy(), PyBytes::new(py, &bytes))?;
        }
        let assignments = self.state(|state| state.assignments.clone());
        (self.path.to_string_lossy(), PyBytes::new(py, &self.text), files, assignments).into_pyobject(py)
    }

    /// Width and height of the picture.
    #[pyo3(signature = (resolution = None, dialect = None))]
    fn resolution(&self, py: Python<'_>, resolution: Option<[u32; 2]>, dialect: Option<&str>) -> PyResult<[u32; 2]> {
        let options =
            CompileOptions { resolution, dialect: dialect.map(dialect_called).transpose()?, ..Default::default() };
        match resolution {
            Some(resolution) => Ok(resolution),
            None => Ok(self.compiled(py, &options)?.resolution()),
        }
    }

    /// Renders.
    #[pyo3(signature = (*, resolution, samples, aa, seed, crop, threads, dialect, look, layers, progress))]
    #[expect(clippy::too_many_arguments, reason = "they are named where this is called")]
    fn render(
        &self,
        py: Python<'_>,
        resolution: Option<[u32; 2]>,
        samples: Option<u32>,
        aa: Option<[i32; 2]>,
        seed: u64,
        crop: Option<[u32; 4]>,
        threads: Option<usize>,
        dialect: Option<&str>,
        look: Option<&str>,
        layers: Vec<String>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Image> {
        let dialect = dialect.map(dialect_called).transpose()?;
        let look = look.map(look_called).transpose()?;
        let options = CompileOptions { dialect, resolution, samples, aa, look };
        let mut scenes = Vec::new();
        for layer in &layers {
            let options = CompileOptions { look: Some(look_called(layer)?), ..options.clone() };
            scenes.push(self.compiled(py, &options)?);
        }
        // The picture itself last, so that it stays compiled for the next one.
        scenes.push(self.compiled(py, &options)?);
        check_crop(crop, scenes[0].resolution())?;
        let options = RenderOptions { threads, seed, crop };
        let films = interruptible(py, progress, move |watch| -> Result<Vec<Film>, Cancelled> {
            let count = scenes.len() as u64;
            let one = |(i, scene): (usize, &Arc<CompiledScene>)| {
                render(scene, &options, &Part { watch, index: i as u64, count }).map(|(film, _)| film)
            };
            scenes.iter().enumerate().map(one).collect()
        })?;
        let mut films = films.map_err(|Cancelled| PyRuntimeError::new_err("the rendering was stopped"))?;
        let film = films.pop().ok_or_else(|| PyRuntimeError::new_err("nothing was rendered"))?;
        Ok(Image::new(film, layers.into_iter().zip(films).collect()))
    }
}

/// One of several renderings, as a part of the whole work.
struct Part<'a> {
    watch: &'a Watch,
    index: u64,
    count: u64,
}

impl Observer for Part<'_> {
    fn progress(&self, done: u64, total: u64) {
        self.watch.progress(self.index * total + done, self.count * total);
    }

    fn cancelled(&self) -> bool {
        self.watch.cancelled()
    }
}

fn check_crop(crop: Option<[u32; 4]>, [width, height]: [u32; 2]) -> PyResult<()> {
    match crop {
        Some([x0, y0, x1, y1]) if x1 > width || y1 > height || x0 >= x1 || y0 >= y1 => Err(value_error(format!(
            "crop: expected (x0, y0, x1, y1) in pixels from the top left, the ends excluded, within (0, 0, {width}, {height}), \
             found ({x0}, {y0}, {x1}, {y1})"
        ))),
        _ => Ok(()),
    }
}

fn look_called(name: &str) -> PyResult<Look> {
    let words = || Look::ALL.iter().map(|look| look.name());
    Look::from_name(name).ok_or_else(|| unknown_word("look", name, words()))
}

fn dialect_called(name: &str) -> PyResult<Dialect> {
    let words = || Dialect::ALL.iter().map(|dialect| dialect.name());
    Dialect::from_name(name).ok_or_else(|| unknown_word("dialect", name, words()))
}
