//! A coordinate measurement of a round gear, against closed forms.

use gearcut::cut::cpu::Cpu;
use gearcut::process;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::gear::measure::cmm::{CmmReport, measure};
use gearcut::process::shaping::scene::model::Shaping;
use std::path::Path;

/// 24 teeth of module 3 by a cutter of 20; roughing stays 0.6 mm back.
fn measured(strokes: u32, settings: &[&str]) -> CmmReport {
    let operation = |name: &str, offset_mm: f64| {
        format!(
            "[[operation]]\nname = \"{name}\"\noffset_mm = {offset_mm:.1}\nstrokes_per_revolution = {strokes}\n\
             [operation.infeed.none]\n"
        )
    };
    let text = format!(
        "[gear]\nmodule_mm = 3\nteeth = 24\nface_width_mm = 4\n[tool.shaper_cutter]\nteeth = 20\n[measure.cmm]\n{}{}",
        operation("rough", 0.6),
        operation("finish", 0.0)
    );
    let settings: Vec<String> = settings.iter().map(|of| format!("measure.cmm.{of}")).collect();
    let scene = process::parse(&text, "round.toml", Path::new("."), &settings).expect("a scene").scene;
    let spec = Shaping::of(&scene).and_then(|own| own.cmm).expect("a measurement");
    let job = ShapingJob::new(scene).expect("a gear");
    measure(&job, &Cpu::default(), &spec, |_, _| false).expect("measured").remove(0)
}

/// The rough flank is the involute of the same base circle, turned by (z + z0) / z (inv alpha' - inv alpha), where
/// cos(alpha') = a cos(alpha) / (a + 0.6): the cutter rolls with the same ratio further away. A ball on an involute
/// touches where its normal says; feed marks of 1 nm are left.
#[test]
fn allowances_of_a_round_gear_are_those_of_involutes() {
    let (z, z0, alpha) = (24.0, 20.0, 20_f64.to_radians());
    let centre_mm = 0.5 * 3.0 * (z + z0);
    let far = (centre_mm * alpha.cos() / (centre_mm + 0.6)).acos();
    let turned = (z + z0) / z * (far.tan() - far - (alpha.tan() - alpha));
    let expected_mm = 2.0 * 36.0 * (0.5 * turned).sin();
    for settings in [["points=20", "probe_diameter_mm=1.0"], ["points=60", "probe_diameter_mm=4.0"]] {
        let found = measured(20_000, &[&settings[..], &["draws=20"]].concat());
        let off = |mm: Option<f64>| (mm.expect("it crosses") - expected_mm).abs();
        let worst_mm = found.teeth.iter().map(|of| off(of.ab_mm()).max(off(of.cd_mm()))).fold(0.0, f64::max);
        println!("{settings:?}: {expected_mm:.6} mm, {:.3} nm off", 1e6 * worst_mm);
        assert!(worst_mm < 3e-6 && worst_mm > 1e-12, "{worst_mm} mm");
        assert!(found.percent(1).expect("drawn")[2] < 1e-2, "nothing is left to chance");
    }
}

/// A clamping that is off by sigma in x and in y moves a flank along its normal by sigma, and its crossing by sigma /
/// cos(alpha); a turn moves crossings by r times its angle. Points err by sigma / cos(alpha) on either surface, and a
/// cubic between two of four even points averages to 0.8 of that at least (sqrt(0.64), in the middle).
#[test]
fn deviations_are_those_of_a_calculation_by_hand() {
    let cos = 20_f64.to_radians().cos();
    let of = |setting: &str| 1e3 * measured(600, &[setting, "draws=60000"]).deviation_mm.expect("drawn");
    let offset_um = of("clamping_offset_um=5");
    assert!((offset_um * cos / 5.0 - 1.0).abs() < 0.01, "{offset_um}");
    let turn_um = of("clamping_turn_deg=0.01");
    assert!((turn_um / (0.01_f64.to_radians() * 36e3) - 1.0).abs() < 0.01, "{turn_um}");
    let points_um = of("point_deviation_um=2");
    let most_um = 2.0 * 2_f64.sqrt() / cos;
    assert!(points_um < 1.01 * most_um && points_um > 0.79 * most_um, "{points_um}");
}
