//! `jaspe.Texture`: a procedural material over arrays of points. Its parameters are properties, one for each that is declared.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use jaspe_bake::{Loop, PREVIEW_SIZE};
use jaspe_render::swatch;
use jaspe_texture::declare::{Declaration, Kind, Parameter, Value};
use jaspe_texture::{BuildError, Space, Texture as Material};
use numpy::{PyArrayDyn, PyArrayMethods as _, PyReadonlyArrayDyn, PyUntypedArrayMethods as _};
use pyo3::exceptions::{PyAttributeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyCFunction, PyDict, PyString, PyTuple};

use crate::bake::{self, Wanted};
use crate::error::value_error;
use crate::image::Image;
use crate::noise::shown;
use crate::points::{self, Points};
use crate::work;

/// A procedural material: `Texture("marble", depth=6, seed=7)`.
///
/// `jaspe.textures` lists the materials with their parameters. Each parameter is an attribute, which can be read and
/// changed. Colours are display-encoded red, green and blue from 0 to 1.
#[pyclass(frozen, module = "jaspe")]
pub struct Texture {
    declaration: &'static Declaration,
    state: Mutex<State>,
}

/// What changes when a parameter is set.
#[derive(Clone)]
struct State {
    /// What was given; the defaults stand for the rest.
    given: Vec<(&'static str, Value)>,
    material: Material,
}

impl Texture {
    fn state(&self) -> State {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The texture as it is now.
    pub fn material(&self) -> Material {
        self.state().material
    }

    fn parameter(&self, name: &str) -> PyResult<&'static Parameter> {
        self.declaration
            .parameter(name)
            .ok_or_else(|| PyAttributeError::new_err(unknown_parameter(self.declaration, name)))
    }

    fn get(&self, name: &str) -> PyResult<Value> {
        let parameter = self.parameter(name)?;
        let given = self.state().given.into_iter().find(|(given, _)| *given == name);
        Ok(given.map_or(parameter.default, |(_, value)| value))
    }

    /// Sets a parameter; `None` gives it its default again.
    fn set(&self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let parameter = self.parameter(name)?;
        let value = if value.is_none() { None } else { Some(read(parameter, value)?) };
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let mut given = state.given.clone();
        given.retain(|(given, _)| *given != parameter.name);
        given.extend(value.map(|value| (parameter.name, value)));
        let material = Material::build(self.declaration.name, &given).map_err(value_error)?;
        *state = State { given, material };
        Ok(())
    }
}

#[pymethods]
impl Texture {
    #[new]
    #[pyo3(signature = (name, /, **parameters))]
    fn new(name: &str, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let declaration = declaration(name)?;
        let mut given = Vec::new();
        for (key, value) in parameters.into_iter().flatten() {
            let key: String = key.extract()?;
            let parameter = declaration.parameter(&key);
            let parameter = parameter.ok_or_else(|| PyTypeError::new_err(unknown_parameter(declaration, &key)))?;
            if !value.is_none() {
                given.push((parameter.name, read(parameter, &value)?));
            }
        }
        let material = Material::build(name, &given).map_err(value_error)?;
        Ok(Texture { declaration, state: Mutex::new(State { given, material }) })
    }

    /// The name of the material.
    #[getter]
    fn name(&self) -> &'static str {
        self.declaration.name
    }

