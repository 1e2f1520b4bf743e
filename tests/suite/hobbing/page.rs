//! What a hobbing run shows first, on the terminal and on its page, and what it folds away.

use crate::fixtures::command::{gearcut, read_json};
use gearcut::process;
use gearcut::process::hobbing::HobbingJob;
use gearcut::process::hobbing::measure::hoffmeister;
use std::path::Path;

/// A small helical gear that says little: its hob is the usual one.
const SCENE: &str = "[gear]\nmodule_mm = 1.5\nteeth = 17\nhelix_angle_deg = 20.0\nface_width_mm = 8.0\n[tool.hob]\n\
    [material]\nname = \"C45\"\n[measure]\niso_1328_class = 9\n[[operation]]\nname = \"finish\"\n\
    [fields.blank]\nspacing_mm = 0.2\nslice_spacing_mm = 1.0\n";

#[test]
fn class_limit_chip_force_and_load_come_first_and_marks_are_folded() {
    let folder = tempfile::tempdir().expect("a folder");
    let (scene, out) = (folder.path().join("scene.toml"), folder.path().join("out"));
    std::fs::write(&scene, SCENE).expect("a scene");
    let path = |path: &Path| path.to_str().expect("a path").to_owned();
    let parts = ["--only", "report", "--only", "texture", "--backend", "cpu"];
    let run = gearcut(&[&["cut", &path(&scene), "--out", &path(&out)][..], &parts].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let first = [
        "class reached",
        "largest share of a limit",
        "thickest chip",
        "Hoffmeister",
        "largest cutting force",
        "hardest hob tooth to mean",
        "left to shift by",
        "highest deviation",
    ];
    let text = run.out.split_whitespace().collect::<Vec<_>>().join(" ");
    let places: Vec<usize> = first.iter().map(|words| text.find(words).unwrap_or_else(|| panic!("{words}"))).collect();
    assert!(places.is_sorted(), "{places:?} in {}", run.out);
    for folded in ["angle apart", "Points on five curves"] {
        assert!(!run.out.contains(folded), "{folded}");
    }
    let page = std::fs::read_to_string(out.join("report.html")).expect("a page");
    for words in ["Deviation without marks", "Runout of a perfect machine is feed marks", "\"noun\":\"pass\""] {
        assert!(page.contains(words), "{words}");
    }
    // A section that is closed has no attribute beside its class.
    for (id, closed) in [("marks", true), ("curves", true), ("deviations", true), ("load", true), ("setup", true)] {
        let details = page.split_once(&format!("<section id=\"{id}\"")).expect("a section").1;
        let details = details.split_once("<details class=\"section\"").expect("foldable").1;
        assert_eq!(details.starts_with('>'), closed, "{id}");
    }
    // Marks of the default windows have points enough.
    let results = read_json(&out.join("results.json"));
    assert!(!results["warnings"].to_string().contains("has only"), "{}", results["warnings"]);
    let windows = results["sections"]["texture"]["finish"].as_object().expect("windows");
    assert!(windows.values().filter(|window| window["marks_along_tooth"]["value"].as_f64() > Some(4.0)).count() >= 2);
}

/// 4.9 m z^-0.542 (r_a0 / m)^-0.225 (i / z_0)^-0.877 (f_a / m)^0.511 (a_p / m)^0.319 on the spur gear: 14.7 mm times
/// 0.13542, 0.54716, 0.11311, 0.81285 and 1.29525.
#[test]
fn the_shops_formula_has_its_value() {
    let loaded = process::load(Path::new("scenes/hobbing/circular_spur.toml"), &[]).expect("a scene");
    let job = HobbingJob::new(&loaded.scene).expect("a job");
    let found_mm = hoffmeister::thickest_chip_mm(&job).expect("a round gear");
    assert!((found_mm - 0.1297).abs() < 2e-4, "{found_mm}");
    let oval = process::load(Path::new("scenes/hobbing/third_order_plain.toml"), &[]).expect("a scene");
    assert_eq!(hoffmeister::thickest_chip_mm(&HobbingJob::new(&oval.scene).expect("a job")), None);
}

/// Marks of helical gears follow each other closely along the tooth: default windows have 20 points of each, wide faces
/// in a part of them.
#[test]
fn default_windows_have_points_enough_for_every_mark() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, SCENE).expect("a scene");
    let scene = scene.to_str().expect("a path");
    for set in ["gear.face_width_mm=30", "gear.helix_angle_deg=30", "tool.hob.gashes=20", "gear.teeth=60"] {
        let check = gearcut(&["check", scene, "--set", set]);
        let words = check.out.split_whitespace().collect::<Vec<_>>().join(" ") + &check.err;
        assert!(check.code == 0 && !words.contains("has only"), "{set}: {words}");
    }
}
