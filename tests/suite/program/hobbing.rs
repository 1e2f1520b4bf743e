//! Hobbing from the command line: bad input explained, and everything that a run gives back.

use crate::fixtures::command::{Outcome, assert_same_files, files, gearcut, gearcut_on_threads};
use crate::fixtures::json_schema::assert_is_results;
use serde_json::Value;
use std::path::Path;

const PLAIN: &str = "scenes/hobbing/third_order_plain.toml";
const DIAGONAL: &str = "scenes/hobbing/third_order_diagonal.toml";

#[test]
fn ridges_above_their_tolerance_are_warned_about_with_their_height() {
    // f^2 sin(alpha) / (8 R_c) with f = 12 / cos(lambda), sin(lambda) = 3 / 80, R_c = 40 - 3 mm: 166.6 um of one gash,
    // 2 % less with those beside it, since the hob is tilted; 10 um are allowed, a feed of 12 sqrt(10 / 164) mm leaves
    // them.
    let coarse = [
        "--set",
        "operation.finish.axial_feed_mm_per_revolution=12",
        "--set",
        "operation.finish.ridge_tolerance_um=10",
    ];
    let outcome = gearcut(&[&["check", "scenes/hobbing/circular_spur.toml"][..], &coarse].concat()).done();
    assert!(
        outcome.err.contains("marks up to 164 um high, 10.0 um are allowed (ridge_tolerance_um): feed at most 2.96 mm"),
        "{}",
        outcome.err
    );
}

#[test]
fn what_cannot_be_hobbed_is_refused_with_the_reason_and_a_way_out() {
    for (scene, setting, words) in [
        (
            PLAIN,
            "gear.pitch_curve.ellipse.eccentricity=0.2",
            &["gear.pitch_curve", "hollow", "straight line", "convex"][..],
        ),
        (
            DIAGONAL,
            "operation.finish.linkage.hobbing_diagonal.stroke_mm=90",
            &["stroke_mm", "full contact", "longer hob"],
        ),
        (DIAGONAL, "operation.finish.linkage.hobbing_diagonal.strategy=one_way", &["mm of shift", "reciprocating"]),
        (
            "scenes/hobbing/circular_spur.toml",
            "tool.hob.reference_diameter_mm=8.4",
            &["tool.hob.reference_diameter_mm", "lead angle 20.92 deg", "fewer starts"],
        ),
        (
            "scenes/hobbing/circular_spur.toml",
            "tool.hob.reference_diameter_mm=2",
            &["tool.hob.reference_diameter_mm", "lead angle 90.00 deg", "fewer starts"],
        ),
        // Root radius: 40 - 1.25 x 3 mm.
        (
            "scenes/hobbing/circular_spur.toml",
            "tool.hob.regrind_mm=9.2",
            &["tool.hob.regrind_mm", "9.062 mm", "root radius"],
        ),
        (PLAIN, "tool.hob.length_mm=40", &["whole contact", "longer hob"]),
        (PLAIN, "tool.hob.gashes=0", &["tool.hob.gashes", "0 is out of range", "4 to 60", "gashes = 10"]),
        (PLAIN, "tool.hob.lead_angle_deg=25", &["tool.hob.lead_angle_deg", "25 is out of range", "0 to 20 deg"]),
        (PLAIN, "tool.hob.tip_radius_mm=9", &["tool.hob.tip_radius_mm", "does not fit", "smaller round"]),
        (DIAGONAL, "operation.finish.shift_start_mm=60", &["shift_start_mm", "set it between", "longer hob"]),
    ] {
        gearcut(&["check", scene, "--set", setting, "--set", "operation.finish.axial_feed_mm_per_revolution=1.5"])
            .failed(1, words);
    }
}

#[test]
fn refusals_point_at_the_file_line_and_character() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string(PLAIN).expect("a shipped scene");
    for (from, to, place) in [
        ("length_mm = 132.0", "length_mm = 40.0", "tool.hob.length_mm"),
        ("eccentricity = 0.1 ", "eccentricity = 0.2 ", "gear.pitch_curve"),
        ("lead_angle_deg = 3.316666666666667", "reference_diameter_mm = 20.0", "tool.hob.reference_diameter_mm"),
    ] {
        assert!(text.contains(from), "{from}");
        let file = folder.path().join("mine.toml");
        std::fs::write(&file, text.replace(from, to)).expect("there is room");
        let line = 1 + text.lines().position(|line| line.contains(from)).expect("there");
        // A table is pointed at where a refusal blames more than one of its keys.
        let header = text.lines().position(|line| line == "[gear.pitch_curve.ellipse]").expect("there") + 1;
        let line = if place == "gear.pitch_curve" { header } else { line };
        let path = file.display().to_string();
        gearcut(&["check", &path]).failed(1, &[&format!("mine.toml:{line}:"), &format!("`{place}`"), "way out: "]);
    }
}

