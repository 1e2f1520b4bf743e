//! `gearcut contact`: a gear and a pinion that one crown gear generates, from their scenes to the folder.

use super::jobs::job;
use crate::fixtures::command::{gearcut, read_json};
use crate::fixtures::json_schema::assert_is_results;
use gearcut::bevel::contact::{BevelPair, Contact, Mounting};
use gearcut::bevel::face_mill::BladeKind;
use gearcut::process::bevel::BevelJob;
use gearcut::process::bevel::pair::findings::ARCSEC_PER_RAD;
use gearcut::process::bevel::pair::{MountingError, MountingErrors, RolledBevels, Running, roll};
use std::f64::consts::PI;

const MARKING_MM: f64 = 0.00635;
/// Where the gear's outside blades cut, mm; the common cone stands two dedenda further, and the scene's pinion takes
/// 1.5 mm off that.
const GEAR_POINTS_MM: f64 = 75.0;
const DEDENDUM_MM: f64 = 5.0;
const BLADE_RAD: f64 = 20.0 * PI / 180.0;
const CROWNING_MM: f64 = 1.5;

fn jobs(pinion: &[&str]) -> [BevelJob; 2] {
    [job("crown_gear", &[]).expect("a gear"), job("crown_pinion", pinion).expect("a pinion")]
}

fn rolled([gear, pinion]: &[BevelJob; 2], errors: &MountingErrors) -> RolledBevels {
    roll(gear, pinion, errors, MARKING_MM).expect("they meet")
}

/// Settings of a pinion whose inside blades follow the gear's cone: no crowning at all.
fn conjugate_pinion() -> [String; 3] {
    let crowned = job("crown_pinion", &[]).expect("a pinion");
    let settings = crowned.finishing().settings;
    // The head's circle goes through the same mean point, with the radius of the gear's outside blades.
    let spiral_rad = 35_f64.to_radians();
    let mean_mm = crowned.blank.mean_cone_distance_mm();
    let across_mm = GEAR_POINTS_MM * spiral_rad.cos();
    let along_mm = mean_mm - GEAR_POINTS_MM * spiral_rad.sin();
    assert!(settings.cradle_angle_rad < 0.0);
    [
        format!("tool.face_mill.radius_mm={}", crowned.head.radius_mm + CROWNING_MM),
        format!("machine.cradle.radial_setting_mm={}", along_mm.hypot(across_mm)),
        format!("machine.cradle.cradle_angle_deg={}", -across_mm.atan2(along_mm).to_degrees()),
    ]
}

/// Conjugate flanks turn evenly and touch along lines; an offset of the axis ends that.
#[test]
fn flanks_of_one_crown_gear_turn_evenly() {
    let settings = conjugate_pinion();
    let [gear, pinion] = jobs(&settings.iter().map(String::as_str).collect::<Vec<_>>());
    let running = |offset_mm: f64| {
        let [gear, pinion] =
            [&gear.target[BladeKind::Outside.index()], &pinion.target[BladeKind::Inside.index()]].map(Clone::clone);
        let mounting = Mounting { shaft_angle_rad: 0.5 * PI, offset_mm, pinion_axial_mm: 0.0, gear_axial_mm: 0.0 };
        Running::of(&BevelPair { gear, pinion, mounting }, MARKING_MM).expect("they meet")
    };
    let concave = running(0.0);
    let arcsec = ARCSEC_PER_RAD * concave.motion_error_rad();
    let [long_mm, short_mm] = concave.middle().ellipse.expect("inside the flank").half_axes_mm;
    println!("conjugate: {arcsec:e} arc seconds, {long_mm} by {short_mm} mm");
    assert!(arcsec < 0.1, "{arcsec} arc seconds");
    // A line: as long as differences over places known to 1e-4 mm can tell, far beyond the face of 25 mm.
    assert!(long_mm > 60.0 && short_mm < 2.0, "{long_mm} by {short_mm} mm");
    let arcsec = ARCSEC_PER_RAD * running(0.05).motion_error_rad();
    println!("E = 50 um: {arcsec} arc seconds");
    assert!(arcsec > 0.5, "{arcsec} arc seconds");
}

