//! A gear that a program cuts, not the scene's own strokes: what is told of it is measured on it, or it is not told.
//!
//! The same scene is cut twice, by its own strokes and by a program that stands beside them in all of them. Where both
//! runs give the same number to many digits, it was not measured on the gear that was cut.

use crate::fixtures::command::{gearcut, read_json};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Quantities that are the same whatever is cut: how it was asked for and where it is measured. Each ends a path.
const OF_THE_SCENE: [&str; 28] = [
    "/strokes",
    "/cycle_time",
    "/idle_strokes",
    "/return_strokes/direction",
    "/program/strokes_per_minute",
    "/program/asked_strokes_per_minute",
    "/evaluated_from",
    "/evaluated_to",
    "/period_teeth",
    "/untouched_dexels",
    "/below_range_dexels",
    // Of the drawing, the blank and the target's thickness, which the cut gear is held against.
    "/reference_diameter",
    "/base_diameter",
    "/tip_diameter",
    "/profile_shift",
    "/generating_profile_shift",
    "/thickness",
    "/chordal_thickness",
    "/chordal_height",
    "/ball_diameter",
    "/span_teeth",
    "/span",
    "/over_balls",
    // A spur gear cut with the feed at rest has straight teeth whatever the program says.
    "/F_beta",
    "/f_H_beta",
    "/f_f_beta",
    // Of the rays.
    "/candidates",
    // A whole number of 1 to 11: two gears of one class are no sign.
    "/class_reached",
];

/// The same, anywhere in a path.
const WITHIN: [&str; 3] = ["/operations/rough/", "/axes/", "two_flank_chips"];

/// All quantities below a value, with their paths.
fn quantities(path: &str, value: &Value, found: &mut BTreeMap<String, Value>) {
    match value {
        Value::Object(keys) if keys.contains_key("definition") => {
            found.insert(path.to_owned(), value.clone());
        }
        Value::Object(keys) => keys.iter().for_each(|(key, of)| quantities(&format!("{path}/{key}"), of, found)),
        _ => {}
    }
}

/// Fewer strokes than the scenes have: what is told does not hang on them.
const FEW_STROKES: [&str; 4] =
    ["--set", "operation.rough.strokes_per_revolution=600", "--set", "operation.finish.strokes_per_revolution=600"];

fn cut(scene: &str, out: &Path, more: &[&str]) -> BTreeMap<String, Value> {
    let only = ["cut", scene, "--draft", "--backend", "cpu", "--only", "numbers", "--out"];
    let out_path = out.to_str().expect("a path");
    let arguments: Vec<&str> =
        only.iter().copied().chain([out_path]).chain(FEW_STROKES).chain(more.iter().copied()).collect();
    let code = gearcut(&arguments).code;
    assert!(code == 0 || code == 3, "{code}");
    let mut found = BTreeMap::new();
    let results = read_json(&out.join("results.json"));
    for part in ["headline", "operations", "teeth", "round_gear", "ring"] {
        let value = if part == "headline" { &results[part] } else { &results["sections"][part] };
        quantities(&format!("/{part}"), value, &mut found);
    }
    found
}

/// Writes the scene's own programs.
fn axes(scene: &str, out: &Path) {
    let arguments = ["axes", scene, "--out", out.to_str().expect("a path")];
    gearcut(&arguments.into_iter().chain(FEW_STROKES).collect::<Vec<_>>());
}

/// The scene's own program with its words of an axis changed.
fn changed(program: &str, axis: char, change: impl Fn(f64) -> f64) -> String {
    let word = |word: &str| match word.strip_prefix(axis).and_then(|digits| digits.parse().ok()) {
        Some(value) => format!("{axis}{:.6}", change(value)),
        None => word.to_owned(),
    };
    let line = |line: &str| {
        let is_block = line.starts_with('N');
        if is_block { line.split(' ').map(word).collect::<Vec<_>>().join(" ") } else { line.to_owned() }
    };
    program.lines().map(line).collect::<Vec<_>>().join("\n") + "\n"
}

