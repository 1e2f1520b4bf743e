//! `gearcut compare` on two small hand-made results.
//!
//! With `GEARCUT_KEEP=folder` the charts are kept there for a look.

use std::path::Path;

use crate::fixtures::command::gearcut_in;
use crate::fixtures::json_schema::{assert_is_results, broken_rule};
use crate::fixtures::picture::Picture;
use gearcut::findings::Findings;
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

/// Unevenness of a tooth in percent: the same in each of the three periods.
fn unevenness(tooth: u32, level: f64) -> f64 {
    level * (0.55 + 0.45 * (f64::from((tooth - 1) % PERIOD) / f64::from(PERIOD) * std::f64::consts::TAU).sin())
}

fn document(process: &str, headline: &Value, sections: &Value) -> Value {
    json!({
        "schema_version": 4, "program": "gearcut", "program_version": "0.1.0", "process": process,
        "scene": "made_by_hand", "complete": true, "headline": headline, "warnings": [], "sections": sections,
    })
}

fn results(level: f64, smallest_mm: f64) -> Value {
    let mut stock = number(smallest_mm, "mm");
    stock["place"] = json!({ "tooth": 3, "flank": "left", "u_mm": 1.0, "v_mm": 0.0 });
    stock["level"] = json!("headline");
    let mut spread = number(level, "%");
    spread["level"] = json!("summary");
    let rows: Vec<Value> = (1..=TEETH).map(|tooth| json!([tooth, unevenness(tooth, level)])).collect();
    let column =
        |key: &str, unit: &str, of: &str| json!({ "key": key, "unit": unit, "definition": "made by hand", "type": of });
    let mut bars = column("unevenness_mean_denominator", "%", "number");
    bars["chart"] = json!("bars");
    let mut witness = none();
    witness["level"] = json!("headline");
    document(
        "shaping",
        &json!({ "smallest_stock": stock, "witness_mark": witness }),
        &json!({ "operations": { "$title": "Operations", "rough": {
            "$title": "Rough",
            "strokes": number(4200.0, "strokes"),
            "allowance": {
                "title": "Allowance", "columns": [column("tooth", "1", "count"), bars], "rows": rows,
                "period_rows": PERIOD,
            },
            "unevenness": { "$title": "Unevenness", "mean_denominator": { "$title": "Mean", "max": spread } },
        } } }),
    )
}

/// Two runs in `out/` of a new folder.
fn two_runs() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder for the test");
    for (name, document) in [("traditional", results(129.52, 0.25)), ("normal", results(3.98, 0.65))] {
        put(&folder, name, &document);
    }
    folder
}

fn put(folder: &tempfile::TempDir, name: &str, document: &Value) {
    assert_is_results(document);
    let run = folder.path().join("out").join(name);
    std::fs::create_dir_all(&run).expect("a folder in the test's folder");
    std::fs::write(run.join("results.json"), document.to_string()).expect("a file in the test's folder");
}

