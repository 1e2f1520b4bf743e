//! Errors of gearcut as exceptions of Python.
//!
//! In: an error and, where there is one, the scene that it is about. Out: `gearcut.SceneError` with every problem, its
//! key, place, allowed values and way out; `gearcut.RefusedError`; `OSError`; `gearcut.GearcutError`.

use gearcut::scene::{LoadedScene, Problem, SceneErrors, SourcePlace};
use gearcut::{Error, Refusal};
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// The exception for an error of work on a scene: what geometry refuses is shown at its place in the scene.
pub fn of_scene(py: Python<'_>, scene: &LoadedScene, error: Error) -> PyErr {
    match error {
        Error::Refused(refusal) if !refusal.key.starts_with("--") => of_problems(py, &scene.explain(&refusal)),
        other => of_error(py, other),
    }
}

/// The exception for any other error.
pub fn of_error(py: Python<'_>, error: Error) -> PyErr {
    match error {
        Error::Scene(errors) => match errors.downcast::<SceneErrors>() {
            Ok(errors) => of_problems(py, &errors),
            Err(other) => made(py, "GearcutError", (other.to_string(),)),
        },
        Error::Refused(Refusal { key, problem, way_out }) => made(py, "RefusedError", (key, problem, way_out)),
        Error::Interrupted => PyKeyboardInterrupt::new_err(error.to_string()),
        Error::Io { ref source, .. } if source.raw_os_error().is_some() => {
            PyOSError::new_err((source.raw_os_error(), error.to_string()))
        }
        other => made(py, "GearcutError", (other.to_string(),)),
    }
}

/// The exception for a scene that is wrong.
pub fn of_problems(py: Python<'_>, errors: &SceneErrors) -> PyErr {
    let problems = errors.problems.iter().map(|problem| fields(py, problem)).collect::<PyResult<Vec<_>>>();
    match problems.and_then(|problems| PyList::new(py, problems)) {
        Ok(problems) => made(py, "SceneError", (errors.to_string(), problems)),
        Err(failed) => failed,
    }
}

/// The fields of `gearcut.Problem`.
fn fields<'py>(py: Python<'py>, problem: &Problem) -> PyResult<Bound<'py, PyDict>> {
    let key = problem.key();
    let known = key.and_then(|key| gearcut::key_table().displayed(key));
    let fields = PyDict::new(py);
    fields.set_item("key", key)?;
    fields.set_item("message", &problem.message)?;
    fields.set_item("way_out", &problem.way_out)?;
    fields.set_item("allowed", known.map(gearcut::scene::Key::allowed))?;
    fields.set_item("unit", known.map(|known| known.unit).filter(|unit| !unit.is_empty()))?;
    let (file, line, column, source) = match &problem.place {
        SourcePlace::Line { file, line, column, source, .. } => (Some(file), Some(line), Some(column), Some(source)),
        SourcePlace::File { file } => (Some(file), None, None, None),
        SourcePlace::Set { argument } => (None, None, None, Some(argument)),
    };
    fields.set_item("file", file)?;
    fields.set_item("line", line)?;
    fields.set_item("column", column)?;
    fields.set_item("source", source)?;
    Ok(fields)
}

/// An exception of the package.
fn made<'py>(py: Python<'py>, class: &str, arguments: impl pyo3::call::PyCallArgs<'py>) -> PyErr {
    let made = py.import("gearcut._errors").and_then(|errors| errors.getattr(class)?.call1(arguments));
    made.map_or_else(|failed| failed, PyErr::from_value)
}
