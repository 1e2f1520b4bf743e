//! The centre distance at which both flanks touch at once, as a double-flank tester finds it.
//!
//! In: two gears. Out: by how much the axes come nearer or go apart from the nominal distance, at an angle of the
//! driver.
//!
//! Law: play grows steadily with the distance of the axes (external; internal: falls), so the place where it is zero is
//! enclosed and found by the regula falsi ([`regula_falsi`]). First order: delta a =
//! s [F_R sin(mu - alpha) + F_L sin(mu + alpha)] / sin(2 alpha) with the gaps F that errors close along the normals.

use std::f64::consts::TAU;

use glam::DVec2;

use super::assembly::{Meshing, first_touch};
use super::contact::PairPose;
use super::flank_chain::{FlankChain, GearFlanks, PolarFlank};
use super::pitch_pair::{Member, PitchPair};
use gearcut_core::error::Refusal;
use gearcut_core::gear::PitchCurve;
use gearcut_core::math::roots::regula_falsi;
use gearcut_core::terms::Side;

/// How far from the nominal distance the tight one is looked for, modules.
const REACH_MODULES: f64 = 0.2;
/// Play that counts as none, rad: a picometre at 100 mm.
const LAST_PLAY_RAD: f64 = 1e-11;
/// First step of the centre distance, mm, and how near to what it foretells the tight distance is enclosed at first:
/// this and a share of its length. Play is nearly straight over some tenths of a millimetre.
const FIRST_STEP_MM: f64 = 0.01;
const FORETOLD_MM: f64 = 2e-4;
const FORETOLD_SHARE: f64 = 0.02;
/// How much wider the next enclosure is where one did not hold it.
const WIDER: f64 = 4.0;

/// A tight mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TightMesh {
    /// Tight centre distance less the nominal one, mm.
    pub distance_error_mm: f64,
    /// Rotation of the driven gear less the nominal one, rad.
    pub error_rad: f64,
}

/// Tight mesh against the mate at an angle of the driver; the distance is counted from that of the meshing.
///
/// # Errors
/// No tight distance within a fifth of a module.
pub fn against_mate(meshing: &Meshing, phi_1_rad: f64) -> Result<TightMesh, Refusal> {
    let pitch = meshing.pitch.at(phi_1_rad);
    tight(REACH_MODULES * meshing.pitch.teeth().module_mm, |error_mm| {
        let [right, left] = [Side::Right, Side::Left].map(|side| meshing.side(&pitch, side, error_mm));
        Ok([right?.error_rad, left?.error_rad])
    })
}

/// A circular master gear with involute teeth.
#[derive(Debug, Clone)]
pub struct Master {
    flanks: GearFlanks<PolarFlank>,
    pitch_radius_mm: f64,
    half_pitch_rad: f64,
}

impl Master {
    /// From a pair of equal circular gears: the master is its driver, with spaces centred on angle 0.
    ///
    /// # Errors
    /// Flanks that cannot be rolled.
    pub fn new(circle: &PitchPair, addendum_mm: f64) -> Result<Self, Refusal> {
        let chains = super::flank_chain::nominal(circle, Member::Driver, [addendum_mm; 2], |_, _| 0.0)?;
        let teeth = circle.teeth().count[0];
        // With tooth 1 in the gear's space 0, the gear's tooth k meets the master's 2 - k (right) and 1 - k (left).
        let flanks = GearFlanks::build(teeth, |side, label| {
            let own = if side == Side::Right { 2 - label } else { 1 - label };
            PolarFlank::new(chains.get(side, own))
        })?;
        let pitch_radius_mm = circle.pitch_mm() * f64::from(teeth) / TAU;
        Ok(Self { flanks, pitch_radius_mm, half_pitch_rad: 0.5 * TAU / f64::from(teeth) })
    }

    /// Nominal distance of the axes and work angle when the pitch circle touches the gear's pitch curve at `phi_rad`.
    pub fn nominal(&self, curve: &PitchCurve, phi_rad: f64) -> (f64, f64) {
        let frame = curve.frame(phi_rad);
        let center = frame.point_mm + self.pitch_radius_mm * frame.normal;
        (center.length(), phi_rad + wrapped(center.to_angle() - phi_rad))
    }

    /// Tight mesh of a gear (own frame, moved by its eccentricity) against the master where the pitch curve touches the
    /// master's pitch circle at `phi_rad`; the work angle is held.
    ///
    /// # Errors
    /// No tight distance within a fifth of a module.
    pub fn against(
        &self,
        curve: &PitchCurve,
        gear: &GearFlanks<FlankChain>,
        module_mm: f64,
        phi_rad: f64,
    ) -> Result<TightMesh, Refusal> {
        let frame = curve.frame(phi_rad);
        let (distance_mm, work_rad) = self.nominal(curve, phi_rad);
        let arc_mm = curve.arc_mm(phi_rad);
        let own_angle = self.half_pitch_rad - arc_mm / self.pitch_radius_mm;
        let phi_2_rad = (-frame.normal).to_angle() - work_rad - own_angle;
        let at = (arc_mm / (self.half_pitch_rad * 2.0 * self.pitch_radius_mm)).round() as i64;
        tight(REACH_MODULES * module_mm, |error_mm| {
            let axis_2_mm = DVec2::new(distance_mm + error_mm, 0.0);
            let stand = PairPose { phi_1_rad: work_rad, axis_2_mm, phi_2_rad, sign: 1.0 };
            let [right, left] = [Side::Right, Side::Left].map(|side| first_touch(gear, &self.flanks, &stand, side, at));
            Ok([right?.error_rad, left?.error_rad])
        })
    }
}

fn wrapped(angle_rad: f64) -> f64 {
    angle_rad - TAU * (angle_rad / TAU).round()
}

/// Finds the distance at which both sides ask for the same rotation.
fn tight(reach_mm: f64, sides: impl Fn(f64) -> Result<[f64; 2], Refusal>) -> Result<TightMesh, Refusal> {
    let mut failed = None;
    let mut play = |error_mm: f64| {
        sides(error_mm).map_or_else(
            |refusal| {
                failed = Some(refusal);
                f64::NAN
            },
            |[right, left]| left - right,
        )
    };
    let at = [play(0.0), play(FIRST_STEP_MM)];
    let slope = (at[1] - at[0]) / FIRST_STEP_MM;
    let foretold_mm = if slope == 0.0 { 0.0 } else { (-at[0] / slope).clamp(-reach_mm, reach_mm) };
    let rising = if slope > 0.0 { 1.0 } else { -1.0 };
    // Where a corner or a fillet carries, play bends: the enclosure grows until it holds the place.
    let mut near_mm = FORETOLD_MM + FORETOLD_SHARE * foretold_mm.abs();
    let found = loop {
        let end = |towards: f64| (foretold_mm + towards * near_mm).clamp(-reach_mm, reach_mm);
        let found = regula_falsi(&mut play, end(-rising), end(rising), LAST_PLAY_RAD);
        if found.is_some() || near_mm > 2.0 * reach_mm {
            break found;
        }
        near_mm *= WIDER;
    };
    let distance_error_mm = match (found, failed) {
        (_, Some(refusal)) => return Err(refusal),
        (Some(found), None) => found,
        (None, None) => {
            return Err(Refusal::new(
                "gear.tooth_thickness_allowance_mm",
                format!("both flanks touch at once nowhere within {reach_mm} mm of the nominal centre distance"),
                "use teeth nearer to the nominal thickness",
            ));
        }
    };
    let [right, left] = sides(distance_error_mm)?;
    Ok(TightMesh { distance_error_mm, error_rad: 0.5 * (right + left) })
}
