//! Thinned teeth, wrong centre distance, eccentric gears: external circular and non-circular, internal.

use super::*;
use crate::pair::backlash::Backlash;
use crate::pair::rolling::peak_to_peak;
use gearcut_core::units::UM_PER_MM;
use serde_json::json;

/// Checks all cases of a file, and tells the largest difference of the transmission error in arcsec.
fn check_cases(file: &str, design: &Value, cases: &Value) {
    let pair = pair_of(design);
    let mut largest = Largest::default();
    for case in cases.as_array().expect("cases") {
        let name = case["name"].as_str().expect("a name");
        let meshing = meshing(&pair, addendum_mm(design), &case["errors"]);
        let tolerance = &case["tolerance"];
        let mut um = Largest::default();
        let mut errors: [Vec<f64>; 2] = Default::default();
        let mut jams = false;
        for (i, phi) in numbers(&case["phi1"]).into_iter().enumerate() {
            let moment = meshing.at(phi).expect("flanks that touch");
            let expected = |key: &str| numbers(&case[key])[i];
            for (side, (touch, key)) in [(&moment.right, "TE_right"), (&moment.left, "TE_left")].into_iter().enumerate()
            {
                let error = arcsec(touch.error_rad);
                errors[side].push(error);
                // To first order, as far as the file says that it holds.
                let far = number(case, &format!("first_order_error_{}_max_arcsec", ["right", "left"][side]));
                let first = expected(&format!("{key}_first_order_arcsec"));
                Largest::default().within(error, first, far + number(tolerance, "TE_arcsec"), "first order");
                let what = format!("{file} {name} {key} at {phi}");
                largest.within(error, expected(&format!("{key}_arcsec")), number(tolerance, "TE_arcsec"), &what);
                let error_um = UM_PER_MM * touch.error_rad * moment.pitch.radius_mm[1];
                um.within(error_um, expected(&format!("{key}_um")), number(tolerance, "TE_um"), &what);
            }
            let play = Backlash::of(&pair, &moment);
            jams |= play.angle_rad < 0.0;
            largest.within(
                arcsec(play.angle_rad),
                expected("j_angle_arcsec"),
                2.0 * number(tolerance, "TE_arcsec"),
                &format!("{file} {name} j_angle"),
            );
            for (value_mm, key) in [
                (play.circumferential_mm, "j_c_um"),
                (play.tangential_mm, "j_t_um"),
                (play.normal_left_mm, "j_n_left_um"),
                (play.normal_right_mm, "j_n_right_um"),
            ] {
                um.within(
                    UM_PER_MM * value_mm,
                    expected(key),
                    number(tolerance, "j_um"),
                    &format!("{file} {name} {key}"),
                );
            }
        }
        assert_eq!(jams, case["interferes"] == true, "{file} {name}");
        for (errors, key) in errors.iter().zip(["TE_right", "TE_left"]) {
            let range = number(case, &format!("{key}_peak_to_peak_arcsec_on_this_grid"));
            largest.within(peak_to_peak(errors), range, 2.0 * number(tolerance, "TE_arcsec"), key);
        }
        println!("{file} {name}: {:.1e} arcsec, {:.1e} um", largest.0, um.0);
    }
}

#[test]
fn thinned_teeth_shift_the_ratio() {
    let file = data("p03_s0_thinned");
    check_cases("p03", &file["design"], &file["cases"]);
}

#[test]
fn a_wrong_centre_distance_is_felt() {
    let file = data("p04_s0_centre_distance");
    check_cases("p04", &file["design"], &file["cases"]);
}

#[test]
fn eccentric_gears_turn_unevenly() {
    let file = data("p05_s0_eccentric");
    check_cases("p05", &file["design"], &file["cases"]);
}

#[test]
fn an_internal_pair_with_errors() {
    let file = data("p09_s1_internal");
    check_cases("p09", &file["nominal"]["design"], &file["cases"]);
}

/// p01: closed forms of circular involutes, exact.
#[test]
fn circular_involutes_in_closed_form() {
    let file = data("p01_circular");
    for case in file["cases"].as_array().expect("cases") {
        let design = &case["design"];
        let pair = pair_of(design);
        let (mut largest, mut plays) = (Largest::default(), Largest::default());
        let meshing_of = |errors: &Value| meshing(&pair, addendum_mm(design), errors);
        assert!((pair.center_distance_mm() - number(design, "a_closing")).abs() < 1e-10);
        let angles: Vec<f64> = (0..40).map(|i| 0.0137 + 0.157 * f64::from(i)).collect();
        let mut check = |errors: &Value, expected: &dyn Fn(usize, f64) -> f64, angles: &[f64], tolerance: f64| {
            let meshing = meshing_of(errors);
            for (i, &phi) in angles.iter().enumerate() {
                let moment = meshing.at(phi).expect("flanks that touch");
                largest.within(arcsec(moment.right.error_rad), expected(i, phi), tolerance, &errors.to_string());
            }
        };
        let play = |errors: &Value| {
            // Half a pitch on, both sides touch far from their tips.
            let moment = meshing_of(errors).at(0.157).expect("flanks that touch");
            Backlash::of(&pair, &moment)
        };
        let distance = &case["centre_distance"];
        let tolerance = number(&distance["tolerance"], "TE_arcsec");
        for row in distance["rows"].as_array().expect("rows") {
            let expected = number(row, "TE_right_arcsec");
            let moved = json!({ "delta_a": row["delta_a"] });
            check(&moved, &|_, _| expected, &angles, tolerance);
            let play = play(&moved);
            plays.within(arcsec(play.angle_rad), number(row, "j_angle_arcsec"), 2.0 * tolerance, "j_angle");
            let um_at_pitch = number(row, "j_pitch_circle_um");
            plays.within(UM_PER_MM * play.circumferential_mm, um_at_pitch, 2e-4, "j on the pitch circle");
        }
        let eccentric = &case["eccentricity"];
        let expected = numbers(&eccentric["TE_right_arcsec"]);
        let tolerance = number(&eccentric["tolerance"], "TE_arcsec");
        check(eccentric, &|i, _| expected[i], &numbers(&eccentric["phi1"]), tolerance);
        let thinning = &case["thinning"];
        let found = play(thinning);
        plays.within(UM_PER_MM * found.circumferential_mm, number(thinning, "j_c_um"), 2e-4, "j_c");
        plays.within(UM_PER_MM * found.normal_right_mm, number(thinning, "j_n_um"), 2e-4, "j_n right");
        plays.within(UM_PER_MM * found.normal_left_mm, number(thinning, "j_n_um"), 2e-4, "j_n left");
        let expected = number(thinning, "TE_right_arcsec");
        check(thinning, &|_, _| expected, &angles, number(&thinning["tolerance"], "TE_arcsec"));
        println!("p01 internal {}: {:.1e} arcsec, play {:.1e}", design["internal"], largest.0, plays.0);
    }
}
