//! Contact ratios of the flanks that cutters generate: p02 outside, p09 in a ring, and what fewer teeth on a cutter
//! leave.

use super::*;
use crate::job::GearJob;
use crate::pair::contact_ratio::path_of_contact;
use crate::pair_job::fit::Fit;
use crate::pair_job::fit::SIDES;
use crate::pair_job::generated::{FlankEnds, flank_ends, limits};
use crate::pair_job::member;
use crate::process::shaping::ShapingJob;
use crate::scene::{Mate, Scene};
use gearcut_core::gear::GearKind;
use gearcut_core::terms::Side;

fn ends(scene: &Scene) -> FlankEnds {
    let mut ends = None;
    let show = &mut |gear: &dyn GearJob| {
        ends = Some(flank_ends(gear.cylindrical().expect("a cylindrical gear"))?);
        Ok(())
    };
    process::prepare(scene).expect("a job").with_gear(show).expect("flanks");
    ends.expect("a job shows its gear")
}

/// Largest difference of the contact ratios of generated flanks from those of a file, whose paths are longer by
/// `longer_mm`.
fn farthest(scenes: [&Scene; 2], addendum_mm: f64, expected: &Value, longer_mm: f64) -> f64 {
    let fit = Fit::new(scenes[0], scenes[1], 0).expect("they belong together");
    let limits = limits(&fit, &scenes.map(ends)).expect("flanks of a pair");
    let mut farthest = 0.0_f64;
    for (side, [a, b]) in SIDES.into_iter().zip(&limits) {
        let given = &expected[if side == Side::Right { "path_right" } else { "path_left" }];
        for (i, phi) in numbers(&expected["phi1"]).into_iter().enumerate() {
            let path = path_of_contact(&fit.pitch, &fit.pitch.at(phi), side, [addendum_mm; 2]).expect("tips");
            let mut generated = path.generated(side, [a, b], phi);
            generated.driven_tip_mm -= side.sign() * longer_mm;
            let ratio = generated.contact_ratio(&fit.pitch);
            farthest = farthest.max((ratio - numbers(&given["contact_ratio_generated"])[i]).abs());
        }
    }
    farthest
}

#[test]
fn contact_ends_where_the_cutters_flanks_end() {
    let file = data("p02_s0_nominal");
    let off = |cutter_teeth: u64| {
        let a = third_order(cutter_teeth, 4200, 0.0);
        let b = member::mate(&a, Mate { teeth: 42, kind: GearKind::External }, &[]).expect("a mate");
        farthest([&a.scene, &b.scene], 3.0, &file, 0.0)
    };
    let [same, fewer] = [20, 14].map(off);
    println!("p02: contact ratios of generated flanks within {same:.1e}; {fewer:.3} off with 14 teeth on the cutters");
    assert!(same < number(&file["tolerance"], "contact_ratio"), "{same}");
    // It can fail: a smaller cutter ends the flanks higher up.
    assert!(fewer > 0.01, "{fewer}");
}

#[test]
fn contact_in_a_ring_ends_where_its_cutter_relieves_the_tips() {
    let file = &data("p09_s1_internal")["nominal"];
    let scene = |name: &str, sets: &[&str]| {
        let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
        process::load(Path::new(&format!("scenes/shaping/{name}.toml")), &sets).unwrap_or_else(|e| panic!("{e}")).scene
    };
    let sharp = ["tool.shaper_cutter.teeth=20"];
    let [driver, ring] = [scene("internal_pair_driver", &sharp), scene("internal_pair_ring", &[])];
    // The file's cutter goes down to its base circle, gearcut's goes over into its tangent a little before it: by the
    // length of the involute's radius of curvature there, the path is shorter.
    let cutter = ShapingJob::new(ring.clone()).expect("the ring").target_generation().cutter.clone();
    let tooth = cutter.involute().expect("involute flanks");
    let longer_mm = tooth.base_radius_mm * tooth.roll_range[0];
    let off = farthest([&driver, &ring], 2.0, file, longer_mm);
    println!("p09: contact ratios of generated flanks within {off:.1e}, paths {longer_mm:.4} mm shorter");
    assert!(off < number(&file["tolerance"], "contact_ratio") && longer_mm < 0.03, "{off}, {longer_mm} mm");
}
