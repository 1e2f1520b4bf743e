//! Parameters against nine reference surfaces.
//!
//! Every reference value that is graded must lie within its own tolerance; undefined ones must be undefined with a
//! reason.

use gearcut_texture::files::read_surface;
use gearcut_texture::{Arguments, Chain, Evaluation, Form, Surface};
use serde_json::Value;
use std::path::{Path, PathBuf};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

/// Symbol here of a name there.
fn symbol(name: &str) -> String {
    match name {
        "wavevector_deg" => "Std".to_owned(),
        // Names of the edition of 2021.
        "Smr1" => "Smrk1".to_owned(),
        "Smr2" => "Smrk2".to_owned(),
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

/// Scattered holes and a large one: what is measured counts, nothing turns into NaN, and what needs every point says
/// so.
#[test]
fn holes_are_left_out_or_named() {
    let whole = read_surface(&data("p6_gauss_isotropic.npy"), Some([1.0, 1.0])).expect("a reference surface").surface;
    let (nx, ny) = (whole.nx(), whole.ny());
    let missing =
        |i: usize| (i * 7919).is_multiple_of(9973) || ((100..130).contains(&(i % nx)) && (60..80).contains(&(i / nx)));
    let heights = whole.heights_um().iter().enumerate().map(|(i, z)| if missing(i) { f64::NAN } else { *z }).collect();
    let holed = Surface::new(nx, ny, 1.0, 1.0, heights).expect("a surface");
    let [whole, evaluation] = [&whole, &holed].map(|surface| Evaluation::of(surface, &Arguments::default()));
    for parameter in &evaluation.parameters {
        match parameter.symbol.as_str() {
            "Std" | "Ssw" => {
                assert!(parameter.value.as_ref().is_err_and(|why| why.to_string().contains("holes")), "{parameter:?}");
            }
            "Spq" | "Svq" | "Smq" => {
                assert!(
                    parameter.value.as_ref().is_err_and(|why| why.to_string().contains("one stratum")),
                    "{parameter:?}"
                );
            }
            symbol => {
                let value = *parameter.value.as_ref().expect("defined");
                let before = whole.value(symbol).expect("defined");
                // Hills and dales that touch a hole are open: fewer count, and mean areas are those of the others. All
                // else is a sample of 99 % of the same points.
                let allowed = match symbol {
                    "Spd" => 0.4,
                    "Sha" | "Sda" => 0.1,
                    _ => 0.05,
                };
                let off = (value - before).abs() / before.abs().max(0.2);
                assert!(off < allowed, "{symbol}: {value} with holes, {before} without");
            }
        }
    }
    let measured: Vec<f64> = holed.heights_um().iter().copied().filter(|z| !z.is_nan()).collect();
    let mean = measured.iter().sum::<f64>() / measured.len() as f64;
    let sa = measured.iter().map(|z| (z - mean).abs()).sum::<f64>() / measured.len() as f64;
    assert!((evaluation.value("Sa").expect("defined") / sa - 1.0).abs() < 1e-12);
    // The filters keep holes, and fill none.
    for robust in [false, true] {
        let (s_filter_um, l_filter_um) = (Some(4.0), Some(50.0));
        let chain = Chain { form: Form::Poly2, s_filter_um, l_filter_um, robust, crop_um: 0.0 };
        assert_eq!(chain.apply(&holed).expect("applies").0.holes(), holed.holes());
    }
}
