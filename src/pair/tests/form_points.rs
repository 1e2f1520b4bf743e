//! Form points against what the mate's tips ask for.

use super::sharp_cutter::needed_reach;
use super::*;
use crate::pair::contact_ratio::path_of_contact;

#[test]
fn tips_that_ask_for_contact_below_the_form_point() {
    let (file, internal) = (data("p10_interference"), data("p09_s1_internal"));
    let mut largest = Largest::default();
    for case in file["cases"].as_array().expect("cases").iter().chain([&internal["interference"]]) {
        let design = &case["design"];
        let pair = pair_of(design);
        let teeth = pair.teeth();
        let cutters = cutters(design);
        // The form point is where the flank turns back, or below it: none of these gears is undercut.
        let undercut = &case["undercut_gear1"];
        let sharpest = extremes(&pair, |at| at.curvature_per_mm[0])[1];
        let margin = |depth_mm: f64| 1.0 - sharpest[1] * depth_mm / teeth.pressure_angle_rad.sin();
        largest.within(margin(number(undercut, "limit")), 0.0, 1e-9, "limit of undercut");
        largest.within(pair.curvature_margin(Member::Driver, sharpest[0], 5.0), margin(5.0), 1e-12, "margin");
        assert_eq!(margin(number(undercut, "lambda_form")) < 0.0, undercut["undercut"] == true, "{}", case["name"]);
        for (member, gear) in [(Member::Driver, 1), (Member::Driven, 2)] {
            let cutter = cutters[gear - 1];
            let form_mm = cutter.form_reach_mm(teeth.module_mm, teeth.pressure_angle_rad);
            for (side, name) in SIDES {
                let expected = &case[format!("gear{gear}_{name}")];
                let what = format!("{} gear {gear} {name}", case["name"]);
                largest.within(form_mm, number(expected, "lambda_form"), 1e-7, &what);
                let needed = needed_reach(&pair, member, side, addendum_mm(design)).expect("tips");
                // The file looks every degree; the maximum lies between, a little higher.
                let at = pair.at(number(expected, "phi1_at_max"));
                let path = path_of_contact(&pair, &at, side, addendum_mm(design)).expect("tips");
                let there = if member == Member::Driver { path.driven_tip_mm } else { path.driver_tip_mm };
                let wanted = number(expected, "lambda_needed_max");
                largest.within(there.abs(), wanted, 1e-7, &what);
                assert!((wanted - 1e-9..wanted + 1e-3).contains(&needed.reach_mm), "{what}: {needed:?}");
                largest.within(form_mm - there.abs(), number(expected, "margin_min"), 1e-6, &what);
                // A ring's tips are relieved from the base point of their cutter on.
                let relieved = &case[format!("gear2_tip_{name}")];
                if member == Member::Driver && relieved.is_object() {
                    let base_mm = cutters[1].base_reach_mm(teeth.module_mm, teeth.pressure_angle_rad);
                    largest.within(base_mm, number(relieved, "lambda_base_of_cutter2"), 1e-7, &what);
                    largest.within(base_mm - there.abs(), number(relieved, "margin_min"), 1e-6, &what);
                    let margin_mm = number(expected, "margin_min_when_gear2_ends_at_its_cutter_base");
                    largest.within(form_mm - base_mm, margin_mm, 1e-6, &what);
                }
            }
        }
    }
    println!("p09 and p10 form points: {:.1e} mm", largest.0);
}
