//! `gearcut pair`: what it writes, what it says, what it refuses.

use crate::fixtures::command::{gearcut, gearcut_in, read_json};
use crate::fixtures::json_schema::assert_is_results;
use gearcut::gear::GearKind;
use gearcut::pair_job::fit::Fit;
use gearcut::pair_job::member;
use gearcut::scene::{LoadedScene, Mate};
use std::path::Path;

/// A small round gear, cut in no time.
const SCENE: &str = "[gear]\nmodule_mm = 3.0\nteeth = 12\nface_width_mm = 10.0\n\
    tooth_thickness_allowance_mm = -0.05\n\
    [tool.shaper_cutter]\nteeth = 16\n\
    [[operation]]\nname = \"finish\"\nstrokes_per_revolution = 720\n\
    [operation.infeed.none]\n\
    [fields.flank]\nprofile_spacing_um = 20.0\n";

/// What a pair of cut gears writes; its record tells no times.
const WRITTEN: [&str; 16] = [
    "results.json",
    "report.html",
    "run.json",
    "tables/rolling.csv",
    "tables/contact_by_tooth.csv",
    "tables/harmonics_right.csv",
    "tables/double_flank_mate.csv",
    "pictures/ratio.svg",
    "pictures/transmission_error.svg",
    "pictures/backlash.svg",
    "pictures/contact_ratio.svg",
    "pictures/double_flank.svg",
    "pictures/waves.svg",
    "pictures/contact_pattern_A.png",
    "pictures/contact_pattern_B.png",
    "pictures/rolling.apng",
];

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder for the test");
    std::fs::write(folder.path().join("a.toml"), SCENE).expect("a scene");
    folder
}

fn roll(folder: &Path, more: &[&str]) -> String {
    let arguments = [&["pair", "a.toml", "--mate", "18", "--positions", "288"], more].concat();
    gearcut_in(folder, &arguments).done().out
}

#[test]
fn a_pair_writes_numbers_tables_charts_patterns_and_a_page() {
    let folder = folder();
    let said = roll(folder.path(), &[]);
    for words in [
        "12 and 18 teeth",
        "transmission error",
        "smallest backlash",
        "tips clear the mate by",
        "10 um of centre distance",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let out = folder.path().join("out/a_with_a_mate_18");
    let results = read_json(&out.join("results.json"));
    assert_is_results(&results);
    assert_eq!(results["process"], "pair");
    let play = &results["sections"]["backlash"]["smallest"];
    // Both gears are thinned by 0.05 mm: 100 um, less the scallops of both flanks.
    assert!((99.3..100.0).contains(&play["value"].as_f64().expect("a number")), "{play}");
    assert_eq!(play["unit"], "um");
    let written = || WRITTEN.map(|name| std::fs::read(out.join(name)).unwrap_or_else(|_| panic!("{name} is missing")));
    let first = written();
    let rows = std::fs::read_to_string(out.join("tables/rolling.csv")).expect("a table").lines().count();
    assert_eq!(rows, 289, "a head and a row for every position");
    let page = std::fs::read_to_string(out.join("report.html")).expect("a page");
    for words in [
        "rolling report",
        "rolled over a whole period",
        "Transmission error",
        "data:image/png;base64,",
        "href=\"tables/rolling.csv\"",
        "id=\"record\"",
        "tooth_thickness_allowance_mm = -0.05",
    ] {
        assert!(page.contains(words), "the page does not say {words}");
    }
    // The same again has the same bytes; another one compares with it.
    roll(folder.path(), &[]);
    for (name, (one, other)) in WRITTEN.iter().zip(first.iter().zip(&written())) {
        assert!(one == other, "{name} differs from run to run");
    }
    roll(folder.path(), &["--center-distance-error-um", "20", "--out", "out/apart"]);
    let compared = gearcut_in(folder.path(), &["compare", "out/a_with_a_mate_18", "out/apart"]).done().out;
    // 20 um apart: 2 * 20 um * tan(20 deg).
    assert!(compared.contains("Smallest backlash") && compared.contains("14.5"), "{compared}");
    let curves = folder.path().join("out/compare_a_with_a_mate_18_apart/transmission_error_positions.svg");
    let curves = std::fs::read_to_string(curves).expect("both curves in one chart");
    for words in
        ["transmission error right", "backlash circumferential", ">a_with_a_mate_18<", ">apart<", "class=\"curve s1\""]
    {
        assert!(curves.contains(words), "the chart does not say {words}");
    }
}

/// What interferes is written all the same, and nobody can miss it.
#[test]
fn a_tip_that_stands_in_the_mate_ends_with_code_3() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let out = folder.path().join("rolled");
    let scene = "scenes/shaping/elliptical_normal.toml";
    let coarse = ["--positions", "504", "--set-a", "fields.flank.profile_spacing_um=50", "--out"];
    let arguments = [&["pair", scene, "--mate", "42"], &coarse[..], &[out.to_str().expect("UTF-8")]].concat();
    gearcut(&arguments).failed(3, &["verdict: a tip of gear", "um deep in a fillet of gear"]);
    let results = read_json(&out.join("results.json"));
    let deepest = &results["headline"]["interference_deepest"];
    assert!(deepest["value"].as_f64().expect("a number") > 1.0, "{deepest}");
    let page = std::fs::read_to_string(out.join("report.html")).expect("a page");
    assert!(page.contains("id=\"roll\"") && page.contains("Contact pattern of gear A"), "both gears roll on the page");
}

