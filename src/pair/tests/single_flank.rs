//! One flank with extra material: which tooth carries, and where tip corners touch beside the path of contact.

use super::*;
use crate::pair::contact::TouchKind;
use crate::pair::contact_ratio::tooth_path;
use gearcut_core::units::UM_PER_MM;

/// Teeth beside the wrong one that may be in contact with it.
const TEETH_BESIDE: i64 = 3;

#[test]
fn errors_of_one_flank_and_corners_that_touch() {
    let file = data("p06_s0_form_pitch");
    let design = &file["design"];
    let pair = pair_of(design);
    let tips = addendum_mm(design);
    for case in file["cases"].as_array().expect("cases") {
        let name = case["name"].as_str().expect("a name");
        let wrong = case["tooth"].as_i64().expect("a tooth");
        let wrong_gear = if case["gear"] == 1 { Member::Driver } else { Member::Driven };
        let flanks = |member: Member| {
            let extra_mm = |side: Side, tooth: i64| {
                let here = member == wrong_gear && side == Side::Right && tooth == wrong;
                if here { number(case, "f_um") / UM_PER_MM } else { 0.0 }
            };
            flank_chain::nominal(&pair, member, tips, extra_mm).expect("flanks")
        };
        let meshing =
            Meshing::new(pair.clone(), &flanks(Member::Driver), &flanks(Member::Driven), &AssemblyErrors::default());
        let others: Vec<_> = (wrong - TEETH_BESIDE..=wrong + TEETH_BESIDE)
            .filter(|&tooth| tooth != wrong)
            .map(|tooth| tooth_path(&pair, Side::Right, tooth, tips).expect("tips"))
            .collect();
        let (mut inner, mut edge) = (Largest::default(), Largest::default());
        for (i, phi) in numbers(&case["phi1"]).into_iter().enumerate() {
            let moment = meshing.at(phi).expect("flanks that touch");
            let expected = numbers(&case["TE_arcsec"])[i];
            let kind = case["contact"][i].as_str().expect("a kind");
            if case["in_path"][i] == true && kind == "inner" {
                // The error over the lever of the line of action, away from the ends of the path.
                let closed = numbers(&case["closed_form_inside_path_arcsec"])[i];
                let far = number(case, "max_difference_from_closed_form_off_edges_arcsec");
                Largest::default().within(arcsec(moment.right.error_rad), closed, far + 0.002, name);
            }
            let in_contact =
                others.iter().filter(|path| (path.phi_at_driven_tip_rad..path.phi_at_driver_tip_rad).contains(&phi));
            assert_eq!(in_contact.count() as u64, case["other_pairs_in_contact"][i].as_u64().expect("a number"));
            let what = format!("{name} at {phi}: {kind}, {:?}", moment.right.acting);
            let error = arcsec(moment.right.error_rad);
            if kind == "inner" {
                inner.within(error, expected, number(&case["tolerance"], "TE_arcsec"), &what);
            } else {
                edge.within(error, expected, 0.05, &what);
                let corner = if kind == "tip1" { TouchKind::DriverTip } else { TouchKind::DrivenTip };
                assert_eq!(moment.right.acting.touch.kind, corner, "{what}");
            }
            // Where only one pair carries the error, it is the one of the file; several agree where there is none.
            if expected.abs() > 0.01 {
                assert_eq!(moment.right.acting.tooth, case["acting_tooth"][i].as_i64().expect("a tooth"), "{what}");
            }
        }
        if wrong_gear == Member::Driver {
            let path = tooth_path(&pair, Side::Right, wrong, tips).expect("tips");
            for (angle, given) in [path.phi_at_driven_tip_rad, path.phi_at_driver_tip_rad]
                .into_iter()
                .zip(numbers(&case["path_of_this_tooth"]))
            {
                Largest::default().within(angle, given, 1e-8, "path of the tooth");
            }
        }
        println!("p06 {name}: flank {:.1e} arcsec, corner {:.1e} arcsec", inner.0, edge.0);
    }
}
