//! The helix of a gear, and the helical guide on the ram that cuts it.
//!
//! In: gear, machine, pitch curve and cutter. Out: [`Helix`]: how a transverse section at a height z differs from the
//! one in the middle of the face, in the cutter's poses and on the target.
//!
//! **Law.** The guide turns the cutter about its own axis by 2 pi z / L, L its lead, while the ram passes z. In every
//! section the problem is planar, with the cutter's angle shifted by that much. The cutter's teeth then mesh as if
//! those of the gear lay 2 pi z r_c / L further along the pitch curve, on any curve and with any linkage: rolling
//! adds S / r_c to the cutter's angle, so a turn of the cutter is an arc. A constant lead therefore is a constant helix
//! angle along the pitch curve, tan(beta) = 2 pi r_c / L, for any shape of the curve.
//!
//! - On a **round** gear a section is the one in the middle, turned.
//! - On any **other** curve the teeth move along the curve, which itself does not turn: every section has teeth of its
//!   own, those of the space `space + arc / pitch`.
//!
//! Turned by an angle, the cutter's involute moves along its normals by r_b times it, and the envelope with it: by
//! cos(alpha_t) times the arc, on every curve and at every offset. The base helix angle, tan(beta_b) = tan(beta)
//! cos(alpha_t), is one for all flanks.
//!
//! Cutter and guide have one lead: the edge then sweeps a section as its projection along the helix, and the cutter is
//! its transverse profile ([`crate::process::shaping::tool::cutter`]).

use super::ShaperCutter;
use super::scene::model::{Machine, guide_hand};
use crate::measure::round_gear::is_round;
use crate::scene::model::Gear;
use gearcut_core::error::Refusal;
use gearcut_core::frame::Rigid2;
use gearcut_core::gear::{GearKind, PitchCurve};
use gearcut_core::terms::{Hand, Side};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use std::ops::Range;

/// Most rows of a band: kernels take sixteen at a time, and the contact of a wider band wanders over more strokes.
const BAND_ROWS: usize = 16;
/// A band's poses leave the cubic through their four nodes by this at most, mm: a hundredth of a nanometre.
const BAND_MM: f64 = 1e-8;

/// What a guide does to sections along the face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Helix {
    /// Lead of the guide, mm.
    pub lead_mm: f64,
    /// Lead that the gear's helix needs, mm.
    pub needed_lead_mm: f64,
    /// Hand of the guide.
    pub hand: Hand,
    /// Turn of the cutter per mm of height, rad, counter-clockwise.
    pub cutter_rad_per_mm: f64,
    /// How far the target's teeth lie along the pitch curve per mm of height: tan(beta), positive right-hand.
    arc_per_mm: f64,
    /// Turn of the target's sections per mm of height, rad; none where the pitch curve is no circle.
    turn_rad_per_mm: Option<f64>,
    /// Pitch on the pitch curve, mm.
    pitch_mm: f64,
    /// Cosine of the transverse pressure angle.
    cos_pressure_angle: f64,
    /// Distance of the furthest edge from the gear's axis, mm, at most.
    reach_mm: f64,
}

