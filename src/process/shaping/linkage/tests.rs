//! Checks of the linkages against finite differences and geometry; what the checks of the other parts share.

mod motion;
#[path = "../../../../crates/core/src/gear/pitch_curve/examples.rs"]
mod pitch_curves;
mod strokes;

use std::f64::consts::TAU;
use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::machine_errors::{Compliance, MachineErrors};
use crate::process::shaping::scene::model::{
    AxisLimits, Feed, Infeed, Linkage, Machine, NormalReading, Operation, Retraction, StrokeSpacing,
    TraditionalDirection,
};
use gearcut_core::gear::{GearKind, PitchCurve, PitchCurveShape};
use gearcut_core::math::Jet;
use pitch_curves::{any_curve, examples};

const NORMAL: Linkage = Linkage::ShapingNormal { reading: NormalReading::Corrected };
const KINDS: [Linkage; 4] = [
    NORMAL,
    Linkage::ShapingNormal { reading: NormalReading::AsPrinted },
    Linkage::ShapingTraditional { direction: TraditionalDirection::CenterLine },
    Linkage::ShapingTraditional { direction: TraditionalDirection::PolarRadius },
];

fn paper_curve() -> Arc<PitchCurve> {
    let shape = PitchCurveShape::Ellipse { order: 3, eccentricity: 0.1348, semi_major_axis_mm: Some(61.11) };
    Arc::new(PitchCurve::new(&shape, 3.0, 42).unwrap())
}

fn paper_linkage(kind: Linkage) -> ShapingLinkage {
    ShapingLinkage::new(GearKind::External, kind, paper_curve(), 30.0, 2.0).unwrap()
}

fn machine() -> Machine {
    Machine {
        double_strokes_per_minute: 600.0,
        approach_mm: 5.0,
        overrun_mm: 5.0,
        back_off_mm: 0.5,
        retraction: Retraction::CenterLine,
        guide_lead_mm: None,
        guide_hand: None,
        errors: MachineErrors::default(),
        compliance: Compliance::default(),
        vibration: None,
        limits: AxisLimits {
            work_speed_rad_per_s: Some(0.1),
            cutter_speed_rad_per_s: Some(0.2),
            center_distance_speed_mm_per_s: Some(2.0),
            ..AxisLimits::default()
        },
    }
}

fn operation(offset_mm: f64, strokes: u32) -> Operation {
    Operation {
        name: "rough".to_owned(),
        offset_mm,
        stock_scatter: None,
        linkage: NORMAL,
        feed: Feed::StrokesPerRevolution(strokes),
        spacing: StrokeSpacing::WorkAngle,
        window_rad: None,
        revolutions: 1,
        overlap_rad: 0.0,
        infeed: Infeed::None,
        feed_during_stroke: false,
        program: None,
    }
}

fn schedule(operation: &Operation) -> StrokeSchedule {
    StrokeSchedule::new(operation, &paper_linkage(operation.linkage), &machine()).unwrap()
}

#[test]
fn derivatives_match_differences_for_every_linkage() {
    let h = 1e-4;
    for curve in examples().into_iter().filter(|curve| curve.breaks_rad().is_empty()).map(Arc::new) {
        for kind in KINDS {
            let linkage = ShapingLinkage::new(GearKind::External, kind, Arc::clone(&curve), 15.0, 1.0).unwrap();
            for i in 0..50 {
                let phi = f64::from(i) * 0.1731 - 1.0;
                let axes = |phi| linkage.axes(phi, 0.7);
                let (before, here, after) = (axes(phi - h), axes(phi), axes(phi + h));
                for axis in [|a: &Axes<3>| a.psi_c_rad, |a: &Axes<3>| a.psi_b_rad, |a: &Axes<3>| a.center_distance_mm] {
                    for k in 0..2 {
                        let difference = (axis(&after).derivative(k) - axis(&before).derivative(k)) / (2.0 * h);
                        let error = difference - axis(&here).derivative(k + 1);
                        assert!(error.abs() < 2e-5 * (1.0 + difference.abs()), "{kind:?} at {phi}: {error}");
                    }
                }
                let (before, after) = (linkage.pose(phi - h, 0.7), linkage.pose(phi + h, 0.7));
                let motion = linkage.pose_motion(phi, 0.7);
                let rate = (after.center_mm - before.center_mm) / (2.0 * h);
                assert!((rate - motion.center_rate_mm_per_rad).length() < 1e-5);
                assert!(((after.angle_rad - before.angle_rad) / (2.0 * h) - motion.angle_rate).abs() < 1e-5);
            }
        }
    }
}