    /// All parameters with their present values.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let values = PyDict::new(py);
        for parameter in self.declaration.parameters {
            values.set_item(parameter.name, python(py, self.get(parameter.name)?)?)?;
        }
        Ok(values)
    }

    /// The colours at points of shape (…, 3), or (…, 2) of a texture whose `space` is "uv": float32 of shape (…, 3),
    /// display-encoded from 0 to 1. Points are rounded to single precision, in which textures are evaluated.
    fn sample<'py>(&self, points: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let material = self.material();
        let points = points_of(&material, points)?;
        let colors = points::results::<f32>(points.py(), points.shape(), &[3])?;
        self.evaluate(&points, &colors, 3, |material, columns, colors| match *columns {
            [x, y] => material.colors([x, y], colors.as_chunks_mut().0),
            [x, y, z] => material.colors([x, y, z], colors.as_chunks_mut().0),
            _ => unreachable!("points have two or three coordinates"),
        })?;
        Ok(colors.into_any())
    }

    /// The coefficient that mixes the two colours, at points as for `sample`: float32 of shape (…), 1 for
    /// `diffuse_initial` and 0 for `diffuse_final`; it may lie outside.
    fn field<'py>(&self, points: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let material = self.material();
        let points = points_of(&material, points)?;
        let values = points::results::<f32>(points.py(), points.shape(), &[])?;
        self.evaluate(&points, &values, 1, |material, columns, values| match *columns {
            [x, y] => material.evaluate([x, y], values),
            [x, y, z] => material.evaluate([x, y, z], values),
            _ => unreachable!("points have two or three coordinates"),
        })?;
        points::array_or_number(values)
    }

    /// A picture of the material on a plane, without light, as `jaspe texture` draws it: the slice z = 0.35, two units across
    /// its shorter side, or u and v from 0 to 1. `size` is the length of both sides in pixels, or (width, height); everything
    /// appears `scale` times as large.
    #[pyo3(signature = (size = None, scale = 1.0))]
    fn image(&self, py: Python<'_>, size: Option<&Bound<'_, PyAny>>, scale: f64) -> PyResult<Image> {
        let size = size.map_or(Ok([512; 2]), |size| sides("size", size))?;
        if !(1e-6..=1e6).contains(&scale) {
            return Err(value_error(format!("scale: expected a number from 0.000001 to 1000000, found {scale}")));
        }
        let (material, pool) = (self.material(), work::pool()?);
        let film = work::interruptible(py, None, move |_| pool.install(|| swatch(&material, size, scale)))?;
        Ok(Image::new(film, Vec::new()))
    }

    /// Bakes maps that tile without a seam, exactly periodic and not blended: `texture.bake(512, ["color", "normal"])`. Each
    /// is float32 from 0 to 1, of shape (height, width) or (height, width, 3): "color" and "emission" display-encoded, "height"
    /// from the lowest to the highest point, "normal" with 0.5 in the middle and from exact derivatives, "roughness", "ao".
    /// Without `maps`, all that tell of the material.
    ///
    /// `size` is the width in pixels. `tile` is the width in units of the texture, by default what shows the material well.
    /// `surface` is unrolled: "plane", or "sphere", "cube" and "cylinder", which are cut from the solid material; or `mesh`, an OBJ
    /// file, in its own texture coordinates. Green points up in a normal map of OpenGL ("gl") and down in one of DirectX
    /// ("dx"). `frames` makes it the one of number `frame` in a sequence that returns to its beginning, while `pace` noise cells of
    /// time pass. `progress` is as for `Scene.render`.
    #[pyo3(signature = (
        size = 1024, maps = None, *, tile = None, surface = "plane", mesh = None, normal = "gl", frames = None, pace = 1, frame = 0,
        progress = None
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are named where this is called")]
    fn bake<'py>(
        &self,
        py: Python<'py>,
        size: u32,
        maps: Option<Vec<String>>,
        tile: Option<f64>,
        surface: &str,
        mesh: Option<PathBuf>,
        normal: &str,
        frames: Option<u32>,
        pace: u32,
        frame: u32,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (surface, normal) = (surface.to_owned(), normal.to_owned());
        let animation = frames.map(|frames| Loop { frames, first: 0, cells: pace });
        let wanted = Wanted { size, maps, tile, surface, mesh, normal, animation };
        bake::arrays(py, self.material(), wanted, frame, progress)
    }

    /// Bakes a set of files into a folder, as `jaspe bake` does, and returns their names: the maps, a `material.json` that says what
    /// was baked, and the files by which other programs open it. The folder appears whole or not at all.
    ///
    /// `format` is "png", "exr", "jpg" or "webp", with 8 or 16 `bits` for PNG and 16 or 32 for EXR; heights have 16 unless
    /// told. `frames` writes a whole sequence. `preview` adds a picture of the material on a ball and a cloth. The rest is as for
    /// `bake`.
    #[pyo3(signature = (
        folder, size = 1024, maps = None, *, tile = None, surface = "plane", mesh = None, normal = "gl", frames = None, pace = 1,
        format = "png", bits = None, preview = false, progress = None
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are named where this is called")]
    fn bake_set(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        size: u32,
        maps: Option<Vec<String>>,
        tile: Option<f64>,
        surface: &str,
        mesh: Option<PathBuf>,
        normal: &str,
        frames: Option<u32>,
        pace: u32,
        format: &str,
        bits: Option<u32>,
        preview: bool,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Vec<String>> {
        let (surface, normal) = (surface.to_owned(), normal.to_owned());
        let animation = frames.map(|frames| Loop { frames, first: 0, cells: pace });
        let wanted = Wanted { size, maps, tile, surface, mesh, normal, animation };
        let options = bake::set_options(format, bits, preview)?;
        bake::set(py, self.material(), wanted, folder, options, progress)
    }

    /// Renders a baked set as it looks: the material on a ball and a cloth under a sky, or on the `surface` or the `mesh` that was
    /// baked. `Texture("stone").preview()` is the `preview.png` of `jaspe bake stone --preview`, to the bit.
    ///
    /// `size` is the width of the maps, and `resolution` that of the picture, (width, height). The rest is as for `bake`.
    #[pyo3(signature = (
        size = 1024, *, resolution = None, tile = None, surface = "plane", mesh = None, frames = None, pace = 1, frame = 0,
        progress = None
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are named where this is called")]
    fn preview(
        &self,
        py: Python<'_>,
        size: u32,
        resolution: Option<&Bound<'_, PyAny>>,
        tile: Option<f64>,
        surface: &str,
        mesh: Option<PathBuf>,
        frames: Option<u32>,
        pace: u32,
        frame: u32,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Image> {
        let resolution = resolution.map_or(Ok(PREVIEW_SIZE), |size| sides("resolution", size))?;
        let (surface, normal) = (surface.to_owned(), "gl".to_owned());
        let animation = frames.map(|frames| Loop { frames, first: 0, cells: pace });
        let wanted = Wanted { size, maps: None, tile, surface, mesh, normal, animation };
        bake::preview(py, self.material(), wanted, frame, resolution, progress)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Texture>().is_ok_and(|other| self.material() == other.get().material())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let mut text = format!("Texture(\"{}\"", self.declaration.name);
        for (name, value) in self.state().given {
            text += &format!(", {name}={}", python(py, value)?.repr()?.to_string_lossy());
        }
        Ok(text + ")")
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let py = slf.py();
        let given = PyDict::new(py);
        for (name, value) in slf.get().state().given {
            given.set_item(name, python(py, value)?)?;
        }
        let restore = py.import("jaspe._jaspe")?.getattr("_texture")?;
        Ok((restore, (slf.get().declaration.name, given).into_pyobject(py)?.into_any()))
    }
}

impl Texture {
    fn evaluate(
        &self,
        points: &PyReadonlyArrayDyn<'_, f32>,
        results: &Bound<'_, PyArrayDyn<f32>>,
        width: usize,
        work: impl Fn(&Material, &[&[f32]], &mut [f32]) + Sync,
    ) -> PyResult<()> {
        let (py, material) = (points.py(), self.material());
        let mut results = results.readwrite();
        let (view, results, widths) = (points.as_array(), results.as_slice_mut()?, [width, 0]);
        match points.shape().last() {
            Some(2) => points::evaluate(py, view, results, &mut [], widths, |columns: [&[f32]; 2], results, _| {
                work(&material, &columns, results);
            }),
            _ => points::evaluate(py, view, results, &mut [], widths, |columns: [&[f32]; 3], results, _| {
                work(&material, &columns, results);
            }),
        }
    }
}

/// A texture from its name and parameters: how pickles are read.
#[pyfunction]
#[pyo3(name = "_texture")]
pub fn restore(name: &str, parameters: &Bound<'_, PyDict>) -> PyResult<Texture> {
    Texture::new(name, Some(parameters))
}

/// Points with as many coordinates as the space of the texture has, in single precision.
fn points_of<'py>(material: &Material, points: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArrayDyn<'py, f32>> {
    let dimensions = if material.space() == Space::Uv { 2 } else { 3 };
    match Points::new(points, &[dimensions])? {
        Points::Single(points) => Ok(points),
        Points::Double(points) => {
            let array = points.call_method1("astype", ("float32",))?;
            Ok(array.cast::<PyArrayDyn<f32>>()?.readonly())
        }
    }
}

/// A size in pixels, from one number for both sides or from (width, height); `parameter` is what it was given as.
fn sides(parameter: &str, size: &Bound<'_, PyAny>) -> PyResult<[u32; 2]> {
    let sides = size.extract::<i128>().map(|side| [side; 2]).or_else(|_| size.extract::<[i128; 2]>());
    let sides = sides
        .map_err(|_| PyTypeError::new_err(format!("{parameter}: expected a number of pixels, or (width, height)")))?;
    match sides.iter().find(|side| !(1..=16_384).contains(*side)) {
        Some(side) => Err(value_error(format!("{parameter}: each side is from 1 to 16384 pixels, found {side}"))),
        None => Ok(sides.map(|side| side as u32)),
    }
}

/// What the material of this name declares.
fn declaration(name: &str) -> PyResult<&'static Declaration> {
    let names = Material::ALL.iter().map(|declaration| declaration.name);
    let found = Material::ALL.iter().find(|declaration| declaration.name == name);
    found.copied().ok_or_else(|| {
        let error = BuildError::UnknownTexture { name: name.to_owned() };
        PyValueError::new_err(match jaspe_scene::nearest(name, names.clone()) {
            Some(nearest) => format!("{error}; did you mean `{nearest}`?"),
            None => format!("{error}; there are {}", names.collect::<Vec<_>>().join(", ")),
        })
    })
}

