//! The contact search against all pairs of points: every flank of the driver with every flank of the driven gear, no
//! windows, no bounds, no refinement.

use super::*;
use crate::pair::contact::{PairPose, probes, touch};
use crate::pair::flank_chain::PolarFlank;
use crate::pair::pitch_pair::ConjugatePoint;
use serde_json::json;
use std::f64::consts::TAU;

/// Largest push (right) over all segments of the driven gear's flanks and all points of the driver's.
fn brute(
    pair: &PitchPair,
    driver: &[Vec<glam::DVec2>],
    driven: &[Vec<glam::DVec2>],
    axis: glam::DVec2,
    phi: f64,
) -> f64 {
    let at = pair.at(phi);
    let turn = glam::DVec2::from_angle(-phi);
    let nominal = pair.sign() * at.phi_2_rad;
    // Pairs half a pitch off belong to the neighbouring tooth space.
    let window = 0.25 * pair.pitch_mm() / at.radius_mm[1];
    let mut most = f64::NEG_INFINITY;
    // Distances of the driven points from their axis, once for all points of the driver.
    let polar = |chain: &Vec<glam::DVec2>| chain.iter().map(|p| (p.length(), *p)).collect::<Vec<_>>();
    let driven: Vec<Vec<(f64, glam::DVec2)>> = driven.iter().map(polar).collect();
    for point in driver.iter().flatten() {
        let d = turn.rotate(*point) - axis;
        let radius = d.length();
        for chain in &driven {
            for segment in chain.windows(2) {
                let [(a, from), (b, to)] = [segment[0], segment[1]];
                if radius < a.min(b) || radius > a.max(b) {
                    continue;
                }
                let on = from.lerp(to, (radius - a) / (b - a));
                let error = d.to_angle() - on.to_angle() - nominal;
                let error = pair.sign() * (error - TAU * (error / TAU).round());
                if error.abs() < window {
                    most = most.max(error);
                }
            }
        }
    }
    most
}

#[test]
fn nothing_is_missed_at_twenty_positions() {
    let design = data("p02_s0_nominal")["design"].clone();
    let pair = pair_of(&design);
    let tips = addendum_mm(&design);
    // Form errors by tooth, up to 20 um, so that the pairs disagree and corners touch.
    let extra = |gear: i64| {
        move |side: Side, tooth: i64| {
            let mixed = (tooth * 7919 + gear * 104_729 + i64::from(side == Side::Left) * 31).rem_euclid(41);
            (mixed as f64 - 20.0) * 1e-3
        }
    };
    let driver = flank_chain::nominal(&pair, Member::Driver, tips, extra(1)).expect("flanks");
    let driven = flank_chain::nominal(&pair, Member::Driven, tips, extra(2)).expect("flanks");
    let errors = json!({ "delta_a": 0.05 });
    let mounting = AssemblyErrors { center_distance_error_mm: number(&errors, "delta_a"), ..AssemblyErrors::default() };
    let meshing = Meshing::new(pair.clone(), &driver, &driven, &mounting);
    let dense = |chains: &[FlankChain], steps: usize| -> Vec<Vec<glam::DVec2>> {
        let points = |c: &FlankChain| (0..=steps).map(|i| c.at(c.last() * i as f64 / steps as f64)).collect();
        chains.iter().map(points).collect()
    };
    let (all_driver, all_driven) = (dense(&driver.right, 400), dense(&driven.right, 400));
    let axis = glam::DVec2::new(pair.center_distance_mm() + 0.05, 0.0);
    let mut largest = 0.0_f64;
    for i in 0..20 {
        // Low-discrepancy positions over the turn.
        let phi = TAU * (0.618_033_988_75 * f64::from(i) + 0.123).fract();
        let found = meshing.at(phi).expect("flanks that touch");
        let all = brute(&pair, &near(&all_driver, axis, phi), &all_driven, axis, phi);
        let off_um = 1e3 * (found.right.error_rad - all) * found.pitch.radius_mm[1];
        // The brute force knows points 20 um apart: it finds less by a sag, or where a corner lies between, never more.
        assert!((-1e-4..0.5).contains(&off_um), "{off_um} um at {phi}: {:?}", found.right.acting);
        largest = largest.max(off_um.abs());
    }
    println!("brute force: {largest:.1e} um");
}

