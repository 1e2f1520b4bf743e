//! Whole pairs of cut gears: round ones outside and in a ring in closed form, the third-order one against the file of
//! thinned teeth, and the contact search against all pairs of points.

use super::*;
use crate::pair::assembly::{AssemblyErrors, Meshing};
use crate::pair::backlash::Backlash;
use crate::pair::rolling::peak_to_peak;
use crate::pair_job::findings::ARCSEC_PER_RAD;
use crate::pair_job::fit::Fit;
use crate::pair_job::flanks::{FlankSource, PairFlanks, made_ready};
use crate::pair_job::member;
use crate::pair_job::options::PairOptions;
use crate::pair_job::rolled::roll_pair;
use crate::scene::Mate;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::gear::GearKind;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;
use std::f64::consts::TAU;

/// Scallops of 300 strokes a tooth are some 0.02 um high where the involute begins, and less above.
const SCALLOPS_UM: f64 = 0.05;
const THINNED: &str = "tooth_thickness_allowance_mm = -0.05\n";
/// Of both gears of a pair, um.
const THINNED_UM: f64 = 100.0;

/// Round involutes: no transmission error, and the thinning of both gears as backlash on the pitch circles.
#[test]
fn round_gears_turn_evenly_outside_and_in_a_ring() {
    for (kind, teeth) in [("", 36), ("kind = \"internal\"\nrim_mm = 10.0\n", 54)] {
        let (a, b) = (round("a", 18, "", THINNED), round("b", teeth, kind, THINNED));
        let options = PairOptions { positions: Some(18 * 3 * 8), ..PairOptions::default() };
        let rolled =
            unwatched(|watch| roll_pair([&a.scene, &b.scene], &options, &Cpu::default(), watch)).expect("a pair");
        let radius_mm = 1.5 * f64::from(teeth);
        let tip_sign = rolled.fit.pitch.sign();
        for error in &rolled.errors {
            let um = UM_PER_MM * radius_mm * peak_to_peak(&error.total_rad);
            assert!(um < SCALLOPS_UM, "{teeth} teeth: {um} um");
        }
        for play in &rolled.backlash {
            let um = UM_PER_MM * play.circumferential_mm;
            assert!((um - THINNED_UM).abs() < 0.1, "{teeth} teeth: {um} um, {THINNED_UM} expected");
        }
        // Double-flank: the play j closes when the axes move by j / (2 tan 20 deg), to first order.
        let tight = rolled.tight.as_ref().expect("a tight mesh");
        let moved = tip_sign * tight.mean_um();
        let expected = -THINNED_UM / (2.0 * 20_f64.to_radians().tan());
        assert!((moved / expected - 1.0).abs() < 0.01, "{moved} um, {expected} expected");
        println!("{teeth} teeth: {:.3} um tight", tight.total_um());
        assert!(tight.total_um() < 0.3, "{} um", tight.total_um());
    }
}

