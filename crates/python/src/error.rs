//! What the libraries say, as Python's exceptions.

use jaspe_edge::message::{self, Style};
use jaspe_edge::{Locator, Refusal};
use jaspe_scene::{Diagnostic, Diagnostics, Severity, Sources, Span};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

/// `jaspe.SceneError`, with every diagnostic; as text it is what the command line prints.
pub fn scene_error(py: Python<'_>, diagnostics: &Diagnostics, sources: &Sources) -> PyErr {
    let make = || -> PyResult<PyErr> {
        let text = message::text(diagnostics, sources, Severity::Warning, Style::Plain);
        let text = format!("{}\n\n{}", message::summary(diagnostics), text.trim_end());
        let class = py.import(intern!(py, "jaspe._errors"))?.getattr(intern!(py, "SceneError"))?;
        Ok(PyErr::from_value(class.call1((text, list(py, diagnostics, sources)?))?))
    };
    make().unwrap_or_else(|error| error)
}

/// The diagnostics as a list of `jaspe.Diagnostic`.
pub fn list<'py>(py: Python<'py>, diagnostics: &Diagnostics, sources: &Sources) -> PyResult<Bound<'py, PyList>> {
    let class = py.import(intern!(py, "jaspe._errors"))?.getattr(intern!(py, "Diagnostic"))?;
    let mut locator = Locator::new(sources);
    let list = PyList::empty(py);
    for diagnostic in diagnostics {
        list.append(one(&class, diagnostic, &mut locator)?)?;
    }
    Ok(list)
}

fn one<'py>(
    class: &Bound<'py, PyAny>,
    diagnostic: &Diagnostic,
    locator: &mut Locator<'_>,
) -> PyResult<Bound<'py, PyAny>> {
    let (file, line, column) = place(diagnostic.span, locator);
    let severity = diagnostic.severity.to_string();
    class.call1((severity, &diagnostic.message, file, line, column, PyTuple::new(class.py(), &diagnostic.hints)?))
}

fn place(span: Option<Span>, locator: &mut Locator<'_>) -> (Option<String>, Option<usize>, Option<usize>) {
    let place = span.and_then(|span| Some((locator.path(span)?, locator.position(span)?)));
    match place {
        Some((path, position)) => (Some(path), Some(position.line), Some(position.column)),
        None => (None, None, None),
    }
}

/// What stands in the way of writing a file.
pub fn os_error(refusal: Refusal) -> PyErr {
    PyOSError::new_err(refusal.to_string())
}

/// A value that cannot be taken.
pub fn value_error(message: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(message.to_string())
}

/// A word that is none of those expected.
pub fn unknown_word(parameter: &str, found: &str, words: impl Iterator<Item = &'static str> + Clone) -> PyErr {
    let expected = words.clone().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ");
    let message = format!("{parameter}: expected one of {expected}, found \"{found}\"");
    value_error(match jaspe_scene::nearest(found, words) {
        Some(nearest) => format!("{message}; did you mean \"{nearest}\"?"),
        None => message,
    })
}
