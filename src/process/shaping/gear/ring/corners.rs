//! The path of the cutter's tip corners into a space of the ring and out of it.
//!
//! In: the finishing linkage, the rounds at the cutter's tip, or places of a drawn one, the target's outline. Out: for
//! every space of a period, and for both paths, the smallest distance of a corner from the teeth. Law: a corner goes in
//! and out of its space past the tips of the teeth beside it. Inside it touches the fillet that it makes; the clearance
//! is the smallest distance from where it has left the blank's outline on. Where its path runs through material, it
//! cuts there what no envelope of the flanks has shaped, and the clearance is minus the depth.

use crate::drawn_tooth::{DrawnPart, DrawnTooth, PartLaw};
use crate::measure::damage::LEAST_DEPTH_MM;
use crate::measure::target_outline::TargetOutline;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::tool::involute_tooth::CornerPart;
use gearcut_core::tool::edge::SegmentName;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Places of a tip corner's path per pitch.
const PLACES_PER_PITCH: i32 = 64;
/// A corner is looked for this far from the teeth, in modules: more than half of a space at the tips.
const FARTHEST_MODULES: f64 = 2.0;

/// Arcs of a drawn tooth whose radius is smaller are rounds of its tip corners, modules: those of flanks are larger.
const LARGEST_ROUND_MODULES: f64 = 0.6;
/// Turn between two places of such a round, rad: chords of a round of a fifth of a module are within 0.3 thousandths of
/// a module of it.
const PLACE_RAD: f64 = 0.105;

/// The tightest place of a corner's path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerPath {
    /// Smallest distance from the teeth, mm; minus the depth where it cuts into them.
    pub clearance_mm: f64,
    /// Polar angle of the pitch point then, rad.
    pub phi_rad: f64,
}

/// A round at the cutter's tip in the tooth's frame: centre and radius, mm.
pub(super) type Round = (DVec2, f64);

/// The rounds at both corners of a cutter tooth; of a drawn one places of its edge, as rounds of no radius.
pub(super) fn tip_rounds(job: &ShapingJob) -> Vec<Round> {
    if let Some(drawn) = job.cutter.drawn() {
        return drawn_corners_mm(drawn, LARGEST_ROUND_MODULES * job.transverse.module_mm);
    }
    let corner = job.cutter.involute().map_or(&[][..], |tooth| &tooth.corner);
    let own = corner.iter().filter_map(|part| match *part {
        CornerPart::Round { center_mm, radius_mm, .. } => Some((center_mm, radius_mm)),
        CornerPart::Chamfer { .. } => None,
    });
    own.flat_map(|(at, radius)| [(at, radius), (DVec2::new(at.x, -at.y), radius)]).collect()
}

/// Places of the arcs beside the tip that are rounder than a flank, up to the first part on either side that is not.
fn drawn_corners_mm(tooth: &DrawnTooth, largest_mm: f64) -> Vec<Round> {
    use SegmentName::{CornerLeft, CornerRight};
    let is_round = |part: &&DrawnPart| match part.law {
        PartLaw::Turn { radius_mm, .. } => (0.0..largest_mm).contains(&radius_mm),
        PartLaw::Line { .. } => false,
    };
    let places = |part: &DrawnPart| {
        let PartLaw::Turn { normals_rad: [from, to], .. } = part.law else { return Vec::new() };
        let steps = ((to - from).abs() / PLACE_RAD).ceil().max(1.0) as u32;
        (0..=steps).map(|i| (part.law.at(f64::from(i) / f64::from(steps)).point_mm, 0.0)).collect()
    };
    let parts = &tooth.parts;
    let right = parts.iter().rposition(|part| part.name == CornerRight).map_or(0, |last| last + 1);
    let left = parts.iter().position(|part| part.name == CornerLeft).unwrap_or(parts.len());
    // From the tip to either side.
    let right = parts[..right].iter().rev().skip_while(|part| !is_round(part)).take_while(is_round);
    let left = parts[left..].iter().skip_while(|part| !is_round(part)).take_while(is_round);
    let mut places_mm: Vec<Round> = right.chain(left).flat_map(places).collect();
    // A sharp corner is divided: its parts are one place.
    places_mm.dedup();
    places_mm
}

