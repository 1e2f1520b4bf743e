//! How far the flanks that the tools of two scenes generate reach along the line of action.
//!
//! In: two gears that belong together. Out: limits of the path of contact, of both sides and both gears, from the ends
//! of the target flanks of every tooth: form point or undercut, and tip.

use super::fit::{Fit, MEMBERS, SIDES};
use crate::job::CylindricalGear;
use crate::pair::flank_limits::FlankLimits;
use crate::pair::pitch_pair::{ConjugatePoint, Member};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::terms::Side;
use rayon::prelude::*;

/// Both ends of the flanks of a gear in the middle of the face, in the frame of its scene: right ones, then left ones,
/// from tooth 1 on.
pub type FlankEnds = [Vec<[ConjugatePoint; 2]>; 2];

/// Limits of the right and the left flanks, of A and of B.
pub type PairLimits = [[FlankLimits; 2]; 2];

/// Limits of the flanks of two gears.
///
/// # Errors
/// Flanks that are not those of the pair.
pub fn limits(fit: &Fit, ends: &[FlankEnds; 2]) -> Result<PairLimits> {
    let of = |side: Side, member: Member| -> Result<FlankLimits, Refusal> {
        let ends_of = |label: i64| {
            let count = fit.pitch.teeth().count[0];
            let (own_side, tooth) = match member {
                Member::Driver => (side, (label - 1).rem_euclid(i64::from(count)) + 1),
                Member::Driven => fit.mate_flank(side, label),
            };
            let at = usize::from(own_side == Side::Left);
            ends[usize::from(member == Member::Driven)][at][tooth as usize - 1].map(|own| match member {
                Member::Driver => own,
                Member::Driven => {
                    ConjugatePoint { point_mm: fit.in_pair(own.point_mm), normal: fit.in_pair(own.normal) }
                }
            })
        };
        let at = usize::from(member == Member::Driven);
        FlankLimits::new(&fit.pitch, member, side, fit.addendum_mm[at], ends_of)
    };
    let [right, left] = SIDES.map(|side| {
        let [a, b] = MEMBERS.map(|member| of(side, member));
        Ok::<_, Refusal>([a?, b?])
    });
    Ok([right?, left?])
}

/// The ends of all flanks of a gear.
///
/// # Errors
/// A tool that generates no flank on some tooth.
pub fn flank_ends(gear: &dyn CylindricalGear) -> Result<FlankEnds> {
    let [right, left] = SIDES.map(|side| ends_of_side(gear, side));
    Ok([right?, left?])
}

fn ends_of_side(gear: &dyn CylindricalGear, side: Side) -> Result<Vec<[ConjugatePoint; 2]>> {
    let ends = |tooth: u32| {
        let sections = gear.target_profiles(tooth, side, &[0.0, gear.profile_length_mm(tooth, side)?], &[0.0])?;
        Ok([0, 1].map(|end| {
            let (point_mm, normal) = sections[0][end];
            ConjugatePoint { point_mm, normal: normal.truncate().normalize() }
        }))
    };
    (1..=gear.scene().gear.teeth).into_par_iter().map(ends).collect()
}
