//! The path of contact between the tips, and how many teeth share it.
//!
//! In: the pitch pair and the tip heights. Out: where the line of action leaves both tip curves at a moment, when a
//! tooth passes them, and the contact ratios that follow.
//!
//! The contact ratio of a moment is the length of the line of action between both tip curves over p cos(alpha); that of
//! a tooth is the arc rolled between its passages of both tips over p. On circular gears they are equal:
//! (sqrt(ra1^2 - rb1^2) + s sqrt(ra2^2 - rb2^2) - s a sin(alpha)) / (p cos(alpha)) (ISO 21771, 5.4.1). Both count the
//! flanks as if they went on down to the mate's tip.

use glam::DVec2;

use super::pitch_pair::{Member, PitchPair, PitchPoint, passing};
use gearcut_core::error::Refusal;
use gearcut_core::terms::Side;

/// Path of contact at a moment: distances from the pitch point along v, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathOfContact {
    /// Where the driver's tip curve cuts it.
    pub driver_tip_mm: f64,
    /// Where the driven gear's tip curve cuts it.
    pub driven_tip_mm: f64,
}

/// Passage of one tooth through the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg(feature = "testing")]
pub struct ToothPath {
    /// Driver's angle at which the flank leaves (right) or meets (left) the driven gear's tip.
    pub phi_at_driven_tip_rad: f64,
    /// Driver's angle at which contact is at the driver's own tip.
    pub phi_at_driver_tip_rad: f64,
    /// Arc rolled between both, over the pitch.
    pub contact_ratio: f64,
    /// Height over the driver's pitch curve of the deepest contact on the driver, mm.
    pub deepest_on_driver_mm: f64,
    /// Height over the driven pitch curve of the deepest contact on the driven gear, mm.
    pub deepest_on_driven_mm: f64,
}

/// Path of contact of a moment between the tip curves.
///
/// # Errors
/// The line of action does not reach a tip curve within two pitches.
pub fn path_of_contact(
    pair: &PitchPair,
    pitch: &PitchPoint,
    side: Side,
    addendum_mm: [f64; 2],
) -> Result<PathOfContact, Refusal> {
    let v = pair.line_of_action(pitch, side);
    let end = |member: Member, height_mm: f64, towards: f64| {
        let below = |travel_mm: f64| {
            let contact = DVec2::new(pitch.radius_mm[0], 0.0) + towards * travel_mm * v;
            let own = pair.gear_from_machine(pitch, member, contact - pair.axis_mm(member));
            Ok(pair.height(member, own, pitch.phi_1_rad)?.0 < height_mm)
        };
        let travel_mm = passing(pair.pitch_mm(), below, || {
            format!("the line of action does not reach a tip {height_mm:.3} mm over the pitch curve")
        })?;
        Ok::<f64, Refusal>(towards * travel_mm)
    };
    Ok(PathOfContact {
        driver_tip_mm: end(Member::Driver, addendum_mm[0], side.sign())?,
        driven_tip_mm: end(Member::Driven, addendum_mm[1], -side.sign())?,
    })
}

impl PathOfContact {
    /// Contact ratio of the moment.
    pub fn contact_ratio(&self, pair: &PitchPair) -> f64 {
        (self.driver_tip_mm - self.driven_tip_mm).abs() / (pair.pitch_mm() * pair.teeth().pressure_angle_rad.cos())
    }
}

/// Passage of a tooth through the mesh, nominal flanks.
///
/// # Errors
/// Tips that the flank does not reach.
#[cfg(feature = "testing")]
pub fn tooth_path(pair: &PitchPair, side: Side, tooth: i64, addendum_mm: [f64; 2]) -> Result<ToothPath, Refusal> {
    let crossing_mm = pair.crossing_mm(side, tooth);
    let phi_at_driver_tip_rad = pair.phi_at_tip(Member::Driver, side, crossing_mm, addendum_mm[0])?;
    let phi_at_driven_tip_rad = pair.phi_at_tip(Member::Driven, side, crossing_mm, addendum_mm[1])?;
    let arc = |phi: f64| pair.curve().arc_mm(phi);
    let height = |member: Member, phi: f64| {
        let point_mm = pair.flank_point(member, side, crossing_mm, phi).point_mm;
        pair.height(member, point_mm, phi).map(|(height_mm, _)| height_mm)
    };
    Ok(ToothPath {
        phi_at_driven_tip_rad,
        phi_at_driver_tip_rad,
        contact_ratio: (arc(phi_at_driver_tip_rad) - arc(phi_at_driven_tip_rad)).abs() / pair.pitch_mm(),
        deepest_on_driver_mm: height(Member::Driver, phi_at_driven_tip_rad)?,
        deepest_on_driven_mm: height(Member::Driven, phi_at_driver_tip_rad)?,
    })
}
