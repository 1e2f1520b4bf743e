//! Spiral bevel gears cut with a face-mill head on a six-axis machine.

mod cases;
mod oracle;
