//! `gearcut compare` on two small hand-made results.
//!
//! With `GEARCUT_KEEP=folder` the charts are kept there for a look.

#[path = "common/command.rs"]
mod command;

use std::path::Path;

use command::gearcut_in;
use gearcut::output::results::AnyResults;
use serde_json::{Value, json};

/// Teeth of the hand-made gear and of its period.
const TEETH: u32 = 42;
const PERIOD: u32 = 14;

fn number(value: f64, unit: &str) -> Value {
    json!({ "value": value, "unit": unit, "definition": "made by hand" })
}

fn none() -> Value {
    json!({ "value": null, "unit": "%", "definition": "made by hand", "why": "made by hand" })
}

fn stock(level_mm: f64) -> Value {
    let at = |value: f64| {
        let mut stock = number(value, "mm");
        stock["place"] = json!({ "tooth": 3, "flank": "left", "u_mm": 1.0, "v_mm": 0.0 });
        stock
    };
    json!({ "smallest": at(0.5 * level_mm), "largest": at(1.5 * level_mm), "mean": number(level_mm, "mm") })
}

fn spread(max: &Value, mean: &Value) -> Value {
    json!({ "max": max, "mean": mean })
}

/// Unevenness of a tooth in percent: the same in each of the three periods.
fn unevenness(tooth: u32, level: f64) -> f64 {
    level * (0.55 + 0.45 * (f64::from((tooth - 1) % PERIOD) / f64::from(PERIOD) * std::f64::consts::TAU).sin())
}

fn chip_peak(unit: &str) -> Value {
    json!({
        "value": number(0.3, unit), "stroke": number(7.0, "strokes"), "time": number(1.05, "s"),
        "work_angle": number(0.6, "deg"), "space": number(1.0, "1"), "cutter_tooth": number(0.0, "1"),
    })
}

fn chips() -> Value {
    json!({
        "largest_section": chip_peak("mm^2"), "largest_thickness": chip_peak("um"), "largest_force": chip_peak("N"),
        "entry_section": none(), "entry_force": none(),
        "largest_work_torque": chip_peak("N m"), "largest_cutter_torque": chip_peak("N m"),
        "median_section": number(0.2, "mm^2"), "median_force": number(1500.0, "N"), "largest_power": number(800.0, "W"),
        "removed_volume": number(22000.0, "mm^3"), "removal_rate": number(1.8, "cm^3/min"),
        "idle_strokes": number(0.0, "strokes"), "two_flank_chips": number(12.0, "chips"),
        "three_flank_chips": number(4000.0, "chips"),
    })
}

fn operation(name: &str, linkage: &str, level: Option<f64>) -> Value {
    let peak =
        || json!({ "peak": number(1.3, "deg/s"), "work_angle": number(0.0, "deg"), "limit": none(), "margin": none() });
    let tooth = |index: u32, level: f64| {
        json!({
            "index": index, "left": stock(0.7), "right": stock(0.7), "AB": number(0.7, "mm"), "CD": number(0.72, "mm"),
            "unevenness_mean_denominator": number(unevenness(index, level), "%"),
            "unevenness_rack_denominator": number(unevenness(index, level), "%"),
            "envelope_AB": number(0.7, "mm"), "envelope_CD": number(0.72, "mm"),
        })
    };
    let percent = |share: f64| level.map_or_else(none, |level| number(share * level, "%"));
    let both = || spread(&percent(1.0), &percent(0.55));
    let teeth: Vec<Value> = level.map_or(Vec::new(), |level| (1..=TEETH).map(|index| tooth(index, level)).collect());
    json!({
        "name": name, "linkage": linkage, "offset": number(2.0, "mm"), "strokes": number(4200.0, "strokes"),
        "circular_feed": number(0.0942, "mm"), "cycle_time": number(630.0, "s"),
        "axes": {
            "work_speed": peak(), "work_acceleration": peak(), "cutter_speed": peak(), "cutter_acceleration": peak(),
            "center_distance_speed": peak(), "center_distance_acceleration": peak(),
        },
        "relief": {
            "smallest_ratio": number(0.26, "1"), "smallest_clearance": number(44.0, "um"),
            "flank": { "value": "right", "unit": null, "definition": "made by hand" },
            "polar_angle": number(93.5, "deg"), "largest_beta": number(14.95, "deg"),
        },
        "chips": chips(),
        "flank_stock": stock(0.7), "root_stock": stock(2.0),
        "unevenness": {
            "mean_denominator": both(), "rack_denominator": both(),
            "envelope_mean_denominator": both(), "envelope_rack_denominator": both(),
        },
        "teeth": teeth,
    })
}

