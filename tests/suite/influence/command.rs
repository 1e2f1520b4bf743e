//! `gearcut budget` and `gearcut diagnose` as a user starts them.

use super::round::SCENE;
use crate::fixtures::command::{gearcut_in, read_json};
use crate::fixtures::json_schema::assert_is_results;
use crate::fixtures::picture::Picture;
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
    let names = "mounting,machine.errors.guide";
    let arguments =
        ["budget", "round.toml", "--quiet", "--backend", "cpu", "--parameters", names, "--flanks", "2-left"];
    let done = gearcut_in(folder.path(), &arguments).done().says(&["work eccentricity, 90 deg", "predicted"]);
    assert!(!done.err.contains("influence:"), "quiet: {}", done.err);
    assert!(done.out.lines().all(|line| line.chars().count() <= 80), "{}", done.out);
    let out = folder.path().join("out/round_budget");
    let table = std::fs::read_to_string(out.join("budget.csv")).expect("a table");
    assert!(table.starts_with("parameter,error,unit,step,per_step_um,largest_um_per_unit,F_alpha"), "{table}");
    // Eccentricity and wobble have two parts each; an offset along the axis does nothing to spur teeth.
    assert_eq!(table.lines().count(), 1 + 2 + 2 + 1 + 4, "{table}");
    assert!(table.lines().last().is_some_and(|line| line.starts_with("mounting.axial_offset_um")), "{table}");
    assert!(heads(&out.join("tables/influence_maps.csv")).contains("mounting_eccentricity_um_0_um_per_um"));
    assert_eq!(read_json(&out.join("run.json"))["command"], "budget");
    let page = std::fs::read_to_string(out.join("report.html")).expect("a page");
    assert!(page.contains("What costs what"));
    for words in ["Files", "href=\"run.json\"", "Run record", "strokes_per_revolution = 2400"] {
        assert!(page.contains(words), "no {words} on the page");
    }
    // The four dearest have a map, as large below 0 as above.
    assert_eq!(std::fs::read_dir(out.join("pictures")).expect("pictures").count(), 1 + 4);
    assert_eq!(page.matches("data:image/png").count(), 4);
    let results = read_json(&out.join("results.json"));
    assert_is_results(&results);
    assert_eq!(results["complete"], true);
}

/// Mean places of red and of blue pixels left of the bar of colours, px from the left; `None` where there are none.
fn red_and_blue_px(picture: &Path) -> [Option<f64>; 2] {
    let mut places = [Vec::new(), Vec::new()];
    for ((x, _), [red, _, blue]) in Picture::open(picture).placed().filter(|((x, _), _)| *x < LEFT_OF_BAR_PX) {
        let apart = i32::from(red) - i32::from(blue);
        if apart.abs() > COLOURED {
            places[usize::from(apart < 0)].push(f64::from(x));
        }
    }
    places.map(|of| (!of.is_empty()).then(|| of.iter().sum::<f64>() / of.len() as f64))
}

/// Red less blue of 255 from which a pixel is of either colour: lettering and no value have none.
const COLOURED: i32 = 25;
/// A map of a flank is 216 pixels wide and stands 28 from the left.
const LEFT_OF_BAR_PX: u32 = 28 + 216;

/// A slope of the guide sideways adds v cos(alpha) / 100 mm to left flanks and as much less to right ones: half a flank
/// is red and half is blue, the right halves of left flanks red. A radial bow, sin(alpha) (1 - (2 v / b)^2), has one
/// sign all over.
#[test]
fn maps_of_a_budget_show_where_an_error_adds_and_takes_away() {
    let folder = folder();
    for (flank, red_is_right) in [("2-left", true), ("2-right", false)] {
        let slope = "machine.errors.guide.tangential_um_per_100mm,machine.errors.guide.radial_bow_um";
        gearcut_in(folder.path(), &["budget", "round.toml", "--parameters", slope, "--flanks", flank]).done();
        let pictures = folder.path().join("out/round_budget/pictures");
        let [red_px, blue_px] = red_and_blue_px(&pictures.join("influence_1.png")).map(|px| px.expect("both colours"));
        // Four of nine cells of 24 pixels stand on either side of a middle one without colour.
        let apart_px = 5.0 * 24.0 * if red_is_right { 1.0 } else { -1.0 };
        assert!((red_px - blue_px - apart_px).abs() < 2.0, "{flank}: red {red_px}, blue {blue_px}");
        let [red_px, blue_px] = red_and_blue_px(&pictures.join("influence_2.png"));
        assert!(red_px.is_some() != blue_px.is_some(), "{flank}: red {red_px:?}, blue {blue_px:?}");
        let page = std::fs::read_to_string(folder.path().join("out/round_budget/report.html")).expect("a page");
        assert!(page.contains("1: guide: tangential slope, µm/(µm/100 mm)"), "no title with its unit");
    }
}

#[test]
fn what_cannot_be_ranked_is_refused() {
    let folder = folder();
    let budget = |more: &[&str]| gearcut_in(folder.path(), &[&["budget", "round.toml"], more].concat());
    budget(&["--parameters", "mounting.eccentrcity_um"]).failed(1, &["mounting.eccentricity_um", "tool.shaper_cutter"]);
    budget(&["--parameters", "mounting.eccentrcity_um"]).failed(1, &["did you mean mounting.eccentricity_um?"]);
    budget(&["--parameters", "mountings"]).failed(1, &["--parameters", "did you mean mounting?"]);
    budget(&["--parameters", "xyz"]).failed(1, &["`xyz` is no error of this process", "choose among"]);
    let fit = ["calibrate", "round.toml", "--measured", "x.csv", "--fit", "mountings"];
    gearcut_in(folder.path(), &fit).failed(1, &["--fit", "did you mean mounting?"]);
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
