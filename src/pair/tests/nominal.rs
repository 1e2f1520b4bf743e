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
    for (side, name) in SIDES {
        for row in expected[format!("teeth_{name}")].as_array().expect("teeth") {
            let tooth = row["tooth"].as_i64().expect("a tooth");
            let path = tooth_path(&pair, side, tooth, tips).expect("tips");
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
        }
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
