//! What a pair is rolled with, beyond its two scenes.
//!
//! In: options of the command. Out: checked values and the errors of mounting in the frames of the pair.

use glam::DVec2;

use super::fit::Fit;
use super::flanks::FlankSource;
use crate::pair::assembly::AssemblyErrors;
use crate::pair::flank_chain::BEYOND_MODULES;
use crate::pair::rolling::turns_of_period;
use crate::scene::model::Gear;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::units::UM_PER_MM;

/// Largest inclination of the axes, mm per mm: sections are taken across either axis alike, which leaves out half the
/// square of it, 5e-5 of a radius.
const LARGEST_INCLINATION: f64 = 0.01;
/// Positions where none are asked for: as many as the harmonics of the mesh need, and a smooth chart.
const USUAL_POSITIONS: usize = 2000;
/// Fewest positions for each tooth of the period.
const POSITIONS_PER_TOOTH: usize = 12;
/// Sections where none are asked for, on gears whose sections differ.
const USUAL_SECTIONS: usize = 11;

/// What a pair is rolled with.
#[derive(Debug, Clone, PartialEq)]
pub struct PairOptions {
    /// Which flanks.
    pub source: FlankSource,
    /// Positions in a period; `None`: 2,000, or 12 for each tooth if that is more.
    pub positions: Option<usize>,
    /// Transverse sections; `None`: 1 where errors let all be alike, else 11.
    pub sections: Option<usize>,
    /// Distance of the axes; `None`: what the scenes name, else that of the shifts of round gears and the closing one
    /// of others.
    pub center_distance_mm: Option<f64>,
    /// Added to that distance.
    pub center_distance_error_um: f64,
    /// How far each gear sits off its axis of rotation, and at which polar angle of its scene, deg.
    pub eccentricity_um_deg: [[f64; 2]; 2],
    /// Teeth by which gear B is turned on.
    pub phase_teeth: i64,
    /// How far the axes depart from parallel over the common face: in their plane, and out of it.
    pub parallelism_um: [f64; 2],
    /// Thickness of the marking compound of contact patterns.
    pub marking_um: f64,
}

impl Default for PairOptions {
    fn default() -> Self {
        Self {
            source: FlankSource::Cut,
            positions: None,
            sections: None,
            center_distance_mm: None,
            center_distance_error_um: 0.0,
            eccentricity_um_deg: [[0.0; 2]; 2],
            phase_teeth: 0,
            parallelism_um: [0.0; 2],
            marking_um: 6.0,
        }
    }
}

