//! What a deviation is and what it is not: ridges between strokes stay as high on a gear off its axis, and where a
//! turn closes on a machine that drifts, the step has its size and its sign.

use crate::fixtures::command::{gearcut, read_json};
use serde_json::Value;
use std::fs;

/// A round gear of module 1: 20 teeth, 600 strokes in a turn of 72 s.
const SCENE: &str = "[gear]\nmodule_mm = 1.0\nteeth = 20\nface_width_mm = 1.0\nbore_diameter_mm = 5.0\n\
                     [gear.pitch_curve.circle]\n[tool.shaper_cutter]\nteeth = 30\n[tool.shaper_cutter.tip.sharp]\n\
                     [machine]\ndouble_strokes_per_minute = 500.0\n\
                     [[operation]]\nname = \"finish\"\nstrokes_per_revolution = 600\nfeed_during_stroke = false\n\
                     [fields.flank]\nprofile_spacing_um = 5.0\nlead_spacing_um = 500.0\n";

/// What a run of the scene with this setting finds.
fn cut(setting: &str) -> Value {
    cut_with(&[setting])
}

fn cut_with(settings: &[&str]) -> Value {
    cut_scene(SCENE, settings)
}

fn cut_scene(text: &str, settings: &[&str]) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("a path").to_owned();
    fs::write(path("gear.toml"), text).expect("a scene");
    let (scene, out) = (path("gear.toml"), path("out"));
    let mut words = vec!["cut", &scene, "--out", &out, "--only", "numbers", "--quiet", "--backend", "cpu"];
    words.extend(settings.iter().flat_map(|setting| ["--set", setting]));
    let outcome = gearcut(&words);
    assert!([0, 3].contains(&outcome.code), "{}", outcome.err);
    read_json(&folder.path().join("out/results.json"))
}

fn headline_um(results: &Value, key: &str) -> f64 {
    results["headline"][key]["value"].as_f64().unwrap_or_else(|| panic!("{}", results["headline"][key]))
}

/// A gear clamped 40 um off its axis: the deviation swings by as much, and ridges stay what they were.
#[test]
fn ridges_between_strokes_do_not_grow_with_the_eccentricity() {
    let [sound, off] = ["mounting.eccentricity_um=0", "mounting.eccentricity_um=40"].map(cut);
    let [before, after] = [&sound, &off].map(|results| headline_um(results, "scallop_height"));
    // The highest lies up to a feed below the evaluated end, and ridges grow by some 5 % over a feed there.
    assert!((after / before - 1.0).abs() < 0.1, "{before} um, off the axis {after} um");
    let deviation_um = headline_um(&off, "highest_deviation");
    // Towards the tip normals and radii close in: at most all of the shift.
    assert!(deviation_um > 30.0 && deviation_um < 41.0, "{deviation_um} um");
    assert!(headline_um(&sound, "highest_deviation") < 2.0 * before);
}

/// 600 um/h over a turn of 72 s are 12 um of centre distance, 12 sin(20 deg) um normal to a flank: deeper with a
/// distance that shrinks, above with one that grows. The largest f_p is measured there, and both are said.
#[test]
fn a_drift_leaves_its_step_where_the_turn_closes() {
    let expected_um = 12.0 * 20_f64.to_radians().sin();
    for (sign, word) in [(-1.0, "deeper than"), (1.0, "above")] {
        let results = cut(&format!("machine.errors.center_distance.drift_um_per_h={}", sign * 600.0));
        let step_um = headline_um(&results, "witness_mark");
        assert!((step_um / (sign * expected_um) - 1.0).abs() < 0.05, "{step_um} um for {} um", sign * expected_um);
        // The step is no ridge.
        assert!(headline_um(&results, "scallop_height") < 0.3);
        let warnings = results["warnings"].to_string();
        assert!(warnings.contains("where its end meets its beginning") && warnings.contains(word), "{warnings}");
        assert!(warnings.contains("the largest f_p") && warnings.contains("closes"), "{warnings}");
    }
    let none = cut("machine.errors.center_distance.drift_um_per_h=0");
    assert!(headline_um(&none, "witness_mark").abs() < 0.05 && !none["warnings"].to_string().contains("closes"));
}

/// A cutter r off its axis has turned by 20 / 30 of a turn more when the turn closes: its axis stands 2 r sin(120 deg)
/// from where it stood, and a flank sees no more of that, and on one of 40 flanks nearly all. A draft sees it, too: the
/// facets are as far apart whatever the dexels.
#[test]
fn a_cutter_off_its_axis_leaves_its_step_where_the_turn_closes() {
    let most_um = 2.0 * 5.0 * 120_f64.to_radians().sin();
    let off = "tool.shaper_cutter.runout_um=5";
    let results = [cut(off), cut_with(&[off, "fields.flank.profile_spacing_um=10"])];
    let steps_um = results.each_ref().map(|results| headline_um(results, "witness_mark"));
    for (step_um, results) in steps_um.iter().zip(&results) {
        assert!(step_um.abs() > 0.1 * most_um && step_um.abs() < most_um, "{step_um} um of {most_um} um");
        let warnings = results["warnings"].to_string();
        assert!(warnings.contains("runout_um and pitch_errors_um of the cutter"), "{warnings}");
    }
    assert!((steps_um[0] - steps_um[1]).abs() < 0.1, "{steps_um:?} um");
}

/// On a sound machine 200 strokes for 17 teeth come round between those of the turn before: the largest f_p is measured
/// there, and neither drift nor cutter is blamed. With twelve strokes per tooth teeth are alike.
#[test]
fn strokes_per_tooth_that_are_not_whole_are_named_as_such() {
    let scene = "[gear]\nmodule_mm = 2.0\nteeth = 17\nhelix_angle_deg = 22.0\nhand = \"left\"\n\
                 profile_shift_coefficient = 0.3\ntooth_thickness_allowance_mm = -0.05\nface_width_mm = 10.0\n\
                 bore_diameter_mm = 10\n[tool.shaper_cutter]\nteeth = 25\n[[operation]]\nname = \"finish\"\n\
                 strokes_per_revolution = 200\n[operation.infeed.spiral]\n";
    let strokes = |count: u32| {
        cut_scene(scene, &[&format!("operation.finish.strokes_per_revolution={count}")])["warnings"].to_string()
    };
    let broken = strokes(200);
    assert!(broken.contains("200 for 17 teeth are no whole number per tooth"), "{broken}");
    assert!(!broken.contains("runout_um") && !broken.contains("machine.errors"), "{broken}");
    assert!(!strokes(204).contains("closes"));
}

/// Two dexels along the tooth make no helix: its figures say that, and not that something was not cut.
#[test]
fn too_few_dexels_along_the_tooth_are_named_as_such() {
    let results = cut("fields.flank.lead_spacing_um=1000");
    let of_helix = &results["headline"]["F_beta"];
    assert!(of_helix["value"].is_null(), "{of_helix}");
    assert!(of_helix["why"].to_string().contains("fewer than three dexels"), "{of_helix}");
    assert_eq!(results["headline"]["untouched_dexels"]["value"], 0);
}
