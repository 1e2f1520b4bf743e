//! Errors put in on purpose come out as their closed forms say: cutter runout, cutter pitch error, work eccentricity;
//! and a round gear is an involute gear.

use crate::fixtures::paper::*;
use gearcut::cut::cpu::Cpu;
use gearcut::gear::PitchCurveShape;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::scene::model::*;
use gearcut::scene::Scene;
use gearcut::scene::model::*;
use gearcut::steps::planar::CutField;
use gearcut::terms::Side;
use glam::DVec2;

const FLANKS: [(u32, Side); 4] = [(2, Side::Left), (5, Side::Right), (8, Side::Left), (13, Side::Right)];

fn fine_scene() -> Scene {
    let mut scene = paper_scene(vec![operation("finish", NORMAL, 0.0, 4200)]);
    scene.fields = Fields { profile_spacing_mm: 0.05, lead_spacing_mm: 30.0, ..scene.fields };
    scene
}

/// Cuts the same flank with and without an error; gives columns with both heights, away from form point and tip.
fn heights(sound: &ShapingJob, faulty: &ShapingJob, tooth: u32, side: Side) -> Vec<(DVec2, DVec2, f64, f64)> {
    let cut = |job: &ShapingJob| -> CutField {
        let flank = sound.target_flank(tooth, side);
        job.cut(&Cpu::default(), sound.flank_field(flank)).expect("native")
    };
    let (a, b) = (cut(sound), cut(faulty));
    let count = a.field.columns.len();
    (8..count - 12)
        .map(|i| {
            let at = |cut: &CutField| f64::from(cut.layers[0].column(i, cut.field.rows())[0]);
            (a.field.columns[i].origin_mm, a.field.columns[i].normal, at(&a), at(&b))
        })
        .collect()
}

#[test]
fn cutter_runout_moves_flanks_by_its_part_along_the_normal() {
    let sound = ShapingJob::new(fine_scene()).expect("the gear");
    let (runout_mm, angle_rad) = (0.01, 0.6);
    let mut scene = fine_scene();
    let cutter = &mut Shaping::of_mut(&mut scene).expect("shaping").tool;
    (cutter.runout_mm, cutter.runout_angle_rad) = (runout_mm, angle_rad);
    let faulty = ShapingJob::new(scene).expect("the gear");
    let mut worst_um = 0.0_f64;
    for (tooth, side) in FLANKS {
        let flank = sound.target_flank(tooth, side);
        for (origin, normal, before, after) in heights(&sound, &faulty, tooth, side) {
            // The cutter's orientation when it touches here: the target's own contact.
            let contact = (0..2000)
                .map(|i| flank.at_arc(flank.length_mm() * f64::from(i) / 1999.0))
                .min_by(|a, b| a.point_mm.distance(origin).total_cmp(&b.point_mm.distance(origin)))
                .expect("contacts");
            let pose = sound.finishing().linkage.pose(contact.phi_rad, 0.0);
            let expected = runout_mm * DVec2::from_angle(pose.angle_rad + angle_rad).dot(normal);
            worst_um = worst_um.max((after - before - expected).abs() * 1e3);
        }
    }
    println!("runout of 10 um: worst difference from the closed form {worst_um:.4} um");
    // The second order of the runout, e^2 / (2 rho) with rho of 3 mm and more, and what is left of the scallops.
    assert!(worst_um < 0.1, "{worst_um} um");
}

