//! What is known before cutting, on the terminal, in the results and on the page of a run: the same answers.

use crate::fixtures::command::{check_as_it_is, gearcut, read_json};
use crate::fixtures::expected::number;
use crate::fixtures::json_schema::assert_is_results;
use gearcut::process::load;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::axes_report::OperationAxes;
use gearcut::process::shaping::findings::{returns, ring};
use std::path::Path;

fn shipped(name: &str) -> ShapingJob {
    let path = format!("scenes/shaping/{name}.toml");
    ShapingJob::new(load(Path::new(&path), &[]).expect("a shipped scene").scene).expect("it can be cut")
}

/// Every question has a number, a place on the curve, what to change, and a column that a chart is drawn from.
#[test]
fn check_answers_what_is_asked_of_a_ring() {
    let job = shipped("internal_pair_ring");
    let section = ring::of_job(&job, &OperationAxes::of_job(&job)).expect("a ring");
    let table = section.table_at("teeth").expect("a table");
    assert_eq!(table.len(), 34, "the curve repeats after 34 teeth");
    for (key, column) in [
        ("rolling_teeth", "rolling_share"),
        ("clearing_teeth", "corners_in"),
        ("smallest_radius_of_curvature", "radius_of_curvature"),
        ("undercut_flanks", "printed_undercut"),
        ("involute_height", "involute_left"),
        ("tip_relief", "tip_relief_left"),
        ("tip_corner_clearance", "corners_out"),
        ("module_limit", "rolling_module"),
    ] {
        let answer = section.quantity(key).unwrap_or_else(|| panic!("no {key}"));
        // No flank is undercut here, and none has a place for it.
        assert_eq!(answer.place().is_some(), key != "undercut_flanks", "{key}: {answer:?}");
        assert!(answer.value().is_some(), "{key}: {answer:?}");
        let entry = section.entry(key).expect("the same");
        assert!(entry.advice.as_ref().is_some_and(|advice| !advice.text.is_empty()), "{key} has no advice");
        assert!(table.numbers(column).all(|value| value.is_some()), "{key}: no chart");
    }
    // The module's limit is where 13 teeth no longer roll on the oracle's smallest radius of curvature.
    let limit_mm = section.number("module_limit").expect("known");
    assert!((limit_mm - 2.0 * 72.305_560_356 / 13.0).abs() < 1e-6, "{limit_mm}");
    assert!(ring::warnings(&section, 0.02).is_empty());
    check_as_it_is("scenes/shaping/internal_pair_ring.toml").done().says(&[
        "largest cutter that rolls     72 teeth",
        "largest cutter that clears    63 teeth",
        "smallest radius of curvature  72.31 mm",
        "undercut                      0 flanks",
        "involute of the cutter        1.389 mm",
        "tips set back                 29.5",
        "tip corners                   0.99",
        "limit of the module           11.12 mm",
        "retraction angle              9.81",
        "Along the curve: largest cutter, radius of curvature, limit of the module",
        "Along the curve: undercut",
        "on the way out",
        "how far the base sets the tip back",
    ]);
}

/// An external gear whose return strokes rub on stock: `check`, the results and the page offer the same tilt at the
/// same cost.
#[test]
fn a_cut_offers_the_direction_that_clears_stock() {
    let scene = "scenes/shaping/tilted_retraction.toml";
    let settings = ["--set", "machine.retraction=center_line", "--set", "machine.double_strokes_per_minute=400"];
    let told = "machine.retraction = \"tilted\" draws the edge";
    gearcut(&[&["check", scene][..], &settings].concat())
        .done()
        .says(&["rubs on stock", "machine.retraction = \"tilted\""]);
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let cut = ["cut", scene, "--draft", "--backend", "cpu", "--out", out.to_str().expect("a path")];
    gearcut(&[&cut[..], &settings].concat()).done();
    let results = read_json(&out.join("results.json"));
    assert_is_results(&results);
    let found = &results["sections"]["operations"]["finish"]["return_strokes"];
    let value = |key: &str| number(&found[key]["value"]);
    println!(
        "{} mm deep, {} deg clears, at most {}",
        value("depth_in_stock"),
        value("clearing_tilt"),
        value("clearing_strokes_per_minute")
    );
    let advice = &found["depth_in_stock"]["advice"];
    assert!(advice["change"] == true && advice["text"].as_str().expect("words").starts_with(told), "{advice}");
    assert_eq!(found["retraction_angle"]["advice"]["change"], false, "6 deg are less than the pressure angle");
    // docs/shaping.md: the whole blank finds 0.077 mm, with all strokes and not at six places to a pitch alone; -18.9
    // to -11.3 deg clear.
    assert!((value("depth_in_stock") - 0.077).abs() < 0.01 && (value("clearing_tilt") + 15.1).abs() < 0.1);
    assert!(value("clearing_slowdown") > 1.0, "these axes are too slow for 400 double strokes");
    let page = std::fs::read_to_string(out.join("report.html")).expect("a page");
    assert!(page.contains("Return strokes") && page.contains("draws the edge away from it"));
    // The scene as it is shipped draws back so, and clears all material.
    let section = returns::section(&shipped("tilted_retraction"), 0, None).expect("poses").expect("drawn back");
    assert_eq!(section.number("depth_in_stock"), Some(0.0));
    assert!(section.number("smallest_clearance").expect("known") > 0.0);
}

/// An oval has no class: `check` offers the limits of the round gear of its mean diameter as lines of a scene. For 20
/// teeth of module 2 ISO 1328-1:2013 gives f_p = (0.001 d + 0.4 m + 5) um sqrt(2)^2 = 11.7 um in class 7, rounded to
/// 12.
#[test]
fn a_gear_without_a_class_is_offered_limits_to_paste() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("oval.toml");
    let gear = "[gear]\nmodule_mm = 2.0\nteeth = 20\nface_width_mm = 10.0\n[gear.pitch_curve.ellipse]\norder = 2\n\
                eccentricity = 0.05\n[tool.shaper_cutter]\nteeth = 24\n[tool.shaper_cutter.tip.sharp]\n";
    let check = |text: &str| {
        std::fs::write(&path, text).expect("a scene");
        gearcut(&["check", path.to_str().expect("a path")]).done()
    };
    let offered =
        check(gear).says(&["Limits of the round gear of the same mean diameter", "single_pitch_um = 12\n"]).out;
    let from = offered.find("[measure.limits]").expect("limits");
    let lines = offered[from..].lines().take_while(|line| !line.is_empty()).map(|line| format!("{}\n", line.trim()));
    // Pasted, they are read, and no longer offered.
    let outcome = check(&format!("{gear}{}", lines.collect::<String>()));
    assert!(!outcome.out.contains("Limits of the round gear"), "{}", outcome.out);
}