#[test]
fn exceeded_limits_and_the_printed_linkage_are_told_and_give_no_program() {
    let folder = tempfile::tempdir().expect("a folder");
    let axes = |name: &str, setting: &str| {
        let out = folder.path().join(name);
        let coarse = "operation.finish.axial_feed_mm_per_revolution=10";
        let told = gearcut(&["axes", PLAIN, "--set", coarse, "--set", setting, "--out", &out.display().to_string()])
            .done()
            .err;
        let programs = std::fs::read_dir(out.join("axes")).expect("axes").filter_map(Result::ok);
        let written = programs.filter(|file| file.path().extension().is_some_and(|ending| ending == "ngc")).count();
        (told, written)
    };
    let (told, written) = axes("limits", "machine.hobbing_limits.work_speed_deg_per_s=1");
    for words in ["work spindle speed reaches", "the machine allows 1.000 deg/s", "lower hob_speed_per_minute"] {
        assert!(told.contains(words), "{told}");
    }
    assert_eq!(written, 0);
    let (told, written) = axes("printed", "operation.finish.linkage.hobbing.form=as_printed");
    assert!(told.contains("no G-code written: the linkage as printed"), "{told}");
    assert_eq!(written, 0);
    let (_, written) = axes("allowed", "machine.hobbing_limits.work_speed_deg_per_s=100");
    assert_eq!(written, 2);
}

/// A small gear, coarse enough for seconds.
const SMALL: [&str; 12] = [
    "picture=[{name = \"flank\", view = \"flank\", width_px = 320, height_px = 240}]",
    "gear.module_mm=2",
    "gear.helix_angle_deg=15",
    "gear.face_width_mm=8",
    "tool.hob.length_mm=40",
    "tool.hob.tip_radius_mm=0.3",
    "operation.finish.axial_feed_mm_per_revolution=1.5",
    "fields.flank.profile_spacing_um=100",
    "fields.flank.lead_spacing_um=500",
    "fields.blank.spacing_mm=0.3",
    "output.mesh_spacing_mm=0.25",
    "output.gcode_contour_error_um=10",
];

fn cut(folder: &Path, scene: &str, more: &[&str], threads: u32) -> Value {
    serde_json::from_str(&outcome(folder, scene, more, threads).done().out).expect("results")
}

fn outcome(folder: &Path, scene: &str, more: &[&str], threads: u32) -> Outcome {
    let settings: Vec<&str> = SMALL.iter().chain(more).flat_map(|setting| ["--set", setting]).collect();
    let out = folder.display().to_string();
    let arguments = [&["cut", scene, "--backend", "cpu", "--json", "--out", &out][..], &settings].concat();
    gearcut_on_threads(threads, &arguments)
}

