//! Closed forms of a shaper cutter with sharp tip corners, and how far the mate's tips ask for contact.
//!
//! It leaves the flank down to lambda_form = sqrt(r_a0^2 - r_b0^2) - r_c sin(alpha) along the line of action: where its
//! corner passes (Litvin and Fuentes, *Gear Geometry and Applied Theory*, 2004, ch. 6.7, for the corner's path). The
//! same line is the one of the pair, since cutter and mate roll on the same pitch curve.

use std::f64::consts::TAU;

use crate::pair::contact_ratio::path_of_contact;
use crate::pair::pitch_pair::{Member, PitchPair};
use crate::pair::rolling::turns_of_period;
use gearcut_core::error::Refusal;
use gearcut_core::math::extremum::maximum;
use gearcut_core::terms::Side;

/// Cells of a turn in which the largest reach is looked for.
const CELLS_PER_TURN: usize = 120;

/// A shaper cutter with sharp tip corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharpCutter {
    /// Number of teeth.
    pub teeth: u32,
    /// Height of the teeth over the pitch circle, modules.
    pub addendum_coefficient: f64,
}

impl SharpCutter {
    /// How far along the line of action, from the pitch point towards the root, it leaves the flank, mm.
    pub fn form_reach_mm(&self, module_mm: f64, pressure_angle_rad: f64) -> f64 {
        let pitch_radius_mm = 0.5 * module_mm * f64::from(self.teeth);
        let tip_radius_mm = pitch_radius_mm + self.addendum_coefficient * module_mm;
        let base_radius_mm = pitch_radius_mm * pressure_angle_rad.cos();
        (tip_radius_mm.powi(2) - base_radius_mm.powi(2)).sqrt() - pitch_radius_mm * pressure_angle_rad.sin()
    }

    /// How far along it towards the tip of a ring's tooth, mm: there the cutter's involute begins at its base circle,
    /// and what lies beyond is relieved.
    pub fn base_reach_mm(&self, module_mm: f64, pressure_angle_rad: f64) -> f64 {
        0.5 * module_mm * f64::from(self.teeth) * pressure_angle_rad.sin()
    }
}

/// How far the mate's tips ask for contact on a gear's flanks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeededReach {
    /// Largest distance from the pitch point towards the gear's root, along the line of action, mm.
    pub reach_mm: f64,
    /// Driver's angle there.
    pub phi_1_rad: f64,
}

/// The farthest that the mate's tips ask for on the flanks of a gear, over the period. Where it is more than
/// [`SharpCutter::form_reach_mm`], the tip works on the fillet.
///
/// # Errors
/// The line of action does not reach a tip.
pub fn needed_reach(
    pair: &PitchPair,
    member: Member,
    side: Side,
    addendum_mm: [f64; 2],
) -> Result<NeededReach, Refusal> {
    let reach = |phi: f64| {
        let path = path_of_contact(pair, &pair.at(phi), side, addendum_mm)?;
        Ok::<f64, Refusal>(match member {
            Member::Driver => path.driven_tip_mm.abs(),
            Member::Driven => path.driver_tip_mm.abs(),
        })
    };
    reach(0.0)?;
    let turns = turns_of_period(pair.teeth().count);
    // A round gear asks for the same everywhere: what cannot be reached was refused above.
    let found = |phi: f64| reach(phi).unwrap_or(f64::INFINITY);
    let (phi_1_rad, reach_mm) = maximum(found, 0.0, TAU * f64::from(turns), CELLS_PER_TURN * turns as usize);
    Ok(NeededReach { reach_mm, phi_1_rad })
}
