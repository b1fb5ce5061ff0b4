//! `jaspe.Image`: a film, and what can be made of it.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use jaspe_edge::file::Output;
use jaspe_render::{Alpha, Depth, Encoding, Film, Format, Samples, develop, encode, srgb_decode};
use numpy::{PyArray1, PyArrayMethods as _, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::error::{os_error, value_error};
use crate::points;

/// A picture: linear light, as it was rendered, which is encoded for the display when it is shown, saved or converted to bytes.
///
/// `numpy.asarray(image)` gives the bytes of the picture as a display or a PNG file has them, of shape (height, width, 3), or
/// 4 with straight alpha where a pixel is not wholly covered. `linear` gives the light itself.
///
/// An image can be made from an array of light: `Image(numpy.zeros((480, 640, 3), numpy.float32))`.
#[pyclass(frozen, eq, module = "jaspe")]
#[derive(PartialEq)]
pub struct Image {
    film: Arc<Film>,
    layers: Vec<(String, Arc<Film>)>,
}

impl Image {
    /// A picture with what else was rendered.
    pub fn new(film: Film, layers: Vec<(String, Film)>) -> Self {
        let layers = layers.into_iter().map(|(name, film)| (name, Arc::new(film))).collect();
        Image { film: Arc::new(film), layers }
    }
}

#[pymethods]
impl Image {
    /// From numbers of shape (height, width, 3), or 4 with the covered share of each pixel last; `encoding` says whether they
    /// are "linear" light or "display" values from 0 to 1, and `layers` are pictures that go with it, by their names.
    #[new]
    #[pyo3(signature = (pixels, encoding = "linear", layers = None))]
    fn from_pixels(
        pixels: &Bound<'_, PyAny>,
        encoding: &str,
        layers: Option<HashMap<String, Bound<'_, Image>>>,
    ) -> PyResult<Self> {
        let encoding = match encoding {
            "linear" => Encoding::Linear,
            "display" => Encoding::Display,
            _ => {
                let message = format!("encoding: expected \"linear\" or \"display\", found \"{encoding}\"");
                return Err(value_error(message));
            }
        };
        let numpy = pixels.py().import("numpy")?;
        let pixels = numpy.call_method1("ascontiguousarray", (pixels, "float32"))?;
        let pixels: PyReadonlyArray3<'_, f32> = pixels.extract().map_err(|_| wrong_shape())?;
        let pixels = pixels.as_array();
        let (height, width, channels) = pixels.dim();
        let is_size = |side: usize| (1..=MAX_SIDE).contains(&side);
        if !(is_size(height) && is_size(width) && (channels == 3 || channels == 4)) {
            return Err(wrong_shape());
        }
        let rows = pixels.rows().into_iter();
        let pixels = rows.map(|p| [p[0], p[1], p[2], if channels == 4 { p[3] } else { 1.0 }]).collect();
        let film = Film { width: width as u32, height: height as u32, pixels, encoding };
        let layers = layers.unwrap_or_default().into_iter();
        let mut layers: Vec<_> = layers.map(|(name, image)| (name, Arc::clone(&image.get().film))).collect();
        layers.sort_by(|(a, _), (b, _)| a.cmp(b));
        Ok(Image { film: Arc::new(film), layers })
    }

    /// Pixels per row.
    #[getter]
    fn width(&self) -> u32 {
        self.film.width
    }

    /// Rows.
    #[getter]
    fn height(&self) -> u32 {
        self.film.height
    }

    /// Whether `pixels` are "linear" light or "display" values, as the dialect of the 2010 program computes.
    #[getter]
    fn encoding(&self) -> &'static str {
        match self.film.encoding {
            Encoding::Linear => "linear",
            Encoding::Display => "display",
        }
    }

    /// What was rendered, untouched: float32 of shape (height, width, 4), red, green, blue and the covered share, row by row
    /// from the top left.
    #[getter]
    fn pixels<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let numbers = PyArray1::from_slice(py, self.film.pixels.as_flattened());
        Ok(numbers.reshape([self.film.height as usize, self.film.width as usize, 4])?.into_any())
    }

    /// What else was asked for when it was rendered, by name: see `Scene.render`.
    #[getter]
    fn layers(&self) -> HashMap<String, Image> {
        let image = |film: &Arc<Film>| Image { film: Arc::clone(film), layers: Vec::new() };
        self.layers.iter().map(|(name, film)| (name.clone(), image(film))).collect()
    }

    /// Linear light: float32 of shape (height, width, 3), Rec. 709 primaries, unbounded.
    #[getter]
    fn linear<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let decode = |value: f32| srgb_decode(f64::from(value)) as f32;
        let pixels = self.film.pixels.iter().map(|&[red, green, blue, _]| [red, green, blue]);
        let numbers: Vec<[f32; 3]> = match self.film.encoding {
            Encoding::Linear => pixels.collect(),
            Encoding::Display => pixels.map(|color| color.map(decode)).collect(),
        };
        let numbers = PyArray1::from_slice(py, numbers.as_flattened());
        Ok(numbers.reshape([self.film.height as usize, self.film.width as usize, 3])?.into_any())
    }

    /// Display-encoded samples: uint8, or uint16 with `bits=16`, of shape (height, width, 3), or 4 with straight alpha where a
    /// pixel is not wholly covered.
    #[pyo3(signature = (bits = 8))]
    fn display<'py>(&self, py: Python<'py>, bits: u8) -> PyResult<Bound<'py, PyAny>> {
        let depth = match bits {
            8 => Depth::Eight,
            16 => Depth::Sixteen,
            _ => return Err(value_error(format!("bits: expected 8 or 16, found {bits}"))),
        };
        let film = Arc::clone(&self.film);
        let image = py.detach(|| develop(&film, depth, Alpha::Straight));
        let shape = [image.height as usize, image.width as usize, image.channel_count];
        Ok(match image.samples {
            Samples::Eight(samples) => PyArray1::from_vec(py, samples).reshape(shape)?.into_any(),
            Samples::Sixteen(samples) => PyArray1::from_vec(py, samples).reshape(shape)?.into_any(),
        })
    }

    /// The bytes of the picture, for NumPy: see the class.
    #[pyo3(signature = (dtype = None, copy = None))]
    fn __array__<'py>(
        &self,
        py: Python<'py>,
        dtype: Option<&Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        points::copied("an image", dtype, copy, || self.display(py, 8))
    }

    /// Writes the picture; the extension chooses the format: .png, .jpg, .tiff and .bmp are encoded for the display, .exr and
    /// .hdr hold linear light. `bits=16` gives PNG and TIFF 16 bits. The file appears whole or not at all.
    #[pyo3(signature = (path, *, bits = None))]
    fn save(&self, py: Python<'_>, path: PathBuf, bits: Option<u8>) -> PyResult<()> {
        if !matches!(bits, None | Some(8 | 16)) {
            return Err(value_error(format!("bits: expected 8 or 16, found {}", bits.unwrap_or_default())));
        }
        // The extension is the caller's mistake; folders and permissions are the system's answer.
        Format::from_path(&path).map_err(|error| {
            let known = Format::EXTENSIONS.iter().map(|extension| format!(".{extension}")).collect::<Vec<_>>();
            value_error(format!("{error}; the extension chooses the format: {}", known.join(", ")))
        })?;
        let film = Arc::clone(&self.film);
        py.detach(|| Output::new(&path, bits)?.write(&film)).map(drop).map_err(os_error)
    }

    /// The picture as PNG, by which notebooks show it.
    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let film = Arc::clone(&self.film);
        let bytes = py.detach(|| encode(&film, Format::Png(Depth::Eight))).map_err(value_error)?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn __repr__(&self) -> String {
        format!("<jaspe.Image {} x {}>", self.film.width, self.film.height)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let (py, image) = (slf.py(), slf.get());
        let arguments = (image.pixels(py)?, image.encoding(), image.layers());
        Ok((py.get_type::<Image>().into_any(), arguments.into_pyobject(py)?.into_any()))
    }
}

/// As in the scene format.
const MAX_SIDE: usize = 16_384;

fn wrong_shape() -> PyErr {
    value_error(format!(
        "an image is made of numbers of shape (height, width, 3) or (height, width, 4), with sides from 1 to {MAX_SIDE}"
    ))
}
