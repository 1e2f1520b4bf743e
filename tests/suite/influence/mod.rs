//! Influences of errors, and what is fitted by them.

mod budget;
mod calibrate;
mod calibrated_gears;
mod command;
mod cut_gears;
mod diagnose;
mod drives;
mod ends_of_ranges;
mod measured_files;
mod parameters;
mod pressed_down;
mod refused_tables;
mod resumed;
mod round;
mod spatial;
mod standing_out;
mod stopped_fit;
mod taken_over;
mod torn_marks;
mod turning_tools;