/// Only to save time: points farther from the driven axis than any of its tips can touch nothing.
fn near(chains: &[Vec<glam::DVec2>], axis: glam::DVec2, phi: f64) -> Vec<Vec<glam::DVec2>> {
    let axis = glam::DVec2::from_angle(phi).rotate(axis);
    let close = |p: &&glam::DVec2| p.distance(axis) < 80.0;
    chains.iter().map(|c| c.iter().filter(close).copied().collect()).collect()
}

/// Flanks with kinks touch at one of their points: that of all points which asks for most, however far they are off.
#[test]
fn points_without_an_angle_ask_for_less() {
    let design = data("p02_s0_nominal")["design"].clone();
    let pair = pair_of(&design);
    let tips = addendum_mm(&design);
    let wavy = |chain: &FlankChain| {
        let place = |i: usize| f64::from(i as u32) * chain.last() / 300.0;
        let wave = |i: usize| 1e-3 * glam::DVec2::from_angle(f64::from((i * i % 17) as u32));
        FlankChain::straight((0..=300).map(|i| chain.at(place(i)) + wave(i)).collect())
    };
    let [driver, driven] = [Member::Driver, Member::Driven].map(|of| thinned(&pair, of, tips, 0.05).each(wavy));
    let driven = driven.each(PolarFlank::new);
    let mut touches = 0;
    for i in 0..12_u32 {
        let at = pair.at(0.513 * f64::from(i));
        let stand = PairPose {
            phi_1_rad: at.phi_1_rad,
            axis_2_mm: pair.axis_mm(Member::Driven) + glam::DVec2::new(0.1 * f64::from(i % 3), 0.02),
            // Up to a whole turn off: what the flanks ask for goes round with it.
            phi_2_rad: at.phi_2_rad + TAU / 12.0 * f64::from(i),
            sign: 1.0,
        };
        let middle = (at.arc_mm / pair.pitch_mm()).round() as i64;
        for (side, tooth) in
            [Side::Left, Side::Right].into_iter().flat_map(|side| (-5..=5).map(move |k| (side, middle + k)))
        {
            let (driver, driven) = (driver.get(side, tooth), driven.get(side, tooth));
            let mut most = f64::NEG_INFINITY;
            probes(driver, driven, &stand, side, |probe| most = most.max(probe.push_rad));
            let found = touch(driver, driven, &stand, side).map_or(f64::NEG_INFINITY, |of| -side.sign() * of.error_rad);
            assert!(found == most, "{side:?} {tooth}, position {i}: {found}, and {most} of all points");
            touches += usize::from(found.is_finite());
        }
    }
    assert!(touches > 60, "{touches} pairs of flanks have radii in common");
}

#[test]
fn kinked_chains_touch_at_their_corners() {
    // A driver's flank with one crest of 1 um between two of its points, against the exact flank: the crest touches.
    let design = data("p02_s0_nominal")["design"].clone();
    let pair = pair_of(&design);
    let tips = addendum_mm(&design);
    let driven = flank_chain::nominal(&pair, Member::Driven, tips, |_, _| 0.0).expect("flanks");
    let at = pair.at(0.44);
    let crossing = pair.crossing_mm(Side::Right, 4);
    let crest = pair.flank_point(Member::Driver, Side::Right, crossing, at.phi_1_rad);
    let beside = |phi: f64| -> ConjugatePoint { pair.flank_point(Member::Driver, Side::Right, crossing, phi) };
    let points = vec![beside(0.43).point_mm, crest.point_mm + 1e-3 * crest.normal, beside(0.45).point_mm];
    let kinked = FlankChain::straight(points);
    let polar = PolarFlank::new(driven.get(Side::Right, 4));
    let stand = PairPose {
        phi_1_rad: at.phi_1_rad,
        axis_2_mm: pair.axis_mm(Member::Driven),
        phi_2_rad: at.phi_2_rad,
        sign: 1.0,
    };
    let touch = touch(&kinked, &polar, &stand, Side::Right).expect("a touch");
    let error_um = 1e3 * touch.error_rad * pair.arm_mm(&at, Side::Right);
    assert!((error_um - 1.0).abs() < 1e-3, "{error_um}");
}
