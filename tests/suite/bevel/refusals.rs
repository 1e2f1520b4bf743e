//! Bad input: settings that miss the blank, heads that cannot be made, cones that contradict each other, shared keys
//! that mean nothing to a bevel gear.

use super::jobs::job;
use crate::fixtures::command::gearcut;

const PRINTED: &str = "five_linkage_printed";

#[test]
fn what_cannot_be_cut_is_refused_with_numbers() {
    for (setting, words) in [
        ("machine.cradle.radial_setting_mm=20", &["cone distance", "generate no flank"][..]),
        ("gear.bevel.face_angle_deg=75.0", &["gear.bevel.face_angle_deg", "75.0000 deg", "77.5833 to 90"]),
        ("gear.face_width_mm=140", &["gear.face_width_mm", "140 mm reaches the apex", "132.3"]),
        ("tool.face_mill.tip_width_mm=0.9", &["0.9 mm wide", "a slot of 2 mm", "use 1 to 2 mm"]),
        ("tool.face_mill.corner_radius_mm=3", &["a round of 3 mm finds no room"]),
        ("tool.face_mill.blades=15", &["15 blades do not alternate"]),
    ] {
        let refused = job(PRINTED, &[setting]).map(|_| ()).expect_err(setting).to_string();
        for word in words {
            assert!(refused.contains(word), "{setting}: {refused}");
        }
    }
}

#[test]
fn what_is_off_is_warned_of_with_numbers() {
    for (setting, words) in [
        ("tool.face_mill.blades=16", "slots come out 0.7464 mm too shallow"),
        ("gear.bevel.shaft_angle_deg=90", "19 teeth at a shaft angle of 90.0000 deg roll on cones of 72.9"),
        ("machine.cradle.root_angle_deg=75", "root angle is -0.4333 deg off the blank's"),
    ] {
        let warnings = job(PRINTED, &[setting]).expect("a gear").contradictions();
        assert!(warnings.iter().any(|warning| warning.contains(words)), "{setting}: {warnings:?}");
    }
    let short = ["operation.finish.roll_from_deg=45", "operation.finish.roll_to_deg=70"];
    let warnings = job(PRINTED, &short).expect("a gear").contradictions();
    assert!(warnings.iter().any(|warning| warning.contains("the flanks need 42.2")), "{warnings:?}");
}

#[test]
fn keys_of_cylindrical_gears_are_refused_at_their_place() {
    let scene = format!("scenes/bevel/{PRINTED}.toml");
    for (setting, words) in [
        ("gear.helix_angle_deg=10", "this scene is for bevel, where the machine's settings make the spiral"),
        ("gear.kind=internal", "where the pitch angle says where teeth stand"),
        ("gear.pitch_curve.ellipse={order=2, eccentricity=0.1}", "where gears roll on cones"),
        ("fields.blank.spacing_mm=0.5", "where no rays go through the whole blank"),
        ("tool.face_mill.runouts_um=[1.0]", "has 1 entries for 16 blades"),
    ] {
        gearcut(&["check", &scene, "--set", setting]).failed(1, &[words]);
    }
    gearcut(&["mate", &scene, "--teeth", "19"]).failed(1, &["no external mate with 19 teeth", "no pitch curve"]);
}
