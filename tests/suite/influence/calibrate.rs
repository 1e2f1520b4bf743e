//! Parameters fitted to numbers whose closed forms are known.

use super::round::{CUTTER_MM, PITCH_MM, SCENE, loaded};
use crate::fixtures::command::{gearcut_in, read_json};
use crate::fixtures::json_schema::assert_is_results;
use gearcut::backend::{BackendWish, Choice, OnFailure, choose};
use gearcut::influence::budget::chosen;
use gearcut::influence::calibrate::{Calibration, MeasuredGear, MeasuredNumber};
use gearcut::influence::known_cuts::KnownCuts;
use gearcut::influence::numbers::numbers;
use gearcut::interrupt::Interrupt;
use gearcut::progress::{Progress, ProgressMode};

/// A gear that is cut in a fraction of a second.
const COARSE: [&str; 5] = [
    "operation.finish.strokes_per_revolution=480",
    "fields.flank.profile_spacing_um=80",
    "fields.flank.lead_spacing_um=5000",
    "fields.blank.spacing_mm=1.0",
    "fields.chips.spacing_mm=0.4",
];

fn settings() -> Vec<String> {
    let start = ["mounting.eccentricity_um=5"];
    COARSE.iter().chain(&start).map(|&setting| setting.to_owned()).collect()
}

/// What the scene predicts, and what errors add to it: runout 2 e, mean tooth thicker by 2 a tan(alpha) where the
/// centre distance is too large by a. An eccentricity of 9 um, and 120 um/m of scale.
fn measured(choice: &Choice) -> Vec<MeasuredNumber> {
    let before = numbers(&loaded(&settings()), choice, &Interrupt::default()).expect("cut");
    let thicker_mm = 2.0 * 120e-6 * (PITCH_MM + CUTTER_MM) * 20_f64.to_radians().tan();
    let number = |quantity: &str, more: f64, uncertainty: f64| MeasuredNumber {
        quantity: quantity.to_owned(),
        value: before[quantity].0 + more,
        uncertainty,
    };
    vec![number("headline.F_r", 2.0 * (9.0 - 5.0), 0.2), number("round_gear.thickness_as_cut", thicker_mm, 2e-4)]
}

#[test]
fn errors_of_a_round_gear_are_fitted_to_its_runout_and_thickness() {
    let choice = choose(BackendWish::Cpu, OnFailure::default()).expect("the processor");
    let loaded = loaded(&settings());
    let [eccentric, scale, offset] =
        ["mounting.eccentricity_um@0", "machine.errors.center_distance.scale_um_per_m", "mounting.axial_offset_um"];
    let parameters = chosen(&loaded, &[eccentric, scale, offset].map(str::to_owned)).expect("parameters");
    let quiet = Progress::new(ProgressMode::Quiet);
    let measured = MeasuredGear::of_numbers(measured(&choice));
    let (go_on, nothing) = (Interrupt::default(), KnownCuts::default());
    let found = Calibration::new(&loaded, &parameters, &measured, &choice, &quiet, &go_on, &nothing).expect("cut");
    assert!(found.settled, "{found:?}");
    let of = |id: &str| found.fitted.iter().find(|(parameter, _)| parameter.id == id).expect("asked for").1;
    let [shift, half] = of(eccentric).expect("the runout says it");
    // The uncertainty of the runout over its derivative 2, by the normal distribution's 1.96.
    assert!((shift - 4.0).abs() < 0.1 && (half / (1.96 * 0.1) - 1.0).abs() < 0.05, "{shift} +- {half} um");
    let [shift, half] = of(scale).expect("the thickness says it");
    assert!((shift - 120.0).abs() < half && half < 20.0, "{shift} +- {half} um/m");
    assert_eq!(of(offset), None, "spur teeth are the same all along");
}

#[test]
fn the_command_prints_a_fitted_scene_and_refuses_unknown_numbers() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("round.toml"), SCENE).expect("written");
    let settings: Vec<String> = settings().into_iter().flat_map(|setting| ["--set".to_owned(), setting]).collect();
    let calibrate = |rows: &str| {
        std::fs::write(folder.path().join("numbers.csv"), format!("quantity,value,uncertainty\n{rows}"))
            .expect("written");
        let fit = "mounting.eccentricity_um@0,mounting.axial_offset_um";
        let arguments = ["calibrate", "round.toml", "--measured", "numbers.csv", "--fit", fit];
        let arguments: Vec<&str> = arguments.into_iter().chain(settings.iter().map(String::as_str)).collect();
        gearcut_in(folder.path(), &arguments)
    };
    let words = ["fitted", "--set 'mounting.eccentricity_um=", "cannot be identified", "predicted"];
    let done = calibrate("headline.F_r,18.0,0.2\n").done().says(&words);
    assert!(done.out.lines().all(|line| line.chars().count() <= 80), "{}", done.out);
    assert!(done.err.contains("as many numbers are fitted as measured"), "{}", done.err);
    let out = folder.path().join("out/round_calibration");
    let results = read_json(&out.join("results.json"));
    assert_is_results(&results);
    let shift = results["headline"]["fit_1"]["value"].as_f64().expect("a number");
    assert!((shift - 4.0).abs() < 0.5, "{results:#}");
    everything_is_marked(&results);
    // An offset along the axis does nothing to spur teeth: it has no size, and is named.
    let offset = &results["headline"]["fit_2"];
    assert!(offset["value"].is_null() && offset["why"].is_string(), "{offset:#}");
    assert!(done.err.contains("mounting.axial_offset_um cannot be identified"), "{}", done.err);
    let page = std::fs::read_to_string(out.join("report.html")).expect("a page");
    for words in ["mounting.axial_offset_um cannot be identified", "Predicted by the scene", ">Fitted<", "fitted"] {
        assert!(page.contains(words), "no {words:?} on the page");
    }
    // What it writes is read again.
    let again = ["calibrate", "round.toml", "--measured", "out/round_calibration/tables/numbers.csv", "--out", "again"];
    let again = [&again[..], &["--fit", "mounting.eccentricity_um@0"]].concat();
    let again: Vec<&str> = again.into_iter().chain(settings.iter().map(String::as_str)).collect();
    gearcut_in(folder.path(), &again).done().says(&["headline.F_r"]);
    calibrate("headline.F_q,18.0,0.2\n").failed(1, &["headline.F_q", "results.json"]);
    calibrate("headline.F_r,18.0,0\n").failed(1, &["uncertainty", "above 0"]);
}

/// Every number of a calibration says in its definition whether it was measured, fitted or predicted.
fn everything_is_marked(results: &serde_json::Value) {
    let marked = |words: &str| ["fitted", "predicted", "measured"].iter().any(|mark| words.starts_with(mark));
    let mut numbers = 0;
    let mut look = |what: &serde_json::Value| {
        if what.get("value").is_some() || what["unit"].is_string() {
            numbers += 1;
            assert!(marked(what["definition"].as_str().unwrap_or_default()), "{what:#}");
        }
    };
    results["headline"].as_object().expect("numbers").values().for_each(&mut look);
    for (key, part) in results["sections"]["calibration"].as_object().expect("a section") {
        if key.starts_with('$') {
            continue;
        }
        match part.get("columns").and_then(serde_json::Value::as_array) {
            // Words (parameter, unit, quantity) have no unit; numbers without one have theirs in another column.
            Some(columns) => columns.iter().for_each(&mut look),
            None => look(part),
        }
    }
    assert!(numbers > 4, "{numbers} numbers are too few: {results:#}");
}
