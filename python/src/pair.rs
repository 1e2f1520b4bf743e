//! Two gears rolled on each other.

use crate::failure;
use crate::scene::NativeScene;
use crate::waiting::{EventWatch, waited};
use gearcut::interrupt::Interrupt;
use gearcut::pair_job::flanks::FlankSource;
use gearcut::pair_job::options::PairOptions;
use gearcut::pair_job::watch::Watch as Rolling;
use gearcut::pair_job::{findings, rolled, spline};
use gearcut::{Findings, Result};
use gearcut_core::cut::Backend;
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
    let (a, b) = (&a.loaded, &b.loaded);
    let (found, raised) = waited(py, &interrupt, || -> Result<Findings> {
        let scenes = [&a.scene, &b.scene];
        let name = format!("{}_with_{}", a.scene.name, b.scene.name);
        let rolling = Rolling::new(&watch.progress, &interrupt);
        let cpu: &dyn Backend = &Cpu::default();
        if spline::is_spline(scenes) {
            let fit = spline::fit(scenes, &options, cpu, &rolling)?;
            return Ok(spline::report::findings(&name, scenes, &fit));
        }
        let rolled = rolled::roll_pair(scenes, &options, cpu, &rolling)?;
        Ok(findings::findings(&name, scenes, &options, &rolled))
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
        let name: String = name.extract()?;
        let finite = || -> PyResult<f64> {
            let number: f64 = value.extract()?;
            if number.is_finite() { Ok(number) } else { Err(PyValueError::new_err(format!("{name} is {number}"))) }
        };
        match name.as_str() {
            "flanks" => {
                options.source = match value.extract::<String>()?.as_str() {
                    "cut" => FlankSource::Cut,
                    "nominal" => FlankSource::Nominal,
                    other => {
                        let words = format!("`{other}` are no flanks; give \"cut\" or \"nominal\"");
                        return Err(PyValueError::new_err(words));
                    }
                }
            }
            "positions" => options.positions = Some(value.extract()?),
            "sections" => options.sections = Some(value.extract()?),
            "center_distance_mm" => options.center_distance_mm = Some(finite()?),
            "center_distance_error_um" => options.center_distance_error_um = finite()?,
            "eccentricity_a_um" => options.eccentricity_um_deg[0][0] = finite()?,
            "eccentricity_a_at_deg" => options.eccentricity_um_deg[0][1] = finite()?,
            "eccentricity_b_um" => options.eccentricity_um_deg[1][0] = finite()?,
            "eccentricity_b_at_deg" => options.eccentricity_um_deg[1][1] = finite()?,
            "parallelism_in_plane_um" => options.parallelism_um[0] = finite()?,
            "parallelism_out_of_plane_um" => options.parallelism_um[1] = finite()?,
            "phase_teeth" => options.phase_teeth = value.extract()?,
            "marking_um" => options.marking_um = finite()?,
            _ => return Err(PyTypeError::new_err(format!("pair() has no option `{name}`"))),
        }
    }
    Ok(options)
}
