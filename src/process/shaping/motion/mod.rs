//! How the axes really go: on the return stroke, by a program, with the machine's errors.
//!
//! In: linkages and their schedules, cutter, errors. Out: the law of every return stroke ([`returns`]), programs read
//! back and judged ([`gcode`]), poses for the passes ([`actual`]), strokes that vibrate ([`vibration`]).

pub mod actual;
pub mod gcode;
pub mod returns;
pub mod vibration;
