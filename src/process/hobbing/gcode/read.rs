//! Axis positions from the text of a hobbing program.

use super::program::HobbingProgram;
use crate::gcode::read_timed;
use crate::process::hobbing::linkage::dynamics::AXES;

/// Axis positions of a program of straight lines over time ([`read_timed`]). Without W the shift is `shift_mm`.
///
/// # Errors
/// Line and word of what is malformed, unknown or missing.
pub fn read(text: &str, shift_mm: f64) -> Result<HobbingProgram, String> {
    let mut standing = [None; 6];
    standing[5] = Some(shift_mm);
    Ok(HobbingProgram { knots: read_timed(text, &AXES, standing)? })
}