#[test]
fn a_folder_of_results_rolls_as_its_scene_does() {
    let folder = folder();
    gearcut_in(folder.path(), &["cut", "a.toml", "--only", "numbers"]).done();
    let by_scene = gearcut_in(folder.path(), &["pair", "a.toml", "a.toml", "--positions", "144", "--json"]).done().out;
    let arguments = ["pair", "out/a_part", "out/a_part", "--positions", "144", "--json"];
    let by_folder = gearcut_in(folder.path(), &arguments).done().out;
    let sections = |text: &str| {
        let mut results: serde_json::Value = serde_json::from_str(text).expect("JSON");
        results["sections"]["pair"].take();
        results["sections"]["interference"].take();
        results["sections"].clone()
    };
    assert_eq!(sections(&by_scene), sections(&by_folder));
    gearcut_in(folder.path(), &["pair", "out/a_with_a", "a.toml"]).failed(1, &["record of pair", "gearcut cut"]);
}

/// The contour of the cutter lies beside the scene: not in the current folder, and not in that of the results.
#[test]
fn files_beside_the_scene_are_found_for_its_mate_and_its_results() {
    let a = member::read(Path::new("scenes/shaping/cycloid.toml"), &[]).expect("gear A");
    let contour = |gear: &LoadedScene| {
        let [file] = gear.scene.process.files_read()[..] else { panic!("one file") };
        file.canonicalize().expect("it is there")
    };
    let b = member::mate(&a, Mate { teeth: 18, kind: GearKind::External }, &[]).expect("a mate");
    assert_eq!(contour(&b), contour(&a));
    let folder = tempfile::tempdir().expect("a folder for the test");
    let out = folder.path().join("deep/cycloid");
    std::fs::create_dir_all(&out).expect("made");
    let files = a.folder_of_files(&out).expect("a way to its files");
    let record = serde_json::json!({ "command": "cut", "scene": a.resolved_toml(), "scene_folder": files });
    std::fs::write(out.join("run.json"), record.to_string()).expect("written");
    assert_eq!(contour(&member::read(&out, &[]).expect("cut before")), contour(&a));
}

#[test]
fn what_cannot_be_rolled_is_refused_with_numbers() {
    let ring = "scenes/shaping/internal_pair_ring.toml";
    let driver = "scenes/shaping/internal_pair_driver.toml";
    let round = "scenes/shaping/circular_m3_z24.toml";
    gearcut(&["pair", ring, driver]).failed(1, &["ring of 102", "external gear first"]);
    gearcut(&["pair", driver, round]).failed(1, &["2 mm", "3 mm", "differ by 3.1416 mm"]);
    gearcut(&["pair", round, "--mate", "24", "--center-distance-error-um", "7000"])
        .failed(1, &["79.000000 mm", "72.000000 mm", "6000 um"]);
    gearcut(&["pair", round, "--mate", "24", "--center-distance-mm", "60"]).failed(1, &["60 mm", "67.6579 mm"]);
    let third = "scenes/shaping/elliptical_normal.toml";
    let apart = ["27.331 to 43.806 mm", "8.669 mm away", "0.300 mm are allowed", "--mate"];
    gearcut(&["pair", third, round]).failed(1, &apart);
    // The mate for outside, said to be a ring.
    gearcut(&["pair", third, "--mate", "42", "--set-b", "gear.kind=internal", "--set-b", "gear.rim_mm=10"])
        .failed(1, &["a driver of 42 teeth does not fit into a ring of 42"]);
    gearcut(&["pair", round, "--mate", "24", "--marking-um", "0"]).failed(1, &["--marking-um", "above 0"]);
    gearcut(&["pair", round, "--mate", "25", "--positions", "100"]).failed(1, &["100 positions", "600", "4800"]);
    gearcut(&["pair", round]).failed(2, &["--mate", "pair [OPTIONS] <A> <B | --mate <TEETH>>"]);
    gearcut(&["pair", round, round, "--mate", "24"]).failed(2, &["--mate"]);
    gearcut(&["pair", round, "--mate", "24", "--internal"]).failed(1, &["no internal mate with 24 teeth"]);
}

/// Every pair of the documentation: its scenes load, take their settings and belong together.
#[test]
fn the_pairs_of_the_documentation_fit() {
    let page = std::fs::read_to_string("docs/pair.md").expect("the page");
    let table = page.split("## Pairs to begin with").nth(1).expect("its table");
    let commands: Vec<Vec<&str>> = table
        .split('`')
        .filter_map(|text| Some(text.strip_prefix("gearcut pair ")?.split_whitespace().collect()))
        .collect();
    assert!(commands.len() >= 8, "{} commands", commands.len());
    for words in commands {
        let after = |option: &str| -> Vec<String> {
            words.windows(2).filter(|pair| pair[0] == option).map(|pair| pair[1].to_owned()).collect()
        };
        let (set_a, set_b) = (after("--set-a"), after("--set-b"));
        let a = member::read(Path::new(words[0]), &set_a).expect("gear A");
        let b = match after("--mate").first() {
            Some(teeth) => {
                let teeth = teeth.parse().expect("a number of teeth");
                member::mate(&a, Mate { teeth, kind: GearKind::External }, &set_b).expect("a mate")
            }
            None => member::read(Path::new(words[1]), &set_b).expect("gear B"),
        };
        let fit = Fit::new(&a.scene, &b.scene, 0).unwrap_or_else(|refusal| panic!("{words:?}: {refusal}"));
        assert!(fit.misfit_mm < 1e-3, "{words:?}: {} mm", fit.misfit_mm);
    }
}
