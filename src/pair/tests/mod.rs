//! Values of an independent implementation (`tests/data/pair`), each within its own tolerance.

mod brute_force;
mod form_points;
mod harmonics;
mod nominal;
mod rigid_errors;
mod sharp_cutter;
mod single_flank;
mod tight;

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use serde_json::Value;

use super::assembly::{AssemblyErrors, Meshing};
use super::flank_chain::{self, FlankChain, GearFlanks};
use super::pitch_pair::{Member, PairTeeth, PitchPair, PitchPoint};
use gearcut_core::gear::{GearKind, PitchCurve, PitchCurveShape};
use gearcut_core::math::extremum::maximum;
use gearcut_core::terms::Side;
use sharp_cutter::SharpCutter;

fn data(name: &str) -> Value {
    let path = format!("{}/tests/data/pair/{name}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_slice(&std::fs::read(path).expect("a file of expected values")).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect()
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("{key} is a number"))
}

/// The cutters of both gears.
fn cutters(design: &Value) -> [SharpCutter; 2] {
    [1, 2].map(|gear| SharpCutter {
        teeth: number(design, &format!("cutter{gear}_z0")) as u32,
        addendum_coefficient: number(design, "cutter_ha0"),
    })
}

/// Zero where the file does not name it.
fn optional(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or(0.0)
}

fn pair_of(design: &Value) -> PitchPair {
    let curve = &design["pitch_curve"];
    let size = curve["A"].as_f64();
    let order = |key: &str| curve[key].as_u64().expect("a whole number") as u32;
    let shape = match curve["type"].as_str().expect("a type") {
        "high_order_ellipse" if number(curve, "k") == 0.0 => PitchCurveShape::Circle,
        "high_order_ellipse" => {
            PitchCurveShape::Ellipse { order: order("n"), eccentricity: number(curve, "k"), semi_major_axis_mm: size }
        }
        // r1 = a0 / (c - b sin phi): the driver of a ratio that is 1 + i = c - b sin phi.
        "s1_driver" => PitchCurveShape::SinusoidalRatio {
            order: 1,
            mean_ratio: number(curve, "c") - 1.0,
            ratio_amplitude: -number(curve, "b"),
            center_distance_mm: curve["a0"].as_f64(),
        },
        other => panic!("{other}: {curve}"),
    };
    let teeth = PairTeeth {
        module_mm: number(design, "m"),
        pressure_angle_rad: number(design, "alpha_deg").to_radians(),
        base_helix_cosine: 1.0,
        count: ["z1", "z2"].map(|key| number(design, key) as u32),
        driven: if design["internal"] == true { GearKind::Internal } else { GearKind::External },
    };
    let curve = PitchCurve::with_accuracy(&shape, teeth.module_mm, teeth.count[0], 1e-12).expect("a closed curve");
    PitchPair::closing(Arc::new(curve), teeth).expect("a mate that closes")
}

/// Places and values of the smallest and the largest of something over the driver's turn.
fn extremes(pair: &PitchPair, of: impl Fn(&PitchPoint) -> f64) -> [[f64; 2]; 2] {
    [-1.0, 1.0].map(|sign| {
        let (at, found) = maximum(|phi| sign * of(&pair.at(phi)), 0.0, TAU, 360);
        [at, sign * found]
    })
}

fn addendum_mm(design: &Value) -> [f64; 2] {
    ["ha1", "ha2"].map(|key| number(design, key) * number(design, "m"))
}

fn thinned(pair: &PitchPair, member: Member, addendum_mm: [f64; 2], thinning_mm: f64) -> GearFlanks<FlankChain> {
    let extra_mm = -0.5 * thinning_mm * pair.teeth().pressure_angle_rad.cos();
    flank_chain::nominal(pair, member, addendum_mm, |_, _| extra_mm).expect("flanks")
}

/// The pair with the errors that a case names.
fn meshing(pair: &PitchPair, addendum_mm: [f64; 2], errors: &Value) -> Meshing {
    let off = |e: &str, eps: &str| optional(errors, e) * glam::DVec2::from_angle(optional(errors, eps));
    // The driven gear's angles count from the pitch point at phi_1 = 0, which an external one has on its left.
    let around = if pair.sign() > 0.0 { PI } else { 0.0 };
    let mounting = AssemblyErrors {
        center_distance_error_mm: optional(errors, "delta_a"),
        eccentricity_mm: [off("e1", "eps1"), glam::DVec2::from_angle(around).rotate(off("e2", "eps2"))],
        ..AssemblyErrors::default()
    };
    let driver = thinned(pair, Member::Driver, addendum_mm, optional(errors, "thin1"));
    let driven = thinned(pair, Member::Driven, addendum_mm, optional(errors, "thin2"));
    Meshing::new(pair.clone(), &driver, &driven, &mounting)
}

fn arcsec(rad: f64) -> f64 {
    rad.to_degrees() * 3600.0
}

/// Largest difference of values from those of the file.
#[derive(Default)]
struct Largest(f64);

impl Largest {
    #[track_caller]
    fn within(&mut self, value: f64, expected: f64, tolerance: f64, what: &str) {
        let off = (value - expected).abs();
        assert!(off <= tolerance, "{what}: {value} is {off:e} from {expected}, {tolerance:e} is allowed");
        self.0 = self.0.max(off);
    }
}

const SIDES: [(Side, &str); 2] = [(Side::Right, "right"), (Side::Left, "left")];
