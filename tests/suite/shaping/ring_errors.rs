//! Errors of machine and clamping on a ring, against their closed forms, left and right told apart.
//!
//! A ring's teeth look inwards: the normal out of the material has the part -sin(alpha) outwards, and on left flanks,
//! the ones at the larger arc, cos(alpha) counter-clockwise. A shift of the cutter, a outwards and t counter-clockwise,
//! therefore leaves h = -a sin(alpha) + s t cos(alpha) at the pitch point, s = 1 on left flanks and -1 on right ones: a
//! cutter that stands too far out cuts too deep. The cutter's edge stands on its far side, where what turns
//! counter-clockwise about the cutter moves counter-clockwise about the gear. Its spindle turns with the work's, so
//! that its angle against the line of centres falls by R / r_c of the work's; tooth 0 points away from the gear's axis
//! when the work begins.

use super::machine_errors::{ALPHA_RAD, ARCSEC_RAD, Place, changes};
use crate::fixtures::closed_form::{agree, differences_um};
use gearcut::process::shaping::ShapingJob;
use glam::DVec2;
use std::f64::consts::TAU;
use std::path::Path;

/// Pitch radii of the ring, 60 teeth of module 2, and of its cutter of 25 teeth.
const PITCH_MM: f64 = 60.0;
const CUTTER_MM: f64 = 25.0;
const TEETH: f64 = 60.0;
const CUTTER_TEETH: f64 = 25.0;
/// Double strokes of roughing and of finishing in a turn, and how long one takes, s.
const ROUGHING: f64 = 900.0;
const SECONDS_PER_STROKE: f64 = 60.0 / 300.0;
const WORK_RAD_PER_S: f64 = TAU / 3600.0 / SECONDS_PER_STROKE;

fn job(settings: &[&str]) -> ShapingJob {
    let fine = [
        "machine.double_strokes_per_minute=300",
        "gear.face_width_mm=20",
        "operation.rough.strokes_per_revolution=900",
        "operation.finish.strokes_per_revolution=3600",
        "operation.rough.feed_during_stroke=false",
        "operation.finish.feed_during_stroke=false",
    ];
    let settings: Vec<String> = fine.iter().chain(settings).map(|&setting| setting.to_owned()).collect();
    let path = Path::new("scenes/shaping/internal_circle.toml");
    let loaded = gearcut::process::load(path, &settings).expect("a scene");
    ShapingJob::new(loaded.scene).expect("a gear")
}

/// Height after a shift at the pitch point: outwards and counter-clockwise, mm; `side` +1 left, -1 right.
fn shifted(side: f64, out_mm: f64, around_mm: f64) -> f64 {
    -out_mm * ALPHA_RAD.sin() + side * around_mm * ALPHA_RAD.cos()
}

/// How the other flank's form stands to a flank's own.
#[derive(Clone, Copy, PartialEq)]
enum Sides {
    /// It is another one: the error is one across the line of centres.
    ToldApart,
    /// It is the same: the error is one along the line of centres.
    Alike,
}

/// Compares with a form of the place's side, and sees that neither the other side's form nor that of the other sign
/// would pass.
fn holds(name: &str, sides: Sides, found: &[(Place, f64)], least_um: f64, form: &dyn Fn(&Place, f64) -> f64) {
    agree(name, found, [least_um, 0.02], |place| form(place, place.side));
    let wrong_um = |side: f64, sign: f64| {
        differences_um("planted", found, |place| sign * form(place, side * place.side))[1] > 0.2 * least_um
    };
    assert!(wrong_um(1.0, -1.0), "{name}: the other sign is not seen");
    assert_eq!(wrong_um(-1.0, 1.0), sides == Sides::ToldApart, "{name}: the other flank's form");
}

