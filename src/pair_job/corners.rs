//! Tip corners in the mate's material, over a period of the pair.
//!
//! In: the gears in mesh, the outlines of their spaces. Out: for each gear the deepest place at which a tip corner of
//! the other is in it, in the position that the pitch curves ask for.
//!
//! Law: every corner has its own way through the mate's space, and is looked at in every position. Where it is deeper
//! than in the positions before and after, its depth is followed between them, as long as it may yet exceed the deepest
//! that is known: it gains no more there than it has gained from the lower neighbour. Cut fillets have a wave for each
//! stroke, so that it is looked at in many places before the deepest is followed. In a ring the corners of all teeth
//! are looked at: with few teeth of difference they come in and go out far from the line of centres, and may meet the
//! ring's there (trochoidal interference).
//!
//! Teeth that are thinner than nominal leave the driven gear a play in which it evades; the depth tells what it has to
//! evade, and the transmission error tells whether it did.

use rayon::prelude::*;
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

use glam::DVec2;

use super::flanks::{PairFlanks, SectionOfGear};
use super::watch::WatchedUnits;
use crate::pair::assembly::{Meshing, Moment};
use crate::pair::penetration::CornerDepth;
use crate::pair::pitch_pair::{Member, PitchPoint};
use crate::pair::rolling::turns_of_period;
use gearcut_core::error::Result;
use gearcut_core::math::extremum::maximum;
use gearcut_core::terms::Side;

/// Cells from the position before to the one after in which a corner's depth is looked at before it is followed to its
/// largest value: with eight positions to a tooth these are a quarter of a pitch, in which fine cuts have 25 strokes.
const FOLLOWED_CELLS: usize = 64;

/// The deepest corner in a gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeepestCorner {
    /// How deep, mm; negative where every corner stays clear.
    pub depth_mm: f64,
    /// Driver's angle, rad.
    pub phi_1_rad: f64,
    /// Label of the pair of flanks whose flank it stands in.
    pub label: i64,
    /// Side of that label.
    pub side: Side,
    /// Arc along the profile there, from the form point, mm; negative in the fillet.
    pub u_mm: f64,
}

/// A tip corner of the mate that is looked at: the section, the label of the pair of flanks, and the side of the tooth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct ToothCorner {
    section: usize,
    label: i64,
    tip: Side,
}

/// One gear, in whose material the mate's corners are looked for.
struct InGear<'a> {
    flanks: &'a PairFlanks,
    meshing: &'a Meshing,
    member: Member,
}

impl InGear<'_> {
    /// Where a corner is; none far from its space, and of gears whose outlines are not known.
    fn depth(&self, pitch: &PitchPoint, corner: ToothCorner) -> Option<CornerDepth> {
        let section = &self.meshing.sections[corner.section];
        let gears = &self.flanks.sections[corner.section];
        let stand = self.meshing.stand(pitch, section, 0.0);
        let (angle_1, angle_2) = (-stand.phi_1_rad, stand.sign * stand.phi_2_rad);
        let [off_1, off_2] = self.meshing.eccentricity_mm;
        let turned = |angle_rad: f64, point_mm: DVec2| DVec2::from_angle(angle_rad).rotate(point_mm);
        let [own, mate] = match self.member {
            Member::Driver => [&gears[0], &gears[1]],
            Member::Driven => [&gears[1], &gears[0]],
        };
        // The mate's tooth in the space before the right flank of a label.
        let before = i64::from(self.member == Member::Driver && corner.tip == Side::Left);
        let tip = mate.chains.get(corner.tip, corner.label - before).points_mm.last()?;
        let own_mm = match self.member {
            Member::Driver => turned(-angle_1, turned(angle_2, *tip + off_2) + stand.axis_2_mm) - off_1,
            Member::Driven => turned(-angle_2, turned(angle_1, *tip + off_1) - stand.axis_2_mm) - off_2,
        };
        let teeth = own.chains.right.len() as i64;
        own.spaces.get(corner.label.rem_euclid(teeth) as usize)?.corner(own_mm)
    }

    /// Depths of all corners in a position, mm.
    fn depths_mm(&self, pitch: &PitchPoint) -> Vec<(ToothCorner, f64)> {
        let corners = self.meshing.sections.iter().enumerate().flat_map(|(section, gears)| {
            let labels = gears.crossing(pitch, &self.meshing.pitch);
            labels.flat_map(move |label| [Side::Right, Side::Left].map(|tip| ToothCorner { section, label, tip }))
        });
        corners.filter_map(|corner| Some((corner, self.depth(pitch, corner)?.depth_mm))).collect()
    }

    /// A corner with its place in words of the pair.
    fn named(&self, pitch: &PitchPoint, corner: ToothCorner) -> Option<DeepestCorner> {
        let found = self.depth(pitch, corner)?;
        Some(place(found, &self.flanks.sections[corner.section], self.member, corner.label, pitch.phi_1_rad))
    }

    /// Where a corner is deepest between two angles of the driver.
    fn followed(&self, corner: ToothCorner, [low, high]: [f64; 2]) -> Option<DeepestCorner> {
        let pitch = &self.meshing.pitch;
        let depth_mm = |phi| self.depth(&pitch.at(phi), corner).map_or(f64::NEG_INFINITY, |found| found.depth_mm);
        self.named(&pitch.at(maximum(depth_mm, low, high, FOLLOWED_CELLS).0), corner)
    }
}

