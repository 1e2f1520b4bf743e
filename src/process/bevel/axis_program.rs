//! A program of the six-axis machine, and how it is read.

use super::course::AXES;
use crate::gcode::{TimedKnot, TimedProgram, read_timed};

/// Axes at one moment.
pub type BevelKnot = TimedKnot<5>;
/// A program over all slots.
pub type BevelProgram = TimedProgram<5>;

/// Axis positions of a program of straight lines over time ([`read_timed`]).
///
/// # Errors
/// Line and word of what is malformed, unknown or missing.
pub fn read(text: &str) -> Result<BevelProgram, String> {
    Ok(BevelProgram { knots: read_timed(text, &AXES, [None; 5])? })
}
