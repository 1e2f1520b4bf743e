//! Spiral bevel gears cut with a face-mill head on a six-axis machine.

mod blank;
mod cases;
mod command;
mod contact;
pub mod cut;
mod drawing;
mod formate;
mod frames;
mod gcode;
pub mod jobs;
mod machine_errors;
mod oracle;
mod pair;
mod program_under_test;
mod refusals;
mod spiral_angle;
mod tilt;
