//! How gears of one scene scatter, and which layer of errors makes how much of each number.
//!
//! In: a scene with errors. Out: numbers of one flank and of the gear's pitch ([`numbers`]) with every layer alone,
//! with all of them, and with all but one ([`layers`]); and the same numbers for many seeds ([`seeds`]), as median and
//! interval ([`statistics`]).
//!
//! A gear is prepared for each seed as a scene with that seed, so that a row is what `gearcut cut` would find with
//! `--set machine.errors.seed=...`. Rows are kept as they are found ([`rows`]): a run that was killed goes on where it
//! ended.
//!
//! Road not taken: whole gears. A flank with its texture takes a hundredth of the time, and two hundred gears a night.

pub mod layers;
pub mod numbers;
pub mod rows;
pub mod seeds;
pub mod statistics;
pub mod tables;

#[cfg(test)]
mod tests;

use gearcut_core::terms::Side;

/// The flank that is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FlankWish {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Which of its flanks.
    pub side: Side,
}
