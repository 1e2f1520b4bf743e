//! How deep the mate's tip corner stands in a fillet: p10, on the envelopes of flank and root.
//!
//! The file defines the depth as the smallest distance of the corner from the cutter over all of its poses. A sharp
//! corner of the cutter leaves its own path as the fillet, so that is the distance from this path, which is computed
//! here from the rolling circles alone. It confirms the file's values but one: for 20 teeth the file tells 5.784 um,
//! and in the file's own position its own corner is 5.647 um away from the path. The file's search over the poses has
//! stopped 35 microradians beside the nearest one. There the tolerance of the file holds for the depth as it defines
//! it.

use super::*;
use crate::job::GearJob;
use crate::pair::assembly::AssemblyErrors;
use crate::pair::flank_chain::FlankChain;
use crate::pair::penetration::SpaceOutline;
use crate::pair::pitch_pair::{Member, PitchPair};
use crate::pair::rolling::roll;
use crate::pair_job::corners::deepest;
use crate::pair_job::fit::Fit;
use crate::pair_job::flanks::{FlankSource, PairFlanks, made_ready};
use crate::pair_job::member;
use crate::pair_job::outline::{ToothOutline, joined};
use crate::scene::Mate;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::gear::GearKind;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;
use std::f64::consts::{PI, TAU};

/// The pair whose depth in the file is not the smallest over all poses, and by how much, um.
const STOPPED_SHORT: (&str, f64) = ("S0 z0=20", 0.137);
/// Sag of the chords between points of roots 5 um apart, and sampling of the positions, um.
const CHORDS_UM: f64 = 0.005;

/// Outline of the space before a tooth, of targets 5 um apart.
fn space(gear: &dyn GearJob, tooth: u32) -> SpaceOutline {
    let cylinder = gear.cylindrical().expect("a cylindrical gear");
    let root: Vec<DVec2> =
        cylinder.target_roots(tooth - 1, 0.005, &[0.0]).expect("a root")[0].iter().map(|(point, _)| *point).collect();
    let chain = |tooth: u32, side: Side| {
        let u_mm = cylinder.even_arcs_mm(tooth, side, 0.005).expect("a flank");
        let profiles = cylinder.target_profiles(tooth, side, &u_mm, &[0.0]).expect("a flank");
        let flank = ToothOutline { points_mm: profiles[0].iter().map(|(point, _)| *point).collect(), u_mm };
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

/// The round driver of the file.
fn round_driver() -> LoadedScene {
    parsed(
        "round_driver",
        "[gear]\nmodule_mm = 3.0\nteeth = 20\nface_width_mm = 20.0\n\
         [tool.shaper_cutter]\nteeth = 20\naddendum_coefficient = 1.25\n",
    )
}

#[test]
fn tip_corners_in_fillets() {
    let file = data("p10_interference");
    for case in file["cases"].as_array().expect("cases") {
        let design = &case["design"];
        let name = case["name"].as_str().expect("a name");
        let cutter_teeth = design["cutter1_z0"].as_u64().expect("a number of teeth");
        let a = if design["z1"] == 42 { third_order(cutter_teeth, 420, 0.0) } else { round_driver() };
        let teeth = design["z2"].as_u64().expect("a number of teeth") as u32;
        let b = member::mate(&a, Mate { teeth, kind: GearKind::External }, &[]).expect("a mate");
        let pair = Fit::new(&a.scene, &b.scene, 0).expect("they belong together").pitch;
        let expected = &case["tip2_into_fillet1"];
        // Teeth before the first one are those of the turn before.
        let before = expected["tooth"].as_i64().expect("a tooth") < 1;
        let turn = if before { a.scene.gear.teeth } else { 0 };
        let tooth = (expected["tooth"].as_i64().expect("a tooth") + i64::from(turn)) as u32;
        let file_rad = number(expected, "phi1") + if before { TAU } else { 0.0 };
        let crossing_mm = pair.crossing_mm(Side::Right, i64::from(tooth));
        let tip = pair.phi_at_tip(Member::Driven, Side::Right, crossing_mm, 3.0).expect("a tip");
        let corner = pair.flank_point(Member::Driven, Side::Right, crossing_mm, tip).point_mm;
        // In the driver's frame.
        let corner_at = |phi: f64| {
            let at = pair.at(phi);
            let machine = DVec2::from_angle(at.phi_2_rad).rotate(corner) + pair.axis_mm(Member::Driven);
            pair.gear_from_machine(&at, Member::Driver, machine)
        };
        let mut deepest_mm = f64::NEG_INFINITY;
        let show = &mut |gear: &dyn GearJob| {
            let space = space(gear, tooth);
            for i in -200..=200 {
                let found = space.corner(corner_at(file_rad + 2e-4 * f64::from(i))).expect("it stands in the space");
                deepest_mm = deepest_mm.max(found.depth_mm);
            }
            Ok(())
        };
        process::prepare(&a.scene).expect("a job").with_gear(show).expect("its gear");
        let depth_um = UM_PER_MM * deepest_mm;
        let (file_um, tolerance_um) = (number(expected, "penetration_um"), number(expected, "tolerance_um"));
        println!("p10 {name}: {depth_um:.3} um, the file {file_um:.3}");
        if file_um < tolerance_um {
            // A corner that stays clear touches the flank at the end of the path of contact: 0.
            assert!(depth_um.abs() <= tolerance_um, "{name}: {depth_um}");
            continue;
        }
        let defined_um = from_corner_path_um(&pair, cutter_teeth, tooth, file_rad, corner_at(file_rad));
        assert!((depth_um - defined_um).abs() < CHORDS_UM, "{name}: {depth_um}, as defined {defined_um}");
        let short_um = if name == STOPPED_SHORT.0 { STOPPED_SHORT.1 } else { 0.0 };
        assert!((file_um - defined_um - short_um).abs() < 0.1 * tolerance_um + CHORDS_UM, "{name}: {defined_um}");
        assert!((depth_um - (file_um - short_um)).abs() <= tolerance_um, "{name}: {depth_um}");
    }
}

/// The deepest place does not hang on the positions that are rolled: eight and twenty to a tooth find what 100 to a
/// tooth find, whose spacing alone leaves less than a hundredth of a micrometre.
#[test]
fn depths_are_followed_between_positions() {
    let a = third_order(20, 4200, 0.0);
    let b = member::mate(&a, Mate { teeth: 42, kind: GearKind::External }, &[]).expect("a mate");
    let fit = Fit::new(&a.scene, &b.scene, 0).expect("they belong together");
    let scenes = [&a.scene, &b.scene];
    let ready = made_ready(scenes, FlankSource::Cut).expect("gears that can be cut");
    let flanks = unwatched(|watch| PairFlanks::new(&fit, scenes, ready.as_ref(), 1, &Cpu::default(), watch));
    let flanks = flanks.expect("flanks");
    let meshing = flanks.meshing(&fit, &a.scene.gear, &AssemblyErrors::default());
    let found = [336, 840, 4200].map(|positions| {
        let moments = roll(&meshing, positions, || Ok(())).expect("a period").moments;
        unwatched(|watch| {
            let stage = watch.stage("tip corners", positions, "positions").expect("a stage");
            deepest(&flanks, &meshing, &moments, Member::Driver, &stage).expect("depths").expect("outlines")
        })
    });
    let um = found.map(|corner| UM_PER_MM * corner.depth_mm);
    println!("deepest corner {um:?} um by 336, 840 and 4,200 positions");
    assert!((um[0] - um[2]).abs() < 1e-5 && (um[1] - um[2]).abs() < 1e-5, "{um:?} um");
}
