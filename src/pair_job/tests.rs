//! Cut pairs against an independent implementation (`tests/data/pair`) and closed forms, and what is refused.

mod cut_pairs;
mod depths;
mod generated;
mod helical;
mod lead_errors;
mod mounted;
mod parallelism;
mod refusals;
mod ring_tips;
mod scallops;
mod spline;
mod working;

use serde_json::Value;
use std::path::Path;

use super::watch::Watch;
use crate::interrupt::Interrupt;
use crate::process;
use crate::progress::{Progress, ProgressMode};
use crate::scene::LoadedScene;

fn data(name: &str) -> Value {
    let path = format!("{}/tests/data/pair/{name}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_slice(&std::fs::read(path).expect("a file of expected values")).expect("JSON")
}

/// Work that nobody watches or stops.
fn unwatched<T>(work: impl FnOnce(&Watch) -> T) -> T {
    work(&Watch::new(&Progress::new(ProgressMode::Quiet), &Interrupt::default()))
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("{key} is a number"))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect()
}

fn parsed(name: &str, text: &str) -> LoadedScene {
    process::parse(text, &format!("{name}.toml"), Path::new(""), &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

/// The third-order gear of the files, finished at once by a cutter with sharp corners.
fn third_order(cutter_teeth: u64, strokes: u64, allowance_mm: f64) -> LoadedScene {
    parsed(
        "third_order",
        &format!(
            "[gear]\nmodule_mm = 3.0\nteeth = 42\nface_width_mm = 20.0\ntooth_thickness_allowance_mm = {allowance_mm}\n\
             [gear.pitch_curve.ellipse]\norder = 3\neccentricity = 0.1348\n\
             [tool.shaper_cutter]\nteeth = {cutter_teeth}\naddendum_coefficient = 1.25\n\
             [[operation]]\nname = \"finish\"\nstrokes_per_revolution = {strokes}\n\
             [operation.linkage.shaping_normal]\n[operation.infeed.none]\n"
        ),
    )
}

/// A round gear of module 3.
fn round(name: &str, teeth: u32, kind: &str, more: &str) -> LoadedScene {
    parsed(
        name,
        &format!(
            "[gear]\nmodule_mm = 3.0\nteeth = {teeth}\nface_width_mm = 20.0\n{kind}{more}\
             [tool.shaper_cutter]\nteeth = 16\n\
             [[operation]]\nname = \"finish\"\nstrokes_per_revolution = {}\n\
             [operation.infeed.none]\n\
             [fields.flank]\nprofile_spacing_um = 10.0\n",
            300 * teeth
        ),
    )
}
