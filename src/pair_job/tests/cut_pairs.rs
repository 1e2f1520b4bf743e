//! Whole pairs of cut gears: round ones outside and in a ring in closed form, the third-order one against the file of
//! thinned teeth, and the contact search against all pairs of points.

use super::*;
use crate::pair::assembly::{Meshing, Mounting};
use crate::pair::backlash::Backlash;
use crate::pair::rolling::peak_to_peak;
use crate::pair_job::findings::ARCSEC_PER_RAD;
use crate::pair_job::fit::Fit;
use crate::pair_job::flanks::{FlankSource, PairFlanks};
use crate::pair_job::member;
use crate::pair_job::options::PairOptions;
use crate::pair_job::rolled::roll_pair;
use crate::scene::Mate;
use gearcut_core::gear::GearKind;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;
use std::f64::consts::TAU;

/// Scallops of 200 strokes a tooth are 0.02 um high at most, and dexels 10 um apart cut their crests off.
const SCALLOPS_UM: f64 = 0.05;
const THINNED: &str = "tooth_thickness_allowance_mm = -0.05\n";

/// Round involutes: no transmission error, backlash of twice the thinning on the pitch circles.
#[test]
fn round_gears_turn_evenly_outside_and_in_a_ring() {
    for (kind, teeth) in [("", 27), ("kind = \"internal\"\nrim_mm = 10.0\n", 54)] {
        let (a, b) = (round("a", 18, "", THINNED), round("b", teeth, kind, THINNED));
        let options = PairOptions { positions: Some(18 * 3 * 12), ..PairOptions::default() };
        let rolled = roll_pair([&a.scene, &b.scene], &options).expect("a pair");
        let radius_mm = 1.5 * f64::from(teeth);
        for error in &rolled.errors {
            let um = UM_PER_MM * radius_mm * peak_to_peak(&error.total_rad);
            assert!(um < SCALLOPS_UM, "{teeth} teeth: {um} um");
        }
        for play in &rolled.backlash {
            let um = UM_PER_MM * play.circumferential_mm;
            assert!((um - 100.0).abs() < 0.1, "{teeth} teeth: {um} um");
        }
        // Double-flank: play of 0.1 mm closes when the axes move by 0.1 / (2 tan 20 deg), to first order.
        let moved = rolled.fit.pitch.sign() * rolled.tight.mean_um();
        assert!((moved + 100.0 / (2.0 * 20_f64.to_radians().tan())).abs() < 1.0, "{moved} um");
        println!("{teeth} teeth: {:.3} um tight", rolled.tight.total_um());
        assert!(rolled.tight.total_um() < 0.3, "{} um", rolled.tight.total_um());
    }
}

/// The third-order pair, both gears cut; the cutter is large enough that no tip meets a fillet.
fn third_order_pair(allowance_mm: f64) -> (Fit, PairFlanks, Meshing) {
    let a = third_order(30, 4200, allowance_mm);
    let b = member::mate(&a, Mate { teeth: 42, kind: GearKind::External }, &[]).expect("a mate");
    let fit = Fit::new(&a.scene, &b.scene, 0).expect("they belong together");
    let flanks = PairFlanks::new(&fit, [&a.scene, &b.scene], FlankSource::Cut, 1).expect("flanks");
    let meshing = flanks.meshing(&fit, &a.scene.gear, &Mounting::default()).expect("gears that roll");
    (fit, flanks, meshing)
}

#[test]
fn the_third_order_pair_as_cut() {
    let file = data("p03_s0_thinned");
    let case = file["cases"]
        .as_array()
        .expect("cases")
        .iter()
        .find(|case| number(&case["errors"], "thin1") == number(&case["errors"], "thin2"));
    let case = case.expect("both gears thinned alike");
    let (fit, _, meshing) = third_order_pair(-number(&case["errors"], "thin1"));
    let mut largest = [0.0_f64; 2];
    for (i, phi) in numbers(&case["phi1"]).into_iter().enumerate() {
        let moment = meshing.at(phi).expect("flanks that touch");
        for (side, key) in [(Side::Right, "TE_right_arcsec"), (Side::Left, "TE_left_arcsec")] {
            let off_rad = moment.side(side).error_rad - numbers(&case[key])[i] / ARCSEC_PER_RAD;
            let um = UM_PER_MM * off_rad * moment.pitch.radius_mm[1];
            largest[0] = largest[0].max(um.abs());
        }
        let play_um = UM_PER_MM * Backlash::of(&fit.pitch, &moment).circumferential_mm;
        largest[1] = largest[1].max((play_um - numbers(&case["j_c_um"])[i]).abs());
    }
    println!("p03 as cut: {:.3} um, play {:.3} um", largest[0], largest[1]);
    assert!(largest[0] < 0.3 && largest[1] < 0.3, "{largest:?}");
    brute_force(&meshing);
}

/// All points of all flanks of the driver against all segments of all flanks of the driven gear.
fn brute_force(meshing: &Meshing) {
    let section = &meshing.sections[0];
    let mut largest = 0.0_f64;
    for i in 0..20 {
        let phi = TAU * (0.618_033_988_75 * f64::from(i) + 0.123).fract();
        let pitch = meshing.pitch.at(phi);
        let stand = meshing.stand(&pitch, section, 0.0);
        let window = 0.25 * meshing.pitch.pitch_mm() / pitch.radius_mm[1];
        let tip_mm = section.driven.right.iter().map(|flank| flank.range_mm()[1]).fold(0.0, f64::max);
        let mut most = f64::NEG_INFINITY;
        for chain in &section.driver.right {
            for point in &chain.points_mm {
                let d = DVec2::from_angle(-phi).rotate(*point) - stand.axis_2_mm;
                // Only to save time: what is farther away than any tip touches nothing.
                if d.length() > tip_mm {
                    continue;
                }
                for flank in &section.driven.right {
                    let Some(angle) = flank.angle_rad(d.length()) else { continue };
                    let error = d.to_angle() - angle - pitch.phi_2_rad;
                    let error = error - TAU * (error / TAU).round();
                    if error.abs() < window {
                        most = most.max(error);
                    }
                }
            }
        }
        let found = meshing.side(&pitch, Side::Right, 0.0).expect("a touch");
        let off_um = UM_PER_MM * (found.error_rad - most) * pitch.radius_mm[1];
        // Points of the driver alone miss touches between them, by the sag of a chord: the search finds no less.
        assert!((-1e-6..0.02).contains(&off_um), "{off_um} um at {phi}: {:?}", found.acting);
        largest = largest.max(off_um.abs());
    }
    println!("brute force on cut flanks: {largest:.1e} um");
}
