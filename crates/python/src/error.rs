//! What the libraries say, as Python's exceptions.

use jaspe_edge::Refusal;
use pyo3::PyErr;
use pyo3::exceptions::{PyOSError, PyValueError};

/// What stands in the way of writing a file.
pub fn os_error(refusal: Refusal) -> PyErr {
    PyOSError::new_err(refusal.to_string())
}

/// A value that cannot be taken.
pub fn value_error(message: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(message.to_string())
}
