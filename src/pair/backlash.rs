//! The play between driving and back flanks, in the measures that are used for it.
//!
//! In: a moment of the pair. Out: the play as angle of the driven gear and as lengths.
//!
//! j_angle is what the driven gear can turn while the driver is held; j_c = r2 j_angle across the line of centres at
//! the pitch point; j_t = j_c sin(mu) along the pitch curves; normal to the flanks j_n = j_c sin(mu -+ alpha)
//! cos(beta_b), which differs between both sides where the pitch curves are not round. With negative play the pair
//! would jam.

use super::assembly::Moment;
use super::pitch_pair::PitchPair;
use gearcut_core::terms::Side;

/// Backlash of a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Backlash {
    /// Play of the driven gear, rad.
    pub angle_rad: f64,
    /// Across the line of centres at the pitch point, mm.
    pub circumferential_mm: f64,
    /// Along the pitch curves, mm.
    pub tangential_mm: f64,
    /// Gap of the right flanks while the left ones touch, along their normal, mm.
    pub normal_right_mm: f64,
    /// Gap of the left flanks while the right ones touch, along their normal, mm.
    pub normal_left_mm: f64,
}

impl Backlash {
    /// Backlash of a moment.
    pub fn of(pair: &PitchPair, moment: &Moment) -> Self {
        let pitch = &moment.pitch;
        let angle_rad = moment.left.error_rad - moment.right.error_rad;
        let circumferential_mm = pitch.radius_mm[1] * angle_rad;
        Self {
            angle_rad,
            circumferential_mm,
            tangential_mm: circumferential_mm * pitch.mu_rad.sin(),
            normal_right_mm: angle_rad * pair.arm_mm(pitch, Side::Right),
            normal_left_mm: angle_rad * pair.arm_mm(pitch, Side::Left),
        }
    }
}