#[test]
fn two_results_stand_side_by_side() {
    let folder = two_runs();
    gearcut_in(folder.path(), &["compare", "out/traditional", "out/normal"]).done().says(&[
        "traditional and normal",
        "Changed most",
        "Smallest stock",
        "0.2500",
        "0.6500",
        "0.4000",
        "Rough: unevenness, mean, max",
        "129.5",
        "3.980",
        "compare_traditional_normal",
    ]);
    let written = folder.path().join("out/compare_traditional_normal");
    let csv = std::fs::read_to_string(written.join("comparison.csv")).expect("written");
    assert!(
        csv.starts_with("quantity,unit,a,b,difference_b_minus_a,ratio_b_to_a,definition\nname,,traditional,normal,,,"),
        "{csv}"
    );
    // 0.65 - 0.25 and 0.65 / 0.25; details are in the file, on the terminal they are not.
    assert!(csv.contains("\nsmallest_stock,mm,0.25,0.65,0.4,2.6,made by hand\n"), "{csv}");
    assert!(csv.contains("\nwitness_mark,%,,,,,made by hand\n"), "{csv}");
    assert!(csv.contains("\noperations.rough.strokes,strokes,4200.0,4200.0,0.0,1.0,made by hand\n"), "{csv}");
    assert!(!csv.contains("u_mm"), "places are not compared");
    let stem = "operations_rough_allowance_unevenness_mean_denominator";
    for name in [format!("{stem}_first_period"), stem.to_owned()] {
        let svg = std::fs::read_to_string(written.join(format!("{name}.svg"))).expect("written");
        assert!(svg.contains("traditional") && svg.contains("normal"), "both are in the legend");
        if let Some(keep) = std::env::var_os("GEARCUT_KEEP") {
            std::fs::write(Path::new(&keep).join(format!("compare_{name}.svg")), svg)
                .expect("the folder to keep charts in");
        }
    }
    let page = std::fs::read_to_string(written.join("report.html")).expect("written");
    for words in ["What changed most", "Smallest stock", "0.2500 \u{2192} 0.6500", "Side by side", "<svg"] {
        assert!(page.contains(words), "{words} is not on the page");
    }
    assert!(!page.contains("<script"), "a page without a gear needs no scripts");
    for name in ["a.svg", "b.svg"] {
        assert!(written.join(format!("{stem}_{name}")).is_file(), "{name}");
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

/// What changed most comes first, by its share of the larger value; nanometres are no change, and the tooth that was
/// looked at is shown but not subtracted.
#[test]
fn the_largest_changes_come_first_and_places_are_not_subtracted() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let of = |stock_mm: f64, pitch_um: f64, force_n: f64, tooth: u32| {
        let headline = |value: f64, unit: &str| {
            let mut quantity = number(value, unit);
            quantity["level"] = json!("headline");
            quantity
        };
        let mut place = json!({ "value": tooth, "unit": "1", "definition": "made by hand" });
        place["level"] = json!("summary");
        document(
            "shaping",
            &json!({
                "smallest_stock": headline(stock_mm, "mm"),
                "pitch": headline(pitch_um, "um"),
                "force": headline(force_n, "N"),
            }),
            &json!({ "texture": { "$title": "Texture", "tooth": place } }),
        )
    };
    put(&folder, "a", &of(0.50, 0.001, 1000.0, 3));
    put(&folder, "b", &of(0.55, 0.010, 4000.0, 7));
    let out = gearcut_in(folder.path(), &["compare", "out/a", "out/b"]).done().out;
    let place = |words: &str| out.find(words).unwrap_or_else(|| panic!("no {words:?} in {out}"));
    // 3/4 of the larger force, 1/11 of the larger stock, 9 nm of a micrometre; teeth are no change.
    assert!(place("Force") < place("Smallest stock") && place("Smallest stock") < place("Pitch"), "{out}");
    assert!(!out.contains("tooth"), "{out}");
    // All of them, where that is wanted.
    let all = gearcut_in(folder.path(), &["compare", "out/a", "out/b", "--all"]).done().out;
    assert!(all.contains("\nAll\n") && all.contains("Texture: tooth"), "{all}");
    let csv = std::fs::read_to_string(folder.path().join("out/compare_a_b/comparison.csv")).expect("written");
    assert!(csv.contains("\ntexture.tooth,1,3.0,7.0,,,made by hand\n"), "{csv}");
}

/// A figure with a limit is judged by that: half of a limit of 4 um is more than a third of a force. What rounding
/// leaves beside 0 is no change in any unit.
#[test]
fn limits_are_the_scale_where_there_are_some() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let of = |pitch_um: f64, force_n: f64, noise: f64, limit_um: Option<f64>| {
        let summary = |value: f64, unit: &str, title: &str| {
            let mut quantity = number(value, unit);
            quantity["level"] = json!("summary");
            quantity["title"] = json!(title);
            quantity
        };
        let column = |key: &str| json!({ "key": key, "unit": null, "definition": "made by hand", "type": "word" });
        let mut limit = column("limit");
        (limit["unit"], limit["why"], limit["type"]) = (json!("um"), json!("made by hand"), json!("number"));
        let figures = json!({
            "title": "Figures", "columns": [column("figure"), limit], "rows": [["f_p", limit_um]],
        });
        document(
            "shaping",
            &json!({}),
            &json!({
                "deviations": {
                    "$title": "Deviations",
                    "single_pitch": summary(pitch_um, "um", "single pitch deviation f_p"),
                    "force": summary(force_n, "N", "force"),
                    "volume": summary(noise, "mm3", "volume"),
                    "section": summary(2.0 * noise, "mm^2", "section"),
                    "flanks": summary(3.0 * noise, "flanks", "flanks"),
                    "load": summary(4.0 * noise, "kN", "load"),
                },
                "inspection": { "$title": "Inspection", "figures": figures },
            }),
        )
    };
    let first = |limit_um: Option<f64>, name: &str| {
        put(&folder, "a", &of(20.0, 1000.0, 0.0, limit_um));
        put(&folder, "b", &of(22.0, 1500.0, 1e-9, limit_um));
        gearcut_in(folder.path(), &["compare", "out/a", "out/b", "--out", name]).done().out
    };
    let place = |first: &str, words: &str| first.find(words).unwrap_or_else(|| panic!("no {words:?} in {first}"));
    // 2 um are half of the limit, 500 N a third of the force; without a limit 2 um are an eleventh.
    let limited = first(Some(4.0), "limited");
    assert!(place(&limited, "single pitch") < place(&limited, "force"), "{limited}");
    let free = first(None, "free");
    assert!(place(&free, "force") < place(&free, "single pitch"), "{free}");
    for noise in ["volume", "section", "flanks", "load"] {
        assert!(place(&free, noise) > place(&free, "single pitch"), "{free}");
    }
    // The page has units in their signs, and words as they are.
    let page = std::fs::read_to_string(folder.path().join("free/report.html")).expect("a page");
    assert!(page.contains("Deviations: volume") && page.contains("µm") && !page.contains("volµme"), "{page}");
}

