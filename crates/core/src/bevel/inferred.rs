//! What settings say of a cutter that nobody has written down.
//!
//! In: settings and blank. Out: the mean cutter radius and mean spiral angle that the settings place on the mean point,
//! and the ratio of roll that they should have.
//!
//! In the plane of the root cone the machine centre, the head's middle and the mean point make a triangle: with S_r and
//! q the head stands V = S_r sin q across and H = S_r cos q along the line to the mean point, which is R_m cos(theta_f)
//! away, theta_f the dedendum angle. A circle through that point has the radius and there the spiral angle of the
//! vector between them. A crown gear in that plane rolls on the gear with cos(theta_f) / sin(gamma). Both hold for
//! settings without offset and without modified roll that let the head's circle run through the mean point.

use super::blank::BevelBlank;
use super::cradle::CradleSettings;
use glam::DVec2;

/// What follows from settings and blank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InferredCutter {
    /// Mean cutter radius r_c, mm.
    pub radius_mm: f64,
    /// Mean spiral angle, rad, positive.
    pub spiral_angle_rad: f64,
    /// Ratio of roll of a crown gear in the plane of the root cone.
    pub roll_ratio: f64,
}

impl InferredCutter {
    /// Of settings and a blank.
    pub fn new(settings: &CradleSettings, blank: &BevelBlank) -> Self {
        let dedendum_cos = blank.dedendum_angle_rad().cos();
        let head = settings.radial_setting_mm * DVec2::from_angle(settings.cradle_angle_rad.abs());
        let to_head = head - DVec2::new(blank.mean_cone_distance_mm() * dedendum_cos, 0.0);
        Self {
            radius_mm: to_head.length(),
            spiral_angle_rad: (-to_head.x).atan2(to_head.y),
            roll_ratio: dedendum_cos / blank.pitch_angle_rad.sin(),
        }
    }
}
