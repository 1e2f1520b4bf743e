//! How deep the mate's tip corner stands in a fillet: p10, on the envelopes of flank and root.
//!
//! A sharp corner of the cutter leaves its own path as the fillet, so the depth is the distance from that path, which
//! is computed here from the rolling circles alone. The file's own value agrees for 14 teeth; for 20 teeth it lies
//! 0.135 um above the path, because it is the smallest of sampled poses.

use super::*;
use crate::job::GearJob;
use crate::pair::flank_chain::FlankChain;
use crate::pair::penetration::SpaceOutline;
use crate::pair::pitch_pair::{Member, PitchPair};
use crate::pair_job::fit::Fit;
use crate::pair_job::member;
use crate::pair_job::outline::{Profile, joined};
use crate::scene::Mate;
use gearcut_core::gear::GearKind;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;
use std::f64::consts::PI;

/// What sampled poses add to the file's depths, um.
const SAMPLED_UM: f64 = 0.15;

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

/// Distance of a point of the driver from the path of the cutter's corner that cuts the fillet of a tooth's right
/// flank: r_c rolls on the pitch curve; the corner stands at r_a, half a tooth pi / (2 z) + inv alpha - inv alpha_a
/// beside it.
fn from_corner_path_um(pair: &PitchPair, cutter_teeth: u64, tooth: u32, phi: f64, point: DVec2) -> f64 {
    let alpha = pair.teeth().pressure_angle_rad;
    let inv = |angle: f64| angle.tan() - angle;
    let r_c = 1.5 * cutter_teeth as f64;
    let r_a = r_c + 1.25 * 3.0;
    let half = PI / (2.0 * cutter_teeth as f64) + inv(alpha) - inv((r_c * alpha.cos() / r_a).acos());
    let corner = |phi: f64| {
        let frame = pair.curve().frame(phi);
        let rolled = (pair.curve().arc_mm(phi) - f64::from(tooth - 1) * pair.pitch_mm()) / r_c;
        let towards = -frame.normal * rolled.cos() - frame.tangent * rolled.sin();
        frame.point_mm + r_c * frame.normal + r_a * DVec2::from_angle(-half).rotate(towards)
    };
    let path: Vec<DVec2> = (0..=8000).map(|i| corner(phi - 0.2 + 5e-5 * f64::from(i))).collect();
    let distance = |side: &[DVec2]| {
        let along = side[1] - side[0];
        let share = ((point - side[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        (point - side[0] - share * along).length()
    };
    UM_PER_MM * path.windows(2).map(distance).fold(f64::INFINITY, f64::min)
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
        let cutter_teeth = design["cutter1_z0"].as_u64().expect("a number of teeth");
        let a = third_order(cutter_teeth, 420, 0.0);
        let b = member::mate(&a, Mate { teeth: 42, kind: GearKind::External }, &[]).expect("a mate");
        let pair = Fit::new(&a.scene, &b.scene, 0).expect("they belong together").pitch;
        let expected = &case["tip2_into_fillet1"];
        let tooth = expected["tooth"].as_u64().expect("a tooth") as u32;
        let mut deepest = (f64::NEG_INFINITY, 0.0, DVec2::ZERO);
        let show = &mut |gear: &dyn GearJob| {
            let space = space(gear, tooth);
            let crossing_mm = pair.crossing_mm(Side::Right, i64::from(tooth));
            let tip = pair.phi_at_tip(Member::Driven, Side::Right, crossing_mm, 3.0).expect("a tip");
            let corner = pair.flank_point(Member::Driven, Side::Right, crossing_mm, tip).point_mm;
            for i in -200..=200 {
                let at = pair.at(number(expected, "phi1") + 2e-4 * f64::from(i));
                let machine = DVec2::from_angle(at.phi_2_rad).rotate(corner) + pair.axis_mm(Member::Driven);
                let own = pair.gear_from_machine(&at, Member::Driver, machine);
                let found = space.corner(own).expect("the corner stands in the space");
                if found.depth_mm > deepest.0 {
                    deepest = (found.depth_mm, at.phi_1_rad, own);
                }
            }
            Ok(())
        };
        process::prepare(&a.scene).expect("a job").with_gear(show).expect("its gear");
        let depth_um = UM_PER_MM * deepest.0;
        let wanted_um = number(expected, "penetration_um");
        println!("p10 {}: {depth_um:.3} um, the file {wanted_um:.3}", case["name"]);
        // A corner that stays clear touches the flank at the end of the path of contact: 0.
        assert!(depth_um - wanted_um.max(0.0) <= number(expected, "tolerance_um"), "{depth_um}, {wanted_um}");
        assert!(wanted_um - depth_um <= SAMPLED_UM, "{depth_um}, {wanted_um}");
        if wanted_um > 1.0 {
            let path_um = from_corner_path_um(&pair, cutter_teeth, tooth, deepest.1, deepest.2);
            assert!((depth_um - path_um).abs() < 0.005, "{}: {depth_um}, from the path {path_um}", case["name"]);
        }
    }
}
