//! Checks of linkages, schedules, dynamics and relief against finite differences, geometry and each other.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use proptest::prelude::*;

use super::dynamics::{motion, peaks};
use super::relief::{ReliefFlank, ReliefVerdict, relief_ratio, smallest_relief};
use super::*;
use crate::gear::pitch_curve::tests::{any_curve, examples};
use crate::gear::{Jet, PitchCurve};
use crate::scene::model::{
    AxisLimits, Feed, Infeed, Linkage, Machine, NormalReading, Operation, PitchCurveShape, StrokeSpacing,
    TraditionalDirection,
};

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
    ShapingLinkage::new(kind, paper_curve(), 30.0, 2.0).unwrap()
}

fn machine() -> Machine {
    Machine {
        double_strokes_per_minute: 600.0,
        approach_mm: 5.0,
        overrun_mm: 5.0,
        back_off_mm: 0.5,
        work_eccentricity_mm: 0.0,
        work_eccentricity_angle_rad: 0.0,
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
        linkage: NORMAL,
        feed: Feed::StrokesPerRevolution(strokes),
        spacing: StrokeSpacing::WorkAngle,
        window_rad: None,
        revolutions: 1,
        overlap_rad: 0.0,
        infeed: Infeed::None,
        feed_during_stroke: false,
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
            let linkage = ShapingLinkage::new(kind, Arc::clone(&curve), 15.0, 1.0).unwrap();
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
    assert!(ShapingLinkage::new(NORMAL, Arc::clone(&curve), hollow_mm - 0.1, 0.0).is_ok());
    let refusal = ShapingLinkage::new(NORMAL, Arc::clone(&curve), hollow_mm + 0.1, 0.0).unwrap_err();
    assert_eq!(refusal.key, "tool.shaper_cutter.teeth");
    assert!(ShapingLinkage::new(NORMAL, Arc::clone(&curve), hollow_mm - 0.1, 0.2).is_err());
    assert!(ShapingLinkage::new(NORMAL, curve, f64::NAN, 0.0).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn work_angle_inverts(
        curve in any_curve(), kind in 0usize..4, share in 0.05..1.0f64, offset in -0.2..0.5f64,
        phis in prop::collection::vec(-20.0..20.0f64, 20),
    ) {
        let (r_c, curve) = (share * curve.size_mm(), Arc::new(curve));
        if let Ok(linkage) = ShapingLinkage::new(KINDS[kind], Arc::clone(&curve), r_c, offset * r_c) {
            for (phi, offset_mm) in phis.into_iter().zip([0.0, offset * r_c].into_iter().cycle()) {
                let axes = linkage.axes(phi, offset_mm);
                let psi_c = axes.psi_c_rad.value();
                let back = linkage.phi_at_work_angle(psi_c, offset_mm);
                // One bit of psi_c is worth more of phi where the work hardly turns.
                let slack = 1e-12 + 1e-14 / axes.psi_c_rad.derivative(1);
                prop_assert!((back - phi).abs() < slack, "{} away at {phi}", back - phi);
                let turned = linkage.phi_at_work_angle(psi_c + TAU, offset_mm);
                prop_assert!((turned - phi - TAU).abs() < 2.0 * slack);
            }
        }
    }
}

#[test]
fn counts_windows_and_seams() {
    let mut run = operation(2.0, 360);
    assert_eq!(schedule(&run).count(), 360);
    run.window_rad = Some([1f64.to_radians(), 119f64.to_radians()]);
    let strokes = schedule(&run);
    assert_eq!(strokes.count(), 119);
    for i in 0..119 {
        let expected = f64::from(i + 1) * TAU / 360.0;
        assert!((strokes.state(f64::from(i)).psi_c_rad - expected).abs() < 1e-12);
    }
    let [first, last] = strokes.seam_rad();
    assert!((first - 1f64.to_radians()).abs() < 1e-12 && (last - 119f64.to_radians()).abs() < 1e-12);
    run.revolutions = 2;
    assert_eq!(
        StrokeSchedule::new(&run, &paper_linkage(NORMAL), &machine()).unwrap_err().key,
        "operation.rough.window_deg"
    );
    run.window_rad = None;
    run.overlap_rad = 10.5f64.to_radians();
    assert_eq!(schedule(&run).count(), 2 * 360 + 11);
    run.feed = Feed::CircularMmPerStroke(0.5);
    let by_feed = schedule(&run);
    assert_eq!(by_feed.strokes_per_revolution(), 792);
    assert!(by_feed.circular_feed_mm_per_stroke() < 0.5);
    run.feed = Feed::CircularMmPerStroke(0.0);
    assert!(StrokeSchedule::new(&run, &paper_linkage(NORMAL), &machine()).is_err());
}

#[test]
fn spacings_advance_equally() {
    let mut run = operation(2.0, 500);
    run.spacing = StrokeSpacing::Arc;
    let strokes = schedule(&run);
    assert_eq!(strokes.count(), 500);
    let arc = |i: usize| paper_curve().arc_mm(strokes.phi_rad(i as f64));
    for i in 0..500 {
        assert!((arc(i + 1) - arc(i) - strokes.circular_feed_mm_per_stroke()).abs() < 1e-10);
    }
    run.spacing = StrokeSpacing::Time;
    let strokes = schedule(&run);
    assert_eq!(strokes.count(), 500);
    // At every stroke one axis uses the same share of its limit, and no axis uses more.
    let share = |stroke: f64| {
        let (m, limits) = (motion(&strokes, stroke), machine().limits);
        (m.work.velocity / limits.work_speed_rad_per_s.unwrap())
            .max(m.cutter.velocity / limits.cutter_speed_rad_per_s.unwrap())
            .max(m.center_distance.velocity.abs() / limits.center_distance_speed_mm_per_s.unwrap())
    };
    for i in 0..999 {
        assert!((share(f64::from(i) * 0.5) / share(0.0) - 1.0).abs() < 1e-9);
    }
    let mut unlimited = machine();
    unlimited.limits = AxisLimits::default();
    let refusal = StrokeSchedule::new(&run, &paper_linkage(NORMAL), &unlimited).unwrap_err();
    assert_eq!(refusal.key, "operation.rough.stroke_spacing");
    unlimited.limits.center_distance_speed_mm_per_s = Some(1.0);
    assert!(StrokeSchedule::new(&run, &paper_linkage(NORMAL), &unlimited).is_err());
}

#[test]
fn infeed_reaches_depth() {
    let mut run = operation(0.5, 360);
    run.revolutions = 2;
    run.infeed =
        Infeed::PlungeAndRoll { plunge_depth_mm: 1.0, strokes: 10, roll_depth_mm: 2.0, angle_rad: 90f64.to_radians() };
    let strokes = schedule(&run);
    assert_eq!((strokes.count(), strokes.plunge_count()), (730, 10));
    for (stroke, offset_mm) in [(0.0, 3.5), (5.0, 3.0), (10.0, 2.5), (55.0, 1.5), (100.0, 0.5), (700.0, 0.5)] {
        assert!((strokes.offset_mm(stroke) - offset_mm).abs() < 1e-12);
    }
    assert_eq!(strokes.phi_rad(3.0), strokes.phi_rad(10.0));
    assert!((strokes.state(11.0).psi_c_rad - TAU / 360.0).abs() < 1e-12);
    for corner in [10.0, 100.0] {
        let (before, after) = (strokes.state(corner - 1e-9), strokes.state(corner));
        assert!((before.pose.center_mm - after.pose.center_mm).length() < 1e-8);
    }
    run.infeed = Infeed::Spiral { depth_mm: 2.0, angle_rad: PI };
    assert_eq!(schedule(&run).state(90.0).offset_mm, 1.5);
}

#[test]
fn motions_match_differences_and_peaks_bound_them() {
    let mut run = operation(1.0, 360);
    run.revolutions = 2;
    for spacing in [StrokeSpacing::WorkAngle, StrokeSpacing::Arc, StrokeSpacing::Time] {
        for infeed in [Infeed::None, Infeed::Spiral { depth_mm: 1.0, angle_rad: 2.0 }] {
            (run.spacing, run.infeed) = (spacing, infeed);
            let strokes = schedule(&run);
            let peaks = peaks(&strokes, &machine().limits);
            let axes = |m: dynamics::MachineMotion| [m.work, m.cutter, m.center_distance];
            let bounds = [peaks.work, peaks.cutter, peaks.center_distance];
            let h = 1e-3;
            for i in 0..300 {
                let stroke = f64::from(i) * 2.4 + 0.31;
                let step_s = strokes.time_s(h);
                let (before, here, after) =
                    (motion(&strokes, stroke - h), motion(&strokes, stroke), motion(&strokes, stroke + h));
                assert!((axes(here)[0].position - strokes.state(stroke).psi_c_rad).abs() < 1e-11);
                for (axis, bound) in bounds.iter().enumerate() {
                    let (b, a, m) = (axes(before)[axis], axes(after)[axis], axes(here)[axis]);
                    let speed = (a.position - b.position) / (2.0 * step_s);
                    assert!((speed - m.velocity).abs() < 1e-6 * (1.0 + speed.abs()), "{spacing:?} {infeed:?} {axis}");
                    let change = (a.velocity - b.velocity) / (2.0 * step_s);
                    let kink = spacing == StrokeSpacing::Time && (change - m.acceleration).abs() > 1e-3;
                    assert!(
                        kink || (change - m.acceleration).abs() < 1e-3 * (1.0 + change.abs()),
                        "{spacing:?} {axis}"
                    );
                    assert!(m.velocity.abs() <= bound.speed.value * (1.0 + 1e-12));
                    assert!(m.acceleration.abs() <= bound.acceleration.value * (1.0 + 1e-9) + 1e-9);
                }
            }
            let limit = machine().limits.work_speed_rad_per_s.unwrap();
            let margin = peaks.work.speed.margin().unwrap();
            assert!((margin - (1.0 - peaks.work.speed.value / limit)).abs() < 1e-15);
            assert!(peaks.work.acceleration.margin().is_none());
        }
    }
}

#[test]
fn relief_of_the_paper_gear() {
    let alpha = 20f64.to_radians();
    let smallest = smallest_relief(&paper_linkage(NORMAL), 0.0, alpha);
    // Largest |beta| 14.95 deg: sin(20 - 14.95) / sin 20 deg
    let linkage = paper_linkage(NORMAL);
    let beta = |phi: f64| {
        let frame = linkage.curve().frame(phi);
        (frame.radius_mm * frame.mu_rad.cos()).atan2(frame.radius_mm * frame.mu_rad.sin() + 30.0)
    };
    let steepest = (0..20_000).map(|i| beta(f64::from(i) * TAU / 20_000.0).abs()).fold(0.0, f64::max);
    assert!((steepest.to_degrees() - 14.95).abs() < 0.005);
    assert!((smallest.ratio - (alpha - steepest).sin() / alpha.sin()).abs() < 1e-6);
    assert!((smallest.ratio - 0.26).abs() < 0.005, "{}", smallest.ratio);
    assert_eq!(smallest.verdict(), ReliefVerdict::Tight);
    assert!(smallest.warning(0.5).unwrap().contains("26 %"));
    for i in 0..30 {
        let phi = f64::from(i) * 0.21;
        let ratio = relief_ratio(&linkage, phi, 0.0, alpha);
        assert!((ratio.left - (alpha + beta(phi)).sin() / alpha.sin()).abs() < 1e-12);
        assert!((ratio.right - (alpha - beta(phi)).sin() / alpha.sin()).abs() < 1e-12);
    }
    // Where the radius falls with phi, drawing back along the line of centres moves the cutter towards larger ... the left flank loses.
    assert_eq!(beta(smallest.phi_rad) < 0.0, smallest.flank == ReliefFlank::Left);
    let shallow = smallest_relief(&paper_linkage(NORMAL), 0.0, 14f64.to_radians());
    assert_eq!(shallow.verdict(), ReliefVerdict::Rubs);
    assert!(shallow.clearance_mm(0.5) < 0.0 && shallow.warning(0.5).unwrap().contains("rubs"));
    let circle = Arc::new(PitchCurve::new(&PitchCurveShape::Circle, 3.0, 42).unwrap());
    let round = smallest_relief(&ShapingLinkage::new(NORMAL, circle, 30.0, 0.0).unwrap(), 0.0, alpha);
    assert!((round.ratio - 1.0).abs() < 1e-12 && round.warning(0.5).is_none());
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
