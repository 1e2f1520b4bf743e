//! Nominal pairs: ratio law, path of contact, contact ratios, and no transmission error.

use super::*;
use crate::pair::contact_ratio::{path_of_contact, tooth_path};
use serde_json::json;

#[test]
fn circular_contact_ratios_in_closed_form() {
    for case in data("p01_circular")["cases"].as_array().expect("cases") {
        let design = &case["design"];
        let pair = pair_of(design);
        let expected = &case["contact_ratio"];
        let mut largest = Largest::default();
        for phi in [0.0, 0.3, 1.7, 4.0] {
            for (side, name) in SIDES {
                let path = path_of_contact(&pair, &pair.at(phi), side, addendum_mm(design)).expect("tips");
                let ratio = path.contact_ratio(&pair);
                largest.within(ratio, number(expected, "value"), number(expected, "tolerance"), name);
            }
        }
        println!("p01 contact ratio: {:.1e}", largest.0);
    }
}

fn check_nominal(file: &str, design: &Value, expected: &Value) {
    let pair = pair_of(design);
    let tips = addendum_mm(design);
    let tolerance = |key: &str| number(&expected["tolerance"], key);
    let mut largest: [Largest; 4] = Default::default();
    largest[0].within(pair.center_distance_mm(), number(design, "a_closing"), tolerance("r"), "a");
    let teeth = pair.teeth();
    for (value, key) in [
        (pair.curve().perimeter_mm(), "perimeter_1"),
        (pair.pitch_mm() * f64::from(teeth.count[1]), "perimeter_2"),
        (extremes(&pair, |at| at.radius_mm[1] / at.radius_mm[0])[0][1], "i_min"),
        (extremes(&pair, |at| at.radius_mm[1] / at.radius_mm[0])[1][1], "i_max"),
    ] {
        largest[0].within(value, number(expected, key), tolerance("r"), key);
    }
    for (gear, kappa, rho) in [(0, "kappa1_min", "rho1_min"), (1, "kappa2_min", "rho2_min")] {
        let [[_, least], [_, most]] = extremes(&pair, |at| at.curvature_per_mm[gear]);
        largest[0].within(least, number(expected, kappa), tolerance("kappa"), kappa);
        largest[0].within(most, 1.0 / number(expected, rho), tolerance("kappa"), rho);
    }
    let cutters = cutters(design);
    let limits = &expected["generated_limits"];
    for (cutter, key) in cutters.iter().zip(["lambda_form_gear1", "lambda_form_gear2"]) {
        let value = cutter.form_reach_mm(teeth.module_mm, teeth.pressure_angle_rad);
        largest[1].within(value, number(limits, key), tolerance("lam"), key);
    }
    let meshing = meshing(&pair, tips, &json!({}));
    for (i, phi) in numbers(&expected["phi1"]).into_iter().enumerate() {
        let at = pair.at(phi);
        let given = |key: &str| numbers(&expected[key])[i];
        for (value, key, allowed) in [
            (at.phi_2_rad, "phi2", "phi2"),
            (at.radius_mm[0], "r1", "r"),
            (at.radius_mm[1], "r2", "r"),
            (at.mu_rad, "mu", "mu"),
            (at.arc_mm, "S", "r"),
            (at.curvature_per_mm[0], "kappa1", "kappa"),
            (at.curvature_per_mm[1], "kappa2", "kappa"),
            (at.radius_mm[1] / at.radius_mm[0], "i", "r"),
            (pair.arm_mm(&at, Side::Right), "arm_right", "r"),
            (pair.arm_mm(&at, Side::Left), "arm_left", "r"),
        ] {
            largest[0].within(value, given(key), tolerance(allowed), &format!("{file} {key} at {phi}"));
        }
        for (side, name) in SIDES {
            let path = path_of_contact(&pair, &at, side, tips).expect("tips");
            let given = |key: &str| numbers(&expected[format!("path_{name}")][key])[i];
            largest[1].within(path.driver_tip_mm, given("lambda_tip1"), tolerance("lam"), name);
            largest[1].within(path.driven_tip_mm, given("lambda_tip2"), tolerance("lam"), name);
            largest[1].within(path.contact_ratio(&pair), given("contact_ratio"), tolerance("contact_ratio"), name);
        }
        let moment = meshing.at(phi).expect("flanks that touch");
        for touch in [&moment.right, &moment.left] {
            largest[3].within(arcsec(touch.error_rad), 0.0, tolerance("TE_nominal_arcsec"), "nominal error");
        }
    }
    let mut extreme = [f64::INFINITY, f64::NEG_INFINITY];
    for (side, name) in SIDES {
        for row in expected[format!("teeth_{name}")].as_array().expect("teeth") {
            let tooth = row["tooth"].as_i64().expect("a tooth");
            let path = tooth_path(&pair, side, tooth, tips).expect("tips");
            if side == Side::Right {
                extreme = [extreme[0].min(path.contact_ratio), extreme[1].max(path.contact_ratio)];
            }
            let what = format!("{file} tooth {tooth} {name}");
            for (value, key, allowed) in [
                (path.phi_at_driven_tip_rad, "phi1_at_tip2", "phi1_at_tips"),
                (path.phi_at_driver_tip_rad, "phi1_at_tip1", "phi1_at_tips"),
                (path.contact_ratio, "contact_ratio", "contact_ratio"),
                (path.deepest_on_driver_mm, "SAP_height_gear1", "heights"),
                (path.deepest_on_driven_mm, "SAP_height_gear2", "heights"),
            ] {
                largest[2].within(value, number(row, key), tolerance(allowed), &format!("{what} {key}"));
            }
            for (phi, key) in
                [(path.phi_at_driven_tip_rad, "contact_at_tip2"), (path.phi_at_driver_tip_rad, "contact_at_tip1")]
            {
                let own_mm = pair.flank_point(Member::Driver, side, pair.crossing_mm(side, tooth), phi).point_mm;
                let contact_mm = glam::DVec2::from_angle(-phi).rotate(own_mm).to_array();
                for (value, expected) in contact_mm.into_iter().zip(numbers(&row[key])) {
                    largest[2].within(value, expected, tolerance("heights"), &format!("{what} {key}"));
                }
            }
        }
    }
    for (value, given) in extreme.into_iter().zip(numbers(&expected["contact_ratio_min_max_right"])) {
        largest[2].within(value, given, tolerance("contact_ratio"), "contact ratio of teeth");
    }
    let worst = largest.map(|l| l.0);
    println!("{file}: law {:.1e}, path {:.1e}, teeth {:.1e}, TE {:.1e} arcsec", worst[0], worst[1], worst[2], worst[3]);
}

#[test]
fn the_third_order_pair() {
    let file = data("p02_s0_nominal");
    check_nominal("p02", &file["design"], &file);
}

#[test]
fn the_internal_pair() {
    let file = data("p09_s1_internal");
    check_nominal("p09", &file["nominal"]["design"], &file["nominal"]);
}
