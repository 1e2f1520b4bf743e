//! What a scene gets that says little: a cut that a shop could run, by the report's own numbers.

use crate::fixtures::command::{gearcut, read_json};
use std::path::Path;

const SHORTEST: &str = "[gear]\nmodule_mm = 3.0\nteeth = 24\n[tool.shaper_cutter]\nteeth = 20\n";
/// Coarse dexels; chips are followed on rays of their own.
const COARSE: &str = "[fields.flank]\nprofile_spacing_um = 100.0\nlead_spacing_um = 10000.0\n";

/// Cuts a scene and gives back its folder's results and warnings.
fn cut(folder: &Path, text: &str) -> serde_json::Value {
    let (scene, out) = (folder.join("scene.toml"), folder.join("out"));
    std::fs::write(&scene, text).expect("a scene");
    let path = |path: &Path| path.to_str().expect("a path").to_owned();
    gearcut(&["cut", &path(&scene), "--only", "report", "--out", &path(&out)]).done();
    read_json(&out.join("results.json"))
}

/// Cutting force of the strokes of an operation with their work angles, N and deg.
fn forces(folder: &Path, operation: &str) -> Vec<[f64; 2]> {
    let mut table = csv::Reader::from_path(folder.join(format!("out/tables/chips_{operation}.csv"))).expect("chips");
    let column = |name: &str, heads: &csv::StringRecord| heads.iter().position(|head| head == name).expect("a column");
    let heads = table.headers().expect("heads").clone();
    let [angle, force] = ["work_angle_deg", "cutting_force_N"].map(|name| column(name, &heads));
    let rows = table.records().map(|row| row.expect("a row"));
    rows.map(|row| [angle, force].map(|column| row[column].parse().expect("a number"))).collect()
}

fn largest_n(forces: &[[f64; 2]], from_deg: f64, to_deg: f64) -> f64 {
    let inside = forces.iter().filter(|[angle, _]| (from_deg..to_deg).contains(angle));
    inside.fold(0.0, |largest, [_, force]| f64::max(largest, *force))
}

fn warned(results: &serde_json::Value, words: &str) -> bool {
    results["warnings"].to_string().contains(words)
}

#[test]
fn the_shortest_scene_can_be_run_in_a_shop() {
    let folder = tempfile::tempdir().expect("a folder");
    let results = cut(folder.path(), &format!("{SHORTEST}{COARSE}"));
    assert!(!warned(&results, "first stroke") && !warned(&results, "cutting force"), "{}", results["warnings"]);
    let mut most_n = 0.0;
    for operation in ["rough", "finish"] {
        let forces = forces(folder.path(), operation);
        let spiral_deg = forces.last().expect("strokes")[0] - 360.0;
        let [infeed_n, rest_n] = [largest_n(&forces, 0.0, spiral_deg), largest_n(&forces, spiral_deg + 30.0, 360.0)];
        println!("{operation}: {:.0} N first, {infeed_n:.0} N on the way to depth, {rest_n:.0} N after", forces[0][1]);
        assert!(forces[0][1] < 0.1 * rest_n, "{operation}: {} N at the first stroke", forces[0][1]);
        // Finishing thus stays far below what roughing asks of the ram.
        most_n = f64::max(most_n, 1.25 * rest_n);
        assert!(infeed_n < most_n, "{operation}: {infeed_n} N on the way to depth, {rest_n} N after");
    }
}

#[test]
fn full_depth_on_the_first_stroke_is_cut_where_it_is_asked_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let finish = "[[operation]]\nname = \"finish\"\n";
    let results = cut(folder.path(), &format!("{SHORTEST}{finish}[operation.infeed.none]\n{COARSE}"));
    assert!(warned(&results, "the first stroke comes at full depth"), "{}", results["warnings"]);
    let at_once = forces(folder.path(), "finish");
    assert!(at_once[0][1] > 100.0 * largest_n(&at_once, 90.0, 360.0), "{:?}", at_once[0]);
    let results = cut(folder.path(), &format!("{SHORTEST}{finish}{COARSE}"));
    assert!(!warned(&results, "the first stroke comes at full depth"), "{}", results["warnings"]);
    assert!(forces(folder.path(), "finish")[0][1] < 100.0);
}

/// The sentence of the key: a round tangent to flank and tip circle fits as far as the tip is wide.
#[test]
fn tip_rounds_have_the_room_that_their_key_says() {
    let fits = |teeth: u32, modules: f64| {
        let text = format!(
            "[gear]\nmodule_mm = 1.0\nteeth = 24\n[tool.shaper_cutter]\nteeth = {teeth}\naddendum_coefficient = 1.25\n\
             [tool.shaper_cutter.tip.round]\nradius_mm = {modules}\n"
        );
        let scene = gearcut::process::parse(&text, "round.toml", Path::new(""), &[]);
        scene.is_ok_and(|scene| gearcut::process::prepare(&scene.scene).is_ok())
    };
    for (teeth, room, too_much) in [(14, 0.25, 0.3), (20, 0.34, 0.35), (26, 0.37, 0.38), (27, 0.38, 0.4)] {
        assert!(fits(teeth, room) && !fits(teeth, too_much), "{teeth} teeth: {room} and not {too_much} modules");
    }
}
