//! Influences of errors, and what is fitted by them.

mod budget;
mod calibrate;
mod command;
mod diagnose;
mod drives;
mod measured_files;
mod parameters;
mod resumed;
mod round;
mod spatial;
mod stopped_fit;
mod turning_tools;
