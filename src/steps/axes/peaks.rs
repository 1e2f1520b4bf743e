//! Peaks of the axes against their limits: rows for the terminal, sentences where a limit is exceeded, findings.

use super::AxesOfOperation;
use crate::findings::notices::AxisLimit;
use crate::findings::quantities::cutting::{AXES, LIMIT, MARGIN, PEAK};
use crate::findings::{Notice, Place, Section};
use crate::machine::{Peak, smallest_margin};
use crate::number_text::significant;

/// Speeds and accelerations below this, in deg or mm per s or s^2, are what rounding leaves of a standing axis.
pub const STEADY: f64 = 1e-9;

/// How a process speaks of the peaks of its axes.
#[derive(Debug)]
pub struct PeakWords {
    /// Title of the places on the terminal.
    pub at: &'static str,
    /// Name of the coordinate of a place, as findings write it.
    pub place: &'static str,
    /// Its unit on the terminal, and digits after the point.
    pub place_unit: (&'static str, usize),
    /// What else a reader must know of a place; ends the definition of a peak.
    pub place_note: &'static str,
    /// What to do about an exceeded limit.
    pub way_out: &'static str,
    /// How findings name a peak.
    pub named: fn(&Peak) -> Named,
    /// Peaks below this, in the unit that is read, are zero among the findings.
    pub zero_below: f64,
}

/// A peak by its names among the findings.
#[derive(Debug)]
pub struct Named {
    /// Key.
    pub key: String,
    /// Title.
    pub title: String,
    /// Why there is no limit.
    pub unlimited: String,
}

/// A row of titles, then one per peak.
pub(super) fn rows(operation: &impl AxesOfOperation) -> Vec<Vec<String>> {
    let words = operation.peak_words();
    let titles = ["axis", "largest", words.at, "limit", "left"].map(str::to_owned).to_vec();
    let rows = operation.peaks().iter().map(|peak| {
        let text = |value: f64| format!("{} {}", significant(zero_below(STEADY, value), 4), peak.unit());
        let (unit, digits) = words.place_unit;
        let limit = peak.shown_limit().map_or_else(|| "not given".to_owned(), text);
        let left = peak.margin().map_or_else(String::new, |share| format!("{:.0} %", 100.0 * share));
        vec![peak.name(), text(peak.shown()), format!("{:.digits$} {unit}", operation.place(peak)), limit, left]
    });
    [titles].into_iter().chain(rows).collect()
}

/// The limits that are exceeded.
pub(super) fn exceeded(operation: &impl AxesOfOperation) -> impl Iterator<Item = Notice> {
    operation.peaks().iter().filter(|peak| peak.exceeds_its_limit()).filter_map(|peak| {
        let limit = AxisLimit {
            operation: operation.name(),
            peak: peak.name(),
            reached: significant(peak.shown(), 4),
            allowed: significant(peak.shown_limit()?, 4),
            unit: peak.unit(),
            way_out: operation.peak_words().way_out,
        };
        Some(limit.notice().fault_where(operation.is_under_test()))
    })
}

/// Peaks against limits as findings, axis by axis.
pub fn findings(operation: &impl AxesOfOperation) -> Section {
    let words = operation.peak_words();
    let one = |peak: &Peak| {
        let Named { key, title, unlimited } = (words.named)(peak);
        let at = Place::default().and(words.place, operation.place(peak));
        let remark = words.place_note;
        Section::new(key, title).entries([
            PEAK.of(zero_below(words.zero_below, peak.shown())).in_unit(peak.unit()).remarked(remark).at(at),
            LIMIT.of_or(peak.shown_limit(), unlimited.clone()).in_unit(peak.unit()),
            MARGIN.of_or(peak.margin(), unlimited),
        ])
    };
    AXES.section([]).parts(operation.peaks().iter().map(one))
}

/// Share of the tightest limit that all operations leave; none where there is no limit.
pub fn margin<O: AxesOfOperation>(operations: &[O]) -> Option<f64> {
    smallest_margin(operations.iter().flat_map(AxesOfOperation::peaks))
}

fn zero_below(least: f64, value: f64) -> f64 {
    if value.abs() < least { 0.0 } else { value }
}
