//! Undercut: where the path of the cutter's tip corner crosses a flank, and how far below it the path runs.
//!
//! In: a flank as the cutter's flank alone generates it, the fillet of its space. Out: the target flank, which begins
//! at the crossing, with the depth of what is cut away below.
//!
//! An envelope that turns back (at the base circle of a round gear) ends in a cusp. The corner's path begins on the
//! branch behind the cusp, in air, dives through the flank and runs on under it: what stands of the flank ends where
//! both cross, above the cusp. The crossing is sought upwards from the root. There the fillet lies inside the flank,
//! and the first place at which it does not is the one. Inside and outside are told at equal heights over the pitch
//! curve, which climb steadily along a flank: by (p - q) n, p on the fillet, q and n point and normal of the flank.

use crate::process::shaping::target::fillet::Fillet;
use crate::process::shaping::target::generation::Generation;
use crate::process::shaping::target::{FlankEnd, TargetFlank, Undercut, no_flank};
use gearcut_core::error::Refusal;
use gearcut_core::gear::blank::Blank;
use gearcut_core::math::roots::halve;
use gearcut_core::terms::Side;
use std::sync::Arc;

/// Steps along every piece of the fillet in which the crossing is sought.
const STEPS_PER_PIECE: u32 = 64;
/// Halvings down to the last bits of a place.
const HALVINGS: u32 = 52;
/// Places of the flank that is cut away at which its depth is taken, the cusp among them. They stand evenly along the
/// roll, of which arcs from a cusp are the squares: the depth is largest some micrometres off it.
const DEPTHS: u32 = 33;
/// A crossing nearer to the tip than this leaves no flank, mm.
const LEAST_FLANK_MM: f64 = 1e-3;

impl TargetFlank {
    /// Target flank of a tooth.
    ///
    /// # Errors
    /// No involute is generated, or the cutter's tip cuts all of it away.
    pub fn new(generation: &Arc<Generation>, blank: &Blank, tooth: u32, side: Side) -> Result<Self, Refusal> {
        Self::as_generated(generation, blank, tooth, side, 0.0, None)?.whole_part(blank)
    }

    /// What of a generated flank stands: all of it above an undercut.
    pub(in crate::process::shaping) fn whole_part(self, blank: &Blank) -> Result<Self, Refusal> {
        // Loops of a drawn tooth's envelope are cut away already.
        if self.form_end != FlankEnd::Undercut || self.undercut.is_some() {
            return Ok(self);
        }
        let fillet = Fillet::new(self.generation(), self.space());
        let height_mm = |arc_mm: f64| {
            let contact = self.at_arc(arc_mm);
            blank.height(contact.point_mm, contact.phi_rad).0
        };
        let [low_mm, high_mm] = [height_mm(0.0), height_mm(self.length_mm())];
        // Whether the fillet has not yet come out of the flank, up from the root.
        let is_under = |place: f64| {
            let Some((phi, point_mm, _)) = fillet.at(place) else { return true };
            let fillet_mm = blank.height(point_mm, phi).0;
            let beside = || self.at_height(blank, fillet_mm);
            fillet_mm <= low_mm
                || beside().is_some_and(|(_, flank)| (point_mm - flank.point_mm).dot(flank.normal) < 0.0)
        };
        // From the middle of the space to the flank.
        let end = if self.side == Side::Left { 0.0 } else { fillet.end() };
        let middle = 0.5 * fillet.end();
        let steps = (middle * f64::from(STEPS_PER_PIECE)).ceil();
        let at_step = |step: f64| middle + (end - middle) * step / steps;
        let walk = (1..=steps as u32).map(f64::from);
        // Where rounding hides an undercut of less than a nanometre, nothing stands off the cusp.
        let Some(out) = walk.into_iter().find(|&step| !is_under(at_step(step))) else { return Ok(self) };
        let [fillet_at, _] = halve(is_under, at_step(out - 1.0), at_step(out), HALVINGS);
        let Some((phi, point_mm, _)) = fillet.at(fillet_at) else { return Ok(self) };
        let crossing_mm = blank.height(point_mm, phi).0.max(low_mm);
        let crossed = self.at_height(blank, crossing_mm).filter(|_| crossing_mm < high_mm - LEAST_FLANK_MM);
        let Some((arc_mm, contact)) = crossed else {
            return Err(no_flank(self.tooth, self.side, "the cutter's tip corner cuts all of it away"));
        };
        let depth_mm = self.depth_mm(&fillet, [fillet_at, middle], arc_mm);
        Ok(self.undercut_up_to(contact.phi_rad, Undercut { fillet_at, depth_mm }))
    }

    /// Largest depth of the fillet between two places, from the crossing on, under the flank up to an arc.
    fn depth_mm(&self, fillet: &Fillet, [crossing, middle]: [f64; 2], up_to_mm: f64) -> f64 {
        let depth_under = |arc_mm: f64| {
            let contact = self.at_arc(arc_mm);
            let off = |place: f64| fillet.at(place).map(|(_, point_mm, _)| point_mm - contact.point_mm);
            // Whether the fillet has not yet met the flank's normal, down from the crossing.
            let along = |place: f64| off(place).map_or(0.0, |off| contact.normal.perp_dot(off));
            let start = along(crossing);
            let [place, _] = halve(|place| along(place) * start > 0.0, crossing, middle, HALVINGS);
            off(place).map_or(0.0, |off| -off.dot(contact.normal))
        };
        let arcs = (0..DEPTHS).map(|i| up_to_mm * (f64::from(i) / f64::from(DEPTHS)).powi(2));
        arcs.map(depth_under).fold(0.0, f64::max)
    }
}
