//! The settings that hold: those of the scene, and those that follow from the blank, the spiral angle and the head.
//!
//! In: the scene's settings, its blank and mean cutter radius. Out: complete settings, and what they say of the cutter.
//!
//! **What is left out** becomes: the machine's root angle that of the blank; radial setting and cradle angle those of
//! the spiral angle; with a spiral angle the sliding base that which brings the tips of the blades to the root cone in
//! the middle of the face; the ratio of roll that which generates the mean point in the middle of the roll. Blank
//! offset, cross shift, centre to back and modified roll are never computed: they are choices.

use super::scene::model::Bevel;
use gearcut_core::bevel::blank::BevelBlank;
use gearcut_core::bevel::cradle::CradleSettings;
use gearcut_core::bevel::ease_off::Setting;
use gearcut_core::bevel::inferred::InferredCutter;
use gearcut_core::error::Refusal;
use std::f64::consts::PI;

/// Key of the tilt, and the most that head and root angle lean together: at a right angle A and C are one turn.
const TILT_KEY: &str = "machine.cradle.tilt_deg";
const LARGEST_LEAN_RAD: f64 = 89.5 * PI / 180.0;

impl Bevel {
    /// Complete settings, and what they say of the cutter.
    ///
    /// # Errors
    /// An offset beyond the head, a tilt that no machine here cuts with.
    pub(super) fn settings_on(&self, blank: &BevelBlank) -> Result<(CradleSettings, InferredCutter), Refusal> {
        let of = &self.settings;
        let mut settings = of.cradle;
        settings.root_angle_rad = of.root_angle_rad.unwrap_or(blank.root_angle_rad);
        if let Some((spiral_rad, radius_mm)) = of.spiral_angle_rad.zip(self.head.radius_mm) {
            settings = settings.through_mean_point(blank, radius_mm, spiral_rad)?;
            settings.sliding_base_mm = of.sliding_base_mm.unwrap_or_else(|| settings.short_of_mm(blank.mean_root_mm()));
        }
        let inferred = InferredCutter::new(&settings, blank);
        settings.roll.ratio = of.roll_ratio.unwrap_or(inferred.roll_ratio);
        tilted(&self.with_errors(&settings))?;
        Ok((settings, inferred))
    }

    /// Settings with the machine's errors.
    pub(super) fn with_errors(&self, settings: &CradleSettings) -> CradleSettings {
        self.settings.errors.iter().fold(*settings, |settings, &(setting, error)| {
            let mut off = setting.off_by(error, &settings);
            if setting == Setting::RollRatio {
                off.roll.ratio_error += error;
            }
            off
        })
    }

    /// Where radial setting and cradle angle come from.
    pub(super) fn settings_source(&self) -> &'static str {
        match self.settings.spiral_angle_rad {
            Some(_) => "computed from spiral angle, cutter radius and blank",
            None => "given by the scene",
        }
    }
}

/// Refuses tilts that no machine here cuts with.
fn tilted(settings: &CradleSettings) -> Result<(), Refusal> {
    let tilt_rad = settings.tilt.tilt_rad;
    if tilt_rad != 0.0 && settings.plunges() {
        return Err(Refusal::new(
            TILT_KEY,
            "a tilted head does not plunge: its shallower cones do not lie within the one at full depth",
            "lean the work by machine.cradle.root_angle_deg, or give a ratio of roll",
        ));
    }
    if tilt_rad != 0.0 && settings.root_angle_rad + tilt_rad > LARGEST_LEAN_RAD {
        let [lean, most] = [settings.root_angle_rad + tilt_rad, LARGEST_LEAN_RAD].map(f64::to_degrees);
        return Err(Refusal::new(
            TILT_KEY,
            format!("with the root angle the head may lean {lean:.3} deg: it would run along the axis of the work"),
            format!("keep tilt and root angle together below {most} deg"),
        ));
    }
    Ok(())
}