/// Figures of the inspection stand in a table; what a guide out of line does to helices is among the first lines.
#[test]
fn figures_of_the_inspection_are_compared() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let of = |left_um: f64, right_um: f64, runout_um: f64| {
        let column = |key: &str| json!({ "key": key, "unit": null, "definition": "made by hand", "type": "word" });
        let number = |key: &str| {
            let none = "made by hand";
            json!({ "key": key, "unit": "um", "definition": "made by hand", "why": none, "type": "number" })
        };
        let figures = json!({
            "title": "Figures", "columns": [column("figure"), column("name"), number("left"), number("right")],
            "rows": [["f_H_beta", "helix slope deviation", left_um, right_um], ["F_r", "runout", runout_um, null]],
        });
        document("shaping", &json!({}), &json!({ "inspection": { "$title": "Inspection", "figures": figures } }))
    };
    put(&folder, "a", &of(0.004, -0.004, 0.5));
    put(&folder, "b", &of(9.0, -9.4, 0.5));
    let out = gearcut_in(folder.path(), &["compare", "out/a", "out/b", "--all"]).done().out;
    let (first, all) = out.split_once("\nAll\n").expect("first lines, then all");
    let (left, right) = ("Helix slope deviation, left f_H_beta", "Helix slope deviation, right f_H_beta");
    for (line, value) in [(left, "9.000"), (right, "-9.400")] {
        let found =
            first.lines().find(|printed| printed.contains(line)).unwrap_or_else(|| panic!("no {line} in {out}"));
        assert!(found.contains(value) && found.contains("um"), "{found}");
    }
    assert!(all.contains("Runout F_r ") && !first.contains("Runout"), "{out}");
    // Over rounding there is no ratio: 0 beside 0 is as often 2 as a half.
    put(&folder, "c", &of(3e-11, -0.004, 1.1e-11));
    put(&folder, "d", &of(9.0, -0.004, 1e-11));
    let out = gearcut_in(folder.path(), &["compare", "out/c", "out/d", "--all"]).done().out;
    let runout = out.lines().find(|line| line.contains("Runout F_r ")).expect("a line");
    assert!(!runout.contains("1.1"), "{runout}");
}

