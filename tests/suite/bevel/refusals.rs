//! Bad input: settings that miss the blank, heads that cannot be made, cones that contradict each other, shared keys
//! that mean nothing to a bevel gear.

use super::jobs::job;
use crate::fixtures::command::gearcut;
use gearcut::process::bevel::blank::CellGrid;
use gearcut::terms::Side;

const PRINTED: &str = "five_linkage_printed";

#[test]
fn what_cannot_be_cut_is_refused_with_numbers() {
    for (setting, words) in [
        ("machine.cradle.radial_setting_mm=20", &["cone distance", "make no flank"][..]),
        ("gear.bevel.face_angle_deg=75.0", &["face angle", "75.0000 deg", "77.5833 to 90"]),
        ("gear.face_width_mm=140", &["face width", "140 mm reaches the apex", "132.3"]),
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

/// More points than dexels: the grid would have one point twice.
#[test]
fn a_grid_finer_than_the_dexels_is_refused() {
    let settings = ["fields.flank.profile_spacing_um=500", "inspection.profile_points=60"];
    let refused = job(PRINTED, &settings).map(|_| ()).expect_err("too fine").to_string();
    for words in ["inspection.profile_points", "60 points find", "ask for at most"] {
        assert!(refused.contains(words), "{refused}");
    }
    assert!(job(PRINTED, &settings[1..]).is_ok());
    let many = job(PRINTED, &["fields.blank.spacing_mm=0.001", "fields.blank.slice_spacing_mm=0.02"]).expect("a gear");
    let refused = CellGrid::of_scene(&many).expect_err("too many rays").to_string();
    assert!(refused.contains("fields.blank.spacing_mm") && refused.contains("at most 2e9"), "{refused}");
}

#[test]
fn what_is_off_is_warned_of_with_numbers() {
    for (setting, words) in [
        ("tool.face_mill.blades=16", "slots come out 0.7464 mm too shallow"),
        ("gear.bevel.shaft_angle_deg=90", "19 teeth at a shaft angle of 90.0000 deg roll on cones of 72.9"),
        ("machine.cradle.root_angle_deg=75", "root angle is -0.4333 deg off the blank's"),
    ] {
        let warnings = job(PRINTED, &[setting]).expect("a gear").contradictions();
        assert!(warnings.iter().any(|warning| warning.text.contains(words)), "{setting}: {warnings:?}");
    }
    // Blades of 18.5 and 21.5 deg fit one way round better than the other.
    let angles = |outside: f64, inside: f64| {
        [
            format!("tool.face_mill.outside_blade_angle_deg={outside}"),
            format!("tool.face_mill.inside_blade_angle_deg={inside}"),
        ]
    };
    let exchanged = |[outside, inside]: [String; 2]| {
        let warnings = job(PRINTED, &[&outside, &inside]).expect("a gear").contradictions();
        warnings.iter().any(|warning| warning.text.contains("inside and outside blades look exchanged"))
    };
    assert!(!exchanged(angles(20.0, 20.0)));
    let both = [exchanged(angles(18.5, 21.5)), exchanged(angles(21.5, 18.5))];
    assert!(both[0] != both[1], "{both:?}");
    // Ends of the travel: B stands at the root angle of 75.4333 deg.
    for (limit, words) in [
        ("machine.bevel_limits.b_to_deg=70", "B goes from 75.433 to 75.433 deg, the machine from no end to 70.000 deg"),
        ("machine.bevel_limits.y_to_mm=80", "the machine from no end to 80.000 mm"),
    ] {
        let warnings = job(PRINTED, &[limit]).expect("a gear").contradictions();
        assert!(warnings.iter().any(|warning| warning.text.contains(words)), "{limit}: {warnings:?}");
    }
    assert_eq!(job(PRINTED, &["machine.bevel_limits.b_to_deg=80"]).expect("a gear").contradictions().len(), 1);
    let short = ["operation.finish.roll_from_deg=45", "operation.finish.roll_to_deg=70"];
    let warnings = job(PRINTED, &short).expect("a gear").contradictions();
    assert!(warnings.iter().any(|warning| warning.text.contains("the flanks need 42.2")), "{warnings:?}");
}

/// A head that is too wide cuts into the next tooth. With the ratio of roll of a gear without offset rays go through
/// the hypoid gear's teeth and meet the slot beyond, 1 mm deep; bounds of the blades' ring say that none comes there.
#[test]
fn a_head_that_hits_the_next_tooth_is_warned_of() {
    assert_eq!(job(PRINTED, &[]).expect("a gear").next_tooth_warning().expect("flanks"), None);
    let wide = ["tool.face_mill.point_width_mm=9"];
    let warning = job(PRINTED, &wide).expect("a gear").next_tooth_warning().expect("flanks");
    println!("{warning:?}");
    assert!(warning.is_some_and(|of| of.text.contains("hits the next tooth") && of.text.contains("go at least ")));
    let hypoid = job("hypoid", &["machine.cradle.roll_ratio=1.0232"]).expect("a gear");
    let beside = hypoid.deepest_cut(Side::Left, &[1]).expect("flanks").depth_mm;
    let other = hypoid.deepest_cut(Side::Left, &[hypoid.blank.teeth - 1]).expect("flanks").depth_mm;
    assert!(beside.max(other) > 0.5, "{beside} {other}");
    assert_eq!(hypoid.next_tooth_warning().expect("flanks"), None);
    assert_eq!(job("hypoid", &[]).expect("a gear").next_tooth_warning().expect("flanks"), None);
}

#[test]
fn keys_of_cylindrical_gears_are_refused_at_their_place() {
    let scene = format!("scenes/bevel/{PRINTED}.toml");
    for (setting, words) in [
        ("gear.helix_angle_deg=10", "this scene is for bevel, where the machine's settings make the spiral"),
        ("gear.kind=internal", "where the pitch angle says where the teeth are"),
        ("gear.pitch_curve.ellipse={order=2, eccentricity=0.1}", "where gears roll on cones"),
        ("material.normal_force_n_per_mm2=1000", "the cutting force alone is computed"),
        ("tool.face_mill.runouts_um=[1.0]", "has 1 entries for 16 blades"),
    ] {
        gearcut(&["check", &scene, "--set", setting]).failed(1, &[words]);
    }
    gearcut(&["mate", &scene, "--teeth", "19"]).failed(1, &["no external mate with 19 teeth", "no pitch curve"]);
}

/// The blades are no deeper in the blank of the shortest scene than its teeth are high at the heel, 7.552 mm, and not
/// much less; a roll that begins where the notice names is clear, and so is a head that plunges.
#[test]
fn a_roll_that_begins_in_the_blank_is_warned_of() {
    let warned = |scene: &str, settings: &[&str]| {
        let scene = format!("scenes/bevel/{scene}.toml");
        let set = settings.iter().flat_map(|setting| ["--set", setting]);
        let done = gearcut(&["check", &scene].into_iter().chain(set).collect::<Vec<_>>());
        done.err.lines().find(|line| line.contains("bevel.starts_in_blank")).map(str::to_owned)
    };
    let line = warned("spiral_angle", &[]).expect("a warning");
    let number = |after: &str| -> f64 {
        let rest = line.split(after).nth(1).unwrap_or_default().trim_start();
        rest.split(' ').next().and_then(|word| word.parse().ok()).unwrap_or_else(|| panic!("{after}: {line}"))
    };
    let deep_mm = number("withdrawn by");
    assert!(deep_mm > 0.75 * 7.552 && deep_mm < 7.552, "{line}");
    let from = format!("operation.0.roll_from_deg={}", number("roll_from_deg ="));
    assert_eq!(warned("spiral_angle", &[&from]), None);
    assert_eq!(warned("formate", &[]), None);
}
