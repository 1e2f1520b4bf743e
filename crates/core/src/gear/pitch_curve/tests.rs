//! Checks of every kind of pitch curve against finite differences, closed forms and its own inverse.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;

use super::examples::{any_curve, by_formula, examples};
use super::*;
use crate::gear::{Driver, FormulaMeaning, GearKind};

#[test]
fn derivatives_match_differences() {
    let h = 1e-4;
    for curve in examples() {
        for i in 0..200 {
            let phi = f64::from(i) * 0.0437 - 1.0;
            let (before, here, after) = (curve.radius(phi - h), curve.radius(phi), curve.radius(phi + h));
            for k in 0..2 {
                let difference = (after.derivative(k) - before.derivative(k)) / (2.0 * h);
                let error = difference - here.derivative(k + 1);
                assert!(error.abs() < 1e-4, "derivative {} of {:?} at {phi}: {error}", k + 1, curve.law);
            }
        }
    }
}

#[test]
fn third_derivative_and_curvature_slope_match_differences() {
    let h = 1e-4;
    for curve in examples().iter().filter(|curve| curve.breaks_rad().is_empty()) {
        for i in 0..200 {
            let phi = f64::from(i) * 0.0437 - 1.0;
            let third = (curve.radius(phi + h).derivative(2) - curve.radius(phi - h).derivative(2)) / (2.0 * h);
            assert!((third - curve.radius(phi).derivative(3)).abs() < 1e-3 * (1.0 + third.abs()));
            let kappa = |phi: f64| facts::curvature(&curve.radius(phi));
            let slope = (kappa(phi + h).value() - kappa(phi - h).value()) / (2.0 * h);
            assert!((slope - kappa(phi).derivative(1)).abs() < 1e-6 * (1.0 + slope.abs()));
        }
    }
}

#[test]
fn frames_are_consistent() {
    let h = 1e-5;
    for curve in examples() {
        for i in 0..100 {
            let phi = f64::from(i) * 0.0731 - 2.0;
            let frame = curve.frame(phi);
            let step = (curve.frame(phi + h).point_mm - curve.frame(phi - h).point_mm) / (2.0 * h);
            assert!((step - frame.tangent * frame.arc_rate_mm_per_rad).length() < 1e-6);
            assert!(frame.tangent.dot(frame.normal).abs() < 1e-15);
            assert!(frame.normal.dot(frame.point_mm) > 0.0);
            assert!((frame.tangent.angle_to(-frame.point_mm).abs() - (PI - frame.mu_rad)).abs() < 1e-12);
            // dt/ds = -kappa n
            let turn = (curve.frame(phi + h).tangent - curve.frame(phi - h).tangent) / (2.0 * h);
            let kappa = -turn.dot(frame.normal) / frame.arc_rate_mm_per_rad;
            assert!((kappa - frame.curvature_per_mm).abs() < 1e-7);
        }
    }
}

#[test]
fn sizes_close_and_arcs_agree_with_midpoint_sums() {
    for curve in examples() {
        assert!(curve.closure_error_mm().abs() < 1e-11, "{:?}: {}", curve.law, curve.closure_error_mm());
        // The midpoint rule converges exponentially over a period, and only as 1/n^2 for the table.
        let n = 40_000;
        let rate = |i: usize| curve.frame((i as f64 + 0.5) * TAU / n as f64).arc_rate_mm_per_rad;
        let sum = (0..n).map(rate).sum::<f64>() * TAU / n as f64;
        let bound = if curve.breaks_rad().is_empty() { 1e-10 } else { 1e-6 };
        assert!((sum - curve.perimeter_mm()).abs() < bound, "{:?}: {}", curve.law, sum - curve.perimeter_mm());
    }
}