fn number(value: &Value) -> f64 {
    value["value"].as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// Parts of a section in `results.json`.
fn parts(section: &Value) -> impl Iterator<Item = &Value> {
    section.as_object().expect("a section").values().filter(|part| part.get("$title").is_some())
}

mod slow {
    use super::*;

    #[test]
    fn the_printed_linkage_gives_no_program_and_no_closed_body() {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("gear");
        let settings = [
            "gear.teeth=24",
            "gear.pitch_curve.ellipse.eccentricity=0.03",
            "operation.finish.linkage.hobbing.form=as_printed",
        ];
        // The gear is damaged, and everything is written all the same.
        let damaged = outcome(&out, PLAIN, &settings, 2).failed(3, &["verdict: ", "cut below the target"]);
        let results: Value = serde_json::from_str(&damaged.out).expect("results");
        assert!(number(&results["headline"]["deepest_cut"]) > 10.0, "the printed form cuts into the target");
        for file in ["axes/finish.ngc", "axes/finish_gearbox.ngc", "mesh/gear.stl"] {
            assert!(!out.join(file).exists(), "{file}");
        }
        assert!(out.join("report.html").exists() && out.join("axes/finish.csv").exists());
    }

    /// So coarse, with so few teeth and so narrow a face that a scene takes some seconds.
    const COARSEST: [&str; 14] = [
        "--set",
        "gear.teeth=21",
        "--set",
        "gear.face_width_mm=2",
        "--set",
        "operation.finish.axial_feed_mm_per_revolution=6",
        "--set",
        "fields.flank.profile_spacing_um=1000",
        "--set",
        "fields.flank.lead_spacing_um=2000",
        "--set",
        "fields.blank.spacing_mm=3",
        "--set",
        "output.map_spacing_mm=0.5",
    ];

    #[test]
    fn other_scenes_give_the_same_bytes_on_one_thread_and_on_two() {
        let folder = tempfile::tempdir().expect("a folder");
        let scenes = ["machine_errors", "third_order_diagonal"];
        let cut = |scene: &str, name: &str, threads: u32, more: &[&str]| {
            let out = folder.path().join(name);
            let out_text = out.to_str().expect("a path");
            let arguments = ["cut", scene, "--out", out_text, "--backend", "cpu", "--quiet", "--only", "maps"];
            gearcut_on_threads(threads, &[&arguments[..], &COARSEST[..], more].concat()).done();
            files(&out)
        };
        // The bytes of a round helical gear, all of its files, are compared by another test.
        for (number, name) in scenes.iter().enumerate() {
            let scene = &format!("scenes/hobbing/{name}.toml");
            let first = cut(scene, &format!("{number}_one"), 1, &[]);
            assert_same_files(&first, &cut(scene, &format!("{number}_two"), 2, &[]));
            if number == 0 {
                // The comparison is alive: a hob 10 nm back leaves other bytes.
                let moved = cut(scene, "moved", 2, &["--set", "operation.finish.offset_mm=0.00001"]);
                assert!(std::panic::catch_unwind(|| assert_same_files(&first, &moved)).is_err());
            }
        }
    }

    #[test]
    fn a_hobbed_gear_comes_with_meshes_charts_marks_points_and_programs() {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("gear");
        let cut_on = |out: &Path, threads: u32| {
            let sets = ["gear.teeth=16", "tool.hob.reference_diameter_mm=50"];
            cut(out, "scenes/hobbing/circular_spur.toml", &sets, threads)
        };
        let results = cut_on(&out, 2);
        let again = folder.path().join("again");
        cut_on(&again, 1);
        assert_same_files(&files(&out), &files(&again));
        for file in [
            "mesh/gear.stl",
            "mesh/gear.ply",
            "mesh/gear.glb",
            "mesh/flanks/tooth_16_right.ply",
            "pictures/flank.png",
            "pictures/offset_curves.svg",
            "pictures/passes_finish.png",
            "deviation/tooth_01_left.png",
            "tables/flanks.csv",
            "tables/marks.csv",
            "tables/offset_curves.csv",
            "axes/finish.csv",
            "axes/finish_velocities.svg",
            "axes/finish.ngc",
            "axes/finish_gearbox.ngc",
            "report.html",
        ] {
            assert!(out.join(file).metadata().is_ok_and(|data| data.len() > 100), "{file}");
        }
        let table = |name: &str| std::fs::read_to_string(out.join("tables").join(name)).expect("a table");
        // Five curves cross both flanks of 16 teeth.
        assert_eq!(table("offset_curves.csv").lines().count(), 1 + 5 * 32);
        assert_is_results(&results);
        let sections = &results["sections"];
        let curves = &sections["offset_curves"];
        assert_eq!(curves["points"]["value"], 160);
        // A round gear: errors in x and y spread alike, and their frequencies are those of all points.
        let [x, y] = ["error_x", "error_y"].map(|key| number(&curves[key]["sigma"]));
        assert!(x > 0.1 && (x / y - 1.0).abs() < 0.2, "{x} {y}");
        let frequencies = curves["error_x"]["frequencies"]["rows"].as_array().expect("seven");
        assert_eq!(frequencies.iter().map(|row| row[1].as_u64().expect("a count")).sum::<u64>(), 160);
        // Marks of one feed and one gash on every flank alike; both ways agree.
        let marks: Vec<&Value> = parts(&sections["marks"]).collect();
        assert!(marks.len() >= 2);
        for step in marks.iter().flat_map(|flank| ["step_1", "step_2"].map(|step| &flank[step])) {
            let [known, seen] = ["kinematic", "surface"].map(|key| number(&step[key]["length"]));
            assert!((seen / known - 1.0).abs() < 0.05, "{step}");
        }
        // Every pitch deviation is less than the marks are high.
        let highest = number(&results["headline"]["highest_deviation"]);
        assert!(number(&results["headline"]["f_p"]) < 2.0 * highest);
        let window = parts(&sections["texture"]["finish"]).next().expect("a window");
        let sz = &window["parameters"]["Sz"];
        assert!(number(sz) <= 1.1 * highest, "{sz}");
        let length_mm = 16.0 * 8.0 / 15_f64.to_radians().cos();
        assert!((number(&sections["hob_load"]["length_of_teeth"]) / length_mm - 1.0).abs() < 1e-12);
        // The load tooth by tooth is the whole volume, and a comparison reads it back.
        let load = &sections["hob_load"]["operations"]["finish"];
        assert_eq!(load["teeth"]["columns"][1]["key"], "volume");
        let teeth = load["teeth"]["rows"].as_array().expect("hob teeth");
        let sum: f64 = teeth.iter().map(|tooth| tooth[1].as_f64().expect("a volume")).sum();
        assert!((sum / number(&load["volume"]) - 1.0).abs() < 1e-12);
        let compared = folder.path().join("compared");
        let gear = out.display().to_string();
        gearcut(&["compare", &gear, &gear, "--out", &compared.display().to_string()])
            .done()
            .says(&["gear (a) and gear (b)", "nothing changed"]);
        assert!(compared.join("hob_load_operations_finish_teeth_volume.svg").is_file());
        let page = std::fs::read_to_string(out.join("report.html")).expect("a page");
        for words in [
            "Cutting marks",
            "Points on five curves",
            "Work of the hob's teeth",
            "Helix, left flanks",
            "Axis motion",
            "15.0000° right-hand",
            "hob tooth, from the entering end",
        ] {
            assert!(page.contains(words), "{words}");
        }
    }
}
