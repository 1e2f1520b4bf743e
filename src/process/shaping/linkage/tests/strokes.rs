//! Checks of stroke counts, spacings and infeeds.

use std::f64::consts::{PI, TAU};

use super::*;
use crate::machine::Motion as _;
use crate::process::shaping::scene::model::{AxisLimits, Feed, Infeed, StrokeSpacing};

#[test]
fn counts_windows_and_witness_marks() {
    let mut run = operation(2.0, 360);
    assert_eq!(schedule(&run).count(), 360);
    run.window_rad = Some([1f64.to_radians(), 119f64.to_radians()]);
    let strokes = schedule(&run);
    assert_eq!(strokes.count(), 119);
    for i in 0..119 {
        let expected = f64::from(i + 1) * TAU / 360.0;
        assert!((strokes.state(f64::from(i)).psi_c_rad - expected).abs() < 1e-12);
    }
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
        let ([work, cutter, distance], limits) = (strokes.at(stroke), machine().limits);
        (work.velocity / limits.work_speed_rad_per_s.unwrap())
            .max(cutter.velocity / limits.cutter_speed_rad_per_s.unwrap())
            .max(distance.velocity.abs() / limits.center_distance_speed_mm_per_s.unwrap())
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
