//! The flank of a shaper cutter as it is ground: where its rake face cuts the relieved flank.
//!
//! In: rake, tip relief and pressure angle of the grinding. Out: the edge of a flank, projected on the transverse plane
//! along the stroke, and how far it lies beside the involute that the gear needs.
//!
//! **Law.** Sections of a relieved cutter are involutes of the ground pressure angle alpha_0 on the pitch circle r_c,
//! on teeth that grow thicker towards the face by the side relief: tan(alpha_s) = tan(alpha_t) tan(alpha_0) per mm of
//! the axis and flank, alpha_t the relief of the tip. The rake face is the cone z = (r - r_c) tan(gamma). The edge has
//! the half angle
//!
//! `theta(r) = h / r_c + inv(alpha_0) + tan(alpha_s) tan(gamma) (r - r_c) / r_c - inv_0(r)`
//!
//! with the half thickness h on the pitch circle, and lies `e = r_b (theta - theta_involute)` beside the involute of
//! the same thickness there, along their normals. Ground with the gear's own pressure angle, teeth are too thick at the
//! tip and too thin at the root, by (r - r_c) sin(alpha) tan(alpha_t) tan(gamma). The usual correction takes the slope
//! on the pitch circle away, tan(alpha_0) = tan(alpha) / (1 - tan(gamma) tan(alpha_t)); what is left bends the profile
//! by some micrometres.
//!
//! The tip circle is that of the scene: cutters are measured at their edge.
//!
//! Road not taken: faces stepped from tooth to tooth, as on cutters of large helix angles. Their two flanks differ, and
//! are ground with a pressure angle each.

use crate::process::shaping::scene::model::{CutterSpec, Grinding};
use crate::scene::model::Gear;
use gearcut_core::error::Refusal;
use gearcut_core::tool::edge_profile::BladeCurve;
use gearcut_core::tool::involute::inv;
use glam::DVec2;
use std::f64::consts::PI;

/// Largest difference of the ground pressure angle from the gear's: beyond it the profile is that of another cutter.
const MOST_CORRECTION_RAD: f64 = PI / 60.0;

/// One flank, the left one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundFlank {
    /// r_c.
    pitch_radius_mm: f64,
    /// alpha of the gear in the transverse section.
    pressure_angle_rad: f64,
    /// alpha_0.
    ground_angle_rad: f64,
    /// r_c cos(alpha_0).
    pub(super) base_radius_mm: f64,
    /// h / r_c + inv(alpha_0).
    half_angle_rad: f64,
    /// tan(alpha_s) tan(gamma) / r_c, rad/mm.
    taper_rad_per_mm: f64,
}

impl GroundFlank {
    /// Of a cutter for a gear, both in their transverse section, with teeth of this thickness on the pitch circle.
    ///
    /// # Errors
    /// A pressure angle of another cutter.
    pub fn new(spec: &CutterSpec, grinding: &Grinding, gear: &Gear, thickness_mm: f64) -> Result<Self, Refusal> {
        let (alpha_rad, pitch_radius_mm) = (gear.pressure_angle_rad, 0.5 * gear.module_mm * f64::from(spec.teeth));
        let (rake, relief) = (spec.rake_angle_rad.tan(), grinding.tip_relief_rad.tan());
        let corrected_rad = (alpha_rad.tan() / (1.0 - rake * relief)).atan();
        let ground_angle_rad = grinding.pressure_angle_rad.unwrap_or(corrected_rad);
        if (ground_angle_rad - alpha_rad).abs() > MOST_CORRECTION_RAD {
            let [ground, own, most] = [ground_angle_rad, alpha_rad, MOST_CORRECTION_RAD].map(f64::to_degrees);
            return Err(Refusal::new(
                "tool.shaper_cutter.grinding.pressure_angle_deg",
                format!(
                    "flanks ground with {ground:.3} deg are no small correction of {own:.3} deg, both in the \
                     transverse section: {most} deg at most"
                ),
                "leave it out for the usual correction of rake and relief",
            ));
        }
        let side_relief = relief * ground_angle_rad.tan();
        Ok(Self {
            pitch_radius_mm,
            pressure_angle_rad: alpha_rad,
            ground_angle_rad,
            base_radius_mm: pitch_radius_mm * ground_angle_rad.cos(),
            half_angle_rad: 0.5 * thickness_mm / pitch_radius_mm + inv(ground_angle_rad),
            taper_rad_per_mm: side_relief * rake / pitch_radius_mm,
        })
    }

    /// e: how far the edge lies outside of the involute of the same thickness on the pitch circle, along its normal;
    /// mm, valid outside of both base circles.
    pub fn deviation_mm(&self, radius_mm: f64) -> f64 {
        let base_mm = self.pitch_radius_mm * self.pressure_angle_rad.cos();
        let inv_at = |base_mm: f64| inv((base_mm / radius_mm).min(1.0).acos());
        let ground = inv_at(self.base_radius_mm) - inv(self.ground_angle_rad);
        let involute = inv_at(base_mm) - inv(self.pressure_angle_rad);
        base_mm * (self.taper_rad_per_mm * (radius_mm - self.pitch_radius_mm) - ground + involute)
    }

    /// Roll of its involute at a radius; 0 inside the base circle.
    pub(super) fn roll_at_radius(&self, radius_mm: f64) -> f64 {
        ((radius_mm / self.base_radius_mm).powi(2) - 1.0).max(0.0).sqrt()
    }
}

/// Over the arc of its involute from the base circle, mm.
impl BladeCurve for GroundFlank {
    fn point_and_rate(&self, arc_mm: f64) -> [DVec2; 2] {
        let base_mm = self.base_radius_mm;
        let roll = (2.0 * arc_mm / base_mm).sqrt();
        let radius_mm = base_mm * roll.hypot(1.0);
        let taper = self.taper_rad_per_mm;
        let out =
            DVec2::from_angle(self.half_angle_rad + taper * (radius_mm - self.pitch_radius_mm) - (roll - roll.atan()));
        let climb = base_mm / radius_mm;
        let turn = taper * climb - roll / (base_mm * (1.0 + roll * roll));
        [radius_mm * out, climb * out + radius_mm * turn * out.perp()]
    }
}
