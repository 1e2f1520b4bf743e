//! Tip corners in the mate's material, over a period of the pair.
//!
//! In: the gears in mesh, the outlines of their spaces. Out: for each gear the deepest place at which a tip corner of
//! the other is in it, in the position that the pitch curves ask for.
//!
//! Law: every position names its deepest corner. Between positions a corner goes deeper still; where one is deeper than
//! at both neighbours, its depth is followed between them, as long as it may yet exceed the deepest that is known. A
//! corner gains no more there than it has gained from the lower neighbour.
//!
//! Teeth that are thinner than nominal leave the driven gear a play in which it evades; the depth tells what it has to
//! evade, and the transmission error tells whether it did.

use rayon::prelude::*;
use std::cmp::Ordering;
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

/// Cells between two positions in which a corner's depth is looked at before it is followed to its largest value.
const FOLLOWED_CELLS: usize = 4;

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
#[derive(Debug, Clone, Copy)]
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

    /// The deepest corner of a position.
    fn deepest(&self, pitch: &PitchPoint) -> Option<(ToothCorner, DeepestCorner)> {
        let pitch_mm = self.meshing.pitch.pitch_mm();
        let corners = self.meshing.sections.iter().enumerate().flat_map(|(section, gears)| {
            let labels = gears.near(pitch, pitch_mm);
            labels.flat_map(move |label| [Side::Right, Side::Left].map(|tip| ToothCorner { section, label, tip }))
        });
        let found = corners.filter_map(|corner| Some((corner, self.named(pitch, corner)?)));
        found.max_by(|a, b| deeper(&a.1, &b.1))
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
        Ok(gear.deepest(&moment.pitch))
    };
    let found: Vec<Option<(ToothCorner, DeepestCorner)>> = moments.par_iter().map(of).collect::<Result<_>>()?;
    let n = found.len();
    let depth_mm = |i: usize| found[i % n].as_ref().map_or(f64::NEG_INFINITY, |(_, corner)| corner.depth_mm);
    let phi_rad = |i: usize| moments[i % n].pitch.phi_1_rad;
    let period_rad = TAU * f64::from(turns_of_period(meshing.pitch.teeth().count));
    // How deep a corner may come between the neighbours of a position at which it is deeper than at both.
    let mut humps: Vec<(f64, usize)> = (0..n)
        .filter_map(|i| {
            let [before, here, after] = [i + n - 1, i, i + 1].map(depth_mm);
            (here >= before && here >= after && here.is_finite()).then(|| (2.0 * here - before.min(after), i))
        })
        .collect();
    humps.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut deepest = found.iter().flatten().map(|(_, corner)| *corner).max_by(deeper);
    for (at_most_mm, i) in humps {
        if deepest.is_some_and(|deepest| at_most_mm <= deepest.depth_mm) {
            break;
        }
        let before_rad = if i == 0 { phi_rad(n - 1) - period_rad } else { phi_rad(i - 1) };
        let after_rad = if i + 1 == n { phi_rad(0) + period_rad } else { phi_rad(i + 1) };
        let followed = found[i].and_then(|(corner, _)| gear.followed(corner, [before_rad, after_rad]));
        deepest = deepest.into_iter().chain(followed).max_by(deeper);
    }
    Ok(deepest)
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