/// The deepest corner of the mate in a gear; none where its outlines are not known.
///
/// # Errors
/// Ctrl-C.
pub fn deepest(
    flanks: &PairFlanks,
    meshing: &Meshing,
    moments: &[Moment],
    member: Member,
    stage: &WatchedUnits,
) -> Result<Option<DeepestCorner>> {
    let gear = InGear { flanks, meshing, member };
    let of = |moment: &Moment| {
        stage.count()?;
        Ok((moment.pitch.phi_1_rad, gear.depths_mm(&moment.pitch)))
    };
    let found: Vec<(f64, Vec<(ToothCorner, f64)>)> = moments.par_iter().map(of).collect::<Result<_>>()?;
    let count = meshing.pitch.teeth().count;
    let turns = turns_of_period(count);
    let labels = i64::from(turns * count[0]);
    let period_rad = TAU * f64::from(turns);
    // Every corner's way: the driver's angles with the depths there. A label of the next period is the first one's.
    let mut ways: BTreeMap<ToothCorner, Vec<(f64, f64)>> = BTreeMap::new();
    for (phi, corners) in found {
        for (corner, depth_mm) in corners {
            let first = ToothCorner { label: corner.label.rem_euclid(labels), ..corner };
            let periods = corner.label.div_euclid(labels) as f64;
            ways.entry(first).or_default().push((phi - periods * period_rad, depth_mm));
        }
    }
    let mut humps = Vec::new();
    for (corner, mut way) in ways {
        way.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        humps.extend((0..way.len()).filter_map(|i| Some((corner, hump(&way, i)?))));
    }
    // The deepest positions first: what they become leaves little to be followed.
    humps.sort_by(|a, b| b.1.here_mm.total_cmp(&a.1.here_mm));
    let mut deepest: Option<DeepestCorner> = None;
    for (corner, Hump { between_rad, at_most_mm, .. }) in humps {
        if deepest.is_some_and(|deepest| at_most_mm <= deepest.depth_mm) {
            continue;
        }
        let followed = gear.followed(corner, between_rad);
        deepest = deepest.into_iter().chain(followed).max_by(deeper);
    }
    Ok(deepest.map(|deepest| DeepestCorner { phi_1_rad: deepest.phi_1_rad.rem_euclid(period_rad), ..deepest }))
}

/// A position in which a corner is deeper than before and after.
struct Hump {
    here_mm: f64,
    /// The driver's angles before and after.
    between_rad: [f64; 2],
    /// How deep it may come between them; without end where it comes from outside its space.
    at_most_mm: f64,
}

/// The hump of a corner's way at one of its positions, if there is one.
fn hump(way: &[(f64, f64)], i: usize) -> Option<Hump> {
    let (phi, here_mm) = way[i];
    let outside = (f64::NAN, f64::NEG_INFINITY);
    let before = i.checked_sub(1).map_or(outside, |before| way[before]);
    let after = way.get(i + 1).copied().unwrap_or(outside);
    if here_mm < before.1 || here_mm < after.1 {
        return None;
    }
    // One step is as wide as the other where only one is known.
    let step_rad = (after.0 - phi).max(phi - before.0);
    let between_rad = [before.0.max(phi - step_rad), after.0.min(phi + step_rad)];
    let at_most_mm = 2.0 * here_mm - before.1.min(after.1);
    between_rad[0].is_finite().then_some(Hump { here_mm, between_rad, at_most_mm })
}

fn deeper(a: &DeepestCorner, b: &DeepestCorner) -> Ordering {
    // Equal depths: the earlier place, whichever thread was first.
    a.depth_mm.total_cmp(&b.depth_mm).then(b.phi_1_rad.total_cmp(&a.phi_1_rad))
}

/// The place in words of the pair: which flank, and where on it.
fn place(found: CornerDepth, gears: &[SectionOfGear; 2], member: Member, label: i64, phi_1_rad: f64) -> DeepestCorner {
    let own = &gears[usize::from(member == Member::Driven)];
    // Outside, and on the driver of a ring, the first flank of a space is the left one of the tooth before.
    let (side, label) = match (member, found.on_first) {
        (Member::Driver, true) => (Side::Left, label - 1),
        (Member::Driver, false) => (Side::Right, label),
        (Member::Driven, on_first) => {
            let right_is_first = own.right_is_first;
            if on_first == right_is_first { (Side::Right, label) } else { (Side::Left, label) }
        }
    };
    let u_mm = own.outline_u(side, label, found.place);
    DeepestCorner { depth_mm: found.depth_mm, phi_1_rad, label, side, u_mm }
}