#[test]
fn every_linkage_moves_the_cutter_as_its_head_says() {
    let r_c = 30.0;
    for i in 0..40 {
        let phi = f64::from(i) * 0.3 - 2.0;
        let frame = paper_curve().frame(phi);
        let finish = paper_linkage(NORMAL).pose(phi, 0.0);
        assert!((finish.center_mm - (frame.point_mm + frame.normal * r_c)).length() < 1e-12);
        // The pitch point of the cutter, at arc S from tooth 0, lies on the pitch curve.
        let to_pitch_point = finish.angle_rad - paper_curve().arc_mm(phi) / r_c;
        let rolled = finish.center_mm + glam::DVec2::from_angle(to_pitch_point) * r_c;
        assert!((rolled - frame.point_mm).length() < 1e-11);
        let moves = [
            (KINDS[0], frame.normal, true),
            (KINDS[1], frame.normal, false),
            (KINDS[2], finish.center_mm.normalize(), true),
            (KINDS[3], frame.point_mm.normalize(), true),
        ];
        for (kind, direction, keeps_orientation) in moves {
            let pose = paper_linkage(kind).pose(phi, 2.0);
            assert!((pose.center_mm - finish.center_mm - direction * 2.0).length() < 1e-12, "{kind:?}");
            assert_eq!((pose.angle_rad - finish.angle_rad).abs() < 1e-12, keeps_orientation, "{kind:?}");
        }
        // Rough pass along the normal: the instantaneous centre stays on the normal.
        let center = paper_linkage(NORMAL).pose_motion(phi, 2.0).instantaneous_center_mm();
        let expected = frame.point_mm + frame.normal * (2.0 / (1.0 + r_c * frame.curvature_per_mm));
        assert!((center - expected).length() < 1e-10);
    }
}

#[test]
fn a_cutter_too_large_for_the_hollow_is_refused() {
    let shape = PitchCurveShape::Pascal { order: 2, eccentricity: 0.5, mean_radius_mm: None };
    let curve = Arc::new(PitchCurve::new(&shape, 3.0, 42).unwrap());
    let hollow_mm = -1.0 / curve.facts().smallest_curvature.curvature_per_mm;
    assert!(ShapingLinkage::new(GearKind::External, NORMAL, Arc::clone(&curve), hollow_mm - 0.1, 0.0).is_ok());
    let refusal =
        ShapingLinkage::new(GearKind::External, NORMAL, Arc::clone(&curve), hollow_mm + 0.1, 0.0).unwrap_err();
    assert_eq!(refusal.key, "tool.shaper_cutter.teeth");
    assert!(ShapingLinkage::new(GearKind::External, NORMAL, Arc::clone(&curve), hollow_mm - 0.1, 0.2).is_err());
    assert!(ShapingLinkage::new(GearKind::External, NORMAL, curve, f64::NAN, 0.0).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn work_angle_inverts(
        curve in any_curve(), kind in 0usize..4, share in 0.05..1.0f64, offset in -0.2..0.5f64,
        phis in prop::collection::vec(-20.0..20.0f64, 20),
    ) {
        let (r_c, curve) = (share * curve.size_mm(), Arc::new(curve));
        let shared = Arc::clone(&curve);
        if let Ok(linkage) = ShapingLinkage::new(GearKind::External, KINDS[kind], shared, r_c, offset * r_c) {
            for (phi, offset_mm) in phis.into_iter().zip([0.0, offset * r_c].into_iter().cycle()) {
                let axes = linkage.axes(phi, offset_mm);
                let psi_c = axes.psi_c_rad.value();
                let back = linkage.phi_at_work_angle(psi_c, offset_mm);
                // One bit of psi_c is worth more of phi where the work hardly turns.
                let tolerance = 1e-12 + 1e-14 / axes.psi_c_rad.derivative(1);
                prop_assert!((back - phi).abs() < tolerance, "{} away at {phi}", back - phi);
                let turned = linkage.phi_at_work_angle(psi_c + TAU, offset_mm);
                prop_assert!((turned - phi - TAU).abs() < 2.0 * tolerance);
            }
        }
    }
}

#[test]
fn series_of_any_parameter_agree_with_series_of_phi() {
    let linkage = paper_linkage(NORMAL);
    let by_phi = linkage.axes(0.4, 1.0).psi_b_rad;
    let by_time = linkage.axes_along(Jet::from_derivatives([0.4, 2.0, -3.0]), Jet::constant(1.0)).psi_b_rad;
    assert!((by_time.derivative(1) - 2.0 * by_phi.derivative(1)).abs() < 1e-12);
    let expected = 4.0 * by_phi.derivative(2) - 3.0 * by_phi.derivative(1);
    assert!((by_time.derivative(2) - expected).abs() < 1e-12);
}