fn results(linkage: &str, level: f64, smallest_mm: f64) -> Value {
    let keys = [
        ("smallest_normal_stock", number(smallest_mm, "mm")),
        ("largest_normal_stock", number(1.0, "mm")),
        ("start_of_involute", number(-1.718, "mm")),
        ("undercut_flanks", json!({ "value": 0, "unit": "flanks", "definition": "made by hand" })),
        ("tip_land", number(2.081, "mm")),
        ("pointed_teeth", json!({ "value": 0, "unit": "teeth", "definition": "made by hand" })),
        ("scallop_height", number(0.000_08, "mm")),
        ("witness_mark", none()),
        ("smallest_tooth_thickness", number(4.7124, "mm")),
        ("largest_tooth_thickness", number(4.7124, "mm")),
        ("axis_margin", none()),
        ("relief_ratio", number(0.26, "1")),
        ("cycle_time", number(1260.0, "s")),
        ("largest_chip_section", chip_peak("mm^2")),
        ("largest_cutting_force", chip_peak("N")),
        ("entry_cutting_force", none()),
        ("removal_rate", number(1.8, "cm^3/min")),
        ("idle_strokes", number(0.0, "strokes")),
        ("unevenness_max", number(level, "%")),
        ("unevenness_mean", number(0.55 * level, "%")),
    ];
    json!({
        "schema_version": 1, "program": "gearcut", "program_version": "0.1.0", "scene": "elliptical", "complete": true,
        "period_teeth": PERIOD, "headline": keys.into_iter().map(|(key, value)| (key.to_owned(), value)).collect::<serde_json::Map<_, _>>(),
        "operations": [operation("rough", linkage, Some(level)), operation("finish", linkage, None)],
        "blank": null, "teeth": [], "texture": [],
    })
}

/// Two runs in `out/` of a new folder.
fn two_runs() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder for the test");
    for (name, document) in [
        ("traditional", results("traditional linkage", 129.52, 0.25)),
        ("normal", results("normal linkage", 3.98, 0.65)),
    ] {
        let run = folder.path().join("out").join(name);
        std::fs::create_dir_all(&run).expect("a folder in the test's folder");
        std::fs::write(run.join("results.json"), document.to_string()).expect("a file in the test's folder");
    }
    folder
}

