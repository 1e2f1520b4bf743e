//! Cut flanks as arrays of numpy, which take over what Rust has allocated.

use gearcut::{Flank, Side};
use numpy::ndarray::{Array2, Array3, ShapeError};
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// The side of a tooth by its name.
pub fn side_named(name: &str) -> PyResult<Side> {
    let of_name = |side: &Side| side.name() == name;
    [Side::Left, Side::Right]
        .into_iter()
        .find(of_name)
        .ok_or_else(|| PyValueError::new_err(format!("`{name}` is no side of a tooth; give \"left\" or \"right\"")))
}

/// The fields of `gearcut.Flank`: arrays of the shape [columns, rows], those of vectors with 3 more.
pub fn arrays(py: Python<'_>, flank: Flank) -> PyResult<Bound<'_, PyDict>> {
    let [columns, rows] = flank.shape();
    let wrong = |error: ShapeError| PyValueError::new_err(error.to_string());
    let fields = PyDict::new(py);
    fields.set_item("tooth", flank.tooth)?;
    fields.set_item("side", flank.side.name())?;
    fields.set_item("operations", &flank.operations)?;
    fields.set_item("u_mm", PyArray1::from_vec(py, flank.arcs_mm.clone()))?;
    fields.set_item("v_mm", PyArray1::from_vec(py, flank.face_mm.clone()))?;
    let (points_mm, normals, layers) = flank.into_arrays();
    for (name, numbers) in [("points_mm", numbers(points_mm)), ("normals", numbers(normals))] {
        let array = Array3::from_shape_vec((columns, rows, 3), numbers).map_err(wrong)?;
        fields.set_item(name, array.into_pyarray(py))?;
    }
    let (heights, passes) = (PyList::empty(py), PyList::empty(py));
    for layer in layers {
        heights.append(Array2::from_shape_vec((columns, rows), layer.heights_mm).map_err(wrong)?.into_pyarray(py))?;
        passes.append(Array2::from_shape_vec((columns, rows), layer.passes).map_err(wrong)?.into_pyarray(py))?;
    }
    fields.set_item("deviations_mm", heights)?;
    fields.set_item("passes", passes)?;
    Ok(fields)
}

/// Vectors as numbers in the same memory: three numbers take the place of each.
fn numbers(vectors: Vec<impl Into<[f64; 3]>>) -> Vec<f64> {
    vectors.into_iter().map(Into::into).collect::<Vec<[f64; 3]>>().into_flattened()
}
