//! Gears that do not belong together are refused, with what differs and by how much.

use super::*;
use crate::pair_job::fit::Fit;
use crate::pair_job::flanks::FlankSource;
use crate::pair_job::member;
use crate::pair_job::options::PairOptions;
use crate::scene::Mate;
use gearcut_core::gear::GearKind;

const RING: &str = "kind = \"internal\"\nrim_mm = 10.0\n";

#[track_caller]
fn refused(a: &LoadedScene, b: &LoadedScene, phase: i64, says: &[&str]) {
    // Without its debug text, which would be pages long.
    let Err(refusal) = Fit::new(&a.scene, &b.scene, phase) else { panic!("they do not belong together") };
    let text = refusal.to_string();
    assert!(says.iter().all(|words| text.contains(words)), "{text} does not say {says:?}");
}

#[test]
fn what_does_not_mesh_is_told_with_numbers() {
    let a = round("a", 24, "", "");
    let other = process::parse(
        "[gear]\nmodule_mm = 2.5\nteeth = 24\n[tool.shaper_cutter]\nteeth = 20\n",
        "other.toml",
        Path::new(""),
        &[],
    )
    .expect("a scene");
    refused(&a, &other, 0, &["3 mm", "2.5 mm", "differ by 1.5708 mm"]);
    refused(&round("ring", 60, RING, ""), &a, 0, &["gear A is a ring of 60", "external gear first"]);
    refused(&round("ring", 60, RING, ""), &round("ring", 61, RING, ""), 0, &["both gears are rings"]);
    // A round gear beside a third-order one: the mate's radii and its own.
    let third = third_order(20, 420, 0.0);
    refused(&third, &round("round", 42, "", ""), 0, &["52.8", "69.3", "63.000", "0.300 mm are allowed", "--mate"]);
    // The mate for outside, used as a ring. (Of ellipses both have one shape: another curve.)
    let pascal = parsed(
        "pascal",
        "[gear]\nmodule_mm = 3.0\nteeth = 42\n[gear.pitch_curve.pascal]\norder = 3\neccentricity = 0.08\n\
         [tool.shaper_cutter]\nteeth = 20\n",
    );
    let ring = member::mate(&pascal, Mate { teeth: 84, kind: GearKind::Internal }, &[]).expect("a ring");
    Fit::new(&pascal.scene, &ring.scene, 0).expect("a ring fits");
    let mut wrong = member::mate(&pascal, Mate { teeth: 84, kind: GearKind::External }, &[]).expect("a mate");
    wrong.scene.gear.kind = GearKind::Internal;
    refused(&pascal, &wrong, 0, &["internal mate of 84 teeth", "do not close together"]);
}

/// Two ovals of equal pitch curves roll on each other with tooth on tooth: 40 teeth, 10 to a quarter of the turn.
#[test]
fn curves_that_close_half_a_pitch_off_are_told_from_others() {
    let oval = member::read(Path::new("scenes/shaping/order_2.toml"), &[]).expect("a scene");
    refused(&oval, &oval, 0, &["close together, but their teeth do not", "0.5 pitches", "are allowed"]);
}

#[test]
fn gear_b_may_be_turned_on_by_whole_repeats_only() {
    let a = third_order(20, 420, 0.0);
    let b = member::mate(&a, Mate { teeth: 42, kind: GearKind::External }, &[]).expect("a mate");
    let fit = Fit::new(&a.scene, &b.scene, 14).expect("a third of a turn repeats the curve");
    assert!(fit.misfit_mm < 1e-6, "{}", fit.misfit_mm);
    refused(&a, &b, 1, &["turned on by 1 teeth", "mm away"]);
}

#[test]
fn what_parts_the_teeth_is_refused_before_they_are_cut() {
    let (a, b) = (round("a", 24, "", ""), round("b", 36, "", ""));
    let fit = Fit::new(&a.scene, &b.scene, 0).expect("they belong together");
    let gears = [&a.scene.gear, &b.scene.gear];
    let options = |um| PairOptions { center_distance_error_um: um, ..PairOptions::default() };
    let says = |options: &PairOptions, words: &[&str]| {
        let text = options.mounting(&fit, gears).expect_err("too far").to_string();
        assert!(words.iter().all(|words| text.contains(words)), "{text} does not say {words:?}");
    };
    // Both tips are 3 mm high: 6 mm further apart they pass each other.
    says(&options(6000.0), &["96.000000 mm", "90.000000 mm", "overlap by 6.000 mm", "-6000 to 6000 um"]);
    options(5990.0).mounting(&fit, gears).expect("teeth that reach each other");
    options(-1000.0).mounting(&fit, gears).expect("tips in roots: what jams is rolled");
    let nominal = PairOptions { source: FlankSource::Nominal, ..options(-601.0) };
    says(&nominal, &["89.399000 mm", "deeper than the flanks", "-600 to 6000 um"]);
    let swing = PairOptions { eccentricity_um_deg: [[3000.0, 0.0], [4000.0, 0.0]], ..options(0.0) };
    says(&swing, &["eccentricities take 7.000 mm", "-6000 to -1000 um"]);
    let inclined = PairOptions { parallelism_um: [0.0, -201.0], ..options(0.0) };
    says(&inclined, &["-201 um", "face of 20 mm", "-200 to 200 um"]);
    let one = PairOptions { sections: Some(1), parallelism_um: [10.0, 0.0], ..PairOptions::default() };
    assert!(one.sections(gears, || Ok(false)).expect_err("one section").to_string().contains("11"));
}

/// Tips of 2 mm on both gears reach 4 mm to either side of the 48 mm at which their pitch circles roll.
#[test]
fn drawn_teeth_are_refused_away_from_their_own_distance() {
    let gear = member::read(Path::new("scenes/shaping/cycloid.toml"), &[]).expect("a scene");
    let scenes = [&gear.scene; 2];
    let refusal = |options: PairOptions| {
        let fit = Fit::at_distance(scenes[0], scenes[1], 0, options.center_distance_mm).expect("they belong together");
        options.mounting(&fit, scenes.map(|scene| &scene.gear)).expect_err("too far").way_out
    };
    let named = PairOptions { center_distance_mm: Some(60.0), ..PairOptions::default() };
    let way_out = refusal(named);
    assert!(way_out.contains("44.000 to 52.000 mm (--center-distance-mm"), "{way_out}");
    assert!(way_out.contains("none for 48.000000 mm"), "{way_out}");
    let off = PairOptions { center_distance_error_um: 12_000.0, ..PairOptions::default() };
    assert_eq!(refusal(off), "give -4000 to 4000 um of --center-distance-error-um");
}
