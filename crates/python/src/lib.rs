//! The native part of the Python package `jaspe`: arrays, pictures and scenes in and out of the libraries. What users see of it
//! is in `python/jaspe`.

mod bake;
mod error;
mod grid;
mod image;
mod noise;
mod points;
mod scene;
mod texture;
mod work;

use pyo3::prelude::*;
use pyo3::types::PyDict;

/// What the libraries declare, by what it is: "bases", "sums", "maps" and "textures".
#[pyfunction]
fn declarations(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let [bases, sums] = noise::declarations(py)?;
    let all = PyDict::new(py);
    all.set_item("bases", bases)?;
    all.set_item("sums", sums)?;
    all.set_item("maps", bake::declarations(py)?)?;
    all.set_item("textures", texture::declarations(py)?)?;
    Ok(all)
}

/// The native part of the package; use `jaspe` itself.
#[pymodule]
mod _jaspe {
    use super::*;

    #[pymodule_export]
    use super::declarations;
    #[pymodule_export]
    use super::grid::Grid;
    #[pymodule_export]
    use super::image::Image;
    #[pymodule_export]
    use super::noise::noise;
    #[pymodule_export]
    use super::scene::Scene;
    #[pymodule_export]
    use super::texture::{Texture, restore};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        texture::add_properties(module.py())
    }
}