fn unknown_parameter(declaration: &'static Declaration, name: &str) -> String {
    let error = BuildError::UnknownParameter { texture: declaration.name, name: name.to_owned() };
    let names = declaration.parameters.iter().map(|parameter| parameter.name);
    match jaspe_scene::nearest(name, names.clone()) {
        Some(nearest) => format!("{error}; did you mean `{nearest}`?"),
        None => format!("{error}; it has {}", names.collect::<Vec<_>>().join(", ")),
    }
}

/// The value of a parameter from Python's: text is read as on the command line.
fn read(parameter: &'static Parameter, value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if let Ok(text) = value.cast::<PyString>() {
        return parameter.parse(&text.to_string_lossy()).map_err(value_error);
    }
    let wrong_type = |_| {
        let message = format!("`{}` takes {}, found {}", parameter.name, parameter.kind, shown(value));
        PyTypeError::new_err(message)
    };
    let value = match parameter.kind {
        Kind::Int { .. } => value.extract().map(Value::Int),
        Kind::Float { .. } => value.extract().map(Value::Float),
        Kind::Color => value.extract().map(Value::Color),
        Kind::Choice(_) => value.extract::<String>().map(|_| Value::Auto),
    };
    parameter.check(value.map_err(wrong_type)?).map_err(value_error)
}

