//! Axis positions from the text of a bevel program.

use super::program::BevelProgram;
use crate::gcode::read_timed;
use crate::process::bevel::motion::AXES;

/// Axis positions of a program of straight lines over time ([`read_timed`]).
///
/// # Errors
/// Line and word of what is malformed, unknown or missing.
pub fn read(text: &str) -> Result<BevelProgram, String> {
    Ok(BevelProgram { knots: read_timed(text, &AXES, [None; 5])? })
}