/// The crowned side has the ellipse of both cones' curvature, and its contact moves with the mounting, the more for
/// the larger error, the other way for the other sign.
#[test]
fn a_crowned_pinion_shows_its_bearing_and_how_it_moves() {
    let rolled = rolled(&jobs(&[]), &MountingErrors::default());
    let concave = &rolled.sides[0];
    let radius_mm = GEAR_POINTS_MM + DEDENDUM_MM * BLADE_RAD.tan();
    let bend = CROWNING_MM / (radius_mm * (radius_mm - CROWNING_MM)) * BLADE_RAD.cos();
    let wanted_mm = (2.0 * MARKING_MM / bend).sqrt();
    let middle: &Contact = concave.running.middle();
    let [long_mm, _] = middle.ellipse.expect("inside the flank").half_axes_mm;
    println!("long half axis {long_mm} mm, {wanted_mm} mm by the cutters' radii");
    assert!(long_mm > wanted_mm && long_mm < 1.05 * wanted_mm);
    assert!(ARCSEC_PER_RAD * concave.running.motion_error_rad() < 0.1);
    assert_eq!(concave.trends.len(), 2 * MountingError::ALL.len());
    let [from_mm, _] = concave.running.center_mm();
    for pair in concave.trends.chunks_exact(2) {
        let moved_mm: Vec<f64> =
            pair.iter().map(|trend| trend.found.expect("they still meet").1[0] - from_mm).collect();
        println!("{:?}: moved along by {moved_mm:?} mm", pair[0].error);
        assert!(moved_mm[0] * moved_mm[1] < 0.0, "{:?}: {moved_mm:?}", pair[0].error);
        assert!((moved_mm[0] + moved_mm[1]).abs() < 0.3 * moved_mm[0].abs(), "{:?}: {moved_mm:?}", pair[0].error);
    }
    // Turned about the axis of the gear, and along it, the flank moves against its mate; the offset moves it most.
    let moved = |error: MountingError| {
        let of = concave.trends.iter().filter(|trend| trend.error == error);
        of.map(|trend| (trend.found.expect("met").1[0] - from_mm).abs()).fold(0.0, f64::max)
    };
    assert!(moved(MountingError::Offset) > 0.1);
}

#[test]
fn the_command_writes_a_folder_and_refuses_what_is_no_pair() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("pair");
    let [gear, pinion] = ["scenes/bevel/crown_gear.toml", "scenes/bevel/crown_pinion.toml"];
    gearcut(&["contact", gear, pinion, "--e-um", "20", "--out", out.to_str().expect("a path")])
        .done()
        .says(&["motion error, concave", "contact length, convex"]);
    let results = read_json(&out.join("results.json"));
    assert_is_results(&results);
    assert_eq!(results["process"], "bevel pair");
    for file in ["report.html", "tables/contact_concave.csv", "tables/trends_convex.csv", "pictures/bearing_convex.svg"]
    {
        assert!(out.join(file).is_file(), "{file} is missing");
    }
    for (arguments, words) in [
        (vec![pinion, gear], "name the gear first, then the pinion"),
        (vec![gear, gear], "the same hand of spiral"),
        (vec![gear, pinion, "--set-pinion", "gear.module_mm=4.1"], "the gear's outer module is 4.0000 mm"),
        (vec![gear, pinion, "--set-gear", "gear.bevel.mate_teeth=20"], "names a mate with 20 teeth"),
        (vec![gear, pinion, "--g-um", "5000"], "5000 is not -2000 to 2000"),
        (vec![gear, "scenes/shaping/circular_m3_z24.toml"], "this tool does not cut bevel gears"),
    ] {
        gearcut(&[&["contact"][..], &arguments].concat()).failed(1, &[words]);
    }
}
