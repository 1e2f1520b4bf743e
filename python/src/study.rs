//! Studies: many scenes that differ in a few keys.

use crate::failure;
use crate::waiting::{EventWatch, waited};
use gearcut::Result;
use gearcut::backend::{BackendWish, OnFailure, choose};
use gearcut::interrupt::Interrupt;
use gearcut::study::file::{folder_of, read};
use gearcut::study::plan::Shard;
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Makes the cases of a study file, or of a share of them, that its folder does not have yet: the folder.
#[pyfunction]
pub fn study(
    py: Python<'_>,
    path: PathBuf,
    out: Option<PathBuf>,
    shard: (u64, u64),
    most_cases: u64,
    watcher: Option<Py<PyAny>>,
) -> PyResult<PathBuf> {
    let interrupt = Interrupt::default();
    let watch = EventWatch::new(watcher, &interrupt);
    let (number, of) = shard;
    let shard: Shard = format!("{number}/{of}").parse().map_err(PyValueError::new_err)?;
    let stem = path.file_stem().map_or_else(|| "study".into(), |stem| stem.to_string_lossy().into_owned());
    let out = out.unwrap_or_else(|| folder_of(&format!("{stem}_study"), shard));
    let (made, raised) = waited(py, &interrupt, || -> Result<_> {
        let file = read(&path, most_cases)?;
        let base = file.base()?;
        let choice = choose(BackendWish::Cpu, OnFailure::default())?;
        file.study(&base, shard, &choice).run(&out, (&watch.progress, &interrupt))
    });
    let made = match (made, watch.raised().or(raised)) {
        (Ok(made), Some(raised)) if raised.is_instance_of::<PyKeyboardInterrupt>(py) => {
            let words =
                format!("{} of {} cases are in {}; go on with the same call", made.rows, made.cases, out.display());
            return Err(PyKeyboardInterrupt::new_err(words));
        }
        (_, Some(raised)) => return Err(raised),
        (made, None) => made.map_err(|error| failure::of_error(py, error))?,
    };
    Ok(made.path)
}