/// The value of a parameter for Python; what follows from its surroundings is `None`.
fn python<'py>(py: Python<'py>, value: Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Int(value) => value.into_pyobject(py)?.into_any(),
        Value::Float(value) => value.into_pyobject(py)?.into_any(),
        Value::Color(color) => PyTuple::new(py, color)?.into_any(),
        Value::Choice(word) => PyString::new(py, word).into_any(),
        Value::Auto => py.None().into_bound(py),
    })
}

/// Gives the class a property for each parameter of any material.
pub fn add_properties(py: Python<'_>) -> PyResult<()> {
    let class = py.get_type::<Texture>();
    let property = py.import("builtins")?.getattr("property")?;
    let parameters = Material::ALL.iter().flat_map(|declaration| declaration.parameters);
    for &Parameter { name, kind, summary, .. } in parameters {
        if class.hasattr(name)? {
            continue;
        }
        let get = move |arguments: &Bound<'_, PyTuple>, _: Option<&Bound<'_, PyDict>>| -> PyResult<Py<PyAny>> {
            let texture: Bound<'_, Texture> = arguments.get_item(0)?.cast_into()?;
            Ok(python(arguments.py(), Texture::get(texture.get(), name)?)?.unbind())
        };
        let set = move |arguments: &Bound<'_, PyTuple>, _: Option<&Bound<'_, PyDict>>| -> PyResult<()> {
            let texture: Bound<'_, Texture> = arguments.get_item(0)?.cast_into()?;
            texture.get().set(name, &arguments.get_item(1)?)
        };
        let (get, set) = (function(py, get)?, function(py, set)?);
        let doc = format!("{summary} ({})", kind_in_words(kind));
        class.setattr(name, property.call1((get, set, py.None(), doc))?)?;
    }
    Ok(())
}

fn function<'py, T>(
    py: Python<'py>,
    body: impl Fn(&Bound<'_, PyTuple>, Option<&Bound<'_, PyDict>>) -> PyResult<T> + Send + Sync + 'static,
) -> PyResult<Bound<'py, PyCFunction>>
where
    T: for<'p> pyo3::conversion::IntoPyObjectExt<'p> + 'static,
{
    PyCFunction::new_closure(py, None, None, body)
}

fn kind_in_words(kind: Kind) -> String {
    let text = kind.to_string();
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| first.to_uppercase().chain(characters).collect())
}

/// What the materials declare.
pub fn declarations<'py>(py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
    let mut list = Vec::new();
    for declaration in Material::ALL {
        let mut parameters = Vec::new();
        for parameter in declaration.parameters {
            let entry = PyDict::new(py);
            entry.set_item("name", parameter.name)?;
            entry.set_item("summary", parameter.summary)?;
            entry.set_item("default", python(py, parameter.default)?)?;
            let (kind, range, choices) = match parameter.kind {
                Kind::Int { min, max } => ("int", (python(py, Value::Int(min))?, python(py, Value::Int(max))?), vec![]),
                Kind::Float { min, max } => {
                    ("float", (python(py, Value::Float(min))?, python(py, Value::Float(max))?), vec![])
                }
                Kind::Color => ("color", (python(py, Value::Float(0.0))?, python(py, Value::Float(1.0))?), vec![]),
                Kind::Choice(words) => ("choice", (python(py, Value::Auto)?, python(py, Value::Auto)?), words.to_vec()),
            };
            entry.set_item("kind", kind)?;
            entry.set_item("least", range.0)?;
            entry.set_item("most", range.1)?;
            entry.set_item("choices", PyTuple::new(py, choices)?)?;
            parameters.push(entry);
        }
        let entry = PyDict::new(py);
        entry.set_item("name", declaration.name)?;
        entry.set_item("summary", declaration.summary)?;
        entry.set_item("parameters", parameters)?;
        list.push(entry);
    }
    Ok(list.into_pyobject(py)?.into_any())
}