impl PairOptions {
    /// Sets the option of this name, which is that of the command's argument with `_` for `-`; false if there is none.
    ///
    /// # Errors
    /// In words: no such value.
    pub fn set(&mut self, name: &str, value: &str) -> Result<bool, String> {
        let number = |least: f64, allowed: &str| {
            let number = value.parse::<f64>().ok().filter(|number| number.is_finite() && *number >= least);
            number.ok_or_else(|| format!("`{name}` is {allowed}, not {value}"))
        };
        let any = || number(f64::NEG_INFINITY, "a number");
        let size = || number(0.0, "0 or more");
        let above = || number(f64::MIN_POSITIVE, "a number above 0");
        let count = || {
            let count = value.parse::<usize>().ok().filter(|&count| count > 0);
            count.ok_or_else(|| format!("`{name}` is a whole number above 0, not {value}"))
        };
        match name {
            "flanks" => {
                self.source = match value {
                    "cut" => FlankSource::Cut,
                    "nominal" => FlankSource::Nominal,
                    _ => return Err(format!("`{value}` are no flanks; give \"cut\" or \"nominal\"")),
                }
            }
            "positions" => self.positions = Some(count()?),
            "sections" => self.sections = Some(count()?),
            "center_distance_mm" => self.center_distance_mm = Some(above()?),
            "center_distance_error_um" => self.center_distance_error_um = any()?,
            "eccentricity_a_um" => self.eccentricity_um_deg[0][0] = size()?,
            "eccentricity_a_at_deg" => self.eccentricity_um_deg[0][1] = any()?,
            "eccentricity_b_um" => self.eccentricity_um_deg[1][0] = size()?,
            "eccentricity_b_at_deg" => self.eccentricity_um_deg[1][1] = any()?,
            "parallelism_in_plane_um" => self.parallelism_um[0] = any()?,
            "parallelism_out_of_plane_um" => self.parallelism_um[1] = any()?,
            "phase_teeth" => {
                self.phase_teeth = value.parse().map_err(|_| format!("`{name}` is a whole number, not {value}"))?;
            }
            "marking_um" => self.marking_um = above()?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Sections that are looked at; `errors_vary` says whether errors let those of a gear differ along the tooth.
    ///
    /// # Errors
    /// One section where contact wanders along the face; those of `errors_vary`.
    pub fn sections(&self, gears: [&Gear; 2], errors_vary: impl FnOnce() -> Result<bool>) -> Result<usize> {
        let wanders = gears[0].helix_angle_rad != 0.0 || self.parallelism_um != [0.0; 2];
        match self.sections {
            None => Ok(if wanders || errors_vary()? { USUAL_SECTIONS } else { 1 }),
            Some(1) if wanders => Err(Refusal::new(
                "sections",
                "1 section is too few where teeth are helical or axes out of parallel: contact wanders along the face",
                format!("leave --sections out for {USUAL_SECTIONS}, or give 3 or more"),
            )
            .into()),
            Some(count) => Ok(count),
        }
    }

    /// Positions in a period.
    pub fn positions(&self, count: [u32; 2]) -> usize {
        let teeth = (turns_of_period(count) * count[0]) as usize;
        self.positions.unwrap_or_else(|| USUAL_POSITIONS.max(POSITIONS_PER_TOOTH * teeth))
    }

    /// Errors of mounting in the frames of the pair.
    ///
    /// # Errors
    /// A centre distance at which the teeth would not meet; axes too far out of parallel.
    pub fn mounting(&self, fit: &Fit, gears: [&Gear; 2]) -> Result<AssemblyErrors, Refusal> {
        let error_mm = fit.named_off_mm + self.center_distance_error_um / UM_PER_MM;
        self.teeth_reach(fit, error_mm)?;
        let face_mm = gears[0].face_width_mm.min(gears[1].face_width_mm);
        let most_um = UM_PER_MM * LARGEST_INCLINATION * face_mm;
        if let Some(um) = self.parallelism_um.into_iter().find(|um| um.abs() > most_um) {
            return Err(Refusal::new(
                "parallelism",
                format!(
                    "axes {um} um out of parallel over a face of {face_mm} mm are inclined by more than \
                     {LARGEST_INCLINATION}: sections across one axis are no longer sections across the other"
                ),
                format!("give -{most_um:.0} to {most_um:.0} um"),
            ));
        }
        let off = |[um, deg]: [f64; 2]| um / UM_PER_MM * DVec2::from_angle(deg.to_radians());
        let [a, b] = self.eccentricity_um_deg.map(off);
        Ok(AssemblyErrors {
            center_distance_error_mm: error_mm,
            eccentricity_mm: [a, fit.in_pair(b)],
            inclination: DVec2::from(self.parallelism_um) / (UM_PER_MM * face_mm),
        })
    }

    /// Whether the teeth reach each other, and no deeper than there are flanks, so far off the distance at which the
    /// pitch curves roll on each other.
    fn teeth_reach(&self, fit: &Fit, error_mm: f64) -> Result<(), Refusal> {
        let deep_mm: f64 = fit.addendum_mm.iter().sum();
        let swing_mm = self.eccentricity_um_deg.iter().map(|[um, _]| um / UM_PER_MM).sum::<f64>();
        // Below the deepest contact nominal flanks end after a while; cut ones go on into the root.
        let deeper_mm = match self.source {
            FlankSource::Nominal => deep_mm.min(BEYOND_MODULES * fit.own.module_mm),
            FlankSource::Cut => deep_mm,
        };
        let apart_mm = fit.pitch.sign() * error_mm;
        let range_mm = [-deeper_mm, deep_mm - swing_mm];
        if apart_mm >= range_mm[0] && apart_mm < range_mm[1] {
            return Ok(());
        }
        let why = if apart_mm < range_mm[0] {
            "the tips come deeper than the flanks that are rolled".to_owned()
        } else {
            format!("the teeth overlap by {deep_mm:.3} mm there, eccentricities take {swing_mm:.3} mm, and they part")
        };
        let closing_mm = fit.pitch.center_distance_mm();
        let problem = format!(
            "the axes would be {:.6} mm apart, {error_mm:.3} mm from the {closing_mm:.6} mm at which the pitch curves \
             roll on each other: {why}",
            closing_mm + error_mm
        );
        if range_mm[1] <= range_mm[0] {
            return Err(Refusal::new("eccentricity_um", problem, "give smaller eccentricities"));
        }
        let [one, other] = range_mm.map(|mm| fit.pitch.sign() * mm);
        let (low_mm, high_mm) = (one.min(other), one.max(other));
        // A named distance that is off is to blame before an error that is added to it.
        if fit.named_off_mm != 0.0 {
            let [low_mm, high_mm] =
                [low_mm, high_mm].map(|mm| closing_mm + mm - self.center_distance_error_um / UM_PER_MM);
            let way_out = format!(
                "name {low_mm:.3} to {high_mm:.3} mm (--center-distance-mm or gear.center_distance_mm), or none for \
                 {closing_mm:.6} mm"
            );
            return Err(Refusal::new("center_distance_mm", problem, way_out));
        }
        let [low_um, high_um] = [low_mm, high_mm].map(|mm| UM_PER_MM * mm);
        let any = if fit.round_involutes {
            "; involutes on round gears roll at any --center-distance-mm at which they meet"
        } else {
            ""
        };
        let way_out = format!("give {low_um:.0} to {high_um:.0} um of --center-distance-error-um{any}");
        Err(Refusal::new("center_distance_error_um", problem, way_out))
    }
}