/// A map of one flank of a run, with one value all over.
fn put_map(folder: &tempfile::TempDir, run: &str, kind: &str, value_mm: f32) {
    use gearcut::output::exr_map::{ExrMap, MapChannel, Samples, write_exr_map};
    use gearcut::output::grid::{MapAxis, MapGrid};
    let axis = |name: &str, count: usize| MapAxis {
        name: name.to_owned(),
        meaning: "made by hand".to_owned(),
        start_mm: 0.0,
        step_mm: 0.5,
        count,
    };
    let maps = folder.path().join("out").join(run).join(kind);
    std::fs::create_dir_all(&maps).expect("a folder");
    let map = ExrMap {
        grid: MapGrid { u: axis("u", 8), v: axis("v", 12) },
        frame: "made by hand".to_owned(),
        channels: vec![MapChannel {
            name: format!("{kind}_mm"),
            unit: "mm".to_owned(),
            definition: "made by hand".to_owned(),
            samples: Samples::F32(vec![value_mm; 96]),
        }],
        notes: Vec::new(),
    };
    write_exr_map(&maps.join("tooth_01_left.exr"), &map).expect("written");
}

/// Maps that both runs have are subtracted cell by cell.
#[test]
fn maps_of_deviations_are_subtracted() {
    let folder = two_runs();
    put_map(&folder, "traditional", "deviation", 0.0);
    put_map(&folder, "normal", "deviation", 0.004);
    gearcut_in(folder.path(), &["compare", "out/traditional", "out/normal"]).done();
    let sheet = folder.path().join("out/compare_traditional_normal/difference_deviation_b_minus_a.png");
    let page = std::fs::read_to_string(sheet.with_file_name("report.html")).expect("a page");
    assert!(
        page.contains("Difference maps") && page.contains("src=\"data:image/png;base64,"),
        "the sheet is on the page"
    );
    assert!(has_field_of(&sheet, 4.0), "no field of the scale's end");
}

/// Two linkages leave the same flanks and another allowance: that is what is drawn, and the flanks are said to be
/// equal.
#[test]
fn maps_show_what_differs() {
    let folder = two_runs();
    for (run, deviation_mm, allowance_mm) in [("traditional", 0.002, 0.25), ("normal", 0.002_02, 0.33)] {
        put_map(&folder, run, "deviation", deviation_mm);
        put_map(&folder, run, "allowance", allowance_mm);
    }
    gearcut_in(folder.path(), &["compare", "out/traditional", "out/normal"]).done();
    let out = folder.path().join("out/compare_traditional_normal");
    assert!(!out.join("difference_deviation_b_minus_a.png").exists(), "84 white tiles say nothing");
    assert!(has_field_of(&out.join("difference_allowance_b_minus_a.png"), 80.0), "no field of the scale's end");
    let page = std::fs::read_to_string(out.join("report.html")).expect("a page");
    assert!(
        page.contains("deviation of normal less that of traditional, all flanks: nothing above 0.020 µm"),
        "{page}"
    );
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 1);
    // What changed is read, the whole table looked up.
    let section = |id: &str| page.split(&format!("<section id=\"{id}\"")).nth(1).unwrap_or_else(|| panic!("{page}"));
    assert!(section("all").contains("numbers side by side"));
}

