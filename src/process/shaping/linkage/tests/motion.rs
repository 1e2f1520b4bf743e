//! Checks of axis speeds and accelerations, their peaks, and the clearance when the cutter backs off.

use std::f64::consts::TAU;

use super::super::dynamics::limits;
use super::super::relief::{ReliefFlank, ReliefVerdict, relief_ratio, smallest_relief};
use super::*;
use crate::machine::{Motion as _, Order, peaks};
use crate::process::shaping::scene::model::{Infeed, StrokeSpacing};

#[test]
fn motions_match_differences_and_peaks_bound_them() {
    let mut run = operation(1.0, 360);
    run.revolutions = 2;
    for spacing in [StrokeSpacing::WorkAngle, StrokeSpacing::Arc, StrokeSpacing::Time] {
        for infeed in [Infeed::None, Infeed::Spiral { depth_mm: 1.0, angle_rad: 2.0 }] {
            (run.spacing, run.infeed) = (spacing, infeed);
            let strokes = schedule(&run);
            let peaks = peaks(&strokes, &limits(&machine().limits));
            assert_eq!(peaks.len(), 6);
            let h = 1e-3;
            for i in 0..300 {
                let stroke = f64::from(i) * 2.4 + 0.31;
                let step_s = strokes.time_s(h);
                let (before, here, after) = (strokes.at(stroke - h), strokes.at(stroke), strokes.at(stroke + h));
                assert!((here[0].position - strokes.state(stroke).psi_c_rad).abs() < 1e-11);
                for (axis, bounds) in peaks.chunks(2).enumerate() {
                    let (b, a, m) = (before[axis], after[axis], here[axis]);
                    let speed = (a.position - b.position) / (2.0 * step_s);
                    assert!((speed - m.velocity).abs() < 1e-6 * (1.0 + speed.abs()), "{spacing:?} {infeed:?} {axis}");
                    let change = (a.velocity - b.velocity) / (2.0 * step_s);
                    let kink = spacing == StrokeSpacing::Time && (change - m.acceleration).abs() > 1e-3;
                    assert!(
                        kink || (change - m.acceleration).abs() < 1e-3 * (1.0 + change.abs()),
                        "{spacing:?} {axis}"
                    );
                    assert!(m.velocity.abs() <= bounds[0].value * (1.0 + 1e-12));
                    assert!(m.acceleration.abs() <= bounds[1].value * (1.0 + 1e-9) + 1e-9);
                }
            }
            let limit = machine().limits.work_speed_rad_per_s.unwrap();
            assert_eq!((peaks[0].order, peaks[1].order), (Order::Speed, Order::Acceleration));
            let margin = peaks[0].margin().unwrap();
            assert!((margin - (1.0 - peaks[0].value / limit)).abs() < 1e-15);
            assert!(peaks[1].margin().is_none());
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
    assert!(smallest.warning("rough", 0.5).unwrap().text.contains("26 %"));
    for i in 0..30 {
        let phi = f64::from(i) * 0.21;
        let ratio = relief_ratio(&linkage, phi, 0.0, alpha);
        assert!((ratio.left - (alpha + beta(phi)).sin() / alpha.sin()).abs() < 1e-12);
        assert!((ratio.right - (alpha - beta(phi)).sin() / alpha.sin()).abs() < 1e-12);
    }
    // beta < 0 where the radius falls with phi: there the left flank loses.
    assert_eq!(beta(smallest.phi_rad) < 0.0, smallest.flank == ReliefFlank::Left);
    let shallow = smallest_relief(&paper_linkage(NORMAL), 0.0, 14f64.to_radians());
    assert_eq!(shallow.verdict(), ReliefVerdict::Rubs);
    assert!(shallow.clearance_mm(0.5) < 0.0 && shallow.warning("rough", 0.5).unwrap().text.contains("rubs"));
    let circle = Arc::new(PitchCurve::new(&PitchCurveShape::Circle, 3.0, 42).unwrap());
    let round =
        smallest_relief(&ShapingLinkage::new(GearKind::External, NORMAL, circle, 30.0, 0.0).unwrap(), 0.0, alpha);
    assert!((round.ratio - 1.0).abs() < 1e-12, "{round:?}");
    assert!(round.warning("rough", 0.5).is_none());
}
