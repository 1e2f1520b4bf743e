//! Texture of surfaces: of arrays and of measured files.

use crate::failure;
use crate::waiting::waited;
use gearcut::findings::Entry;
use gearcut::interrupt::Interrupt;
use gearcut::output::surface_files::read_surface;
use gearcut_texture::{Arguments, Chain, Evaluation, Form, Surface};
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::{Map, Value, json};
use std::path::PathBuf;

/// Form, S-filter, L-filter, whether it is robust, and the margin cut off every side, um.
type ChainFields = (String, Option<f64>, Option<f64>, bool, f64);

/// Parameters of heights, um, of the shape [rows, columns], points `dx_um` and `dy_um` apart: a JSON object of them,
/// and the words of the chain.
#[pyfunction]
pub fn texture(
    py: Python<'_>,
    heights_um: PyReadonlyArray2<'_, f64>,
    spacing_um: (f64, f64),
    chain: ChainFields,
) -> PyResult<(String, Vec<String>)> {
    let heights = heights_um.as_array();
    let (ny, nx) = heights.dim();
    let surface = Surface::new(nx, ny, spacing_um.0, spacing_um.1, heights.iter().copied().collect());
    evaluated(py, &surface.map_err(|error| PyValueError::new_err(error.to_string()))?, chain)
}

/// The same of a file of surfaces; some formats carry no spacing.
#[pyfunction]
pub fn texture_of_file(
    py: Python<'_>,
    path: PathBuf,
    spacing_um: Option<[f64; 2]>,
    chain: ChainFields,
) -> PyResult<(String, Vec<String>)> {
    let read = py.detach(|| read_surface(&path, spacing_um)).map_err(gearcut::output::atomic::file_error);
    evaluated(py, &read.map_err(|error| failure::of_error(py, error))?.surface, chain)
}

fn evaluated(py: Python<'_>, surface: &Surface, chain: ChainFields) -> PyResult<(String, Vec<String>)> {
    let (form, s_filter_um, l_filter_um, robust, crop_um) = chain;
    let forms = [Form::None, Form::Plane, Form::Poly2, Form::Poly2PlusCylinder];
    let named = forms.into_iter().find(|of| json!(of) == json!(form));
    let form = named.ok_or_else(|| {
        let words = forms.map(|of| json!(of).to_string()).join(", ");
        PyValueError::new_err(format!("`{form}` is no form; give one of {words}"))
    })?;
    let chain = Chain { form, s_filter_um, l_filter_um, robust, crop_um };
    let (done, raised) = waited(py, &Interrupt::default(), || {
        let (surface, words) = chain.apply(surface)?;
        Ok((Evaluation::of(&surface, &Arguments::default()), words))
    });
    if let Some(signal) = raised {
        return Err(signal);
    }
    let (evaluation, words) = done.map_err(|problem: String| PyValueError::new_err(problem))?;
    let entries = evaluation.parameters.iter().map(Entry::from);
    let quantities: Map<String, Value> = entries.map(|entry| (entry.key, json!(entry.quantity))).collect();
    Ok((Value::Object(quantities).to_string(), words))
}