/// Whether all cells of a sheet differ by this, um, the end of its scale: a field of one colour, as no other sheet has.
fn has_field_of(sheet: &Path, um: f32) -> bool {
    let end = gearcut::colormap::ColourScale::Diverging { limit: um }.colour(um);
    Picture::open(sheet).pixels.into_iter().filter(|pixel| *pixel == end).count() > 1000
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
    compare("bad.json").failed(1, &["schema version 99", "reads 4"]);
    write(r#"{"schema_version": 4, "program": "gearcut"}"#);
    compare("bad.json").failed(1, &["not a complete result", "missing field"]);
    assert!(!folder.path().join("out/compare_bad.json_normal").exists());
}

#[test]
fn results_read_back_as_they_were_written() {
    let folder = two_runs();
    let findings = Findings::read(&folder.path().join("out/normal")).expect("a hand-made result");
    assert_eq!(findings.to_json(), results(3.98, 0.65));
}

/// The check itself must notice what breaks a rule.
#[test]
fn the_schema_refuses_what_is_not_of_the_layout() {
    let good = || results(3.98, 0.65);
    let refused = |spoil: fn(&mut Value), words: &str| {
        let mut document = good();
        spoil(&mut document);
        let reason = broken_rule(&document).expect_err(words);
        assert!(reason.contains(words), "{reason}");
    };
    assert_eq!(broken_rule(&good()), Ok(()));
    refused(|all| all["schema_version"] = json!(1), "schema_version");
    refused(|all| all["more"] = json!(1), "more");
    refused(|all| all["headline"]["witness_mark"]["why"] = Value::Null, "witness_mark");
    refused(|all| all["headline"]["smallest_stock"]["value"] = Value::Null, "smallest_stock");
    refused(|all| all["headline"]["smallest_stock"]["place"]["tooth"] = json!([3]), "tooth");
    refused(|all| all["sections"]["operations"]["rough"]["strokes"] = json!(4200), "operations");
    refused(|all| all["sections"]["operations"]["rough"]["allowance"]["columns"] = json!([]), "operations");
    refused(|all| all["sections"]["a.b"] = json!({ "$title": "a dot" }), "a.b");
}

/// Results of a hobbed gear whose three hob teeth take these volumes (mm3); `idle_s`: how long the operation stands
/// idle.
fn hobbed(volumes: [f64; 3], idle_s: f64) -> Value {
    let largest = volumes.iter().copied().fold(0.0, f64::max);
    let rows: Vec<Value> =
        (1..).zip(volumes).map(|(label, v): (u32, f64)| json!([label.to_string(), v, 0.1 * v, 10.0 * v])).collect();
    let hardest = volumes.iter().position(|&volume| volume == largest).expect("one") + 1;
    let shown = |mut quantity: Value| {
        quantity["level"] = json!("summary");
        quantity
    };
    let mut columns = vec![json!({ "key": "tooth", "unit": null, "definition": "hob tooth", "type": "word" })];
    columns.extend(
        [("volume", "mm3"), ("thickness", "mm"), ("travel", "mm")]
            .map(|(key, unit)| {
                json!({ "key": key, "unit": unit, "definition": "made by hand", "type": "number", "chart": "bars" })
            }),
    );
    let headline = |mut quantity: Value| {
        quantity["level"] = json!("headline");
        quantity
    };
    document(
        "hobbing",
        &json!({ "highest_mark": headline(number(5.0, "um")), "runout": headline(none()) }),
        &json!({
            "operations": { "$title": "Operations", "finish": {
                "$title": "Finish", "idle_time": shown(number(idle_s, "s")),
            } },
            "hob_load": { "$title": "Load", "operations": { "$title": "Operations", "finish": {
                "$title": "Finish",
                "largest_volume": shown(number(largest, "mm3")),
                "hardest_working_tooth": {
                    "value": hardest.to_string(), "unit": null, "definition": "made by hand",
                },
                "teeth": { "title": "Load by hob tooth", "columns": columns, "rows": rows },
            } } },
            "marks": { "$title": "Marks", "tooth_03_left": { "$title": "Tooth 3 left", "step_1": {
                "$title": "Step 1", "kinematic": { "$title": "Kinematics", "length": number(0.9, "mm") },
            } } },
        }),
    )
}

#[test]
fn hobbed_gears_stand_side_by_side_with_the_load_of_every_hob_tooth() {
    let folder = two_runs();
    for (name, document) in [
        ("plain", hobbed([1.0, 8.0, 3.0], 0.0)),
        ("reciprocating", hobbed([4.0, 4.0, 4.0], 0.0)),
        ("repeating", hobbed([3.0, 4.0, 5.0], 23.1)),
    ] {
        put(&folder, name, &document);
    }
    let three = ["compare", "out/plain", "out/reciprocating", "out/repeating"];
    gearcut_in(folder.path(), &three).done().says(&[
        "plain, reciprocating and repeating",
        "Finish: idle time",
        "23.10",
        "Load: finish, largest volume",
        "compare_plain_reciprocating_repeating",
    ]);
    let written = folder.path().join("out/compare_plain_reciprocating_repeating");
    let csv = std::fs::read_to_string(written.join("comparison.csv")).expect("written");
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(
        lines[0],
        "quantity,unit,a,b,c,difference_b_minus_a,difference_c_minus_a,ratio_b_to_a,ratio_c_to_a,definition"
    );
    assert!(lines[1].starts_with("name,,plain,reciprocating,repeating,,,"));
    for start in [
        "highest_mark,um,5.0,5.0,5.0,0.0,0.0,1.0,1.0,",
        "runout,%,,,,,,",
        "operations.finish.idle_time,s,0.0,0.0,23.1,0.0,23.1,,,",
        // 4 / 8, 5 / 8: what the hardest working tooth still does.
        "hob_load.operations.finish.largest_volume,mm3,8.0,4.0,5.0,-4.0,-3.0,0.5,0.625,",
        "hob_load.operations.finish.hardest_working_tooth,,2,1,3,,,",
        "marks.tooth_03_left.step_1.kinematic.length,mm,0.9",
    ] {
        assert!(lines.iter().any(|line| line.starts_with(start)), "{start}\n{csv}");
    }
    for stem in ["volume", "thickness", "travel"] {
        let svg = std::fs::read_to_string(written.join(format!("hob_load_operations_finish_teeth_{stem}.svg")))
            .expect("written");
        assert!(["plain", "reciprocating", "repeating"].iter().all(|name| svg.contains(name)), "all are in the legend");
    }
    // Of two processes without a number in common.
    gearcut_in(folder.path(), &["compare", "out/plain", "out/normal"])
        .failed(1, &["plain was made by hobbing and normal by shaping", "no number in common"]);
    gearcut_in(folder.path(), &["compare", "out/plain"]).failed(2, &["2"]);
}

/// A hobbed and a shaped gear of one drawing: what both have is compared, and nothing else is shown.
#[test]
fn two_processes_are_compared_in_what_both_have() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let first = |um: f64| json!({ "value": um, "unit": "um", "definition": "made by hand", "level": "headline" });
    let headline = |own: &str, um: f64| json!({ "F_alpha": first(um), own: first(1.0) });
    for (process, own, um) in [("hobbing", "feed_mark_closed_form", 4.0), ("shaping", "scallop_height", 5.0)] {
        let out = folder.path().join("out").join(process);
        std::fs::create_dir_all(&out).expect("a folder");
        let text = document(process, &headline(own, um), &json!({})).to_string();
        std::fs::write(out.join("results.json"), text).expect("written");
    }
    let all = ["compare", "out/hobbing", "out/shaping", "--out", "both", "--all"];
    let shown = gearcut_in(folder.path(), &all).done().says(&["F alpha", "4.000", "5.000", "1.000"]).out;
    assert!(!shown.contains("mark") && !shown.contains("scallop"), "{shown}");
    let csv = std::fs::read_to_string(folder.path().join("both/comparison.csv")).expect("written");
    assert!(csv.contains("\nF_alpha,um,4.0,5.0,1.0,1.25,"), "{csv}");
    assert_eq!(csv.lines().count(), 3, "{csv}");
}

