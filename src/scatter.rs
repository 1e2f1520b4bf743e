//! How gears of one scene scatter, and which layer of errors makes how much of each number.
//!
//! In: a scene with errors. Out: numbers of one flank and of the gear's pitch ([`numbers`]) with every layer alone,
//! with all of them, and with all but one ([`layers`]); and the same numbers for many seeds ([`seeds`]), whose gears
//! may differ within tolerances ([`tolerance`]), as median and interval ([`statistics`]). They are a [`Scatter`],
//! which makes [`findings()`] once; terminal, `results.json`, tables and page ([`page`]) show those.
//!
//! A gear is prepared for each seed as a scene with that seed, so that a row is what `gearcut cut` would find with
//! `--set machine.errors.seed=...`. Rows are kept as they are found ([`rows`]): a run that was killed goes on where it
//! ended.
//!
//! Road not taken: whole gears. A flank with its texture takes a hundredth of the time, and two hundred gears a night.

mod findings;
pub mod layers;
pub(crate) mod notices;
pub mod numbers;
pub mod page;
pub mod quantities;
pub mod rows;
pub mod seeds;
pub mod statistics;
mod text;
pub mod tolerance;

#[cfg(test)]
mod tests;

use crate::findings::Notice;
use gearcut_core::terms::Side;
use layers::LayerCase;
use numbers::{NUMBERS, Values};
use rows::Rows;
use statistics::Spread;
use tolerance::Tolerance;

pub use findings::findings;
pub use text::printed;

/// The flank that is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FlankWish {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Which of its flanks.
    pub side: Side,
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Scatter {
    /// Where texture, profile and helix were looked at.
    pub flank: FlankWish,
    /// Gears with some layers, and their numbers.
    pub cases: Vec<(LayerCase, Values)>,
    /// How many gears were asked for; none where nothing is random, or nobody asked.
    pub gears: Option<u32>,
    /// What differs from gear to gear within limits.
    pub tolerances: Vec<Tolerance>,
    /// What the gears do not follow of their errors.
    pub unfollowed: Vec<Notice>,
    /// Numbers by seed; those beyond the gears that were asked for stay from an earlier run.
    pub rows: Rows,
}

impl Scatter {
    /// Values of a number over the gears that were asked for, by seed.
    pub fn values(&self, number: usize) -> impl Iterator<Item = (u32, f64)> {
        let gears = self.gears.unwrap_or(0);
        self.rows.range(..=gears).filter_map(move |(&seed, values)| Some((seed, values[number]?)))
    }

    /// Median and interval of every number over those gears.
    pub fn spreads(&self) -> Vec<Option<Spread>> {
        (0..NUMBERS.len()).map(|number| Spread::of(self.values(number).map(|(_, value)| value))).collect()
    }

    /// The value of a number in the case with this name.
    pub fn in_case(&self, name: &str, number: usize) -> Option<f64> {
        self.cases.iter().find(|(case, _)| case.name == name).and_then(|(_, values)| values[number])
    }
}
