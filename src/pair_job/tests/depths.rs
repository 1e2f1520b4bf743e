//! How deep the mate's tip corner stands in a fillet: p10, on the envelopes of flank and root.

use super::*;
use crate::job::GearJob;
use crate::pair::flank_chain::FlankChain;
use crate::pair::penetration::SpaceOutline;
use crate::pair::pitch_pair::Member;
use crate::pair_job::fit::Fit;
use crate::pair_job::member;
use crate::pair_job::outline::{Profile, joined};
use crate::scene::Mate;
use gearcut_core::gear::GearKind;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;

/// Outline of the space before a tooth, of targets 5 um apart.
fn space(gear: &dyn GearJob, tooth: u32) -> SpaceOutline {
    let cylinder = gear.cylindrical().expect("a cylindrical gear");
    let root: Vec<DVec2> =
        cylinder.target_roots(tooth - 1, 0.005, &[0.0]).expect("a root")[0].iter().map(|(point, _)| *point).collect();
    let chain = |tooth: u32, side: Side| {
        let (u_mm, profiles) = cylinder.target_profiles(tooth, side, 0.005, &[0.0]).expect("a flank");
        let flank = Profile { points_mm: profiles[0].iter().map(|(point, _)| *point).collect(), u_mm };
        FlankChain::straight(joined(&root, side, &flank).points_mm)
    };
    SpaceOutline::new(&chain(tooth - 1, Side::Left), &chain(tooth, Side::Right), 1.0)
}

#[test]
fn tip_corners_in_fillets() {
    let file = data("p10_interference");
    for case in file["cases"].as_array().expect("cases") {
        let design = &case["design"];
        // The round pair of the file has no fillet to stand in; its form points are tested with the mechanics.
        if design["z1"] != 42 {
            continue;
        }
        let a = third_order(design["cutter1_z0"].as_u64().expect("a number of teeth"), 420, 0.0);
        let b = member::mate(&a, Mate { teeth: 42, kind: GearKind::External }, &[]).expect("a mate");
        let pair = Fit::new(&a.scene, &b.scene, 0).expect("they belong together").pitch;
        let expected = &case["tip2_into_fillet1"];
        let tooth = expected["tooth"].as_u64().expect("a tooth") as u32;
        let mut depth_um = f64::NEG_INFINITY;
        let show = &mut |gear: &dyn GearJob| {
            let space = space(gear, tooth);
            let crossing_mm = pair.crossing_mm(Side::Right, i64::from(tooth));
            let tip = pair.phi_at_tip(Member::Driven, Side::Right, crossing_mm, 3.0).expect("a tip");
            let corner = pair.flank_point(Member::Driven, Side::Right, crossing_mm, tip).point_mm;
            let middle = number(expected, "phi1");
            for i in -200..=200 {
                let at = pair.at(middle + 2e-4 * f64::from(i));
                let machine = DVec2::from_angle(at.phi_2_rad).rotate(corner) + pair.axis_mm(Member::Driven);
                let own = pair.gear_from_machine(&at, Member::Driver, machine);
                let found = space.corner(own).expect("the corner stands in the space");
                depth_um = depth_um.max(UM_PER_MM * found.depth_mm);
            }
            Ok(())
        };
        process::prepare(&a.scene).expect("a job").with_gear(show).expect("its gear");
        let (wanted, tolerance) = (number(expected, "penetration_um"), number(expected, "tolerance_um"));
        println!("p10 {}: {depth_um:.3} um, expected {wanted:.3}", case["name"]);
        // A corner that stays clear touches the flank at the end of the path of contact: 0.
        assert!((depth_um - wanted.max(0.0)).abs() <= tolerance, "{}: {depth_um}, {wanted}", case["name"]);
    }
}