/// Numbers that one side alone has are no "nothing changed": they are counted.
#[test]
fn numbers_of_one_side_are_counted() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let mut more = results(3.98, 0.65);
    let mut known = number(1.5, "um");
    known["level"] = json!("headline");
    more["headline"]["gouge"] = known;
    for (name, document) in [("before", &results(3.98, 0.65)), ("same", &results(3.98, 0.65)), ("after", &more)] {
        put(&folder, name, document);
    }
    let same = gearcut_in(folder.path(), &["compare", "out/before", "out/same"]).done();
    same.says(&["nothing changed"]);
    let after = gearcut_in(folder.path(), &["compare", "out/before", "out/after"]).done();
    after.says(&["nothing changed of what all results have", "1 number is in some of the results only"]);
}

/// Marks 0.1 mm apart across 30 deg with two hills; a second surface of the same place, shifted, tilted and mirrored.
#[test]
fn two_surfaces_are_laid_over_each_other() {
    use gearcut::measure::topography::Surface;
    use gearcut::output::surface_files::{Format, SurfaceFile, write_surface};
    let height = |x: f64, y: f64| {
        let across = 0.866_025 * x + 0.5 * y;
        let hill = |cx: f64, cy: f64| (-((x - cx).powi(2) + (y - cy).powi(2)) / 1.5e4).exp();
        0.4 * (std::f64::consts::TAU * across / 100.0).cos() + hill(300.0, 250.0) - 0.7 * hill(620.0, 150.0)
    };
    let folder = tempfile::tempdir().expect("a folder for the test");
    let write = |name: &str, nx: usize, ny: usize, of: &dyn Fn(f64, f64) -> f64| {
        let heights = (0..nx * ny).map(|i| of((i % nx) as f64 * 5.0, (i / nx) as f64 * 5.0)).collect();
        let surface = Surface::new(nx, ny, 5.0, 5.0, heights).expect("a grid");
        let file = SurfaceFile { surface, notes: Vec::new() };
        write_surface(&folder.path().join(name), Format::X3p, &file).expect("written");
    };
    write("simulated.x3p", 180, 100, &height);
    write("measured.x3p", 140, 90, &|x, y| height(695.0 - x + 57.0, y + 22.5) + 0.002 * x + 3.0);
    write("replica.x3p", 180, 100, &|x, y| -height(x, y));
    let run = |names: &[&str]| gearcut_in(folder.path(), &[&["compare"], names].concat());
    let outcome = run(&["simulated.x3p", "measured.x3p", "--form", "plane"]).done();
    let outcome = outcome.says(&["mirror", "second along x", "correlation", "pitch", "Sa", "difference", "F-operator"]);
    let shift = outcome.out.lines().find(|line| line.contains("first point lies at")).expect("a shift");
    let numbers: Vec<f64> = shift.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    assert!((numbers[0] - 57.0).abs() < 0.2 && (numbers[1] - 22.5).abs() < 0.2, "{shift}");
    let beside = folder.path().join("compare_simulated_measured");
    for file in
        ["report.html", "comparison.csv", "first.png", "second.png", "difference.png", "abbott.svg", "profiles.svg"]
    {
        assert!(beside.join(file).exists(), "{file}");
    }
    let rest = gearcut::output::surface_files::read_surface(&beside.join("difference.x3p"), None).expect("a surface");
    assert!(rest.surface.heights_um().iter().all(|z| z.abs() < 0.02));
    let csv = std::fs::read_to_string(beside.join("comparison.csv")).expect("a table");
    let sa = csv.lines().find(|line| line.starts_with("Sa,um,")).expect("Sa");
    let cells: Vec<f64> = sa.split(',').skip(2).take(4).map(|cell| cell.parse().expect("a number")).collect();
    assert!((cells[3] - 1.0).abs() < 0.01 && cells[0] > 0.2, "{sa}");
    if let Some(kept) = std::env::var_os("GEARCUT_KEEP") {
        std::fs::copy(beside.join("report.html"), Path::new(&kept).join("surfaces.html")).expect("kept");
    }
    run(&["simulated.x3p", "replica.x3p"]).done().says(&["with its heights inverted", "--invert"]);
    run(&["simulated.x3p", "measured.x3p", "replica.x3p"]).failed(1, &["two surface files"]);
    run(&["simulated.x3p", "gone.x3p"]).failed(1, &["gone.x3p"]);
    run(&["simulated.x3p", "measured.x3p", "--l-filter-um", "0"]).failed(1, &["--l-filter-um"]);
}
