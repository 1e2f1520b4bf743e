//! The centre distance at which both flanks touch at once, as a double-flank tester finds it.
//!
//! In: two gears. Out: by how much the axes come nearer or go apart from the nominal distance, at an angle of the
//! driver.
//!
//! Law: play grows with the distance of the axes (external; internal: falls). From the distance of the meshing the
//! search walks towards the side where play vanishes, however far that is, until play has changed its sign, and closes
//! in by the regula falsi ([`regula_falsi`]). It ends without a place only where the teeth lose each other before.
//! First order: delta a = s [F_R sin(mu - alpha) + F_L sin(mu + alpha)] / sin(2 alpha) with the gaps F that errors
//! close along the normals.
//!
//! Road not taken: an enclosure round what the slope of play foretells. Play bends where another pair of teeth, a
//! corner or a fillet carries, and the slope at one place foretells nothing beyond the bend.

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

/// Play that counts as none, rad: a picometre at 100 mm.
const LAST_PLAY_RAD: f64 = 1e-11;
/// First step of the centre distance, mm.
const FIRST_STEP_MM: f64 = 0.01;
/// How far beyond the place that the last two steps foretell the next one goes: this and a share of its length. Play is
/// nearly straight over some tenths of a millimetre, so that the place mostly lies between the last two steps.
const BEYOND_MM: f64 = 2e-4;
const BEYOND_SHARE: f64 = 0.02;
/// The next step is at most so much longer than the last one.
const LONGER: f64 = 16.0;
/// The longest step, modules; and where teeth lose each other, the shortest one, mm.
const LONGEST_MODULES: f64 = 0.25;
const SHORTEST_MM: f64 = 1e-4;
/// Farther from the distance of the meshing than this no teeth reach each other, modules: tips are at most so high.
const FARTHEST_MODULES: f64 = 8.0;

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
/// The teeth lose each other before both flanks touch at once.
pub fn against_mate(meshing: &Meshing, phi_1_rad: f64) -> Result<TightMesh, Refusal> {
    let pitch = meshing.pitch.at(phi_1_rad);
    tight(meshing.pitch.sign(), meshing.pitch.teeth().module_mm, |error_mm| {
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
    /// Tips that the flanks do not reach.
    pub fn new(circle: &PitchPair, addendum_mm: f64) -> Result<Self, Refusal> {
        let chains = super::flank_chain::nominal(circle, Member::Driver, [addendum_mm; 2], |_, _| 0.0)?;
        let teeth = circle.teeth().count[0];
        // With tooth 1 in the gear's space 0, the gear's tooth k meets the master's 2 - k (right) and 1 - k (left).
        let flanks = GearFlanks::build(teeth, |side, label| {
            let own = if side == Side::Right { 2 - label } else { 1 - label };
            Ok::<_, Refusal>(PolarFlank::new(chains.get(side, own)))
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
    /// The teeth lose each other before both flanks touch at once.
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
        tight(1.0, module_mm, |error_mm| {
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

/// Finds the distance at which both sides ask for the same rotation; `sign` is +1 where play grows with the distance.
fn tight(sign: f64, module_mm: f64, sides: impl Fn(f64) -> Result<[f64; 2], Refusal>) -> Result<TightMesh, Refusal> {
    let play = |error_mm: f64| sides(error_mm).map(|[right, left]| left - right);
    let found = |distance_error_mm: f64| {
        let [right, left] = sides(distance_error_mm)?;
        Ok(TightMesh { distance_error_mm, error_rad: 0.5 * (right + left) })
    };
    let first = play(0.0)?;
    if first.abs() < LAST_PLAY_RAD {
        return found(0.0);
    }
    let towards = if first > 0.0 { -sign } else { sign };
    let (mut at_mm, mut here) = (0.0_f64, first);
    let (mut step_mm, longest_mm) = (FIRST_STEP_MM, LONGEST_MODULES * module_mm);
    let nowhere = |as_far_as_mm: f64| {
        let way = if towards > 0.0 { "further apart" } else { "nearer" };
        Refusal::new(
            "gear.tooth_thickness_allowance_mm",
            format!("both flanks touch at once nowhere up to {:.3} mm {way}", as_far_as_mm.abs()),
            "use teeth nearer to the nominal thickness",
        )
    };
    while at_mm.abs() < FARTHEST_MODULES * module_mm {
        let next_mm = at_mm + towards * step_mm;
        let there = match play(next_mm) {
            Ok(there) => there,
            Err(lost) if step_mm < SHORTEST_MM => return Err(lost),
            Err(_) => {
                step_mm *= 0.25;
                continue;
            }
        };
        if there * first <= 0.0 {
            let [low, high] = if first < 0.0 { [at_mm, next_mm] } else { [next_mm, at_mm] };
            let closed = regula_falsi(|error_mm| play(error_mm).unwrap_or(f64::NAN), low, high, LAST_PLAY_RAD);
            return closed.map_or_else(|| Err(nowhere(next_mm)), found);
        }
        let left_mm = step_mm * there / (here - there);
        let wanted_mm = if left_mm > 0.0 { (1.0 + BEYOND_SHARE) * left_mm + BEYOND_MM } else { longest_mm };
        step_mm = wanted_mm.min(LONGER * step_mm).min(longest_mm);
        (at_mm, here) = (next_mm, there);
    }
    Err(nowhere(at_mm))
}
