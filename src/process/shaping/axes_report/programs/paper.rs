//! The one-block form of the literature, `G84 A N K R D S`, for reading beside the paper and for nothing else.
//!
//! Gao et al. 2017 put the law of the normal linkage into their control and call it with one block: A semi-major axis
//! (mm), N order, K eccentricity, R pitch radius of the cutter (mm), D polar angle of the start (deg), S residual feed
//! delta_d (mm). On nearly every other control **G84 is a tapping cycle**: the file says DO NOT RUN before anything
//! else.

use crate::findings::Notice;
use crate::gcode::ascii;
use crate::number_text::plain;
use crate::process::shaping::job::{PreparedOperation, ShapingJob};
use crate::process::shaping::scene::model::Linkage;
use gearcut_core::gear::PitchCurveShape;

/// The program.
///
/// # Errors
/// Why this form cannot say it.
pub fn text(job: &ShapingJob, operation: &PreparedOperation, warnings: &[Notice]) -> Result<String, String> {
    let PitchCurveShape::Ellipse { order, eccentricity, .. } = job.scene.gear.pitch_curve else {
        return Err("the one-block form knows elliptical pitch curves only; use gcode = \"linear\"".to_owned());
    };
    let Linkage::ShapingNormal { .. } = operation.spec.linkage else {
        return Err("the one-block form is that of the normal linkage; use gcode = \"linear\"".to_owned());
    };
    if job.helix.is_some() {
        return Err("the one-block form is that of spur gears; use gcode = \"linear\"".to_owned());
    }
    let start_rad = operation.schedule.phi_rad(0.0);
    let comment = |warning: &Notice| format!("({})\n", ascii(&warning.line()));
    let told = warnings.iter().map(comment).collect::<Vec<_>>().concat();
    // r = a (1 - k^2) / (1 - k cos n phi) is a (1 + k) at phi = 0.
    let semi_major_axis_mm = job.curve.frame(0.0).point_mm.length() / (1.0 + eccentricity);
    Ok(format!(
        "(DO NOT RUN: G84 IS A TAPPING CYCLE ON MOST CONTROLS)\n\
         (DO NOT RUN: this block is understood only by the control described in Gao et al. 2017)\n\
         (gearcut {} operation {} of {}; mm, deg)\n\
         (A semi-major axis, N order, K eccentricity, R cutter pitch radius, D start polar angle, S residual feed)\n\
         {told}\
         G84 A{} N{order} K{} R{} D{} S{}\n",
        env!("CARGO_PKG_VERSION"),
        ascii(&operation.spec.name),
        ascii(&job.scene.name),
        plain(semi_major_axis_mm),
        plain(eccentricity),
        plain(job.cutter.pitch_radius_mm),
        plain(start_rad.to_degrees()),
        plain(operation.spec.offset_mm),
    ))
}
