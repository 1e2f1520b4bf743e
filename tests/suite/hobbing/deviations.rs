//! Errors put into hob and machine on purpose, and the profile, helix and pitch deviations that a round helical gear
//! must show for them in closed form.
//!
//! Every gear is cut twice, with the error and without it; the difference of the figures is the error's alone, since
//! both carry the same marks.

use gearcut::cut::cpu::Cpu;
use gearcut::frame::Rigid3;
use gearcut::measure::deviation;
use gearcut::passes::{MotionTable, TurningPasses};
use gearcut::process;
use gearcut::process::hobbing::measure::flank_report;
use gearcut::process::hobbing::measure::flank_report::HobbedReport;
use gearcut::process::hobbing::measure::offset_curves;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::terms::Side;
use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};
use std::path::Path;

/// A helical gear of 24 teeth, marks of a few tenths of a micrometre.
fn job(settings: &[&str]) -> HobbingJob {
    let fine = [
        "gear.teeth=24",
        "gear.helix_angle_deg=20",
        "gear.face_width_mm=8",
        "tool.hob.gashes=24",
        "operation.finish.axial_feed_mm_per_revolution=0.6",
        "fields.flank.profile_spacing_um=100",
        "fields.flank.lead_spacing_um=500",
    ];
    let settings: Vec<String> = fine.iter().chain(settings).map(|&s| s.to_owned()).collect();
    let loaded = process::load(Path::new("scenes/hobbing/circular_spur.toml"), &settings).expect("a scene");
    HobbingJob::new(&loaded.scene).expect("a job")
}

/// The job's passes with the work out of its place: `error` says by how much at a hob angle, gear frame.
fn with_work_error(job: &HobbingJob, error: impl Fn(f64) -> Rigid3 + Sync) -> HobCutter<'_> {
    let mut cutter = HobCutter::new(job).expect("passes");
    let linkage = &job.finishing().linkage;
    let hob_at = |time_s: f64| linkage.axes::<1>(time_s).hob_rad.value();
    let range_rad = [hob_at(0.0) - PI, hob_at(linkage.end_s()) + PI];
    let motion = MotionTable::new(range_rad, &[], |hob_rad| linkage.head_from_work(hob_rad).after(&error(hob_rad)));
    cutter.operations = vec![TurningPasses::new(0, &job.hob, job.hob.hand, motion).expect("a hob")].into();
    cutter
}

fn report(cutter: &HobCutter, side: Side) -> HobbedReport {
    flank_report::measure(1, side, &cutter.cut(&Cpu::default(), 1, side).expect("cut"))
}

/// cos(beta_b): heights along the normal in space against those in the transverse section.
fn cos_base_helix(job: &HobbingJob) -> f64 {
    (job.scene.gear.helix_angle_rad.sin() * job.scene.gear.pressure_angle_rad.cos()).asin().cos()
}

/// A hob of another pressure angle rolls an involute of another base circle: h = L dr_b / r_b in the transverse
/// section, straight over the roll length L.
#[test]
fn a_hobs_pressure_angle_error_is_a_straight_profile_slope_over_the_roll() {
    let right = job(&[]);
    let mut wrong = job(&[]);
    let steeper = job(&["gear.pressure_angle_deg=20.05"]);
    let base_cos = |job: &HobbingJob| job.scene.gear.transverse_pressure_angle_rad().cos();
    let relative = base_cos(&steeper) / base_cos(&right) - 1.0;
    wrong.hob = steeper.hob;
    for side in [Side::Left, Side::Right] {
        let [clean, bad] = [&right, &wrong].map(|job| report(&HobCutter::new(job).expect("passes"), side));
        let [clean_profile, profile] = [&clean, &bad].map(|report| report.profile.expect("evaluated"));
        let roll_mm = profile.between_mm[1] - profile.between_mm[0];
        let expected_mm = relative * roll_mm * cos_base_helix(&right);
        let slope_mm = profile.slope_mm - clean_profile.slope_mm;
        println!("{side:?}: f_H_alpha {slope_mm:.6} mm for {expected_mm:.6}, over {roll_mm:.3} mm of roll");
        assert!(expected_mm < -0.001 && (slope_mm / expected_mm - 1.0).abs() < 0.01);
        // Straight: over the arc of the profile an eighth of the slope would be a bend.
        let bend_mm = bad
            .profile_trace
            .heights_mm
            .iter()
            .zip(&clean.profile_trace.heights_mm)
            .zip(&bad.profile_trace.places_mm)
            .map(|((bad, clean), place)| bad - clean - expected_mm / roll_mm * place)
            .filter(|rest| rest.is_finite());
        let [low, high] = bend_mm.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(v), h.max(v)]);
        println!("  bend {:.6} mm", high - low);
        assert!(high - low < 0.03 * expected_mm.abs());
        // The roll's ends: on a round gear the tip circle's own.
        let gear = &right.scene.gear;
        let [alpha_t, r_mm] = [gear.transverse_pressure_angle_rad(), 12.0 * gear.transverse_module_mm()];
        let tip_mm = ((r_mm + gear.module_mm).powi(2) - (r_mm * alpha_t.cos()).powi(2)).sqrt() - r_mm * alpha_t.sin();
        assert!((bad.profile_trace.places_mm.last().expect("a tip") - tip_mm).abs() < 1e-6);
        let helix_mm = bad.lead.expect("evaluated").slope_mm - clean.lead.expect("evaluated").slope_mm;
        assert!(helix_mm.abs() < 0.02 * expected_mm.abs(), "{helix_mm} mm along the tooth");
    }
}

