//! What a pair is rolled with, beyond its two scenes.
//!
//! In: options of the command. Out: checked values and the errors of mounting in the frames of the pair.

use glam::DVec2;

use super::fit::Fit;
use super::flanks::FlankSource;
use crate::pair::assembly::AssemblyErrors;
use crate::pair::rolling::turns_of_period;
use crate::scene::model::Gear;
use gearcut_core::error::Refusal;
use gearcut_core::units::UM_PER_MM;

/// Farthest that the centre distance may be from the closing one, modules: the flanks of a round pair of standard teeth
/// still reach each other, and contact of one pair ends before that of the next begins soon after.
const LARGEST_DISTANCE_ERROR_MODULES: f64 = 0.2;
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
    /// Transverse sections; `None`: 1 where all are alike, else 11.
    pub sections: Option<usize>,
    /// Added to the closing centre distance.
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
            center_distance_error_um: 0.0,
            eccentricity_um_deg: [[0.0; 2]; 2],
            phase_teeth: 0,
            parallelism_um: [0.0; 2],
            marking_um: 6.0,
        }
    }
}

impl PairOptions {
    /// Sections that are looked at.
    ///
    /// # Errors
    /// One section of gears whose sections differ.
    pub fn sections(&self, gears: [&Gear; 2]) -> Result<usize, Refusal> {
        let differ = gears[0].helix_angle_rad != 0.0 || self.parallelism_um != [0.0; 2];
        match self.sections {
            None => Ok(if differ { USUAL_SECTIONS } else { 1 }),
            Some(1) if differ => Err(Refusal::new(
                "sections",
                "1 section is too few where teeth are helical or axes out of parallel: contact wanders along the face",
                format!("leave --sections out for {USUAL_SECTIONS}, or give 3 or more"),
            )),
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
    /// A centre distance at which the teeth would not meet.
    pub fn mounting(&self, fit: &Fit, gears: [&Gear; 2]) -> Result<AssemblyErrors, Refusal> {
        let error_mm = self.center_distance_error_um / UM_PER_MM;
        let most_mm = LARGEST_DISTANCE_ERROR_MODULES * fit.pitch.teeth().module_mm;
        if error_mm.abs() > most_mm {
            let closing_mm = fit.pitch.center_distance_mm();
            let play_mm = 2.0 * fit.pitch.sign() * error_mm * fit.pitch.teeth().pressure_angle_rad.tan();
            return Err(Refusal::new(
                "center_distance_error_um",
                format!(
                    "the axes would stand {:.6} mm apart, {error_mm:.3} mm from the {closing_mm:.6} mm at which the \
                    pair closes: a play of about {play_mm:.3} mm on the pitch curves; up to {most_mm:.3} mm (a fifth \
                    of a module) can be rolled",
                    closing_mm + error_mm
                ),
                format!("give -{0:.0} to {0:.0} um", UM_PER_MM * most_mm),
            ));
        }
        let face_mm = gears[0].face_width_mm.min(gears[1].face_width_mm);
        let off = |[um, deg]: [f64; 2]| um / UM_PER_MM * DVec2::from_angle(deg.to_radians());
        let [a, b] = self.eccentricity_um_deg.map(off);
        Ok(AssemblyErrors {
            center_distance_error_mm: error_mm,
            eccentricity_mm: [a, fit.in_pair(b)],
            inclination: DVec2::from(self.parallelism_um) / (UM_PER_MM * face_mm),
        })
    }
}
