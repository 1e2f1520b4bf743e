//! `gearcut budget` and `gearcut diagnose` as a user starts them.

use super::round::SCENE;
use crate::fixtures::command::{gearcut_in, read_json};
use crate::fixtures::json_schema::assert_is_results;
use std::fmt::Write as _;
use std::path::Path;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("round.toml"), SCENE).expect("written");
    folder
}

fn heads(path: &Path) -> String {
    std::fs::read_to_string(path).expect("a table").lines().next().unwrap_or_default().to_owned()
}

#[test]
fn a_budget_ranks_errors_and_writes_its_tables() {
    let folder = folder();
    let arguments = ["budget", "round.toml", "--parameters", "mounting,machine.errors.guide", "--flanks", "2-left"];
    let done = gearcut_in(folder.path(), &arguments).done().says(&["work eccentricity, 90 deg", "predicted"]);
    assert!(done.out.lines().all(|line| line.chars().count() <= 80), "{}", done.out);
    let out = folder.path().join("out/round_budget");
    let table = std::fs::read_to_string(out.join("budget.csv")).expect("a table");
    assert!(table.starts_with("parameter,error,unit,step,per_step_um,largest_um_per_unit,F_alpha"), "{table}");
    // Eccentricity and wobble have two parts each; an offset along the axis does nothing to spur teeth.
    assert_eq!(table.lines().count(), 1 + 2 + 2 + 1 + 4, "{table}");
    assert!(table.lines().last().is_some_and(|line| line.starts_with("mounting.axial_offset_um")), "{table}");
    assert!(heads(&out.join("tables/influence_maps.csv")).contains("mounting_eccentricity_um_0_um_per_um"));
    assert_eq!(read_json(&out.join("run.json"))["command"], "budget");
    assert!(std::fs::read_to_string(out.join("report.html")).expect("a page").contains("What costs what"));
    let results = read_json(&out.join("results.json"));
    assert_is_results(&results);
    assert_eq!(results["complete"], true);
}

#[test]
fn what_cannot_be_ranked_is_refused() {
    let folder = folder();
    let budget = |more: &[&str]| gearcut_in(folder.path(), &[&["budget", "round.toml"], more].concat());
    budget(&["--parameters", "mounting.eccentrcity_um"]).failed(1, &["mounting.eccentricity_um", "tool.shaper_cutter"]);
    budget(&["--flanks", "25-left"]).failed(1, &["25", "24"]);
    budget(&["--flanks", "7"]).failed(1, &["7-left"]);
    assert!(!folder.path().join("out/round_budget").exists(), "nothing is left behind");
}

#[test]
fn a_diagnosis_names_a_slope_and_refuses_what_is_not_measured() {
    let folder = folder();
    let mut table = "tooth,flank,u_mm,v_mm,deviation_um\n".to_owned();
    // A sideways slope of 30 um in 100 mm: 0.3 v cos(alpha), left and right against each other.
    for (flank, sign) in [("left", 1.0), ("right", -1.0)] {
        for row in -9..=9 {
            let um = sign * 0.3 * f64::from(row) * 20_f64.to_radians().cos() + if row % 2 == 0 { 0.1 } else { -0.1 };
            let _ = writeln!(table, "5,{flank},2.0,{row},{um}");
        }
    }
    std::fs::write(folder.path().join("gear.csv"), &table).expect("written");
    let diagnose = |more: &[&str]| {
        gearcut_in(
            folder.path(),
            &[&["diagnose", "round.toml", "--measured", "gear.csv", "--parameters", "machine.errors.guide"], more]
                .concat(),
        )
    };
    let done = diagnose(&["--noise-um", "0.2"]).done().says(&["guide: tangential slope", "95 %"]);
    assert!(done.out.lines().all(|line| line.chars().count() <= 80), "{}", done.out);
    let out = folder.path().join("out/round_diagnosis");
    let results = read_json(&out.join("results.json"));
    assert_is_results(&results);
    assert_eq!(results["headline"]["sources"]["value"], 1, "{results:#}");
    let sources = std::fs::read_to_string(out.join("tables/sources.csv")).expect("a table");
    let size: f64 =
        sources.lines().nth(1).and_then(|line| line.split(',').nth(3)).expect("a row").parse().expect("a size");
    assert!((size - 30.0).abs() < 1.0, "{sources}");
    assert!(sources.contains(",fitted,"), "{sources}");
    diagnose(&["--noise-um", "0"]).failed(1, &["--noise-um", "above 0"]);
    for (from, to, words) in [
        ("deviation_um", "height", "deviation_um"),
        ("5,left", "25,left", "25"),
        ("5,left", "5,upper", "left or right"),
        ("2.0,9,", "2.0,nan,", "a number"),
        ("2.0,9,", "2.0,99,", "off the flank"),
    ] {
        std::fs::write(folder.path().join("gear.csv"), table.replace(from, to)).expect("written");
        diagnose(&["--noise-um", "0.2"]).failed(1, &[words]);
    }
}
