//! Pitch curve, axes, strokes and velocities against an independent implementation.
//!
//! tests/data/shaping/external_*.json hold numbers of a program in another language that computes every value in two
//! ways (f64 and multi-precision); the tolerances stand in the files. Case S0 is the third-order ellipse of Gao et al.
//! 2017, Table 1; the circle is its closed-form limit.

use crate::fixtures::expected::{close, data, number, numbers};
use std::f64::consts::TAU;
use std::sync::Arc;

use crate::fixtures::paper::{NORMAL, TRADITIONAL, operation, paper_scene};
use gearcut::gear::{GearKind, PitchCurve, PitchCurveShape};
use gearcut::process::shaping::linkage::{ShapingLinkage, StrokeSchedule};
use gearcut::process::shaping::scene::model::{Linkage, NormalReading, Shaping};
use serde_json::Value;

const AS_PRINTED: Linkage = Linkage::ShapingNormal { reading: NormalReading::AsPrinted };

/// Difference of two angles of one turn.
fn apart(a: f64, b: f64) -> f64 {
    let d = (a - b).rem_euclid(TAU);
    d.min(TAU - d)
}

fn ellipse(semi_major_axis_mm: Option<f64>, eccentricity: f64) -> Arc<PitchCurve> {
    let shape = PitchCurveShape::Ellipse { order: 3, eccentricity, semi_major_axis_mm };
    Arc::new(PitchCurve::new(&shape, 3.0, 42).unwrap())
}

/// Each case: pitch curve, and the three blocks of the data.
fn cases() -> [(Arc<PitchCurve>, Value, Value, Value); 2] {
    let circle = data("shaping/external_circle");
    [
        (
            ellipse(Some(61.11), 0.1348),
            data("shaping/external_s0_curve"),
            data("shaping/external_s0_axes"),
            data("shaping/external_s0_strokes"),
        ),
        (ellipse(Some(63.0), 0.0), circle["curve"].clone(), circle["axes"].clone(), circle["strokes"].clone()),
    ]
}

#[test]
fn pitch_curve_agrees() {
    for (curve, expected, ..) in cases() {
        let within = |key: &str| number(&expected["tolerance"][key]);
        close("perimeter", curve.perimeter_mm(), number(&expected["perimeter"]), within("perimeter"));
        close("closure", curve.closure_error_mm(), number(&expected["perimeter_error"]), within("perimeter"));
        let column = |key: &str| numbers(&expected[key]);
        let (r, dr, d2r) = (column("r"), column("dr"), column("d2r"));
        let (mu, arc, kappa) = (column("mu"), column("S"), column("kappa"));
        for (i, phi) in column("phi").into_iter().enumerate() {
            let (radius, frame) = (curve.radius(phi), curve.frame(phi));
            close("r", radius.value(), r[i], within("r"));
            close("r'", radius.derivative(1), dr[i], within("r"));
            close("r''", radius.derivative(2), d2r[i], within("r"));
            close("mu", frame.mu_rad, mu[i], within("mu"));
            close("kappa", frame.curvature_per_mm, kappa[i], within("kappa"));
            close("S", curve.arc_mm(phi), arc[i], within("S"));
            close("phi(S)", curve.phi_at_arc(arc[i]), phi, 1e-12);
        }
        let facts = curve.facts();
        close("kappa max", facts.largest_curvature.curvature_per_mm, number(&expected["kappa_max"]), within("kappa"));
        close("kappa min", facts.smallest_curvature.curvature_per_mm, number(&expected["kappa_min"]), within("kappa"));
        close("rho min", facts.smallest_curvature_radius_mm, number(&expected["rho_min"]), 1e-9);
        assert_eq!(facts.convex, expected["convex"].as_bool().unwrap());
        let zones = expected["concave_zones"].as_array().unwrap();
        assert_eq!(facts.concave_zones_rad.len(), zones.len());
        for (found, zone) in facts.concave_zones_rad.iter().zip(zones) {
            for end in 0..2 {
                close("zone", found[end], number(&zone[end]), within("zones"));
            }
        }
    }
}

#[test]
fn curvature_extrema_agree() {
    let (curve, expected, ..) = &cases()[0];
    let extrema = expected["kappa_extrema"].as_array().unwrap();
    let found = &curve.facts().curvature_extrema;
    assert_eq!(found.len(), extrema.len());
    for extremum in extrema {
        let (phi, kappa) = (number(&extremum["phi"]), number(&extremum["kappa"]));
        let nearest = found.iter().min_by(|a, b| apart(a.phi_rad, phi).total_cmp(&apart(b.phi_rad, phi))).unwrap();
        close("place", apart(nearest.phi_rad, phi), 0.0, number(&expected["tolerance"]["phi_extrema"]));
        close("kappa", nearest.curvature_per_mm, kappa, number(&expected["tolerance"]["kappa"]));
    }
    assert!(cases()[1].0.facts().curvature_extrema.is_empty());
}

#[test]
fn size_that_closes() {
    let curve = ellipse(None, 0.1348);
    close("A", curve.size_mm(), 61.110009074395, 1e-12);
    close("closure", curve.closure_error_mm(), 0.0, 1e-12);
}

