//! Double-flank rolling: against the mate and against a circular master.

use super::*;
use crate::pair::double_flank::{Master, against_mate};
use gearcut_core::units::UM_PER_MM;

/// What the file allows first orders against a master, um; against the mate it names none.
const FIRST_ORDER_UM: f64 = 1e-4;

#[test]
fn tight_centre_distances() {
    let file = data("p08_s0_double_flank");
    let nominal = data("p02_s0_nominal");
    let design = &nominal["design"];
    let pair = pair_of(design);
    let tips = addendum_mm(design);
    for case in file["mate"].as_array().expect("cases") {
        let meshing = meshing(&pair, tips, &case["errors"]);
        let mut largest: [Largest; 2] = Default::default();
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for (i, phi) in numbers(&case["phi1"]).into_iter().enumerate() {
            let tight = against_mate(&meshing, phi).expect("a tight mesh");
            let expected = |key: &str| numbers(&case[key])[i];
            let um = UM_PER_MM * tight.distance_error_mm;
            range = [range[0].min(um), range[1].max(um)];
            largest[0].within(um, expected("delta_a_um"), number(&case["tolerance"], "delta_a_um"), "mate");
            // First order: gaps that errors close along the normals of both flanks.
            let alpha = pair.teeth().pressure_angle_rad;
            let mu = pair.curve().frame(phi).mu_rad;
            let off = optional(&case["errors"], "e1") * glam::DVec2::from_angle(optional(&case["errors"], "eps1"));
            let thin_mm = 0.5 * optional(&case["errors"], "thin1") * alpha.cos();
            let [right, left] = [Side::Right, Side::Left]
                .map(|side| off.dot(pair.flank_point(Member::Driver, side, 0.0, phi).normal) - thin_mm);
            let first_mm = (right * (mu - alpha).sin() + left * (mu + alpha).sin()) / (2.0 * alpha).sin();
            Largest::default().within(UM_PER_MM * first_mm, expected("delta_a_first_order_um"), FIRST_ORDER_UM, "mate");
            largest[1].within(
                arcsec(tight.error_rad),
                expected("TE_arcsec"),
                number(&case["tolerance"], "TE_arcsec"),
                "mate's error",
            );
        }
        assert!((range[1] - range[0] - number(case, "peak_to_peak_um")).abs() < 0.004, "{range:?}");
        println!("p08 mate {}: {:.1e} um, {:.1e} arcsec", case["name"], largest[0].0, largest[1].0);
    }
    for case in file["master"].as_array().expect("cases") {
        let errors = &case["errors"];
        let gear = thinned(&pair, Member::Driver, tips, optional(errors, "thin1"));
        let off = optional(errors, "e1") * glam::DVec2::from_angle(optional(errors, "eps1"));
        let gear = gear.map(|chain| Ok::<_, ()>(chain.moved(off))).expect("moved");
        let teeth = number(case, "master_teeth") as u32;
        let circle = PitchCurve::new(&PitchCurveShape::Circle, pair.teeth().module_mm, teeth).expect("a circle");
        let circles = PairTeeth { count: [teeth; 2], driven: GearKind::External, ..*pair.teeth() };
        let circles = PitchPair::closing(Arc::new(circle), circles).expect("a mate");
        let master = Master::new(&circles, tips[1]).expect("a master");
        let mut largest = Largest::default();
        for (i, phi) in numbers(&case["phi"]).into_iter().enumerate() {
            let expected = |key: &str| numbers(&case[key])[i];
            let (distance_mm, work_rad) = master.nominal(pair.curve(), phi);
            assert!((distance_mm - expected("l_nominal")).abs() < 1e-9, "{distance_mm}");
            assert!((work_rad - expected("psi_c")).abs() < 1e-9, "{work_rad}");
            let frame = pair.curve().frame(phi);
            let beta = frame.normal.angle_to(glam::DVec2::from_angle(work_rad));
            assert!((beta - expected("beta")).abs() < 1e-9, "{beta}");
            let closed_mm =
                off.dot(frame.normal) - 0.5 * optional(errors, "thin1") / pair.teeth().pressure_angle_rad.tan();
            Largest::default().within(
                UM_PER_MM * closed_mm / beta.cos(),
                expected("delta_l_first_order_um"),
                number(&case["tolerance"], "delta_l_first_order_um"),
                "master, first order",
            );
            let tight = master.against(pair.curve(), &gear, pair.teeth().module_mm, phi).expect("a tight mesh");
            assert!((distance_mm + tight.distance_error_mm - expected("l")).abs() < 1e-5, "{}", expected("l"));
            largest.within(
                UM_PER_MM * tight.distance_error_mm,
                expected("delta_l_um"),
                number(&case["tolerance"], "delta_l_um"),
                "master",
            );
        }
        println!("p08 master {}: {:.1e} um", case["name"], largest.0);
    }
}