#[test]
fn known_facts() {
    let circle = &examples()[0];
    assert!((circle.size_mm() - 63.0).abs() < 1e-13);
    assert!(circle.facts().convex && circle.facts().curvature_extrema.is_empty());
    assert!((circle.facts().smallest_curvature_radius_mm - 63.0).abs() < 1e-12);
    // A true ellipse (order 1): perimeter 4 a E(k), sharpest at the ends of the major axis with radius a (1 - k^2).
    let ellipse = &examples()[2];
    let facts = ellipse.facts();
    assert!((facts.smallest_curvature_radius_mm - ellipse.size_mm() * 0.64).abs() < 1e-9);
    assert!((facts.smallest_curvature.curvature_per_mm - 0.8 / ellipse.size_mm()).abs() < 1e-12);
    assert!((facts.largest_radius_mm - ellipse.size_mm() * 1.6).abs() < 1e-9);
    assert!((facts.smallest_radius_mm - ellipse.size_mm() * 0.4).abs() < 1e-9);
    assert_eq!(facts.curvature_extrema.len(), 4);
    assert!((ellipse.perimeter_mm() / ellipse.size_mm() - 5.672333577794).abs() < 1e-11);
}

#[test]
fn refusals_name_their_key() {
    let refuse = |shape: PitchCurveShape| PitchCurve::new(&shape, 3.0, 42).unwrap_err();
    let ellipse =
        |eccentricity, semi_major_axis_mm| PitchCurveShape::Ellipse { order: 3, eccentricity, semi_major_axis_mm };
    let open = refuse(ellipse(0.1348, Some(61.3)));
    assert_eq!(open.key, parameter::ELLIPSE_SIZE);
    assert!(open.way_out.contains("61.110009074"), "{}", open.way_out);
    assert_eq!(refuse(ellipse(1.0, None)).key, parameter::ELLIPSE_ECCENTRICITY);
    assert_eq!(refuse(ellipse(f64::NAN, None)).key, parameter::ELLIPSE_ECCENTRICITY);
    assert_eq!(refuse(ellipse(0.1, Some(-1.0))).key, parameter::ELLIPSE_SIZE);
    let fourier = PitchCurveShape::Fourier { cosine: vec![1.2], sine: vec![], mean_radius_mm: None };
    assert!(refuse(fourier).problem.contains("positive"));
    let infinite = PitchCurveShape::Fourier { cosine: vec![f64::INFINITY], sine: vec![], mean_radius_mm: None };
    assert_eq!(refuse(infinite).key, parameter::FOURIER);
    let stopping =
        PitchCurveShape::SinusoidalRatio { order: 2, mean_ratio: 1.0, ratio_amplitude: 1.0, center_distance_mm: None };
    assert_eq!(refuse(stopping).key, parameter::SINUSOIDAL_AMPLITUDE);
    let lobeless = PitchCurveShape::Pascal { order: 0, eccentricity: 0.1, mean_radius_mm: None };
    assert_eq!(refuse(lobeless).key, parameter::PASCAL_ORDER);
    assert_eq!(PitchCurve::new(&PitchCurveShape::Circle, 3.0, 0).unwrap_err().key, parameter::MODULE);
}

