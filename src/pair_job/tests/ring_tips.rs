//! Tips of a pinion that come into its ring far from the line of centres, on nominal flanks: trochoidal interference
//! against its closed form.

use super::*;
use crate::pair::assembly::AssemblyErrors;
use crate::pair::penetration::SpaceOutline;
use crate::pair::pitch_pair::Member;
use crate::pair_job::corners::deepest;
use crate::pair_job::fit::Fit;
use crate::pair_job::flanks::PairFlanks;
use gearcut_core::cut::cpu::Cpu;
use std::f64::consts::TAU;

const MODULE_MM: f64 = 3.0;
const RING_TEETH: u32 = 40;
/// Positions in a pitch: all teeth are alike, and each is somewhere on its way.
const POSITIONS: usize = 24;
/// Chords of a flank, and places of the closed form, mm.
const EXACT_MM: f64 = 3e-5;

/// How deep the pinion's tips are in the ring's teeth, mm; negative where they stay clear.
fn found_mm(teeth: u32) -> f64 {
    let a = round("a", teeth, "", "");
    let b = round("b", RING_TEETH, "kind = \"internal\"\nrim_mm = 20.0\n", "");
    let fit = Fit::new(&a.scene, &b.scene, 0).expect("they belong together");
    unwatched(|watch| {
        let scenes = [&a.scene, &b.scene];
        let mut flanks = PairFlanks::new(&fit, scenes, None, 1, &Cpu::default(), watch).expect("flanks");
        // Nominal flanks have no fillets: a chord closes the space below both.
        let ring = &mut flanks.sections[0][1];
        let spaces = ring.chains.right.iter().zip(&ring.chains.left);
        ring.spaces = spaces.map(|(first, second)| SpaceOutline::new(first, second, -1.0)).collect();
        ring.right_is_first = true;
        let meshing = flanks.meshing(&fit, &a.scene.gear, &AssemblyErrors::default());
        let pitch_rad = TAU / f64::from(teeth);
        let at = |i: usize| meshing.at(pitch_rad * i as f64 / POSITIONS as f64).expect("a moment");
        let moments: Vec<_> = (0..POSITIONS).map(at).collect();
        let stage = watch.stage("corners", POSITIONS, "positions").expect("a stage");
        let found = deepest(&flanks, &meshing, &moments, Member::Driven, &stage).expect("corners");
        found.expect("spaces").depth_mm
    })
}

/// The angle in the ring from its flank to the tip corner of the pinion at `theta_1` from the line of
/// centres, (z1/z2) (theta_1 + inv alpha_a1 - inv alpha) + inv alpha - inv alpha_rho - theta_2, times the base radius:
/// the distance of both, for involutes of one base circle are parallel (Maitra, *Handbook of Gear Design*, 1994, ch.
/// 2). Below 0 the corner is in the material, at most as deep as it is below the ring's tips. Also the value at the
/// ring's tips.
fn closed_form_mm(teeth: u32) -> (f64, f64) {
    let alpha = 20_f64.to_radians();
    let involute = |cos: f64| cos.acos().tan() - cos.acos();
    let [z1, z2] = [teeth, RING_TEETH].map(f64::from);
    let [r1, r2] = [0.5 * MODULE_MM * z1, 0.5 * MODULE_MM * z2];
    let (a, tip_1, tip_2, base_2) = (r2 - r1, r1 + MODULE_MM, r2 - MODULE_MM, r2 * alpha.cos());
    let own = involute(r1 * alpha.cos() / tip_1);
    let gap_mm = |rho: f64| {
        let theta_1 = ((rho * rho - a * a - tip_1 * tip_1) / (2.0 * a * tip_1)).acos();
        let theta_2 = ((rho * rho + a * a - tip_1 * tip_1) / (2.0 * a * rho)).acos();
        let nominal = involute(alpha.cos());
        base_2 * (z1 / z2 * (theta_1 + own - nominal) + nominal - involute(base_2 / rho) - theta_2)
    };
    let places = 100_000;
    let rho = |i: i32| tip_2 + (a + tip_1 - tip_2) * f64::from(i) / f64::from(places);
    let depth_mm = |i| (-gap_mm(rho(i))).min(rho(i) - tip_2);
    (gap_mm(tip_2), (0..places).map(depth_mm).fold(f64::NEG_INFINITY, f64::max))
}

#[test]
fn tips_meet_a_ring_of_few_more_teeth_where_the_closed_form_changes_its_sign() {
    for teeth in [24, 30, 31, 33, 34, 35] {
        let (at_tips_mm, depth_mm) = closed_form_mm(teeth);
        let found_mm = found_mm(teeth);
        println!("{teeth}: {at_tips_mm:.6} {depth_mm:.6} {found_mm:.6}");
        assert_eq!(at_tips_mm < 0.0, teeth > 31, "{teeth}: {at_tips_mm} mm");
        if at_tips_mm > 0.0 {
            assert!(found_mm < EXACT_MM, "{teeth}: {found_mm} mm deep, and {at_tips_mm} mm clear by the closed form");
        } else {
            assert!((found_mm - depth_mm).abs() < EXACT_MM, "{teeth}: {found_mm} mm deep, {depth_mm} mm expected");
        }
    }
}
