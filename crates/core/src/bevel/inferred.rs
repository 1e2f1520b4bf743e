//! What settings say of a cutter that nobody has written down, and the settings of a cutter for a spiral angle.
//!
//! In: settings and blank. Out: the mean cutter radius and mean spiral angle that the settings place on the mean point,
//! and the ratio of roll that they should have. The other way round, in: cutter radius, spiral angle and blank. Out:
//! radial setting and cradle angle.
//!
//! In the plane of the root cone the machine centre, the head's middle and the mean point make a triangle: with S_r and
//! q the head stands V = S_r sin q + E_m across and H = S_r cos q along the line to the mean point, which is
//! R_m cos(theta_f) away, theta_f the dedendum angle. A circle through that point has the radius and there the spiral
//! angle psi of the vector between them. Read backwards that is
//!
//! ```text
//! S_r sin q = r_c cos(psi) - E_m,    S_r cos q = R_m cos(theta_f) - r_c sin(psi)
//! ```
//!
//! the settings of a crown gear that rolls in the plane of the root cone (Litvin and Fuentes, Gear Geometry and Applied
//! Theory, 2004, chapter 21). A tilted head has no such closed form: the direction of its lean follows the cradle
//! angle.
//!
//! The mean point is generated in the middle of the roll where tool and work move along the tooth against each other
//! there. Seen along the cradle's axis the crown gear's point moves by (E_m, R_m cos theta_f) per radian, the work's by
//! (0, R_a R_m sin gamma); their difference runs along the tooth where
//!
//! ```text
//! R_a = (cos theta_f - E_m tan(psi) / R_m) / sin(gamma)
//! ```
//!
//! Without offset that is the ratio of a crown gear in the plane of the root cone. All of this holds for settings
//! without modified roll that let the head's circle run through the mean point.

use super::blank::BevelBlank;
use super::cradle::{CradleSettings, Tilt};
use crate::error::Refusal;
use crate::parameter;
use glam::DVec2;

/// What follows from settings and blank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InferredCutter {
    /// Mean cutter radius r_c, mm.
    pub radius_mm: f64,
    /// Mean spiral angle, rad, positive.
    pub spiral_angle_rad: f64,
    /// Ratio of roll that generates the mean point in the middle of the roll.
    pub roll_ratio: f64,
}

impl InferredCutter {
    /// Of settings and a blank.
    pub fn new(settings: &CradleSettings, blank: &BevelBlank) -> Self {
        let dedendum_cos = blank.dedendum_angle_rad().cos();
        // Both hands as one: mirrored at the plane of the axes.
        let offset_mm = settings.blank_offset_mm * settings.cradle_angle_rad.signum();
        let head = settings.radial_setting_mm * DVec2::from_angle(settings.cradle_angle_rad.abs());
        let mut to_head = head + DVec2::new(-blank.mean_cone_distance_mm() * dedendum_cos, offset_mm);
        if !settings.tilt.is_none() {
            // The circle lies square to the leaning axis; its tangent is seen along the cradle's axis.
            let hand = settings.cradle_angle_rad.signum();
            let Tilt { tilt_rad, swivel_rad } = settings.tilt;
            let lean = settings.cradle_angle_rad.abs() + hand * swivel_rad;
            let axis = (tilt_rad.sin() * DVec2::from_angle(lean)).extend(tilt_rad.cos());
            let height_mm = settings.sliding_base_mm - settings.machine_from_axial_mm(blank.mean_root_mm()).z;
            let arm = to_head.extend(height_mm).reject_from(axis);
            to_head = arm.length() * axis.cross(arm).truncate().normalize().perp() * -1.0;
        }
        let tan_spiral = -to_head.x / to_head.y;
        Self {
            radius_mm: to_head.length(),
            spiral_angle_rad: (-to_head.x).atan2(to_head.y),
            roll_ratio: (dedendum_cos - offset_mm * tan_spiral / blank.mean_cone_distance_mm())
                / blank.pitch_angle_rad.sin(),
        }
    }
}

impl CradleSettings {
    /// The same settings with the radial setting and the cradle angle that lead an upright head of this mean radius
    /// through the mean point at this spiral angle. Like the cradle angle it is positive for right-hand spirals.
    ///
    /// # Errors
    /// A blank offset beyond the head, whose cradle angle would be that of the other hand.
    pub fn through_mean_point(
        &self,
        blank: &BevelBlank,
        radius_mm: f64,
        spiral_angle_rad: f64,
    ) -> Result<Self, Refusal> {
        let (hand, spiral_rad) = (spiral_angle_rad.signum(), spiral_angle_rad.abs());
        let [across_mm, offset_mm] = [radius_mm * spiral_rad.cos(), hand * self.blank_offset_mm];
        if offset_mm >= across_mm {
            return Err(Refusal::new(
                parameter::BLANK_OFFSET,
                format!(
                    "an offset of {} mm takes the cradle's axis past the head, whose middle is {across_mm:.4} mm \
                     beside the mean point",
                    self.blank_offset_mm
                ),
                "check its sign, or take a larger cutter",
            ));
        }
        let along_mm = blank.mean_cone_distance_mm() * blank.dedendum_angle_rad().cos() - radius_mm * spiral_rad.sin();
        let head = DVec2::new(along_mm, across_mm - offset_mm);
        Ok(Self { radial_setting_mm: head.length(), cradle_angle_rad: hand * head.to_angle(), ..*self })
    }
}