#[test]
fn curves_repeat_as_often_as_their_laws_say() {
    let of = |shape: &PitchCurveShape, teeth: u32| PitchCurve::new(shape, 2.0, teeth).expect("it closes");
    let ellipse = |order: u32| PitchCurveShape::Ellipse { order, eccentricity: 0.1, semi_major_axis_mm: None };
    assert_eq!(of(&PitchCurveShape::Circle, 31).period_teeth(31), 1);
    assert_eq!(of(&ellipse(3), 42).period_teeth(42), 14);
    // A sixth of the curve is seven and a half teeth: two of them make a whole number.
    assert_eq!(of(&ellipse(6), 45).period_teeth(45), 15);
    assert_eq!(of(&ellipse(5), 42).period_teeth(42), 42);
    // Every third harmonic, and one between them that is barely there.
    let third = |first: f64| PitchCurveShape::Fourier {
        cosine: vec![first, 0.0, 0.05, 0.0, 0.0, 0.01],
        sine: Vec::new(),
        mean_radius_mm: None,
    };
    assert_eq!(of(&third(0.0), 42).period_teeth(42), 14);
    assert_eq!(of(&third(1e-6), 42).period_teeth(42), 42);
    // The gear of 102 teeth repeats with every turn of its driver of 34.
    let curve =
        PitchCurveShape::SinusoidalRatio { order: 1, mean_ratio: 1.2, ratio_amplitude: 0.3, center_distance_mm: None };
    let driver = Box::new(Driver { curve, teeth: 34, start_rad: None });
    let mate = of(&PitchCurveShape::Mate { driver, kind: GearKind::Internal }, 102);
    assert_eq!(mate.period_teeth(102), 34);
    assert!(mate.repeats_after(TAU / 3.0) && !mate.repeats_after(TAU / 6.0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn arc_and_its_inverse_return(curve in any_curve(), phi in -20.0..20.0f64) {
        let back = curve.phi_at_arc(curve.arc_mm(phi));
        prop_assert!((back - phi).abs() < 1e-12, "{} away", back - phi);
        prop_assert!((curve.arc_mm(phi + TAU) - curve.arc_mm(phi) - curve.perimeter_mm()).abs() < 1e-9);
    }

    #[test]
    fn facts_bound_the_curve(curve in any_curve(), phi in 0.0..TAU) {
        let (facts, frame) = (curve.facts(), curve.frame(phi));
        let tolerance = 1e-9 * facts.largest_curvature.curvature_per_mm.abs();
        prop_assert!(frame.curvature_per_mm <= facts.largest_curvature.curvature_per_mm + tolerance);
        prop_assert!(frame.curvature_per_mm >= facts.smallest_curvature.curvature_per_mm - tolerance);
        prop_assert!(frame.radius_mm <= facts.largest_radius_mm * (1.0 + 1e-12));
        prop_assert!(frame.radius_mm >= facts.smallest_radius_mm * (1.0 - 1e-12));
        let inside = facts.concave_zones_rad.iter().any(|z| (phi - z[0]).rem_euclid(TAU) < z[1] - z[0]);
        prop_assert!(inside == (frame.curvature_per_mm < 0.0) || frame.curvature_per_mm.abs() < tolerance);
    }
}

/// Every built-in curve as a formula: radii, slopes, curvatures and arcs are the same to rounding, at odd angles too.
#[test]
fn formulas_are_the_built_in_curves() {
    let external = FormulaMeaning::Ratio(GearKind::External);
    for (shape, meaning, text) in [
        (PitchCurveShape::Circle, FormulaMeaning::Radius, "1"),
        (
            PitchCurveShape::Ellipse { order: 3, eccentricity: 0.1348, semi_major_axis_mm: None },
            FormulaMeaning::Radius,
            "(1 - 0.1348^2)/(1 - 0.1348*cos(3*phi))",
        ),
        (
            PitchCurveShape::SinusoidalRatio {
                order: 2,
                mean_ratio: 1.2,
                ratio_amplitude: 0.3,
                center_distance_mm: None,
            },
            external,
            "1.2 + 0.3*sin(2*phi)",
        ),
        (
            PitchCurveShape::Pascal { order: 2, eccentricity: 0.2, mean_radius_mm: None },
            FormulaMeaning::Radius,
            "1 + 0.2*cos(2*phi)",
        ),
        (
            PitchCurveShape::Fourier { cosine: vec![0.05, 0.1], sine: vec![-0.04, 0.0, 0.02], mean_radius_mm: None },
            FormulaMeaning::Radius,
            "1 + 0.05*cos(phi) + 0.1*cos(2*phi) - 0.04*sin(phi) + 0.02*sin(3*phi)",
        ),
    ] {
        let [built_in, formula] =
            [shape, by_formula(meaning, text)].map(|shape| PitchCurve::new(&shape, 3.0, 42).expect("a curve"));
        for i in -40..80 {
            let phi = 0.1 + 0.173 * f64::from(i);
            let [a, b] = [&built_in, &formula].map(|curve| curve.radius(phi));
            for k in 0..4 {
                let [a, b] = [a, b].map(|radius| radius.derivative(k) / 63.0);
                assert!((a - b).abs() < 1e-12 * a.abs().max(1.0), "{text} at {phi}: derivative {k}: {a} {b}");
            }
            let [a, b] = [&built_in, &formula].map(|curve| curve.arc_mm(phi) / 63.0);
            assert!((a - b).abs() < 1e-12 * a.abs().max(1.0), "{text} at {phi}: arcs {a} {b}");
        }
    }
}

/// A ring by its own ratio: r - r_2 = C with r_2 = i r, the ratio of the speeds; the ring of 2.06 +- 0.5 turns of the
/// gear inside to one of its own exists.
#[test]
fn a_ring_has_the_ratio_of_its_formula() {
    let text = "1/(2.06 + 0.5*sin(2*phi))";
    let shape = by_formula(FormulaMeaning::Ratio(GearKind::Internal), text);
    let curve = PitchCurve::new(&shape, 2.0, 84).expect("a ring");
    for i in 0..50 {
        let phi = 0.3 * f64::from(i);
        let radius_mm = curve.radius(phi).value();
        let turns = radius_mm / (radius_mm - curve.size_mm());
        let expected = 2.06 + 0.5 * (2.0 * phi).sin();
        assert!((turns - expected).abs() < 1e-12 * expected, "{turns} not {expected}");
    }
}

#[test]
fn formulas_without_a_curve_are_refused_with_the_angle() {
    let external = FormulaMeaning::Ratio(GearKind::External);
    for (meaning, text, key, words) in [
        // sin = -1 / 1.2 at 236.443 deg.
        (external, "1 + 1.2*sin(phi)", parameter::RATIO_FORMULA, "passes zero at 236.443 deg"),
        (FormulaMeaning::Radius, "cos(phi)", parameter::RADIUS_FORMULA, "passes zero at 90.000 deg"),
        (FormulaMeaning::Radius, "-1", parameter::RADIUS_FORMULA, "passes zero at 0.000 deg"),
        (
            FormulaMeaning::Ratio(GearKind::Internal),
            "0.9 + 0.2*sin(phi)",
            parameter::RATIO_FORMULA,
            "reaches 1 at 30.000",
        ),
        // The root of a negative number beyond 60 deg.
        (FormulaMeaning::Radius, "1 + sqrt(cos(phi) - 0.5)", parameter::RADIUS_FORMULA, "no derivative at 60.000"),
        (FormulaMeaning::Radius, "2 + sin(1.5*phi)", parameter::RADIUS_FORMULA, "slope of"),
        (FormulaMeaning::Radius, "2 + phi", parameter::RADIUS_FORMULA, "2.000000 at 0 deg and 8.283185 at 360 deg"),
        (FormulaMeaning::Radius, "2 + 0.1*sin(5000*phi)", parameter::RADIUS_FORMULA, "varies with the harmonic"),
    ] {
        let refusal = PitchCurve::new(&by_formula(meaning, text), 3.0, 42).expect_err(text);
        assert_eq!(refusal.key, key, "{text}");
        assert!(refusal.problem.contains(words), "{text}: {}", refusal.problem);
    }
}

/// A round table: the factor is the ratio of the radii, and only a small one is taken unasked.
#[test]
fn a_table_is_scaled_by_little_unless_the_scene_asks_for_more() {
    let curve = |radius_mm: f64, scaling| {
        let points_rad_mm = (0..72).map(|i| [f64::from(i) * TAU / 72.0, radius_mm]).collect();
        PitchCurve::new(&PitchCurveShape::Table { points_rad_mm, scaling }, 3.0, 42)
    };
    // 42 teeth of 3 mm take a radius of 63 mm.
    for (radius_mm, scaling, factor) in [
        (62.9, TableScaling::Small, Some(63.0 / 62.9)),
        (42.84, TableScaling::Any, Some(63.0 / 42.84)),
        (63.0, TableScaling::AsGiven, None),
    ] {
        let found = curve(radius_mm, scaling).expect("a curve").scaling();
        match (found, factor) {
            (Some(found), Some(factor)) => assert!((found - factor).abs() < 1e-12, "{found}, {factor} expected"),
            (found, factor) => assert_eq!(found, factor),
        }
    }
    let refusal = curve(42.84, TableScaling::Small).expect_err("that is another gear").to_string();
    assert!(refusal.contains("multiplied by 1.470588") && refusal.contains("fit 2.040000 mm"), "{refusal}");
}