/// Of the spaces behind the first `teeth` teeth: on the way in, and out.
pub(super) fn of_period(job: &ShapingJob, target: &TargetOutline, teeth: u32) -> Vec<[CornerPath; 2]> {
    let rounds = tip_rounds(job);
    let paths = |space: u32| [-1, 1].map(|direction| path(job, target, &rounds, space, direction));
    (1..=teeth).into_par_iter().map(paths).collect()
}

/// One path, from the middle of the space outwards: backwards in time on the way in.
fn path(job: &ShapingJob, target: &TargetOutline, rounds: &[Round], space: u32, direction: i32) -> CornerPath {
    let (linkage, offset_mm) = (&job.finishing().linkage, job.finishing().spec.offset_mm);
    let pitch_mm = PI * job.transverse.module_mm;
    let farthest_mm = FARTHEST_MODULES * job.scene.gear.module_mm;
    let mut air = CornerPath { clearance_mm: farthest_mm, phi_rad: 0.0 };
    let mut cut = CornerPath { clearance_mm: -LEAST_DEPTH_MM, phi_rad: 0.0 };
    // Height over the blank's outline and distance from the teeth at the place before, of every round.
    let mut before: Vec<Option<[f64; 2]>> = vec![None; rounds.len()];
    // Half a turn of the cutter: where it nearly fills the ring, its teeth leave it late.
    for place in 0..=job.cutter.teeth.div_ceil(2) as i32 * PLACES_PER_PITCH {
        let pitches = f64::from(space) + f64::from(direction * place) / f64::from(PLACES_PER_PITCH);
        let phi_rad = job.curve.phi_at_arc(pitch_mm * pitches);
        let pose = linkage.pose(phi_rad, offset_mm);
        // The tooth that cuts this space.
        let turn = DVec2::from_angle(pose.angle_rad + TAU * f64::from(space) / f64::from(job.cutter.teeth));
        for (&(center_mm, radius_mm), before) in rounds.iter().zip(&mut before) {
            let center_mm = pose.center_mm + turn.rotate(center_mm);
            let over_mm = over_outline_mm(job, center_mm, phi_rad);
            // No tooth stands beyond the outline.
            if over_mm - radius_mm > air.clearance_mm {
                *before = None;
                continue;
            }
            let Some(distance_mm) = target.distance_mm(center_mm, farthest_mm) else {
                *before = None;
                continue;
            };
            let here = [over_mm, distance_mm - radius_mm];
            if here[1] < cut.clearance_mm {
                cut = CornerPath { clearance_mm: here[1], phi_rad };
            }
            // Just where it leaves the outline, between two places.
            let leaving_mm = before.filter(|before| before[0] < 0.0 && over_mm >= 0.0).map(|before| {
                let share = before[0] / (before[0] - here[0]);
                before[1] + share * (here[1] - before[1])
            });
            let outside_mm = if over_mm >= 0.0 { here[1] } else { f64::INFINITY };
            let clearance_mm = leaving_mm.unwrap_or(f64::INFINITY).min(outside_mm);
            if clearance_mm < air.clearance_mm {
                air = CornerPath { clearance_mm, phi_rad };
            }
            *before = Some(here);
        }
    }
    if cut.clearance_mm < -LEAST_DEPTH_MM { cut } else { air }
}

/// How far a point lies outside the blank's outline, mm, negative inside; no less than that far from the bore's middle.
fn over_outline_mm(job: &ShapingJob, p: DVec2, phi_rad: f64) -> f64 {
    let inside_mm = job.curve.facts().smallest_radius_mm - job.blank.addendum_mm - p.length();
    if inside_mm > 0.0 {
        return inside_mm;
    }
    let near_rad = phi_rad + DVec2::from_angle(phi_rad).angle_to(p);
    job.blank.height(p, near_rad).0 - job.blank.addendum_mm
}
