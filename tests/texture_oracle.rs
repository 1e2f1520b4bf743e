//! Texture parameters against nine reference surfaces: closed forms where they exist, an independent implementation elsewhere.
//!
//! Every value that is graded must lie within its own tolerance; undefined ones must be undefined with a reason.

use gearcut::measure::topography::{Arguments, Chain, Evaluation, Form};
use gearcut::output::surface_files::read_surface;
use serde_json::Value;
use std::path::{Path, PathBuf};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/topography").join(name)
}

/// Symbol here of a name there.
fn symbol(name: &str) -> String {
    match name {
        "wavevector_deg" => "Std".to_owned(),
        _ => name.strip_prefix("Smc_").map_or_else(|| name.to_owned(), |p| format!("Smc({p})")),
    }
}

/// Distance of two values; of angles modulo 180.
fn distance(name: &str, a: f64, b: f64) -> f64 {
    let difference = (a - b).abs();
    if name == "wavevector_deg" { difference.min(180.0 - difference) } else { difference }
}

struct Misses {
    checked: usize,
    lines: Vec<String>,
}

fn check_step(name: &str, step: &Value, spacing_um: [f64; 2], misses: &mut Misses) {
    let file = read_surface(&data(&format!("{name}.npy")), Some(spacing_um)).expect("a reference surface");
    let chain = Chain {
        form: match step["form"].as_str() {
            Some("none") => Form::None,
            Some("plane") => Form::Plane,
            Some("poly2") => Form::Poly2,
            other => panic!("form {other:?}"),
        },
        s_filter_um: step["S_um"].as_f64(),
        l_filter_um: step["L_um"].as_f64(),
        robust: false,
        crop_um: step["crop_each_side_um"].as_f64().expect("a number"),
    };
    let (surface, _) = chain.apply(&file.surface).expect("the chain applies");
    let evaluation = Evaluation::of(&surface, &Arguments::default());
    for (parameter, expected) in step["expected"].as_object().expect("values") {
        let found = evaluation.value(&symbol(parameter));
        let Some(value) = expected["value"].as_f64() else {
            let listed = evaluation.parameters.iter().find(|p| p.symbol == symbol(parameter)).expect("listed");
            if listed.value.is_ok() {
                misses.lines.push(format!("{name} {}: {parameter} is {found:?}, not undefined", step["name"]));
            }
            continue;
        };
        if expected["graded"] != Value::Bool(true) {
            continue;
        }
        misses.checked += 1;
        let tolerance = expected["tol"].as_f64().expect("a tolerance");
        let values = [Some(value), expected["alternative"].as_f64()];
        let near = |found: f64| values.iter().flatten().any(|v| distance(parameter, found, *v) <= tolerance);
        if !found.is_some_and(near) {
            misses.lines.push(format!("{name} {}: {parameter} is {found:?}, not {value} +- {tolerance}", step["name"]));
        }
    }
}

#[test]
fn all_graded_values_are_met_within_their_tolerances() {
    let mut misses = Misses { checked: 0, lines: Vec::new() };
    for name in [
        "p1_sine_oblique",
        "p2_eggcrate",
        "p3_feed_marks",
        "p4_triangle",
        "p5_stratified",
        "p6_gauss_isotropic",
        "p7_form_removal",
        "p8_sl_filter",
        "p9_hobbed_flank",
    ] {
        let text = std::fs::read_to_string(data(&format!("{name}.json"))).expect("a copy");
        let json: Value = serde_json::from_str(&text).expect("JSON");
        let spacing = [&json["dx_um"], &json["dy_um"]].map(|v| v.as_f64().expect("a spacing"));
        for step in json["steps"].as_array().expect("steps") {
            check_step(name, step, spacing, &mut misses);
        }
    }
    assert!(misses.lines.is_empty(), "{}", misses.lines.join("\n"));
    assert_eq!(misses.checked, 217, "values that were graded");
}