/// Both gears cut; the cutter is large enough that no tip meets a fillet.
#[test]
fn the_third_order_pair_as_cut() {
    let a = third_order(30, 4200, 0.0);
    let b = member::mate(&a, Mate { teeth: 42, kind: GearKind::External }, &[]).expect("a mate");
    let fit = Fit::new(&a.scene, &b.scene, 0).expect("they belong together");
    let scenes = [&a.scene, &b.scene];
    let ready = made_ready(scenes, FlankSource::Cut).expect("gears that can be cut");
    let flanks = unwatched(|watch| PairFlanks::new(&fit, scenes, ready.as_ref(), 1, &Cpu::default(), watch));
    let flanks = flanks.expect("flanks");
    let mut play_was_mm = 0.0;
    for case in data("p04_s0_centre_distance")["cases"].as_array().expect("cases") {
        // Teeth that are thinned as well stand in the file of thinned teeth.
        if case["errors"].as_object().expect("errors").len() > 1 {
            continue;
        }
        let center_distance_error_mm = number(&case["errors"], "delta_a");
        let mounting = AssemblyErrors { center_distance_error_mm, ..AssemblyErrors::default() };
        let meshing = flanks.meshing(&fit, &a.scene.gear, &mounting);
        let mut largest = [0.0_f64; 2];
        for (i, phi) in numbers(&case["phi1"]).into_iter().enumerate() {
            let moment = meshing.at(phi).expect("flanks that touch");
            for (side, key) in [(Side::Right, "TE_right_arcsec"), (Side::Left, "TE_left_arcsec")] {
                let off_rad = moment.side(side).error_rad - numbers(&case[key])[i] / ARCSEC_PER_RAD;
                largest[0] = largest[0].max((UM_PER_MM * off_rad * moment.pitch.radius_mm[1]).abs());
            }
            let play_mm = Backlash::of(&fit.pitch, &moment).circumferential_mm;
            largest[1] = largest[1].max((UM_PER_MM * play_mm - numbers(&case["j_c_um"])[i]).abs());
            if i == 0 {
                assert!(play_mm > play_was_mm, "play grows with the distance: this comparison can fail");
                play_was_mm = play_mm;
            }
        }
        println!("p04 {} as cut: {:.3} um, play {:.3} um", case["name"], largest[0], largest[1]);
        assert!(largest[0] < 0.3 && largest[1] < 0.3, "{largest:?}");
        brute_force(&meshing);
    }
}

/// All points of all flanks of either gear against all segments of all flanks of the other, at 20 positions.
fn brute_force(meshing: &Meshing) {
    let section = &meshing.sections[0];
    let mut largest = 0.0_f64;
    for i in 0..20 {
        let phi = TAU * (0.618_033_988_75 * f64::from(i) + 0.123).fract();
        let pitch = meshing.pitch.at(phi);
        let stand = meshing.stand(&pitch, section, 0.0);
        let window = 0.25 * meshing.pitch.pitch_mm() / pitch.radius_mm[1];
        let tip_mm = section.driven.right.iter().map(|flank| flank.runs[0].range_mm()[1]).fold(0.0, f64::max);
        let mut most = f64::NEG_INFINITY;
        let mut offer = |d: DVec2, angle: f64| {
            let error = d.to_angle() - angle - pitch.phi_2_rad;
            let error = error - TAU * (error / TAU).round();
            // Pairs half a pitch off belong to the neighbouring space.
            if error.abs() < window && error > most {
                most = error;
            }
        };
        for chain in &section.driver.right {
            let seen: Vec<DVec2> =
                chain.points_mm.iter().map(|p| DVec2::from_angle(-phi).rotate(*p) - stand.axis_2_mm).collect();
            for side in seen.windows(2) {
                let (a, b) = (side[0].length(), side[1].length());
                // Only to save time: what is farther away than any tip touches nothing.
                if a.min(b) > tip_mm {
                    continue;
                }
                for flank in &section.driven.right {
                    let [flank] = flank.runs.as_slice() else { panic!("these flanks do not turn back") };
                    for (d, radius) in [(side[0], a), (side[1], b)] {
                        if let Some(angle) = flank.angle_rad(radius) {
                            offer(d, angle);
                        }
                    }
                    let first = flank.radii_mm.partition_point(|r| *r < a.min(b));
                    for (k, r) in flank.radii_mm.iter().enumerate().skip(first).take_while(|(_, r)| **r <= a.max(b)) {
                        offer(side[0].lerp(side[1], (r - a) / (b - a)), flank.angle_of_point(k));
                    }
                }
            }
        }
        let found = meshing.side(&pitch, Side::Right, 0.0).expect("a touch");
        let off_um = UM_PER_MM * (found.error_rad - most) * pitch.radius_mm[1];
        assert!(off_um.abs() < 1e-6, "{off_um} um at {phi}: {:?}", found.acting);
        largest = largest.max(off_um.abs());
    }
    println!("brute force on cut flanks: {largest:.1e} um");
}