#[test]
fn errors_of_a_ring_are_their_closed_forms() {
    let sound = job(&[]);
    let teeth = [4, 23, 47];
    let case = |name: &str, sides: Sides, settings: &[&str], least_um: f64, form: &dyn Fn(&Place, f64) -> f64| {
        holds(name, sides, &changes(&sound, &job(settings), &teeth), least_um, form);
    };
    let distance_mm = PITCH_MM - CUTTER_MM;
    let cutter_rad = |place: &Place| PITCH_MM / CUTTER_MM * place.phi_rad;
    case(
        "eccentricity of the work",
        Sides::ToldApart,
        &["mounting.eccentricity_um=10", "mounting.eccentricity_angle_deg=200"],
        5.0,
        &|place, side| {
            let out = DVec2::from_angle(place.phi_rad);
            let off = -10e-3 * DVec2::from_angle(200_f64.to_radians());
            shifted(side, off.dot(out), off.dot(out.perp()))
        },
    );
    case(
        "waves of the work spindle",
        Sides::ToldApart,
        &[
            "machine.errors.work.periodic_orders=[3.0]",
            "machine.errors.work.periodic_amplitudes_arcsec=[40.0]",
            "machine.errors.work.periodic_phases_deg=[25.0]",
        ],
        3.0,
        &|place, side| {
            let wave_rad = 40.0 * ARCSEC_RAD * (3.0 * place.phi_rad + 25_f64.to_radians()).sin();
            shifted(side, 0.0, PITCH_MM * wave_rad)
        },
    );
    case(
        "waves of the cutter spindle",
        Sides::ToldApart,
        &["machine.errors.cutter.periodic_orders=[1.0]", "machine.errors.cutter.periodic_amplitudes_arcsec=[60.0]"],
        3.0,
        &|place, side| shifted(side, 0.0, CUTTER_MM * 60.0 * ARCSEC_RAD * (-cutter_rad(place)).sin()),
    );
    let scale = ["machine.errors.center_distance.scale_um_per_m=300"];
    case("scale of the centre distance", Sides::Alike, &scale, 2.0, &|_, side| {
        shifted(side, 300e-6 * distance_mm, 0.0)
    });
    let drift = ["machine.errors.center_distance.drift_um_per_h=60"];
    case("drift of the centre distance", Sides::Alike, &drift, 1.0, &|place, side| {
        let strokes = ROUGHING + place.stroke;
        shifted(side, 60e-3 / 3600.0 * SECONDS_PER_STROKE * strokes, 0.0)
    });
    // What turns the whole ring is taken off: it is known, and nothing of it is on the flanks. Equal drives only delay
    // the motion: what the work's does the cutter's takes back.
    let lag_rad = 0.75 * WORK_RAD_PER_S / 30.0;
    let drives = [("work", -lag_rad), ("cutter", lag_rad)].map(|(axis, turn_rad)| {
        let keys = ["velocity_gain_per_s=30", "feed_forward=0.25"];
        (keys.map(|key| format!("machine.errors.{axis}.{key}")).to_vec(), turn_rad)
    });
    let backlash = vec!["machine.errors.work.backlash_arcsec=60".to_owned()];
    for (settings, turn_rad) in drives.into_iter().chain([(backlash, -30.0 * ARCSEC_RAD)]) {
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let faulty = job(&settings);
        let found = faulty.turn_rad;
        assert!((found - turn_rad).abs() < 1e-6 * turn_rad.abs(), "{settings:?}: {found} rad, {turn_rad} expected");
        agree(&settings.join(" "), &changes(&sound, &faulty, &teeth), [0.0, 0.02], |_| 0.0);
    }
}

/// What differs along the tooth.
#[test]
fn guide_and_wobble_of_a_ring_are_their_closed_forms() {
    let teeth = [4, 31];
    let lean = |um_per_100mm: f64, place: &Place| um_per_100mm * 1e-5 * place.z_mm;
    for feed_during_stroke in [false, true] {
        let feed = format!("operation.finish.feed_during_stroke={feed_during_stroke}");
        let sound = job(&[&feed]);
        let case = |name: &str, sides: Sides, settings: &[&str], form: &dyn Fn(&Place, f64) -> f64| {
            let settings: Vec<&str> = settings.iter().copied().chain([feed.as_str()]).collect();
            holds(name, sides, &changes(&sound, &job(&settings), &teeth), 1.0, form);
        };
        let radial = ["machine.errors.guide.radial_um_per_100mm=80"];
        case("ram out of parallel, radially", Sides::Alike, &radial, &|place, side| {
            shifted(side, lean(80.0, place), 0.0)
        });
        let tangential = ["machine.errors.guide.tangential_um_per_100mm=80"];
        case("ram out of parallel, sideways", Sides::ToldApart, &tangential, &|place, side| {
            shifted(side, 0.0, lean(80.0, place))
        });
        let wobble = ["mounting.wobble_um_per_100mm=60", "mounting.wobble_angle_deg=50"];
        case("wobble of the work", Sides::ToldApart, &wobble, &|place, side| {
            let out = DVec2::from_angle(place.phi_rad);
            let off = -lean(60.0, place) * DVec2::from_angle(50_f64.to_radians());
            shifted(side, off.dot(out), off.dot(out.perp()))
        });
        let offset = ["mounting.axial_offset_um=5000", radial[0]];
        case("offset along the axis, on a guide out of parallel", Sides::Alike, &offset, &|place, side| {
            shifted(side, 80e-5 * (place.z_mm + 5.0), 0.0)
        });
    }
}

#[test]
fn a_cutter_in_a_ring_that_does_not_run_true_leaves_its_closed_forms() {
    let sound = job(&[]);
    let teeth = [4, 23, 47];
    // The cutter has turned against the gear by less than the line of centres: R / r_c backwards against that.
    let runout = ["tool.shaper_cutter.runout_um=10", "tool.shaper_cutter.runout_angle_deg=40"];
    holds("runout", Sides::ToldApart, &changes(&sound, &job(&runout), &teeth), 5.0, &|place, side| {
        let out = DVec2::from_angle(place.phi_rad);
        let off = 10e-3 * DVec2::from_angle(place.phi_rad * (1.0 - PITCH_MM / CUTTER_MM) + 40_f64.to_radians());
        shifted(side, off.dot(out), off.dot(out.perp()))
    });
    // Teeth further on counter-clockwise come one by one, as the spaces of the ring do.
    let errors_um: Vec<f64> = (0..25).map(|tooth| 8.0 * f64::from(tooth * 7 % 25) / 24.0 - 4.0).collect();
    let list = format!("tool.shaper_cutter.pitch_errors_um={errors_um:?}");
    holds("pitch errors", Sides::ToldApart, &changes(&sound, &job(&[&list]), &teeth), 2.0, &|place, side| {
        let tooth = (place.phi_rad / TAU * TEETH).round().rem_euclid(CUTTER_TEETH);
        shifted(side, 0.0, 1e-3 * errors_um[tooth as usize])
    });
}
