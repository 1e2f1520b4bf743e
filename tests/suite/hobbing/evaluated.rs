//! The evaluated part of a profile: between the scene's heights over the pitch curve, else without 5 % at both ends.

use gearcut::cut::cpu::Cpu;
use gearcut::job::GearJob;
use gearcut::process::hobbing::measure::flank_report::{self, HobbedReport};
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::terms::Side;
use std::path::Path;

/// Left flank of tooth 1 of the shipped spur gear, and its arcs as texture windows take them.
fn measured(settings: &[&str]) -> (HobbedReport, [f64; 2]) {
    let mut all = vec!["gear.face_width_mm=6".to_owned(), "fields.flank.profile_spacing_um=20".to_owned()];
    all.push("fields.flank.lead_spacing_um=500".to_owned());
    all.extend(settings.iter().map(|&setting| setting.to_owned()));
    let scene = load(Path::new("scenes/hobbing/circular_spur.toml"), &all).unwrap_or_else(|e| panic!("{e}")).scene;
    let job = HobbingJob::new(&scene).expect("a scene that cuts");
    let cutter = HobCutter::new(&job).expect("passes");
    let flank = cutter.cut(&Cpu::default(), 1, Side::Left).expect("cut");
    (flank_report::measure(1, Side::Left, &flank), cutter.evaluated_profile_mm(1, Side::Left).expect("a target"))
}

/// On a round gear heights over the pitch curve are radii, the involute's arc between two radii is (R^2 - r^2) / (2
/// r_b), and the contact moves by sqrt(R^2 - r_b^2) - sqrt(r^2 - r_b^2) along the line of action.
#[test]
fn heights_of_the_scene_bound_what_is_evaluated() {
    let (whole, default_mm) = measured(&[]);
    let (part, arcs_mm) = measured(&["measure.profile_start_height_mm=-0.5", "measure.profile_end_height_mm=1.5"]);
    let [margin_mm, rest_mm] = [default_mm[0], whole.length_mm - default_mm[1]];
    assert!((margin_mm - 0.05 * whole.length_mm).abs() < 1e-9 && (rest_mm - margin_mm).abs() < 1e-9);
    assert_eq!(part.evaluated_mm, arcs_mm);
    let (pitch_mm, base_mm) = (60.0_f64, 60.0 * 20_f64.to_radians().cos());
    let [low_mm, high_mm] = [pitch_mm - 0.5, pitch_mm + 1.5];
    let arc_mm = (high_mm * high_mm - low_mm * low_mm) / (2.0 * base_mm);
    assert!((arcs_mm[1] - arcs_mm[0] - arc_mm).abs() < 1e-6, "{arcs_mm:?}, {arc_mm}");
    // The outermost dexels, 20 um apart, stand within one of them of the ends.
    let along =
        |radius_mm: f64| (radius_mm * radius_mm - base_mm * base_mm).sqrt() - (60.0 * 20_f64.to_radians().sin());
    let [from, to] = part.profile.expect("complete").between_mm;
    let [low, high] = [along(low_mm), along(high_mm)];
    assert!(
        from >= low - 1e-6 && from < low + 0.07 && to <= high + 1e-6 && to > high - 0.07,
        "{from} {to} {low} {high}"
    );
    // Heights are those inside: their extremes stand there, and they reach no further than the whole flank's.
    let [inside, all] = [part.own.finished, whole.own.finished].map(|heights| heights.expect("complete"));
    assert!(inside.ends.iter().all(|at| at.arc_mm >= arcs_mm[0] - 1e-9 && at.arc_mm <= arcs_mm[1] + 1e-9));
    assert!(inside.ends[1].value_mm <= all.ends[1].value_mm && inside.ends[0].value_mm >= all.ends[0].value_mm);
    // The helix is traced over the same face.
    assert_eq!(part.lead, whole.lead);
}

#[test]
fn an_end_that_is_not_named_or_not_reached_stays() {
    let (_, default_mm) = measured(&[]);
    let (_, one_mm) = measured(&["measure.profile_start_height_mm=0", "measure.profile_end_height_mm=50"]);
    assert!(one_mm[0] > default_mm[0] && one_mm[1].to_bits() == default_mm[1].to_bits(), "{one_mm:?}, {default_mm:?}");
}
