//! How far the flanks that a tool has generated reach along the line of action.
//!
//! In: points and normals of both ends of a gear's flanks: the form point, where the fillet or an undercut begins, and
//! where they end at their tips. Out: the part of a path of contact that they leave.
//!
//! Law: a point of a flank is in contact where its normal goes through the pitch point (Willis), and lies as far along
//! the line of action as it is away from there. A tool with teeth all alike gives every flank of
//! a side the same distance, and undercut ones shorter ones: between teeth the distance is interpolated. A flank that
//! goes on to the tip curve has no end of its own there: the path between the tip curves knows it better.

use super::contact_ratio::PathOfContact;
use super::pitch_pair::{ConjugatePoint, Member, PitchPair};
use super::rolling::turns_of_period;
use gearcut_core::error::Refusal;
use gearcut_core::terms::Side;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// A flank that ends this near its tip curve goes on to it, mm.
const AT_TIP_MM: f64 = 1e-6;

/// Where the flanks of one side of a gear end along the line of action.
#[derive(Debug, Clone, PartialEq)]
pub struct FlankLimits {
    /// Form points, and ends at the tips: the driver's angle at which a tooth's is in contact, growing, and its
    /// distance from the pitch point along v, mm; none of its own where it goes on to the tip curve.
    ends: [Vec<(f64, Option<f64>)>; 2],
    period_rad: f64,
}

impl FlankLimits {
    /// From form point and end at the tip of every flank (the gear's own frame), by the label of the driver's tooth
    /// that touches it, and the height of the gear's tip curve.
    ///
    /// # Errors
    /// Points whose normals do not meet the pitch curve.
    pub fn new(
        pair: &PitchPair,
        member: Member,
        side: Side,
        addendum_mm: f64,
        ends_of: impl Fn(i64) -> [ConjugatePoint; 2] + Sync,
    ) -> Result<Self, Refusal> {
        let teeth = pair.teeth();
        let turns = turns_of_period(teeth.count);
        let period_rad = TAU * f64::from(turns);
        let end = |label: i64, at: usize| -> Result<(f64, Option<f64>), Refusal> {
            let guess_rad = pair.curve().phi_at_arc(pair.crossing_mm(side, label));
            let on = ends_of(label)[at];
            let goes_on = pair.height(member, on.point_mm, guess_rad)?.0 > addendum_mm - AT_TIP_MM;
            let (phi_rad, along_mm) = pair.contact_of(member, side, &on, guess_rad)?;
            Ok((phi_rad.rem_euclid(period_rad), (!goes_on).then_some(along_mm)))
        };
        let labels = 1..=i64::from(teeth.count[0] * turns);
        let of = |at: usize| -> Result<Vec<(f64, Option<f64>)>, Refusal> {
            let mut ends: Vec<_> =
                labels.clone().into_par_iter().map(|label| end(label, at)).collect::<Result<_, _>>()?;
            ends.sort_by(|a, b| a.0.total_cmp(&b.0));
            Ok(ends)
        };
        Ok(Self { ends: [of(0)?, of(1)?], period_rad })
    }

    /// Distances of form point and tip's end from the pitch point along v, mm, at an angle of the driver; none where
    /// flanks go on to the tip curve.
    pub fn at(&self, phi_1_rad: f64) -> [Option<f64>; 2] {
        let phi = phi_1_rad.rem_euclid(self.period_rad);
        [0, 1].map(|end| {
            let ends = &self.ends[end];
            let after = ends.partition_point(|(at, _)| *at < phi);
            let [before, after] = [ends[(after + ends.len() - 1) % ends.len()], ends[after % ends.len()]];
            let span_rad = (after.0 - before.0).rem_euclid(self.period_rad);
            let share = if span_rad > 0.0 { (phi - before.0).rem_euclid(self.period_rad) / span_rad } else { 0.0 };
            match (before.1, after.1) {
                (Some(from), Some(to)) => Some(from + share * (to - from)),
                // Beside a flank that goes on to its tip the other's end holds: the tip curve ends the path sooner.
                (from, to) => from.or(to),
            }
        })
    }
}

impl PathOfContact {
    /// What the flanks of both gears leave of the path at an angle of the driver: A is given first.
    #[must_use]
    pub fn generated(&self, side: Side, [a, b]: [&FlankLimits; 2], phi_1_rad: f64) -> Self {
        // Counted towards the driver's tip. The driver's flank begins below the pitch point and ends above it, the
        // driven gear's the other way round.
        let towards = side.sign();
        let ends = |limits: &FlankLimits| limits.at(phi_1_rad).map(|end| end.map(|along_mm| towards * along_mm));
        let ([form_a, tip_a], [form_b, tip_b]) = (ends(a), ends(b));
        let last = |ends: [Option<f64>; 2]| ends.into_iter().flatten().fold(towards * self.driver_tip_mm, f64::min);
        let first = |ends: [Option<f64>; 2]| ends.into_iter().flatten().fold(towards * self.driven_tip_mm, f64::max);
        let (last_mm, first_mm) = (last([tip_a, form_b]), first([form_a, tip_b]));
        Self { driver_tip_mm: towards * last_mm.max(first_mm), driven_tip_mm: towards * first_mm }
    }
}
