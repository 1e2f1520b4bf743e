//! What errors of machine, clamping and tool do to a gear: influence functions by simulation, and what follows from
//! them.
//!
//! In: a scene, whose error keys are numbers that can be shifted ([`crate::scene::error_parameters`]). Out: the
//! derivative of the heights of its flanks with respect to each ([`derivative`]), and figures of such maps
//! ([`figures`]). [`budget`] ranks what costs what; [`diagnose`] finds the errors that explain [measured] flanks;
//! [`calibrate`] fits them to measured [numbers], surfaces and [charts]. A run that was stopped goes on with the cuts
//! that it has made ([`known_cuts`]).
//!
//! Gears are cut on few rays ([`gear_grid`]): errors of machines act smoothly over a flank, and the marks of strokes
//! stand in all heights alike and fall out of differences. Road not taken: whole runs. They take a hundred times as
//! long, and most of their numbers are largest values, whose derivatives jump where another place becomes the largest.

pub mod budget;
pub mod calibrate;
pub mod charts;
pub mod derivative;
pub mod diagnose;
pub mod figures;
pub mod gear_grid;
pub mod interval;
pub mod known_cuts;
pub mod measured;
pub mod measured_table;
pub(crate) mod notices;
pub mod numbers;
pub mod quantities;
