//! The part of a tooth's tip that the cutter's base shapes.
//!
//! A cutter with few teeth has its base circle inside its working depth: below it the flank of the cutter goes on
//! straight along the tangent of the involute's last point, and what it touches is no longer the conjugate flank but
//! stands back behind it. In: the finishing generation, a target flank that ends at the cutter's base. Out: the profile
//! from that end to the blank's outline, and how far it stands back.
//!
//! Law: a straight piece p(w) = p_0 + w d with the normal n touches where `n . (O' + chi' i (p_0 + w d)) = 0`, which is
//! linear in w. Involute and straight piece share the normal at p_0, so the profile goes on without a corner. Its
//! curvature does not: from hollow with (R_p - r_c) sin(alpha) on a ring to convex with
//! r_c sin(alpha) (1 + R_p / (R_p - r_c)) by the theorem of Euler and Savary, so that the tip is relieved by about half
//! of the sum of both curvatures times the square of the length.
//!
//! The conjugate flank beyond the involute's end is the same formula with a negative roll: contact would go on along
//! the line of action.
//!
//! Tips of external gears behind the cutter's base are not followed: their target is reported as not known.

use crate::process::shaping::target::generation::Generation;
use crate::process::shaping::target::{FlankEnd, TargetFlank};
use gearcut_core::gear::GearKind;
use gearcut_core::gear::blank::Blank;
use gearcut_core::math::roots::{bisect, halve};
use gearcut_core::terms::Side;
use glam::DVec2;
use std::f64::consts::PI;

/// Steps of the walk along the profile, in shares of a pitch; it ends within two pitches.
const STEPS_PER_PITCH: f64 = 64.0;
const MOST_STEPS: u32 = 128;

/// Profile between the end of a cutter's involute and the blank's outline.
#[derive(Debug, Clone)]
pub struct TipRelief<'a> {
    generation: &'a Generation,
    blank: &'a Blank,
    space: f64,
    side: Side,
    /// Parameter of the linkage at the involute's end and at the outline.
    phi_rad: [f64; 2],
}

impl<'a> TipRelief<'a> {
    /// Of a ring's flank that ends at the cutter's base; `None` for others, and where the base does not reach the
    /// outline.
    pub fn new(flank: &'a TargetFlank, blank: &'a Blank) -> Option<Self> {
        if flank.tip_end != FlankEnd::CutterBase || blank.kind() == GearKind::External {
            return None;
        }
        let (generation, space) = (flank.generation(), flank.space());
        let curve = generation.linkage.curve();
        let [from, before] = [flank.length_mm(), 0.99 * flank.length_mm()].map(|arc_mm| flank.at_arc(arc_mm).phi_rad);
        let pitch_mm = 2.0 * PI * generation.cutter.pitch_radius_mm / f64::from(generation.cutter.teeth);
        let step = (from - before).signum() * pitch_mm / curve.frame(from).arc_rate_mm_per_rad / STEPS_PER_PITCH;
        let below = |phi: f64| {
            let contact = generation.base_contact(phi, space, flank.side);
            contact.is_some_and(|[point_mm, _]| blank.height(point_mm, phi).0 < blank.addendum_mm)
        };
        let walk = (1..=MOST_STEPS).map(|i| from + step * f64::from(i));
        let beyond = walk.clone().find(|&phi| !below(phi))?;
        let [inside, outside] = halve(below, beyond - step, beyond, 60);
        let end = generation.base_contact(0.5 * (inside + outside), space, flank.side)?[0];
        let reached = (blank.height(end, outside).0 - blank.addendum_mm).abs() < 1e-6;
        reached.then_some(Self { generation, blank, space, side: flank.side, phi_rad: [from, inside] })
    }

    /// Point of the profile at a share of its parameter, 0 at the involute's end, 1 at the outline; gear frame, mm.
    pub fn at(&self, share: f64) -> DVec2 {
        let phi = self.phi_rad[0] + share * (self.phi_rad[1] - self.phi_rad[0]);
        let touched = |phi: f64| self.generation.base_contact(phi, self.space, self.side);
        // At the involute's end itself rounding decides whether the straight piece touches.
        let [point_mm, _] = touched(phi).or_else(|| touched(self.phi_rad[1])).expect("it touches up to the outline");
        point_mm
    }

    /// Points about `spacing_mm` apart from the involute's end to the outline, the first left out.
    pub fn points_mm(&self, spacing_mm: f64) -> Vec<DVec2> {
        let count = (self.at(1e-6).distance(self.at(1.0)) / spacing_mm).ceil().max(4.0) as u32;
        (1..=count).map(|i| self.at(f64::from(i) / f64::from(count))).collect()
    }

    /// How far the profile stands back behind the conjugate flank at a height over the pitch curve, along that flank's
    /// normal, mm; 0 below the involute's end.
    pub fn depth_mm(&self, height_mm: f64) -> f64 {
        let [start, end] = self.phi_rad;
        let conjugate = |phi: f64| self.generation.flank_contact(phi, self.space, self.side);
        let height = |phi: f64| conjugate(phi).map_or(f64::INFINITY, |c| self.blank.height(c.point_mm, phi).0);
        if height_mm <= height(start) {
            return 0.0;
        }
        // Both profiles are run through at speeds of the same order.
        let phi = bisect(|phi| height(phi) < height_mm, start, start + 4.0 * (end - start));
        let Some(contact) = conjugate(phi) else { return f64::NAN };
        // Where the normal from the conjugate flank into the tooth meets the profile.
        let beside = |share: f64| contact.normal.perp_dot(self.at(share) - contact.point_mm);
        let sign = beside(1.0).signum();
        let share = bisect(|share| beside(share) * sign < 0.0, 1e-9, 1.0);
        -contact.normal.dot(self.at(share) - contact.point_mm)
    }
}