#[test]
fn axes_agree_for_every_linkage() {
    for (curve, _, expected, _) in cases() {
        let (r_c, delta_d) = (number(&expected["r_c"]), number(&expected["delta_d"]));
        let within = |key: &str| number(&expected["tolerance"][key]);
        let runs = [
            ("finish", TRADITIONAL, 0.0),
            ("finish", NORMAL, 0.0),
            ("finish", AS_PRINTED, 0.0),
            ("traditional", TRADITIONAL, delta_d),
            ("normal", NORMAL, delta_d),
            ("normal_as_printed", AS_PRINTED, delta_d),
        ];
        for (block, kind, offset_mm) in runs {
            let linkage = ShapingLinkage::new(GearKind::External, kind, Arc::clone(&curve), r_c, offset_mm).unwrap();
            let block = &expected[block];
            let (phi, psi_b, l) = (numbers(&block["phi"]), numbers(&block["psi_b"]), numbers(&block["l"]));
            for (i, psi_c) in numbers(&expected["psi_c"]).into_iter().enumerate() {
                let found = linkage.phi_at_work_angle(psi_c, offset_mm);
                let axes = linkage.axes(found, offset_mm);
                close("phi", found, phi[i], within("phi"));
                close("psi_c", axes.psi_c_rad.value(), psi_c, 1e-12);
                close("psi_b", axes.psi_b_rad.value(), psi_b[i], within("psi_b"));
                close("l", axes.center_distance_mm.value(), l[i], within("l"));
            }
            let turn = linkage.axes(TAU, 0.0).psi_b_rad.value() - linkage.axes(0.0, 0.0).psi_b_rad.value();
            close("psi_b per turn", turn, number(&expected["psi_b_per_turn"]), 1e-9);
        }
    }
}

#[test]
fn velocities_and_instantaneous_centers_agree() {
    for (curve, _, expected, _) in cases() {
        let (r_c, delta_d) = (number(&expected["r_c"]), number(&expected["delta_d"]));
        let linkage = ShapingLinkage::new(GearKind::External, TRADITIONAL, Arc::clone(&curve), r_c, delta_d).unwrap();
        let block = &expected["velocity"];
        let within = number(&block["tolerance"]);
        let column = |key: &str| numbers(&block[key]);
        let (omega_b, v_x) = (column("omega_b"), column("v_x"));
        let centers = [(0.0, column("x_P"), column("y_P")), (delta_d, column("x_Pprime"), column("y_Pprime"))];
        for (i, phi) in numbers(&expected["finish"]["phi"]).into_iter().enumerate() {
            let axes = linkage.axes(phi, delta_d);
            let turn = axes.psi_c_rad.derivative(1);
            close("omega_b", axes.psi_b_rad.derivative(1) / turn, omega_b[i], within);
            close("v_x", axes.center_distance_mm.derivative(1) / turn, v_x[i], within);
            for (offset_mm, x, y) in &centers {
                let center = linkage.pose_motion(phi, *offset_mm).instantaneous_center_mm();
                let machine = glam::DVec2::from_angle(-axes.psi_c_rad.value()).rotate(center);
                close("x", machine.x, x[i], within);
                close("y", machine.y, y[i], within);
            }
        }
    }
}

#[test]
fn strokes_agree() {
    let paper = paper_scene(Vec::new());
    let machine = &Shaping::of(&paper).expect("a shaping scene").machine;
    for (curve, _, axes, expected) in cases() {
        let (r_c, delta_d) = (number(&axes["r_c"]), number(&axes["delta_d"]));
        let n = expected["N"].as_u64().unwrap();
        let within = number(&expected["tolerance"]);
        for (block, kind) in [("traditional", TRADITIONAL), ("normal", NORMAL)] {
            let linkage = ShapingLinkage::new(GearKind::External, kind, Arc::clone(&curve), r_c, delta_d).unwrap();
            let schedule =
                StrokeSchedule::new(&operation("rough", kind, delta_d, u32::try_from(n).unwrap()), &linkage, machine)
                    .unwrap();
            assert_eq!(schedule.count() as u64, n);
            let (dpsi_b, dl): (Vec<f64>, Vec<f64>) = (0..schedule.count())
                .map(|i| [i, i + 1].map(|i| schedule.state(i as f64)))
                .map(|[a, b]| (b.psi_b_rad - a.psi_b_rad, b.center_distance_mm - a.center_distance_mm))
                .unzip();
            let block = &expected[block];
            for i in 0..5 {
                close("dpsi_b", dpsi_b[i], number(&block["dpsi_b_first5"][i]), within);
                close("dl", dl[i], number(&block["dl_first5"][i]), within);
            }
            let least = |x: &[f64]| x.iter().copied().fold(f64::INFINITY, f64::min);
            let most = |x: &[f64]| x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            close("least dpsi_b", least(&dpsi_b), number(&block["dpsi_b_min"]), within);
            close("most dpsi_b", most(&dpsi_b), number(&block["dpsi_b_max"]), within);
            close("least dl", least(&dl), number(&block["dl_min"]), within);
            close("most dl", most(&dl), number(&block["dl_max"]), within);
            close("sum of dpsi_b", dpsi_b.iter().sum(), number(&block["sum_dpsi_b"]), within);
            close("sum of dl", dl.iter().sum(), number(&block["sum_dl"]), within);
        }
    }
}