#[test]
fn a_cutter_pitch_error_appears_on_the_spaces_of_its_tooth() {
    let sound = ShapingJob::new(fine_scene()).expect("the gear");
    let mut scene = fine_scene();
    let error_mm = 0.01;
    // Space 2 is cut by cutter tooth -2, that is 18 of 20.
    Shaping::of_mut(&mut scene).expect("shaping").tool.pitch_errors_mm =
        (0..20).map(|j| if j == 18 { error_mm } else { 0.0 }).collect();
    let faulty = ShapingJob::new(scene).expect("the gear");
    let cos = 20_f64.to_radians().cos();
    let shift = |tooth, side| -> (f64, f64) {
        let difference: Vec<f64> = heights(&sound, &faulty, tooth, side).iter().map(|h| (h.3 - h.2) * 1e3).collect();
        (difference.iter().copied().fold(f64::INFINITY, f64::min), difference.iter().copied().fold(-1e9, f64::max))
    };
    // A parallel involute: the shift along the normal is the error times cos(alpha) at every place of the flank.
    for (tooth, side, expected) in [(2, Side::Left, -error_mm * cos * 1e3), (3, Side::Right, error_mm * cos * 1e3)] {
        let (low, high) = shift(tooth, side);
        println!("tooth {tooth} {}: {low:.4} to {high:.4} um, expected {expected:.4}", side.name());
        // Facets move along the flank with the error: up to a scallop height (0.07 um) of change.
        assert!((low - expected).abs() < 0.08 && (high - expected).abs() < 0.08);
    }
    let (low, high) = shift(5, Side::Left);
    assert_eq!((low, high), (0.0, 0.0), "another tooth's flank does not change");
}

#[test]
fn work_eccentricity_shifts_the_whole_gear() {
    let sound = ShapingJob::new(fine_scene()).expect("the gear");
    let mut scene = fine_scene();
    let shift = 0.01 * DVec2::from_angle(2.0);
    let machine = &mut Shaping::of_mut(&mut scene).expect("shaping").machine;
    let mounting = &mut machine.errors.mounting;
    (mounting.eccentricity_mm, mounting.eccentricity_angle_rad) = (0.01, 2.0);
    let faulty = ShapingJob::new(scene).expect("the gear");
    let mut worst_um = 0.0_f64;
    for (tooth, side) in FLANKS {
        for (_, normal, before, after) in heights(&sound, &faulty, tooth, side) {
            worst_um = worst_um.max((after - before + shift.dot(normal)).abs() * 1e3);
        }
    }
    println!("eccentricity of 10 um: worst difference from the closed form {worst_um:.4} um");
    assert!(worst_um < 0.1, "{worst_um} um");
}

#[test]
fn a_round_gear_is_an_exact_involute_gear() {
    let mut scene = fine_scene();
    scene.gear.pitch_curve = PitchCurveShape::Circle;
    scene.gear.teeth = 24;
    let job = ShapingJob::new(scene).expect("a round gear");
    let alpha = 20_f64.to_radians();
    let (r, r_b) = (36.0, 36.0 * alpha.cos());
    let psi_b = std::f64::consts::PI / 48.0 + alpha.tan() - alpha;
    let mut worst_mm = 0.0_f64;
    for (tooth, side) in [(1, Side::Left), (7, Side::Right), (20, Side::Left)] {
        let flank = job.target_flank(tooth, side);
        for i in 0..=100 {
            let contact = flank.at_arc(flank.length_mm() * f64::from(i) / 100.0);
            let p = contact.point_mm;
            let u = ((p.length() / r_b).powi(2) - 1.0).sqrt();
            // Tooth centres stand half a pitch after the spaces.
            let center = std::f64::consts::TAU / 24.0 * (f64::from(tooth) - 0.5);
            let theta = DVec2::from_angle(-center).rotate(p).to_angle();
            worst_mm = worst_mm.max((r_b * (side.sign() * theta + u - u.atan() - psi_b)).abs());
        }
        let tip = flank.at_arc(flank.length_mm()).point_mm.length();
        assert!((tip - (r + 3.0)).abs() < 1e-9);
        let cut = job.cut(&Cpu::default(), job.flank_field(flank)).expect("native");
        let heights = cut.layers[0].heights_mm.iter().skip(2 * cut.field.rows());
        let (low, high) = heights.fold((f32::INFINITY, 0.0_f32), |(l, h), &v| (l.min(v), h.max(v)));
        assert!(low > -1e-7 && high < 2e-4, "scallops only: {low} to {high} mm");
    }
    println!("round gear: worst distance from the involute {worst_mm:.2e} mm");
    assert!(worst_mm < 1e-10);
}
