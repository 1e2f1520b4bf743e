//! Tip corners in the mate's material, over a period of the pair.
//!
//! In: the gears in mesh, the outlines of their spaces. Out: for each gear the deepest place at which a tip corner of
//! the other stands in it, in the position that the pitch curves ask for.
//!
//! Teeth that are thinner than nominal leave the driven gear a play in which it evades; the depth tells what it has to
//! evade, and the transmission error tells whether it did.

use rayon::prelude::*;
use std::cmp::Ordering;

use glam::DVec2;

use super::flanks::{PairFlanks, SectionOfGear};
use super::watch::WatchedUnits;
use crate::pair::assembly::{Meshing, Moment};
use crate::pair::penetration::{CornerDepth, SpaceOutline};
use crate::pair::pitch_pair::Member;
use gearcut_core::error::Result;
use gearcut_core::terms::Side;

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
    let of = |moment: &Moment| -> Result<Option<DeepestCorner>> {
        let sections = flanks.sections.iter().zip(&meshing.sections).flat_map(move |(gears, section)| {
            let here = usize::from(member == Member::Driven);
            let stand = meshing.stand(&moment.pitch, section, 0.0);
            let (angle_1, angle_2) = (-stand.phi_1_rad, stand.sign * stand.phi_2_rad);
            let [off_1, off_2] = meshing.eccentricity_mm;
            let turned = |angle_rad: f64, point_mm: DVec2| DVec2::from_angle(angle_rad).rotate(point_mm);
            let into = move |point_mm: DVec2| match member {
                Member::Driver => turned(-angle_1, turned(angle_2, point_mm + off_2) + stand.axis_2_mm) - off_1,
                Member::Driven => turned(-angle_2, turned(angle_1, point_mm + off_1) - stand.axis_2_mm) - off_2,
            };
            section.near(&moment.pitch, meshing.pitch.pitch_mm()).flat_map(move |label| {
                corners(gears, member, label).into_iter().filter_map(move |(corner_mm, own)| {
                    let space: &SpaceOutline = gears[here].spaces.get(label.rem_euclid(own) as usize)?;
                    let found = space.corner(into(corner_mm))?;
                    Some(place(found, gears, member, label, moment.pitch.phi_1_rad))
                })
            })
        });
        let found = sections.max_by(deeper);
        stage.count()?;
        Ok(found)
    };
    let found: Vec<Option<DeepestCorner>> = moments.par_iter().map(of).collect::<Result<_>>()?;
    Ok(found.into_iter().flatten().max_by(deeper))
}

fn deeper(a: &DeepestCorner, b: &DeepestCorner) -> Ordering {
    // Equal depths: the earlier place, whichever thread was first.
    a.depth_mm.total_cmp(&b.depth_mm).then(b.phi_1_rad.total_cmp(&a.phi_1_rad))
}

/// Tip corners of the mate's tooth in the space before the right flank of a label, in the mate's own frame, and the
/// number of teeth of the gear with the space.
fn corners(gears: &[SectionOfGear; 2], member: Member, label: i64) -> [(DVec2, i64); 2] {
    let (mate, left) = match member {
        Member::Driver => (&gears[1], label - 1),
        Member::Driven => (&gears[0], label),
    };
    let own = &gears[usize::from(member == Member::Driven)];
    let tip = |side, label| {
        let points = &mate.chains.get(side, label).points_mm;
        (points[points.len() - 1], own.chains.right.len() as i64)
    };
    [tip(Side::Right, label), tip(Side::Left, left)]
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
