//! Large profile shifts: flanks of the target and of its sections against the closed form of the involute.

use gearcut::job::{CylindricalGear, GearJob};
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::terms::Side;
use glam::DVec2;
use std::f64::consts::PI;
use std::path::Path;

const SPUR: &str = "scenes/hobbing/circular_spur.toml";
const HELICAL: &str = "scenes/hobbing/circular_helical.toml";

fn job(scene: &str, settings: &[String]) -> HobbingJob {
    let scene = load(Path::new(scene), settings).unwrap_or_else(|problems| panic!("{problems}")).scene;
    HobbingJob::new(&scene).expect("a gear")
}

fn involute(angle_rad: f64) -> f64 {
    angle_rad.tan() - angle_rad
}

/// Half the angle of a tooth at a radius of an involute gear: s / d + inv(alpha_t) - inv(alpha_y), cos(alpha_y) = r_b /
/// r, with s = pi m_t / 2 + 2 x m_n tan(alpha_t) (ISO 21771).
fn half_angle_rad(job: &HobbingJob, radius_mm: f64) -> f64 {
    let gear = &job.scene.gear;
    let (m_t, alpha_t) = (gear.transverse_module_mm(), gear.transverse_pressure_angle_rad());
    let diameter_mm = m_t * f64::from(gear.teeth);
    let thickness_mm = 0.5 * PI * m_t + 2.0 * gear.profile_shift_coefficient * gear.module_mm * alpha_t.tan();
    let at_rad = (0.5 * diameter_mm * alpha_t.cos() / radius_mm).acos();
    thickness_mm / diameter_mm + involute(alpha_t) - involute(at_rad)
}

/// Flanks of the target and of its sections are involutes from their beginning up to the tip, whichever shift lifts or
/// lowers them.
#[test]
fn flanks_are_involutes_up_to_the_tip() {
    for (scene, shift) in [(SPUR, -0.5), (SPUR, 0.7), (SPUR, 0.9), (HELICAL, -0.5), (HELICAL, 0.9)] {
        let job = job(scene, &[format!("gear.profile_shift_coefficient={shift}"), "gear.face_width_mm=6".to_owned()]);
        let gear = HobCutter::new(&job).expect("passes");
        let round = gear.round_gear().expect("flanks").expect("it is round");
        let teeth = f64::from(job.scene.gear.teeth);
        let off_um = |point: DVec2| {
            let radius_mm = point.length();
            1e3 * radius_mm * ((point.to_angle() - PI / teeth).abs() - half_angle_rad(&job, radius_mm))
        };
        let [form_mm, tip_mm] = [round.form_diameter_mm, round.tip_diameter_mm].map(|d| 0.5 * d);
        let patch = gear.even_arcs_mm(1, Side::Left, 0.2).expect("a flank");
        let patch = gear.target_points(1, Side::Left, &patch, &[0.0]).expect("a flank");
        let of_patch: Vec<DVec2> = patch[0].iter().map(|ray| ray.origin_mm.truncate()).collect();
        let of_section = job.tooth_section(1, 0.0, 0.2).tooth_mm;
        for points in [of_patch, of_section] {
            // The tip land lies at the tip radius.
            let on_flank = points.iter().filter(|point| point.length() < tip_mm - 1e-6);
            let worst_um = on_flank.clone().map(|&point| off_um(point).abs()).fold(0.0, f64::max);
            let [low_mm, high_mm] =
                [f64::min, f64::max].map(|of| on_flank.clone().map(|point| point.length()).reduce(of).expect("points"));
            println!("{scene}, x {shift}: {worst_um:.1e} um from {low_mm:.3} to {high_mm:.3} mm");
            assert!(worst_um < 1e-4, "{scene}, x {shift}: {worst_um} um");
            assert!(low_mm < form_mm + 0.2 && high_mm > tip_mm - 0.25, "{low_mm} to {high_mm} mm");
        }
    }
}