impl Helix {
    /// Helix of a gear; none of a spur gear.
    ///
    /// # Errors
    /// Drawn teeth on a curve that is no circle.
    pub fn of(
        gear: &Gear,
        machine: &Machine,
        curve: &PitchCurve,
        cutter: &ShaperCutter,
    ) -> Result<Option<Self>, Refusal> {
        if gear.helix_angle_rad == 0.0 {
            return Ok(None);
        }
        let arc_per_mm = gear.hand.sign() * gear.helix_angle_rad.tan();
        let needed_lead_mm = TAU * cutter.pitch_radius_mm / gear.helix_angle_rad.tan();
        let hand = machine.guide_hand.unwrap_or(guide_hand(gear.kind, gear.hand));
        let lead_mm = machine.guide_lead_mm.unwrap_or(needed_lead_mm);
        let turn_rad_per_mm = is_round(curve).then(|| arc_per_mm * TAU / curve.perimeter_mm());
        if turn_rad_per_mm.is_none() && cutter.drawn().is_some() {
            return Err(Refusal::new(
                "gear.helix_angle_deg",
                "drawn teeth cut helical gears on a circle alone: on another pitch curve every section has teeth of \
                its own, and the envelope of a contour is known for those in the middle of the face",
                "write helix_angle_deg = 0, [gear.pitch_curve.circle], or a cutter with involute teeth",
            ));
        }
        Ok(Some(Self {
            lead_mm,
            needed_lead_mm,
            hand,
            cutter_rad_per_mm: hand.sign() * TAU / lead_mm,
            arc_per_mm,
            turn_rad_per_mm,
            pitch_mm: curve.perimeter_mm() / f64::from(curve.pitches()),
            cos_pressure_angle: gear.transverse_pressure_angle_rad().cos(),
            reach_mm: curve.facts().largest_radius_mm + 2.0 * cutter.tip_radius_mm,
        }))
    }

    /// Pose of the cutter at a height, turned by the guide, from its pose without one.
    pub fn guided(&self, work_from_cutter: &Rigid2, z_mm: f64) -> Rigid2 {
        work_from_cutter.after(&Rigid2::new(self.cutter_rad_per_mm * z_mm, DVec2::ZERO))
    }

    /// Turn of the target's section at a height, rad; none where sections are no turned ones.
    pub fn turn_rad(&self, z_mm: f64) -> Option<f64> {
        self.turn_rad_per_mm.map(|turn| turn * z_mm)
    }

    /// How many pitches the target's teeth lie further along the pitch curve at a height.
    pub fn pitches(&self, z_mm: f64) -> f64 {
        self.arc_per_mm * z_mm / self.pitch_mm
    }

    /// Cosine of the base helix angle: a transverse height over the flank, taken along the flank's own normal.
    pub fn cos_base_helix(&self) -> f64 {
        (1.0 + (self.arc_per_mm * self.cos_pressure_angle).powi(2)).sqrt().recip()
    }

    /// Normal of a flank in space from its normal in the section.
    pub fn flank_normal(&self, side: Side, in_section: DVec2) -> DVec3 {
        self.cos_base_helix() * in_section.extend(-self.climb(side))
    }

    /// How far the section of a flank moves along its normal per mm of height.
    pub fn climb(&self, side: Side) -> f64 {
        side.sign() * self.arc_per_mm * self.cos_pressure_angle
    }

    /// Slope of the flanks' helix against the target that this guide leaves: normal deviation over the face, positive
    /// where the upper end of a left flank keeps more material; of right flanks the opposite.
    pub fn slope(&self, gear: GearKind, cutter_radius_mm: f64) -> f64 {
        let cut_per_mm = -gear.tip_sign() * self.cutter_rad_per_mm * cutter_radius_mm;
        (cut_per_mm - self.arc_per_mm) * self.cos_pressure_angle * self.cos_base_helix()
    }

    /// Rows that are cut together, while the axes rest or not: with one set of rays and poses on a cubic along them on
    /// a round gear at rest, else each row for itself.
    pub fn bands(&self, rows_z_mm: &[f64], rests: bool) -> Vec<Range<usize>> {
        let most_mm = match self.turn_rad_per_mm {
            Some(turn) if rests => {
                // The cubic through Chebyshev nodes misses a rotation by angle^4 / 192.
                let rate = turn.abs() + self.cutter_rad_per_mm.abs();
                2.0 * (192.0 * BAND_MM / self.reach_mm).powf(0.25) / rate
            }
            _ => 0.0,
        };
        let mut bands: Vec<Range<usize>> = Vec::new();
        for row in 0..rows_z_mm.len() {
            match bands.last_mut() {
                Some(band) if band.len() < BAND_ROWS && rows_z_mm[row] - rows_z_mm[band.start] <= most_mm => {
                    band.end = row + 1;
                }
                _ => bands.push(row..row + 1),
            }
        }
        bands
    }
}