/// A work table that runs ahead by k per mm of the slide winds the teeth by k r_b per mm in the transverse section, out
/// of the material on one side and into it on the other.
#[test]
fn a_wrong_differential_is_a_helix_slope() {
    let job = job(&[]);
    let linkage = &job.finishing().linkage;
    let ahead_rad_per_mm = 2e-5;
    // The gear frame is the machine's turned over: its z runs against the slide.
    let z_mm = |hob_rad: f64| -linkage.axes::<1>(linkage.time_at_hob_angle(hob_rad)).slide_mm.value();
    let error = |hob_rad: f64| Rigid3 {
        rotation: DMat3::from_rotation_z(ahead_rad_per_mm * z_mm(hob_rad)),
        translation_mm: DVec3::ZERO,
    };
    let (clean, bad) = (HobCutter::new(&job).expect("passes"), with_work_error(&job, error));
    let gear = &job.scene.gear;
    let base_mm = 12.0 * gear.transverse_module_mm() * gear.transverse_pressure_angle_rad().cos();
    for side in [Side::Left, Side::Right] {
        let [clean, bad] = [&clean, &bad].map(|cutter| report(cutter, side));
        let helix = bad.lead.expect("evaluated");
        let slope_mm = helix.slope_mm - clean.lead.expect("evaluated").slope_mm;
        let face_mm = helix.between_mm[1] - helix.between_mm[0];
        // Work that runs ahead shows the tool its teeth too late: they are cut turned back, away from the space behind
        // a left flank's tooth.
        let expected_mm = -side.sign() * ahead_rad_per_mm * face_mm * base_mm * cos_base_helix(&job);
        println!("{side:?}: f_H_beta {slope_mm:.6} mm for {expected_mm:.6}, over {face_mm:.3} mm");
        assert!(expected_mm.abs() > 0.003 && (slope_mm / expected_mm - 1.0).abs() < 0.01);
    }
}

mod slow {
    use super::*;

    /// Work clamped off its axis by e: cumulative pitch follows n . e / cos(alpha_t) from tooth to tooth, and the
    /// runout is 2 e.
    #[test]
    fn work_off_its_axis_is_a_wave_of_pitch_and_runout() {
        let job = job(&["gear.teeth=12", "gear.face_width_mm=1"]);
        let off_mm = 0.05;
        let error = |_: f64| Rigid3 { rotation: DMat3::IDENTITY, translation_mm: DVec3::new(off_mm, 0.0, 0.0) };
        let cutter = with_work_error(&job, error);
        let gear = &job.scene.gear;
        let crossings = |side: Side| -> Vec<_> {
            let cut =
                |tooth| offset_curves::measure(&cutter, &Cpu::default(), &[(tooth, side)]).expect("cut").remove(0);
            let teeth = (1..=gear.teeth).into_par_iter();
            teeth.map(|tooth| offset_curves::pitch_crossing(&cut(tooth), &cutter)).collect()
        };
        let [left, right] = [Side::Left, Side::Right].map(crossings);
        let alpha_t = gear.transverse_pressure_angle_rad();
        let perimeter_mm = job.curve.perimeter_mm();
        for (side, crossings) in [(Side::Left, &left), (Side::Right, &right)] {
            let found = deviation::pitch(crossings, perimeter_mm, gear.teeth).expect("all teeth");
            // The gear is cut about a point -e from the axis that it is measured about.
            let arc_mm = |tooth: usize| {
                let phi = crossings[tooth].expect("crosses").arc_mm / perimeter_mm * TAU;
                let (out, along) = (DVec2::from_angle(phi), DVec2::from_angle(phi).perp());
                let normal = side.sign() * alpha_t.cos() * along + alpha_t.sin() * out;
                side.sign() * DVec2::new(-off_mm, 0.0).dot(normal) / alpha_t.cos()
            };
            let worst_mm = (0..found.cumulative_mm.len())
                .map(|tooth| (found.cumulative_mm[tooth] - (arc_mm(tooth) - arc_mm(0))).abs())
                .fold(0.0, f64::max);
            println!("{side:?}: F_p {:.6} mm, {worst_mm:.6} mm off the wave", found.total_mm());
            assert!(worst_mm < 0.02 * off_mm);
            assert!((found.total_mm() / (2.0 * off_mm / alpha_t.cos()) - 1.0).abs() < 0.02);
        }
        let runout = deviation::runout(&job.blank, &left, &right, alpha_t).expect("all spaces");
        println!("F_r {:.6} mm", runout.total_mm());
        assert!((runout.total_mm() / (2.0 * off_mm) - 1.0).abs() < 0.02);
    }
}
