//! Two gears rolled on each other.

use crate::failure;
use crate::scene::NativeScene;
use crate::waiting::{EventWatch, waited};
use gearcut::interrupt::Interrupt;
use gearcut::pair_job::found as rolled;
use gearcut::pair_job::options::PairOptions;
use gearcut::pair_job::watch::Watch as Rolling;
use gearcut_core::cut::cpu::Cpu;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The text of `results.json` of a pair; `options` are those of `gearcut pair`.
#[pyfunction]
pub fn pair(
    py: Python<'_>,
    a: &NativeScene,
    b: &NativeScene,
    options: &Bound<'_, PyDict>,
    watcher: Option<Py<PyAny>>,
) -> PyResult<String> {
    let options = of_dict(options)?;
    let interrupt = Interrupt::default();
    let watch = EventWatch::new(watcher, &interrupt);
    let (found, raised) = waited(py, &interrupt, || {
        let rolling = Rolling::new(&watch.progress, &interrupt);
        rolled([&a.loaded.scene, &b.loaded.scene], &options, &Cpu::default(), &rolling)
    });
    match watch.raised().or(raised) {
        Some(raised) => Err(raised),
        None => found.map(|found| found.to_json().to_string()).map_err(|error| failure::of_error(py, error)),
    }
}

/// The options by their names.
fn of_dict(given: &Bound<'_, PyDict>) -> PyResult<PairOptions> {
    let mut options = PairOptions::default();
    for (name, value) in given {
        let (name, value): (String, String) = (name.extract()?, value.str()?.extract()?);
        if !options.set(&name, &value).map_err(PyValueError::new_err)? {
            return Err(PyTypeError::new_err(format!("pair() has no option `{name}`")));
        }
    }
    Ok(options)
}
