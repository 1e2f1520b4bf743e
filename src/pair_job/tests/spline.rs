//! A splined shaft in its hub, DIN 5480 - 50 x 2 x 24 shaped with fine strokes, against closed forms: on the pitch
//! circle E = pi m / 2 + 2 x m tan(alpha), S less by the allowance, and the roots where the involutes of shaft and
//! cutter say; and a part off its axis by e moves flanks along the pitch circle by up to e / cos(alpha).

use super::*;
use crate::pair_job::options::PairOptions;
use crate::pair_job::quantities::spline::{CLEARANCE, FIT};
use crate::pair_job::spline::{SplineFit, fit, is_spline, report};
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;
use std::f64::consts::PI;

const MODULE_MM: f64 = 2.0;
const TEETH: u32 = 24;
const ANGLE_DEG: f64 = 30.0;
/// Teeth of the shaft's cutter.
const CUTTER_TEETH: u32 = 20;
/// Ridges of 200 strokes in a pitch, and points of flanks 10 um apart, um.
const STROKES_UM: f64 = 0.1;

fn part(name: &str, kind: &str, shift: f64, cutter_teeth: u32, more: &str, off_um: f64) -> LoadedScene {
    parsed(
        name,
        &format!(
            "[gear]\nkind = \"{kind}\"\nmodule_mm = {MODULE_MM}\nteeth = {TEETH}\npressure_angle_deg = {ANGLE_DEG}\n\
             addendum_coefficient = 0.45\nprofile_shift_coefficient = {shift}\nface_width_mm = 10.0\n{more}\
             [tool.shaper_cutter]\nteeth = {cutter_teeth}\naddendum_coefficient = 0.6\ndedendum_coefficient = 0.6\n\
             [mounting]\neccentricity_um = {off_um:?}\n\
             [[operation]]\nname = \"finish\"\nstrokes_per_revolution = {}\n[operation.infeed.none]\n\
             [fields.flank]\nprofile_spacing_um = 10.0\n",
            200 * TEETH
        ),
    )
}

/// Width of nominal spaces of the hub, mm.
fn width_mm() -> f64 {
    0.5 * PI * MODULE_MM - 0.1 * MODULE_MM * ANGLE_DEG.to_radians().tan()
}

/// Thickness of the shaft's teeth and radius of its roots, mm. The cutter's teeth fill the shaft's spaces: what teeth
/// are thicker than half a pitch is m (z + z0) (inv(alpha_w) - inv(alpha)), which has the distance of the axes.
fn cut_shaft_mm(allowance_mm: f64) -> [f64; 2] {
    let alpha = ANGLE_DEG.to_radians();
    let inv = |angle: f64| angle.tan() - angle;
    let (teeth, thickness_mm) = (f64::from(TEETH + CUTTER_TEETH), width_mm() + allowance_mm);
    let wanted = inv(alpha) + (thickness_mm - 0.5 * PI * MODULE_MM) / (MODULE_MM * teeth);
    let (mut low, mut high) = (0.1, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if inv(middle) < wanted { low = middle } else { high = middle }
    }
    let distance_mm = 0.5 * MODULE_MM * teeth * alpha.cos() / low.cos();
    [thickness_mm, distance_mm - MODULE_MM * (0.5 * f64::from(CUTTER_TEETH) + 0.6)]
}

fn shaft(allowance_mm: f64, off_um: f64) -> LoadedScene {
    part(
        "shaft",
        "external",
        -0.05,
        CUTTER_TEETH,
        &format!("tooth_thickness_allowance_mm = {allowance_mm:?}\n"),
        off_um,
    )
}

fn hub(off_um: f64) -> LoadedScene {
    part("hub", "internal", 0.05, 12, "", off_um)
}

fn fitted(shaft: &LoadedScene, hub: &LoadedScene, options: &PairOptions) -> Result<SplineFit> {
    unwatched(|watch| fit([&shaft.scene, &hub.scene], options, &Cpu::default(), watch))
}