#[test]
fn two_results_stand_side_by_side() {
    let folder = two_runs();
    gearcut_in(folder.path(), &["compare", "out/traditional", "out/normal"]).done().says(&[
        "traditional and normal",
        "smallest normal stock",
        "0.2500",
        "0.6500",
        "0.4000",
        "rough.unevenness.mean denominator.max",
        "129.5",
        "3.980",
        "compare_traditional_normal",
    ]);
    let written = folder.path().join("out/compare_traditional_normal");
    let csv = std::fs::read_to_string(written.join("comparison.csv")).expect("written");
    assert!(csv.starts_with("quantity,unit,a,b,difference_b_minus_a,definition\nname,,traditional,normal,,"), "{csv}");
    assert!(csv.contains("\nsmallest_normal_stock,mm,0.25,0.65,0.4,made by hand\n"), "{csv}");
    assert!(csv.contains("\nwitness_mark,%,,,,made by hand\n"), "{csv}");
    for name in ["unevenness_first_period", "unevenness_all_teeth"] {
        let svg = std::fs::read_to_string(written.join(format!("{name}.svg"))).expect("written");
        assert!(svg.contains("traditional linkage") && svg.contains("normal linkage"), "both are in the legend");
        assert!(written.join(format!("{name}.png")).is_file());
        if let Some(keep) = std::env::var_os("GEARCUT_KEEP") {
            let kept = Path::new(&keep).join(format!("compare_{name}.png"));
            std::fs::copy(written.join(format!("{name}.png")), kept).expect("the folder to keep pictures in");
        }
    }
    for name in ["unevenness_a.png", "unevenness_b.svg"] {
        assert!(written.join(name).is_file(), "{name}");
    }
    // Again, by the files and into another folder.
    let files = ["out/traditional/results.json", "out/normal/results.json"];
    gearcut_in(folder.path(), &["compare", files[0], files[1], "--out", "both"])
        .done()
        .says(&["traditional and normal"]);
    assert!(folder.path().join("both/comparison.csv").is_file());
    gearcut_in(folder.path(), &["compare", "out/normal", "out/normal", "--out", "both"])
        .done()
        .says(&["normal (a) and normal (b)"]);
}