/// Quantities that both runs give alike.
fn alike(own: &BTreeMap<String, Value>, other: &BTreeMap<String, Value>) -> Vec<String> {
    let is_of_the_scene =
        |path: &str| OF_THE_SCENE.iter().any(|of| path.ends_with(of)) || WITHIN.iter().any(|of| path.contains(of));
    let same = |path: &str, of: &Value| {
        // Zeros are counts of nothing, or the last bits of what is nothing: pitch deviations of a round gear.
        let value = &of["value"];
        !value.is_null()
            && value.as_f64().is_none_or(|number| number.abs() > 1e-9)
            && own.get(path).is_some_and(|own| own["value"] == *value)
    };
    other.iter().filter(|(path, of)| !is_of_the_scene(path) && same(path, of)).map(|(path, _)| path.clone()).collect()
}

#[test]
fn nothing_is_told_of_a_gear_that_was_not_cut() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    for (scene, axis, by) in
        [("circular_m3_z24", 'X', 0.05), ("elliptical_normal", 'B', 0.2), ("internal_circle", 'X', -0.05)]
    {
        let file = format!("scenes/shaping/{scene}.toml");
        let [own_at, other_at, axes_at] = ["own", "other", "axes"].map(|name| at(&format!("{scene}_{name}")));
        let own = cut(&file, &own_at, &[]);
        axes(&file, &axes_at);
        let program = fs::read_to_string(axes_at.join("axes/finish.ngc")).expect("a program");
        let path = at("other.ngc");
        fs::write(&path, changed(&program, axis, |value| value + by)).expect("written");
        let setting = format!("operation.finish.program={}", path.display());
        let other = cut(&file, &other_at, &["--set", &setting]);
        let told = alike(&own, &other);
        assert!(told.is_empty(), "{scene}: told of the scene's own strokes:\n{}", told.join("\n"));
        // What is not told has its reason, and the places that the scene's own strokes fill are not all empty.
        let withheld = |path: &str| other[path]["why"].as_str().is_some_and(|why| why.contains("own strokes alone"));
        for path in
            ["/teeth/tooth_01/left/start_of_flank", "/teeth/tooth_01/right/tip_height", "/headline/relief_ratio"]
        {
            assert!(own[path]["value"].is_number() && withheld(path), "{scene}, {path}: {}", other[path]);
        }
        assert!(!alike(&own, &own).is_empty(), "{scene}: the comparison finds nothing in a run against itself");
        // The same of the table of flanks.
        let cells = |folder: &Path, column: &str| -> Vec<String> {
            let mut table = csv::Reader::from_path(folder.join("tables/flanks.csv")).expect("a table");
            let column = table.headers().expect("a head").iter().position(|head| head == column).expect("a column");
            table.records().map(|row| row.expect("a row")[column].to_owned()).collect()
        };
        for column in ["start_of_flank_mm", "tip_height_mm", "profile_length_mm"] {
            assert!(cells(&other_at, column).iter().all(String::is_empty), "{scene}: {column}");
            assert!(cells(&own_at, column).iter().all(|cell| !cell.is_empty()), "{scene}: {column}");
        }
    }
}

/// Places of chips are the program's: it begins a third of a turn later than the scene.
#[test]
fn chips_stand_where_the_program_has_the_work() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let file = "scenes/shaping/circular_m3_z24.toml";
    axes(file, &at("axes"));
    let program = fs::read_to_string(at("axes/axes/finish.ngc")).expect("a program");
    let path = at("later.ngc");
    // 120 degrees of work are 144 of a cutter of 20 teeth for a gear of 24: eight pitches of either.
    let later = changed(&changed(&program, 'C', |deg| deg - 120.0), 'B', |deg| deg + 144.0);
    fs::write(&path, later).expect("written");
    let setting = format!("operation.finish.program={}", path.display());
    cut(file, &at("own"), &[]);
    cut(file, &at("later"), &["--set", &setting]);
    let first_deg = |run: &str| {
        let chips = fs::read_to_string(at(run).join("tables/chips_finish.csv")).expect("a table");
        let column = chips.lines().next().expect("a head").split(',').position(|name| name == "work_angle_deg");
        let row = chips.lines().nth(1).expect("a stroke").to_owned();
        row.split(',').nth(column.expect("a column")).expect("a cell").parse::<f64>().expect("a number")
    };
    let [own, later] = ["own", "later"].map(first_deg);
    assert!(own.abs() < 1e-9 && (later - 120.0).abs() < 1e-6, "{own} {later}");
}