#[test]
fn nominal_parts_have_the_clearance_of_their_allowances() {
    let (shaft, hub) = (shaft(-0.05, 0.0), hub(0.0));
    assert!(is_spline([&shaft.scene, &hub.scene]));
    let fit = fitted(&shaft, &hub, &PairOptions::default()).expect("a fit");
    let (expected_mm, [thickness_mm, root_mm]) = (width_mm(), cut_shaft_mm(-0.05));
    let clearance_um = UM_PER_MM * (expected_mm - thickness_mm);
    for tooth in &fit.teeth {
        let off_um = [tooth.width_mm - expected_mm, tooth.thickness_mm - thickness_mm].map(|mm| UM_PER_MM * mm);
        assert!(off_um.iter().all(|um| um.abs() < STROKES_UM), "{off_um:?} um");
        let gaps = tooth.gaps_mm.iter().all(|mm| (UM_PER_MM * mm - 0.5 * clearance_um).abs() < STROKES_UM);
        assert!(gaps, "{tooth:?} for {clearance_um} um");
        assert_eq!(tooth.space, if tooth.tooth == 1 { TEETH } else { tooth.tooth - 1 });
    }
    let found = report::findings("fit", [&shaft.scene, &hub.scene], &fit);
    let told_um = found.group(&FIT).and_then(|section| section.value(&CLEARANCE)).expect("a number");
    assert!((told_um - UM_PER_MM * fit.clearance_mm).abs() < 1e-9 && found.warnings.is_empty());
    let [effective_mm, space_mm] = fit.effective_mm;
    for clearance_mm in [fit.clearance_mm, fit.positions_mm[0], fit.positions_mm[1], space_mm - effective_mm] {
        assert!((UM_PER_MM * clearance_mm - clearance_um).abs() < 2.0 * STROKES_UM, "{fit:?}");
    }
    // d_a 49.6 and 46; the hub's d_f 50.2, where its cutter rolls a little nearer than 2 x m.
    let [of_hub_mm, of_shaft_mm] = fit.root_clearance_mm;
    assert!((of_hub_mm - 0.3).abs() < 0.003, "{of_hub_mm} mm");
    assert!((of_shaft_mm - (23.0 - root_mm)).abs() < 1e-4, "{of_shaft_mm} mm");
    assert!(fit.form_clearance_mm.iter().all(|&mm| mm > 0.0 && mm < 0.3), "{:?}", fit.form_clearance_mm);
}

/// A shaft off its axis fills E_v by 2 e / cos(alpha), less what 24 teeth miss of the direction of e; two parts that
/// are off lose twice as much in the worst position and hardly anything in the best.
#[test]
fn a_part_off_its_axis_takes_from_the_clearance() {
    let (allowance_mm, off_um) = (-0.2, 20.0);
    let clearance_um = UM_PER_MM * (width_mm() - cut_shaft_mm(allowance_mm)[0]);
    let taken_um = 2.0 * off_um / ANGLE_DEG.to_radians().cos();
    let missed = 1.0 - (PI / f64::from(TEETH)).cos();
    let shaft = shaft(allowance_mm, off_um);
    let fit = fitted(&shaft, &hub(0.0), &PairOptions::default()).expect("a fit");
    let [thickness_mm, space_mm] = fit.effective_mm;
    let left_um = clearance_um - UM_PER_MM * (space_mm - thickness_mm);
    assert!(left_um < taken_um + STROKES_UM && left_um > (1.0 - missed) * taken_um - STROKES_UM, "{left_um} um");
    // The hub is a perfect one: contact of all teeth finds what the involutes round the shaft say.
    assert!((UM_PER_MM * (fit.clearance_mm - (space_mm - thickness_mm))).abs() < 2.0 * STROKES_UM, "{fit:?}");
    let both = fitted(&shaft, &hub(off_um), &PairOptions::default()).expect("a fit");
    let [worst_um, best_um] = both.positions_mm.map(|mm| clearance_um - UM_PER_MM * mm);
    assert!(worst_um < 2.0 * taken_um + 0.5 && worst_um > 2.0 * (1.0 - missed) * taken_um - 0.5, "{worst_um} um");
    // A tooth of the shaft stands half a pitch from where its scene has it: e and e are 7.5 deg apart at least.
    let apart_um = 2.0 * (0.5 * PI / f64::from(TEETH)).sin() * taken_um;
    assert!((best_um - apart_um).abs() < 0.5, "{best_um} um for {apart_um} um");
    let turned = PairOptions { phase_teeth: 12, ..PairOptions::default() };
    let turned = fitted(&shaft, &hub(off_um), &turned).expect("a fit");
    assert!((UM_PER_MM * (both.clearance_mm - turned.clearance_mm)).abs() > taken_um, "another position");
    assert_eq!(both.positions_mm, turned.positions_mm);
}

/// A guide that leans by f over the face of the hub takes f: sections are looked at without being asked for.
#[test]
fn a_leaning_guide_takes_from_the_clearance() {
    let leans = "[machine.errors.guide]\ntangential_um_per_100mm = 100.0\n";
    let hub = part("hub", "internal", 0.05, 12, leans, 0.0);
    let fit = fitted(&shaft(-0.05, 0.0), &hub, &PairOptions::default()).expect("a fit");
    // 100 um in 100 mm over a face of 10 mm.
    let expected_um = UM_PER_MM * (width_mm() - cut_shaft_mm(-0.05)[0]) - 10.0;
    let off_um = UM_PER_MM * fit.clearance_mm - expected_um;
    assert!(off_um.abs() < 4.0 * STROKES_UM, "{off_um} um off {expected_um} um");
}

#[test]
fn options_that_mean_nothing_to_a_spline_are_refused() {
    let (shaft, hub) = (shaft(-0.05, 0.0), hub(0.0));
    let off_axis = PairOptions { center_distance_error_um: 10.0, ..PairOptions::default() };
    let told = fitted(&shaft, &hub, &off_axis).expect_err("one axis").to_string();
    assert!(told.contains("on the axis of its hub") && told.contains("mounting.eccentricity_um"), "{told}");
}
