//! Teeth of half height, as splines have them, and hobs that top the gear.

use gearcut::cut::cpu::Cpu;
use gearcut::job::CylindricalGear;
use gearcut::process;
use gearcut::process::hobbing::measure::offset_curves;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::terms::Side;
use std::path::Path;

const SHORT: [&str; 3] =
    ["gear.face_width_mm=5", "fields.flank.profile_spacing_um=50", "fields.flank.lead_spacing_um=500"];

fn job(scene: &str, settings: &[&str]) -> HobbingJob {
    let settings: Vec<String> = SHORT.iter().chain(settings).map(|&s| s.to_owned()).collect();
    let loaded = process::load(Path::new(&format!("scenes/hobbing/{scene}.toml")), &settings).expect("a scene");
    HobbingJob::new(&loaded.scene).expect("a job")
}

/// Points of a flank as cut: all five curves, none off by more than marks; and the lowest and highest place of the
/// flank.
fn cut_um(job: &HobbingJob, side: Side) -> [f64; 2] {
    let cutter = HobCutter::new(job).expect("passes");
    let points =
        offset_curves::measure(&cutter, &Cpu::default(), &[(1, side)]).expect("all points are found").remove(0);
    assert_eq!(points.len(), 5);
    for point in &points {
        let along_um = 1e3 * point.along_mm.expect("cut");
        assert!((-0.01..40.0).contains(&along_um), "{along_um} um at {} mm", point.offset_mm);
    }
    let [depth_mm, height_mm] = [job.target.rack.tip_height_mm, job.blank.addendum_mm];
    assert!(points[0].offset_mm > -depth_mm && points[4].offset_mm < height_mm);
    let flank = cutter.cut(&Cpu::default(), 1, side).expect("a flank");
    let heights = || flank.layers[0].heights_mm.iter().map(|&height| 1e3 * f64::from(height));
    [heights().fold(f64::INFINITY, f64::min), heights().fold(0.0, f64::max)]
}

/// inv(aK) = D / (z m cos a) - (pi - 4 x tan a) / (2 z) + inv(a), M = z m cos a / cos aK + D; the span is 21.1793 mm
/// over 4 teeth. ISO 4156 has 30, 37.5 and 45 deg with heights of 0.5, 0.45 and 0.4 modules.
#[test]
fn splines_are_cut_and_have_their_sizes() {
    let sizes = |job: &HobbingJob| {
        let round = HobCutter::new(job).expect("passes").round_gear().expect("flanks").expect("round");
        let over = round.over_balls(4.0).expect("balls").dimension_mm;
        (round, over)
    };
    let shaft = job("spline_shaft", &[]);
    let (round, over_mm) = sizes(&shaft);
    let span = round.span().expect("a span");
    assert!((round.tip_diameter_mm - 49.6).abs() < 1e-9 && (round.root_diameter_mm - 45.4).abs() < 1e-9);
    assert!(span.teeth == 4 && (span.length_mm - 21.1793).abs() < 5e-5 && (over_mm - 54.2176).abs() < 5e-5);
    let iso = |angle: &str, addendum: &str, dedendum: &str, round_mm: &str| {
        let settings = [
            format!("gear.pressure_angle_deg={angle}"),
            format!("gear.addendum_coefficient={addendum}"),
            "gear.profile_shift_coefficient=0".to_owned(),
            format!("tool.hob.addendum_coefficient={dedendum}"),
            format!("tool.hob.dedendum_coefficient={dedendum}"),
            format!("tool.hob.tip_radius_mm={round_mm}"),
        ];
        job("spline_shaft", &settings.each_ref().map(String::as_str))
    };
    let jobs =
        [shaft, iso("30", "0.5", "0.75", "0.4"), iso("37.5", "0.45", "0.7", "0.6"), iso("45", "0.4", "0.6", "0.5")];
    for job in &jobs {
        let alpha = job.scene.gear.pressure_angle_rad;
        let inv = |angle: f64| angle.tan() - angle;
        let (z, m, x) = (24.0, 2.0, job.scene.gear.profile_shift_coefficient);
        let wanted =
            4.0 / (z * m * alpha.cos()) - (std::f64::consts::PI - 4.0 * x * alpha.tan()) / (2.0 * z) + inv(alpha);
        let angle = (0..200).fold([0.0, 1.5], |[low, high]: [f64; 2], _| {
            let middle = 0.5 * (low + high);
            if inv(middle) < wanted { [middle, high] } else { [low, middle] }
        })[0];
        let dimension_mm = z * m * alpha.cos() / angle.cos() + 4.0;
        let (_, over_mm) = sizes(job);
        assert!((over_mm - dimension_mm).abs() < 1e-6, "{over_mm} for {dimension_mm}");
        for side in [Side::Left, Side::Right] {
            let [lowest_um, highest_um] = cut_um(job, side);
            println!("{:.1} deg {side:?}: {lowest_um:.3} to {highest_um:.2} um", alpha.to_degrees());
            assert!(lowest_um > -0.01 && highest_um < 15.0, "{lowest_um} to {highest_um}");
        }
    }
}

/// Roots of the hob at 0.7 modules leave tips of 0.7 modules: flanks end there, and nothing lies under the target. With
/// a hob as deep as usual the blank's own tips stay.
#[test]
fn a_hob_with_a_short_dedendum_tops_the_gear() {
    let small = ["gear.module_mm=2", "gear.teeth=24", "tool.hob.reference_diameter_mm=60", "tool.hob.length_mm=60"];
    let whole = job("circular_spur", &small);
    assert!(!whole.tops_the_gear() && whole.blank.addendum_mm == 2.0);
    let mut settings = small.to_vec();
    settings.push("tool.hob.dedendum_coefficient=0.7");
    let topped = job("circular_spur", &settings);
    assert!(
        topped.tops_the_gear() && (topped.blank.addendum_mm - 1.4).abs() < 1e-12 && topped.stock.addendum_mm == 2.0
    );
    let round = HobCutter::new(&topped).expect("passes").round_gear().expect("flanks").expect("round");
    assert!((round.tip_diameter_mm - 50.8).abs() < 1e-9 && (round.tip_form_diameter_mm - 50.8).abs() < 1e-9);
    let [lowest_um, highest_um] = cut_um(&topped, Side::Left);
    assert!(lowest_um > -0.01 && highest_um < 15.0, "{lowest_um} to {highest_um}");
}
