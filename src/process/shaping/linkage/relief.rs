//! Clearance of the flanks when the cutter backs off.
//!
//! In: a linkage, the offset, the pressure angle alpha_p. Out: what of the back-off becomes clearance on each flank,
//! and where it is least. Before the return stroke the cutter is drawn back by d along the line of centres, direction
//! u: away from the gear axis, in a ring towards it. A flank in contact with unit normal v (out of the work) then
//! clears by d (u . v).
//!
//! Law: all contact normals of one moment pass through the instantaneous centre Q and touch the cutter's base circle.
//! With e the direction from Q to the cutter axis O_b, the normals stand at pi/2 -+ alpha_w from i e, where cos alpha_w
//! = r_b / |Q O_b|. With beta the angle from e to u (the linkage's beta in finishing, positive where r' > 0):
//!
//! ```text
//! left  flank (larger arc):   d sin(alpha_w + beta)
//! right flank (smaller arc):  d sin(alpha_w - beta)
//! ```
//!
//! and the other way round in a ring, where the larger arc lies on the other side of the direction e.
//!
//! In finishing Q is the pitch point and alpha_w = alpha_p. A circular gear has beta = 0 and clears by d sin alpha_p on
//! both flanks: that is the value the ratios refer to. A non-circular gear loses on one flank wherever its radius
//! changes; at |beta| = alpha_p the cutter slides along the flank, beyond it the cutter is pressed into it. The
//! statement is exact for a small d; with d = 2 mm, overlapping the outlines of cutter and gear shows that rubbing
//! already begins about 1.5 deg before.

use super::ShapingLinkage;
use crate::findings::Notice;
use crate::number_text::significant;
use crate::process::shaping::notices::{ReliefRubs, ReliefTight};
use gearcut_core::math::extremum::maximum;

/// Below this share of a circular gear's clearance a warning is due.
pub const TIGHT_RATIO: f64 = 0.5;
/// Smaller ratios are rounding: a cutter that keeps to a flank neither clears it nor enters.
const LEAST_RATIO: f64 = 1e-9;

/// Side of a gear tooth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReliefFlank {
    /// The side of larger arc.
    Left,
    /// The side of smaller arc.
    Right,
}

/// Clearance of the two flanks divided by that of a circular gear, d sin alpha_p.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReliefRatio {
    /// Left flank.
    pub left: f64,
    /// Right flank.
    pub right: f64,
    /// Angle from the contact's normal to the line of centres, rad: positive on the side on which left flanks gain.
    pub beta_rad: f64,
}

/// The place of the smallest clearance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmallestRelief {
    /// Ratio to the clearance of a circular gear.
    pub ratio: f64,
    /// Polar angle of the pitch point at that moment, rad.
    pub phi_rad: f64,
    /// The flank.
    pub flank: ReliefFlank,
    /// alpha_p, rad.
    pub pressure_angle_rad: f64,
}

/// What the smallest clearance means for the cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReliefVerdict {
    /// At least [`TIGHT_RATIO`] of a circular gear's clearance.
    Clears,
    /// Less than that.
    Tight,
    /// The return stroke rubs on the flank.
    Rubs,
}

/// Clearance ratios at `phi_rad`. Where an offset brings the instantaneous centre inside the base circle the working
/// pressure angle is taken as zero, its limit.
pub fn relief_ratio(linkage: &ShapingLinkage, phi_rad: f64, offset_mm: f64, pressure_angle_rad: f64) -> ReliefRatio {
    let motion = linkage.pose_motion(phi_rad, offset_mm);
    let from_center = motion.pose.center_mm - motion.instantaneous_center_mm();
    let (sin_p, cos_p) = pressure_angle_rad.sin_cos();
    let working_rad = (linkage.cutter_pitch_radius_mm() * cos_p / from_center.length()).min(1.0).acos();
    let sign = linkage.gear().tip_sign();
    let back = sign * motion.pose.center_mm;
    let beta_rad = sign * from_center.perp_dot(back).atan2(from_center.dot(back));
    let ratio = |angle_rad: f64| angle_rad.sin() / sin_p;
    ReliefRatio { left: ratio(working_rad + beta_rad), right: ratio(working_rad - beta_rad), beta_rad }
}

/// The smallest clearance over one turn.
pub fn smallest_relief(linkage: &ShapingLinkage, offset_mm: f64, pressure_angle_rad: f64) -> SmallestRelief {
    let ratio = |phi: f64| relief_ratio(linkage, phi, offset_mm, pressure_angle_rad);
    let loss = |phi: f64| -ratio(phi).left.min(ratio(phi).right);
    let [from, to] = linkage.curve().toothed_rad();
    let (phi_rad, loss) = maximum(loss, from, to, linkage.curve().samples_per_turn());
    let flank = if ratio(phi_rad).left < ratio(phi_rad).right { ReliefFlank::Left } else { ReliefFlank::Right };
    // The angle of a flank that the cutter slides along is 0 but for rounding, with either sign.
    let ratio = if loss.abs() < LEAST_RATIO { 0.0 } else { -loss };
    SmallestRelief { ratio, phi_rad, flank, pressure_angle_rad }
}

impl SmallestRelief {
    /// Clears, tight, or rubs.
    pub fn verdict(&self) -> ReliefVerdict {
        if self.ratio < 0.0 {
            ReliefVerdict::Rubs
        } else if self.ratio < TIGHT_RATIO {
            ReliefVerdict::Tight
        } else {
            ReliefVerdict::Clears
        }
    }

    /// Clearance of the flank for a back-off, mm.
    pub fn clearance_mm(&self, back_off_mm: f64) -> f64 {
        back_off_mm * self.pressure_angle_rad.sin() * self.ratio
    }

    /// What must be known of an operation unless the cutter clears.
    pub fn warning(&self, operation: &str, back_off_mm: f64) -> Option<Notice> {
        let flank = match self.flank {
            ReliefFlank::Left => "left",
            ReliefFlank::Right => "right",
        };
        let place = format!("the {flank} flank near polar angle {:.2} deg", self.phi_rad.to_degrees());
        let clearance_um = 1e3 * self.clearance_mm(back_off_mm);
        match self.verdict() {
            ReliefVerdict::Clears => None,
            ReliefVerdict::Tight => {
                let percent = format!("{:.0}", 100.0 * self.ratio);
                let clearance_um = significant(clearance_um, 3);
                Some(ReliefTight { operation, back_off_mm, place, clearance_um, percent }.notice())
            }
            ReliefVerdict::Rubs => {
                let depth_um = significant(-clearance_um, 3);
                Some(ReliefRubs { operation, place, depth_um, back_off_mm }.notice())
            }
        }
    }
}
