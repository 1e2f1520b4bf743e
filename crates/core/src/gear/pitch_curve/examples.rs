//! Pitch curves to test with: one of every kind, and any that is accepted. Tests of the linkages include this file too.

use crate::gear::{Driver, FormulaMeaning, GearKind, PitchCurve, PitchCurveShape, TableScaling};
use crate::math::formula::Formula;
use proptest::prelude::*;
use std::f64::consts::TAU;

/// One curve of every kind, all closing on 42 teeth of 3 mm.
pub(crate) fn examples() -> Vec<PitchCurve> {
    let table = |phi: f64| 60.0 + 5.0 * (2.0 * phi).cos() + 2.0 * (3.0 * phi).sin();
    let points = (0..180).map(|i| f64::from(i) * TAU / 180.0 - 0.7).map(|phi| [phi, table(phi)]).collect();
    [
        PitchCurveShape::Circle,
        PitchCurveShape::Ellipse { order: 3, eccentricity: 0.1348, semi_major_axis_mm: None },
        PitchCurveShape::Ellipse { order: 1, eccentricity: 0.6, semi_major_axis_mm: None },
        PitchCurveShape::SinusoidalRatio { order: 2, mean_ratio: 1.2, ratio_amplitude: 0.3, center_distance_mm: None },
        PitchCurveShape::Pascal { order: 2, eccentricity: 0.2, mean_radius_mm: None },
        PitchCurveShape::Fourier { cosine: vec![0.05, 0.1], sine: vec![-0.04, 0.0, 0.02], mean_radius_mm: None },
        by_formula(FormulaMeaning::Ratio(GearKind::External), "1.2 + 0.3*sin(2*phi) + 0.05*cos(5*phi)"),
        PitchCurveShape::Table { points_rad_mm: points, scaling: TableScaling::Any },
        mate_of(GearKind::External, 42),
        mate_of(GearKind::Internal, 14),
    ]
    .iter()
    .map(|shape| PitchCurve::new(shape, 3.0, 42).unwrap())
    .collect()
}

/// A curve by a formula, its size solved.
pub(crate) fn by_formula(meaning: FormulaMeaning, text: &str) -> PitchCurveShape {
    PitchCurveShape::Formula { formula: Formula::parse(text).expect("a formula"), meaning, size_mm: None }
}

/// Mate of a driver of a sinusoidal ratio.
fn mate_of(kind: GearKind, driver_teeth: u32) -> PitchCurveShape {
    let curve =
        PitchCurveShape::SinusoidalRatio { order: 1, mean_ratio: 1.5, ratio_amplitude: 0.2, center_distance_mm: None };
    PitchCurveShape::Mate { driver: Box::new(Driver { curve, teeth: driver_teeth, start_rad: None }), kind }
}

/// Any curve that is accepted, by kind and parameters.
pub(crate) fn any_curve() -> impl Strategy<Value = PitchCurve> {
    let shape = prop_oneof![
        (1u32..6, 0.0..0.7f64).prop_map(|(order, eccentricity)| PitchCurveShape::Ellipse {
            order,
            eccentricity,
            semi_major_axis_mm: None
        }),
        (1u32..6, 0.0..0.7f64).prop_map(|(order, eccentricity)| PitchCurveShape::Pascal {
            order,
            eccentricity,
            mean_radius_mm: None
        }),
        (1u32..6, 0.5..3.0f64, -0.4..0.4f64).prop_map(|(order, mean_ratio, ratio_amplitude)| {
            PitchCurveShape::SinusoidalRatio { order, mean_ratio, ratio_amplitude, center_distance_mm: None }
        }),
        (prop::collection::vec(-0.08..0.08f64, 0..5), prop::collection::vec(-0.08..0.08f64, 0..5))
            .prop_map(|(cosine, sine)| PitchCurveShape::Fourier { cosine, sine, mean_radius_mm: None }),
        prop::collection::vec(50.0..60.0f64, 4..40).prop_map(|radii| {
            let n = radii.len() as f64;
            let points_rad_mm = radii.iter().enumerate().map(|(i, r)| [0.3 + i as f64 * TAU / n, *r]).collect();
            PitchCurveShape::Table { points_rad_mm, scaling: TableScaling::Any }
        }),
    ];
    (shape, 0.5..6.0f64, 10u32..120)
        .prop_filter_map("accepted curves", |(shape, module_mm, teeth)| PitchCurve::new(&shape, module_mm, teeth).ok())
}
