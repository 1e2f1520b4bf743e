//! The thickest uncut chip by the formula that shops plan feeds with.
//!
//! In: a round gear, the hob and the feed of an operation that cuts into the full blank. Out: the thickness at the
//! hob's tip, mm. Law (B. Hoffmeister, Ueber den Verschleiss am Waelzfraeser, dissertation RWTH Aachen 1970), beta in
//! degrees, r_a0 the hob's tip radius, i gashes, z_0 starts, a_p the depth of the cut:
//!
//! `4.9 m z^(9.25e-3 beta - 0.542) e^(-0.015 beta - 0.015 x) (r_a0 / m)^(-8.25e-3 beta - 0.225) (i / z_0)^-0.877
//! (f_a / m)^0.511 (a_p / m)^0.319`
//!
//! That beta is in degrees is read from its terms: in radians none of them would change a thickness by more than a
//! hundredth, while here between 0 and 30 deg the exponent of z goes from -0.52 to -0.42 and that of r_a0 from -0.16 to
//! -0.31 in cuts of `m` 3 mm, half as far as by the formula.
//!
//! It was fitted to chips of standard racks on round gears, so that it stands beside what the run finds and decides
//! nothing.

use crate::measure::round_gear::is_round;
use crate::process::hobbing::HobbingJob;

/// Thickest chip of the first operation; `None` on a gear that is not round, where the formula means nothing.
pub fn thickest_chip_mm(job: &HobbingJob) -> Option<f64> {
    let operation = job.operations.first()?;
    if !is_round(&job.curve) {
        return None;
    }
    let (gear, hob) = (&job.scene.gear, &job.hob);
    let m = gear.module_mm;
    let beta_deg = gear.helix_angle_rad.to_degrees();
    let depth_mm = hob.tip_radius_mm - hob.pitch_radius_mm + job.stock.addendum_mm - operation.offset_mm;
    let gashes_per_start = f64::from(hob.gashes) / f64::from(hob.starts);
    let of_gear = f64::from(gear.teeth).powf(9.25e-3 * beta_deg - 0.542)
        * (-0.015 * (beta_deg + gear.profile_shift_coefficient)).exp();
    let of_hob = (hob.tip_radius_mm / m).powf(-8.25e-3 * beta_deg - 0.225) * gashes_per_start.powf(-0.877);
    let of_cut = (operation.spec.axial_feed_mm_per_revolution / m).powf(0.511) * (depth_mm / m).powf(0.319);
    Some(4.9 * m * of_gear * of_hob * of_cut)
}
