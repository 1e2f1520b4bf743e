//! Pairs of gears whose cutters are drawn: cycloids, which have a closed form, and an involute given as points beside
//! the analytic one.

use super::drawn_teeth::{ROUND, involute_contour, table};
use crate::fixtures::command::gearcut;
use serde_json::Value;
use std::path::Path;

fn rolled(out: &Path, arguments: &[&str]) -> Value {
    let words = ["--quiet", "--out", out.to_str().expect("UTF-8")];
    gearcut(&[&["pair"], arguments, &words].concat()).done();
    serde_json::from_slice(&std::fs::read(out.join("results.json")).expect("results")).expect("JSON")
}

fn value<'a>(results: &'a Value, path: &[&str]) -> &'a Value {
    path.iter().fold(&results["sections"], |at, key| &at[*key])
}

fn number(results: &Value, path: &[&str]) -> f64 {
    let entry = value(results, path);
    entry["value"].as_f64().or_else(|| entry.as_f64()).unwrap_or_else(|| panic!("{path:?}: {entry}"))
}

/// Cycloids of one rolling circle turn each other evenly (Camus' theorem), at their own distance alone: what is left
/// is the tolerance of the edge and the marks of its strokes. 100 um farther apart the ratio changes with every tooth.
#[test]
fn cycloids_roll_evenly_at_their_distance_and_at_no_other() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = "scenes/shaping/cycloid.toml";
    let coarse = [scene, scene, "--positions", "288"];
    let range = ["transmission_error", "right", "peak_to_peak_at_pitch_point"];
    let right = rolled(&folder.path().join("right"), &coarse);
    let even_um = number(&right, &range);
    let off = rolled(&folder.path().join("off"), &[&coarse[..], &["--center-distance-error-um", "100"]].concat());
    let off_um = number(&off, &range);
    println!("{even_um} um, 100 um farther apart {off_um} um");
    assert!(even_um > 0.01 && even_um < 2.5, "{even_um} um");
    assert!(off_um > 4.0 * even_um, "{off_um} um, {even_um} um");
    // Drawn teeth have no key for their thickness.
    assert!(right["warnings"].to_string().contains("draw the tool's tooth wider"), "{}", right["warnings"]);
    let page = std::fs::read_to_string(folder.path().join("right/report.html")).expect("a page");
    assert!(page.contains("24 teeth, module 2 mm, drawn teeth") && page.contains("made for one distance"));
    for of_involutes in ["turn as evenly at any distance", "pressure angle 20", "Center distance"] {
        assert!(!page.contains(of_involutes), "{of_involutes}");
    }
    // What the law of involutes gives has a reason in place of a number.
    for path in [
        &["transmission_error", "right", "peak_to_peak_normal"][..],
        &["backlash", "smallest_normal"],
        &["contact", "right", "smallest_contact_ratio"],
        &["pair", "pressure_angle"],
    ] {
        let entry = value(&right, path);
        assert!(entry["value"].is_null() && entry.to_string().contains("drawn teeth"), "{path:?}: {entry}");
    }
    let nominal = ["pair", scene, scene, "--flanks", "nominal"];
    gearcut(&nominal).failed(1, &["straight-sided rack", "leave --flanks nominal out"]);
}

/// The involute given as 200 points rolls as the analytic one does, within the tolerances of both edges.
#[test]
fn an_involute_given_as_points_rolls_as_the_analytic_one() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("tooth.csv"), table(&involute_contour())).expect("written");
    let drawn = format!("{ROUND}\n").replace(
        "[tool.shaper_cutter]\nteeth = 20\n",
        "[tool.shaper_cutter]\nteeth = 20\n[tool.shaper_cutter.profile]\nfile = \"tooth.csv\"\n",
    );
    let found = [("analytic", ROUND), ("drawn", drawn.as_str())].map(|(name, text)| {
        let path = folder.path().join(format!("{name}.toml"));
        std::fs::write(&path, text).expect("written");
        let path = path.to_str().expect("UTF-8");
        let results = rolled(&folder.path().join(name), &[path, path, "--positions", "288"]);
        [
            &["transmission_error", "right", "peak_to_peak_at_pitch_point"][..],
            &["backlash", "mean"],
            &["backlash", "smallest"],
            &["contact", "right", "mean_pairs"],
        ]
        .map(|path| number(&results, path))
    });
    let [analytic, drawn] = found;
    println!("{analytic:?}\n{drawn:?}");
    // Two edges, each within 1 um of its points along the normal, on both flanks of a space.
    for at in 0..3 {
        assert!((analytic[at] - drawn[at]).abs() < 4.0 / 20_f64.to_radians().cos(), "{found:?}");
    }
    assert!((analytic[3] - drawn[3]).abs() < 0.2 && drawn[3] > 1.2, "{found:?}");
}
