//! What was measured of a gear: numbers, those of surfaces among them, and lines of inspection charts.
//!
//! In: values with their uncertainties. Out: [`MeasuredGear`]. Files fill it (`files.rs`).

use crate::findings::Notice;
use crate::influence::charts::MeasuredLine;
use crate::influence::numbers::of_window;
use std::collections::BTreeMap;

/// A measured number.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredNumber {
    /// Path in `results.json`.
    pub quantity: String,
    /// Its value, in the unit that it has there.
    pub value: f64,
    /// Standard uncertainty, above 0.
    pub uncertainty: f64,
}

/// How sure measured values are that carry no uncertainty, and what is taken from surfaces.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredWish {
    /// Standard uncertainty of every value on a chart and of every figure of an inspection, um.
    pub noise_um: Option<f64>,
    /// Standard uncertainty of numbers of surfaces, per cent of their values; of heights at least of Sa.
    pub surface_percent: Option<f64>,
    /// Parameters that are taken from surfaces, by symbol.
    pub symbols: Vec<String>,
}

/// Everything that was measured.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeasuredGear {
    /// Numbers, those of surfaces among them.
    pub numbers: Vec<MeasuredNumber>,
    /// Lines of charts.
    pub lines: Vec<MeasuredLine>,
    /// Standard uncertainty of every value on them, um.
    pub noise_um: f64,
    /// What a reader must know of files that are not quite what the scene cuts.
    pub notes: Vec<Notice>,
}

impl MeasuredGear {
    /// Numbers alone.
    #[cfg(feature = "testing")]
    pub fn of_numbers(numbers: Vec<MeasuredNumber>) -> Self {
        Self { numbers, ..Self::default() }
    }

    /// Surfaces of which several numbers were measured, with these numbers: Sa, Sk, Spk and Svk of a window rise and
    /// fall together from one random flank to the next, and the fit takes them as independent. Of n numbers that do so
    /// wholly it counts one observation n times: intervals are too narrow by sqrt(n), by no more whatever the
    /// correlations are, for no eigenvalue of n numbers' correlation matrix is above n.
    pub fn of_one_surface(&self) -> BTreeMap<&str, Vec<&str>> {
        let mut surfaces: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        for (window, symbol) in self.numbers.iter().filter_map(|number| of_window(&number.quantity)) {
            surfaces.entry(window).or_default().push(symbol);
        }
        surfaces.retain(|_, symbols| symbols.len() > 1);
        surfaces
    }
}
