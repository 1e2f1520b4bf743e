//! Retraction of the return strokes against closed forms and an independent implementation.
//!
//! tests/data/shaping/internal_s1.json has epsilon, clearance and angles of the method for the pair of the paper on
//! internal gears, internal_retraction_overlap.json the area that the returning cutter has in common with the finished
//! gear, from polygons of the whole cutter and the whole gear.

use gearcut::gear::{Driver, GearKind, PitchCurve, PitchCurveShape};
use gearcut::process::shaping::ShaperCutter;
use gearcut::process::shaping::linkage::CutterPose;
use gearcut::process::shaping::linkage::retraction::{RetractingCutter, RetractionLaw};
use gearcut::process::shaping::returns::clearance::ReturnRoom;
use gearcut::process::shaping::scene::model::Tip;
use gearcut::process::shaping::scene::model as shaping;
use gearcut::frame::Rigid2;
use glam::DVec2;
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::fixtures::paper::{NORMAL, operation, paper_scene};

fn data(name: &str) -> Value {
    let path = format!("{}/tests/data/shaping/{name}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

/// The internal gear of 102 teeth that runs with a driver of the ratio c + 1 - b sin phi.
fn internal_curve(b: f64) -> PitchCurve {
    let driver = PitchCurveShape::SinusoidalRatio {
        order: 1,
        mean_ratio: (9.0 + b * b).sqrt() - 2.0,
        ratio_amplitude: -b,
        center_distance_mm: None,
    };
    let driver = Box::new(Driver { curve: driver, teeth: 34, start_rad: Some(0.0) });
    PitchCurve::new(&PitchCurveShape::Mate { driver, kind: GearKind::Internal }, 2.0, 102).expect("a closing pair")
}

/// The finishing pose written from geometry: the cutter's pitch circle rolls on the curve, tooth 0 from P(0).
fn rolling_pose(curve: &PitchCurve, kind: GearKind, r_c: f64, phi: f64) -> CutterPose {
    let frame = curve.frame(phi);
    let side = kind.tip_sign();
    let normal_rad = phi + frame.mu_rad - FRAC_PI_2;
    let to_curve_rad = if side > 0.0 { PI } else { 0.0 };
    CutterPose {
        center_mm: frame.point_mm + side * r_c * frame.normal,
        angle_rad: normal_rad + to_curve_rad + side * curve.arc_mm(phi) / r_c,
    }
}

#[test]
fn the_method_finds_the_places_of_the_independent_implementation() {
    let case = &data("internal_s1")["cases"][0];
    let within = |key: &str| number(&case["tolerance"][key]);
    let (curve, r_c) = (internal_curve(0.3), number(&case["r0"]));
    let retraction = RetractingCutter { curve: &curve, kind: GearKind::Internal, cutter_pitch_radius_mm: r_c };
    let rows = case["retraction"].as_array().expect("rows");
    for row in rows {
        let value = |key: &str| number(&row[key]);
        let pose = rolling_pose(&curve, GearKind::Internal, r_c, value("phi"));
        let law = RetractionLaw::Turned;
        let back = retraction.retracted(law, &pose, value("phi"), value("delta_a")).expect("a foot");
        assert!((back.foot_rad - value("epsilon")).abs() < within("epsilon"), "{row}: {back:?}");
        assert!((back.clearance_mm - value("clearance")).abs() < within("clearance"), "{row}: {back:?}");
        assert!((back.pose.center_mm.length() - value("a")).abs() < within("axes"), "{row}: {back:?}");
        // Work angle Phi, and the cutter's angle psi = Phi - orientation in the gear frame.
        let work_rad = back.pose.center_mm.to_angle();
        let off = |angle: f64| (angle + PI).rem_euclid(TAU) - PI;
        assert!(off(work_rad - value("Phi")).abs() < within("axes"), "{row}: {back:?}");
        assert!((value("Phi") - back.pose.angle_rad - value("psi")).abs() < within("axes"), "{row}: {back:?}");
    }
    assert!(rows.len() >= 12);
}

#[test]
fn on_a_circle_the_method_is_the_line_of_centres() {
    let curve = PitchCurve::new(&PitchCurveShape::Circle, 2.0, 60).expect("a circle");
    for kind in [GearKind::External, GearKind::Internal] {
        let retraction = RetractingCutter { curve: &curve, kind, cutter_pitch_radius_mm: 17.0 };
        for phi in [-0.4, 0.0, 2.0, 9.0] {
            let pose = rolling_pose(&curve, kind, 17.0, phi);
            let straight = retraction.retracted(RetractionLaw::CenterLine, &pose, phi, 0.7).expect("a foot");
            let away = kind.tip_sign() * 0.7 * DVec2::from_angle(phi);
            assert!(straight.pose.center_mm.distance(pose.center_mm + away) < 1e-12);
            for law in [RetractionLaw::Turned, RetractionLaw::Normal] {
                let back = retraction.retracted(law, &pose, phi, 0.7).expect("a foot");
                assert!(back.pose.center_mm.distance(straight.pose.center_mm) < 1e-12, "{law:?}");
                assert!((back.pose.angle_rad - pose.angle_rad).abs() < 1e-12, "{law:?}");
                assert!((back.clearance_mm - 0.7).abs() < 1e-12 && (back.foot_rad - phi).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn small_retractions_move_and_turn_at_the_rates_of_rolling() {
    // With Delta between line of centres and normal the foot moves by delta_a sin(Delta) / (1 + s d kappa) along the
    // curve, d the cutter's distance from it, and the cutter turns by the curve's turn and by rolling.
    let h = 1e-5;
    for (curve, kind, r_c) in [
        (PitchCurve::new(&paper_scene(Vec::new()).gear.pitch_curve, 3.0, 42).expect("S0"), GearKind::External, 30.0),
        (internal_curve(0.6), GearKind::Internal, 17.0),
    ] {
        let side = kind.tip_sign();
        let retraction = RetractingCutter { curve: &curve, kind, cutter_pitch_radius_mm: r_c };
        for i in 0..60 {
            let phi = 0.1 * f64::from(i);
            let pose = rolling_pose(&curve, kind, r_c, phi);
            let at = |back_off: f64| {
                let back = retraction.retracted(RetractionLaw::Turned, &pose, phi, back_off).expect("a foot");
                (back.foot_rad, back.pose.angle_rad, back.clearance_mm)
            };
            let (ahead, behind) = (at(h), at(-h));
            let frame = curve.frame(phi);
            let out = side * pose.center_mm.normalize();
            let arc_rate = out.dot(frame.tangent) / (1.0 + side * r_c * frame.curvature_per_mm);
            let found = (ahead.0 - behind.0) / (2.0 * h);
            assert!((found - arc_rate / frame.arc_rate_mm_per_rad).abs() < 1e-8, "{kind:?} {phi}: {found}");
            let turn = arc_rate * (frame.curvature_per_mm + side / r_c);
            let found = (ahead.1 - behind.1) / (2.0 * h);
            assert!((found - turn).abs() < 1e-8, "{kind:?} {phi}: {found} {turn}");
            let found = (ahead.2 - behind.2) / (2.0 * h);
            assert!((found - side * out.dot(frame.normal)).abs() < 1e-8, "{kind:?} {phi}: {found}");
        }
    }
}

fn internal_cutter(teeth: u32) -> ShaperCutter {
    let scene = paper_scene(vec![operation("finish", NORMAL, 0.0, 480)]);
    let mut gear = scene.gear.clone();
    (gear.module_mm, gear.teeth) = (2.0, 102);
    let mut spec = shaping::Shaping::of(&scene).expect("shaping").tool.clone();
    (spec.teeth, spec.addendum_coefficient, spec.tip) = (teeth, 1.25, Tip::Sharp);
    ShaperCutter::new(&spec, &gear).expect("a cutter")
}

#[test]
fn overlaps_of_the_returning_cutter_agree() {
    let data = data("internal_retraction_overlap");
    for case in data["cases"].as_array().expect("cases") {
        let (b, z0, phi) = (number(&case["b"]), number(&case["z0"]), number(&case["phi"]));
        let curve = internal_curve(b);
        let cutter = internal_cutter(z0 as u32);
        let (kind, r_c) = (GearKind::Internal, cutter.pitch_radius_mm);
        let finish = |phi: f64| rolling_pose(&curve, kind, r_c, phi);
        let room = ReturnRoom::new(&cutter, 102, 2.0, &finish, &[]);
        let retraction = RetractingCutter { curve: &curve, kind, cutter_pitch_radius_mm: r_c };
        for row in case["rows"].as_array().expect("rows") {
            let row: Vec<f64> = row.as_array().expect("a row").iter().map(number).collect();
            let laws = [RetractionLaw::CenterLine, RetractionLaw::Normal, RetractionLaw::Turned];
            let found = laws.map(|law| {
                let at = |phase: usize| {
                    let place = (phi / TAU * room.places() as f64).round() as usize + 8 * phase;
                    let phi = room.phi_rad(place);
                    let back = retraction.retracted(law, &finish(phi), phi, row[0]).expect("a foot").pose;
                    let stock = |p: DVec2| {
                        let guess = p.to_angle();
                        curve.radius(guess).value() - p.length() < 2.5
                    };
                    room.at(place, &Rigid2::new(back.angle_rad, back.center_mm), stock).surface
                };
                let phases = (0..6).map(at);
                phases.max_by(|a, b| a.overlap_mm2.total_cmp(&b.overlap_mm2)).expect("phases")
            });
            println!("b {b} da {}: {:?} expected {:?}", row[0], found.map(|r| (r.overlap_mm2, r.smallest_mm)), &row[1..]);
        }
    }
}