#[test]
fn what_is_no_result_is_refused_with_a_reason() {
    let folder = two_runs();
    let compare = |a: &str| gearcut_in(folder.path(), &["compare", a, "out/normal"]);
    compare("out/nothing").failed(1, &["out/nothing"]);
    let write = |text: &str| std::fs::write(folder.path().join("bad.json"), text).expect("a file in the test's folder");
    write("not json");
    compare("bad.json").failed(1, &["bad.json", "not JSON"]);
    write("{}");
    compare("bad.json").failed(1, &["schema_version"]);
    write(r#"{"schema_version": 99}"#);
    compare("bad.json").failed(1, &["schema version 99", "reads 1"]);
    write(r#"{"schema_version": 1, "program": "gearcut"}"#);
    compare("bad.json").failed(1, &["not a complete result", "missing field"]);
    assert!(!folder.path().join("out/compare_bad.json_normal").exists());
}

#[test]
fn results_read_back_as_they_were_written() {
    let folder = two_runs();
    let results = AnyResults::read(&folder.path().join("out/normal")).expect("a hand-made result");
    let copy = folder.path().join("copy.json");
    let AnyResults::Shaped(shaped) = &results else { panic!("a shaped gear") };
    shaped.write(&copy).expect("there is room");
    assert_eq!(AnyResults::read(&copy).expect("just written"), results);
    let [written, hand_made] = [copy, folder.path().join("out/normal/results.json")]
        .map(|path| serde_json::from_str::<Value>(&std::fs::read_to_string(path).expect("there")).expect("JSON"));
    assert_eq!(written, hand_made);
}

/// Results of a hobbed gear whose three hob teeth take these volumes (mm3); `idle_s`: how long the operation stands idle.
fn hobbed(volumes: [f64; 3], idle_s: f64) -> Value {
    let largest = volumes.iter().copied().fold(0.0, f64::max);
    let teeth: Vec<Value> = (1..)
        .zip(volumes)
        .map(|(label, volume): (u32, f64)| {
            json!({
                "tooth": label.to_string(), "volume": number(volume, "mm3"), "thickness": number(0.1 * volume, "mm"),
                "way": number(10.0 * volume, "mm"),
            })
        })
        .collect();
    let hardest = volumes.iter().position(|&volume| volume == largest).expect("one") + 1;
    let text = |words: String| json!({ "value": words, "unit": null, "definition": "made by hand" });
    json!({
        "schema_version": 1, "program": "gearcut", "program_version": "0.1.0", "process": "hobbing", "scene": "by hand",
        "complete": true, "headline": { "highest_mark": number(5.0, "um"), "runout": none() },
        "operations": [{
            "name": "finish", "idle_time": number(idle_s, "s"), "axes": { "hob": { "speed": number(1.0, "deg/s") } },
        }],
        "hob_load": { "assumption": "made by hand", "length_of_teeth": number(1780.2, "mm"), "operations": [{
            "name": "finish", "volume": number(volumes.iter().sum(), "mm3"), "largest_volume": number(largest, "mm3"),
            "hardest_working_tooth": text(hardest.to_string()), "teeth_in_use": number(3.0, "teeth"),
            "peak_to_mean": number(1.0, "1"), "largest_thickness": number(0.1 * largest, "mm"),
            "thickest_chip_of_tooth": text(hardest.to_string()), "thickness_after_hoffmeister": number(0.3, "mm"),
            "way_cut": number(100.0, "mm"), "teeth": teeth,
        }] },
        "offset_curves": { "points": number(10.0, "points"), "error_x": { "sigma": number(1.0, "um"), "frequencies": [1] } },
        "marks": [{ "tooth": 3, "flank": "left", "steps": [{ "kinematic": { "length": number(0.9, "mm") } }] }],
        "teeth": [], "texture": [], "blank": { "gouges": { "places": number(0.0, "sides of teeth") } },
    })
}

#[test]
fn hobbed_gears_stand_side_by_side_with_the_load_of_every_hob_tooth() {
    let folder = two_runs();
    for (name, document) in [
        ("plain", hobbed([1.0, 8.0, 3.0], 0.0)),
        ("reciprocating", hobbed([4.0, 4.0, 4.0], 0.0)),
        ("repeating", hobbed([3.0, 4.0, 5.0], 23.1)),
    ] {
        let run = folder.path().join("out").join(name);
        std::fs::create_dir_all(&run).expect("a folder in the test's folder");
        std::fs::write(run.join("results.json"), document.to_string()).expect("a file in the test's folder");
    }
    let three = ["compare", "out/plain", "out/reciprocating", "out/repeating"];
    gearcut_in(folder.path(), &three).done().says(&[
        "plain, reciprocating and repeating",
        "finish.idle time",
        "23.10",
        "finish.hob load.peak load ratio",
        "1.600",
        "compare_plain_reciprocating_repeating",
    ]);
    let written = folder.path().join("out/compare_plain_reciprocating_repeating");
    let csv = std::fs::read_to_string(written.join("comparison.csv")).expect("written");
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines[0], "quantity,unit,a,b,c,difference_b_minus_a,difference_c_minus_a,definition");
    assert!(lines[1].starts_with("name,,plain,reciprocating,repeating,,,"));
    for start in [
        "highest_mark,um,5.0,5.0,5.0,0.0,0.0,",
        "runout,%,,,,,,",
        "finish.idle_time,s,0.0,0.0,23.1,0.0,23.1,",
        // 8 / 8, 8 / 4, 8 / 5.
        "finish.hob_load.peak_load_ratio,1,1.0,2.0,1.6,1.0,0.6",
        "finish.hob_load.hardest_working_tooth,,2,1,3,,,",
        "blank.gouges.places,sides of teeth,0.0",
        "offset_curves.error_x.sigma,um,1.0",
        "marks.tooth_3_left.step_1.kinematic.length,mm,0.9",
    ] {
        assert!(lines.iter().any(|line| line.starts_with(start)), "{start}\n{csv}");
    }
    for stem in ["volume", "thickness", "way"] {
        let svg = std::fs::read_to_string(written.join(format!("load_finish_{stem}.svg"))).expect("written");
        assert!(["plain", "reciprocating", "repeating"].iter().all(|name| svg.contains(name)), "all are in the legend");
        assert!(written.join(format!("load_finish_{stem}.png")).is_file());
    }
    // Of one process only.
    gearcut_in(folder.path(), &["compare", "out/plain", "out/normal"])
        .failed(1, &["plain was made by hobbing and normal by shaping", "one process"]);
    gearcut_in(folder.path(), &["compare", "out/plain"]).failed(2, &["2"]);
}
