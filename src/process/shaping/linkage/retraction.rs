//! Where the cutter stands on its return stroke: retracted from the work, by one of four laws.
//!
//! In: the pitch curve, the kind of gear, the cutter's pitch radius r_c, the pose of a stroke and the back-off
//! delta_a. Out: the [`Retracted`] pose in the gear frame. Law, with s = +1 for external and -1 for internal gears, n
//! the outward normal of the pitch curve, u from the work axis to the cutter axis O_b, and the foot phi of O_b on the
//! pitch curve:
//!
//! ```text
//! center line   O_b' = O_b + s delta_a u                    the cutter keeps its orientation
//! normal        O_b' = O_b + s delta_a n(phi)               the same
//! tilted        O_b' = O_b + s delta_a R(tilt) n(phi)       the same, turned by an angle out of the normal
//! turned        O_b' as on the center line; its foot epsilon follows from t(epsilon) . (O_b' - P(epsilon)) = 0; the
//!               cutter turns by what rolling from phi to epsilon turns it
//! ```
//!
//! The centre line is what machines do: their relief moves along the line of centres. "Turned" is the method for
//! internal gears of the paper on three-axis shaping of internal non-circular gears, whose formulas give epsilon and
//! leave the cutter angle to be solved again: the retracted cutter stands as it would in rolling on epsilon with the
//! **clearance** c = |O_b' P(epsilon)| - r_c as offset of the normal linkage, so that both flanks clear whatever the
//! angle between normal and line of centres. The work angle stays; centre distance and cutter angle move.
//!
//! Orientation of a rolling cutter in the gear frame: chi = arg(-s n) + s S / r_c. The turn chi(epsilon) - chi(phi) is
//! added to the stroke's own orientation, so that a small delta_a turns little in every linkage.
//!
//! A circle has u = n and epsilon = phi: the first, second and fourth law are one.

use std::f64::consts::FRAC_PI_2;

use glam::DVec2;

use super::ShapingLinkage;
use super::axes::CutterPose;
use gearcut_core::error::NotConverged;
use gearcut_core::gear::{GearKind, PitchCurve};
use gearcut_core::math::newton::{LastStep, newton};

/// Last step to a foot, rad: 1e-11 mm on a curve of 100 mm.
const FOOT_RAD: f64 = 1e-13;
/// Steps to a foot at most; from the foot of the stroke four or five suffice.
const FOOT_STEPS: u32 = 40;

/// How the cutter is drawn back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RetractionLaw {
    /// Along the line of centres, as the relief of standard machines.
    CenterLine,
    /// Along the normal of the pitch curve.
    Normal,
    /// Along a direction this much out of the normal, rad, counter-clockwise in the gear frame.
    Tilted(f64),
    /// Along the line of centres, the cutter turned as if it rolled on.
    Turned,
}

/// The rolling of a cutter on a pitch curve, as far as retraction needs it.
#[derive(Debug, Clone, Copy)]
pub struct RetractingCutter<'a> {
    /// The pitch curve.
    pub curve: &'a PitchCurve,
    /// On which side of it the material lies.
    pub kind: GearKind,
    /// r_c, mm.
    pub cutter_pitch_radius_mm: f64,
}

/// The cutter on its way back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Retracted {
    /// Pose in the gear frame; its angle is unwrapped like the stroke's.
    pub pose: CutterPose,
    /// Foot of the cutter axis on the pitch curve, rad, unwrapped like the stroke's phi.
    pub foot_rad: f64,
    /// Distance of the cutter's pitch circle from the pitch curve, mm.
    pub clearance_mm: f64,
}

impl<'a> RetractingCutter<'a> {
    /// The cutter that a linkage rolls.
    pub fn of(linkage: &'a ShapingLinkage) -> Self {
        Self { curve: linkage.curve(), kind: linkage.gear(), cutter_pitch_radius_mm: linkage.cutter_pitch_radius_mm() }
    }

    /// The cutter after it has been drawn back by `back_off_mm` from the pose of a stroke near `phi_rad`.
    ///
    /// # Errors
    /// The cutter axis has no foot on the pitch curve near `phi_rad`.
    pub fn retracted(
        &self,
        law: RetractionLaw,
        pose: &CutterPose,
        phi_rad: f64,
        back_off_mm: f64,
    ) -> Result<Retracted, NotConverged> {
        let side = self.kind.tip_sign();
        let foot_rad = self.foot_rad(pose.center_mm, phi_rad)?;
        let normal = self.curve.frame(foot_rad).normal;
        let direction = match law {
            RetractionLaw::CenterLine | RetractionLaw::Turned => pose.center_mm.normalize_or_zero(),
            RetractionLaw::Normal => normal,
            RetractionLaw::Tilted(tilt_rad) => DVec2::from_angle(tilt_rad).rotate(normal),
        };
        let center_mm = pose.center_mm + side * back_off_mm * direction;
        let new_foot_rad = self.foot_rad(center_mm, foot_rad)?;
        let turn_rad = match law {
            RetractionLaw::Turned => self.rolled_rad(new_foot_rad) - self.rolled_rad(foot_rad),
            _ => 0.0,
        };
        let frame = self.curve.frame(new_foot_rad);
        Ok(Retracted {
            pose: CutterPose { center_mm, angle_rad: pose.angle_rad + turn_rad },
            foot_rad: new_foot_rad,
            clearance_mm: side * (center_mm - frame.point_mm).dot(frame.normal) - self.cutter_pitch_radius_mm,
        })
    }

    /// Orientation of the cutter in the gear frame when it rolls at `phi_rad`, unwrapped, less a constant.
    fn rolled_rad(&self, phi_rad: f64) -> f64 {
        let normal_rad = phi_rad + self.curve.frame(phi_rad).mu_rad - FRAC_PI_2;
        normal_rad + self.kind.tip_sign() * self.curve.arc_mm(phi_rad) / self.cutter_pitch_radius_mm
    }

    /// Polar angle of the place of the pitch curve on whose normal the point lies, near a guess.
    fn foot_rad(&self, point_mm: DVec2, guess_rad: f64) -> Result<f64, NotConverged> {
        newton("the foot of the cutter axis", guess_rad, LastStep::relative(FOOT_RAD), FOOT_STEPS, |phi| {
            let frame = self.curve.frame(phi);
            let away_mm = point_mm - frame.point_mm;
            let rate = frame.arc_rate_mm_per_rad * (1.0 + frame.curvature_per_mm * away_mm.dot(frame.normal));
            let beside_mm = away_mm.dot(frame.tangent);
            [beside_mm, beside_mm / rate]
        })
    }
}
