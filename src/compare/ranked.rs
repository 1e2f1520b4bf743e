//! Which lines of a comparison changed most: the first to read.
//!
//! In: the lines. Out: those of headline and summary by their change, the largest first. A change is the largest
//! difference from the first result over the larger of both values, or over what is worth telling in that unit where
//! both are smaller: 10 nm beside 1 nm is no change. Of lines with one key or with the same values (a number of the
//! headline stands below its path as well, and one quantity below every operation) the one that changed most is there.

use super::lines::Line;
use crate::findings::{Level, Quantity};
use std::collections::HashSet;

/// Lines that are printed first.
pub(super) const FIRST: usize = 10;

/// A value of this unit that is worth telling: what a drawing or an inspection machine resolves.
fn worth_telling(unit: Option<&str>) -> f64 {
    match unit {
        Some("um" | "%" | "N" | "s" | "deg") => 1.0,
        Some("mm") => 1e-3,
        Some("1") => 0.01,
        _ => f64::MIN_POSITIVE,
    }
}

/// The lines with their changes, the largest first; of equal ones as they stand. Lines that did not change are left
/// out.
pub(super) fn ranked(lines: &[Line]) -> Vec<(&Line, f64)> {
    let read = lines.iter().filter(|line| line.level <= Level::Summary);
    let mut ranked: Vec<(&Line, f64)> = read.filter_map(|line| Some((line, change(line)?))).collect();
    ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
    let (mut keys, mut values) = (HashSet::new(), HashSet::new());
    ranked.retain(|(line, _)| {
        let bits: Vec<Option<u64>> = line.quantities.iter().map(|of| of.as_ref()?.value().map(f64::to_bits)).collect();
        let (new_key, new_values) = (keys.insert(line.key().to_owned()), values.insert(bits));
        new_key && new_values
    });
    ranked
}

/// Largest change among the results; none without one.
fn change(line: &Line) -> Option<f64> {
    let least = worth_telling(line.either().and_then(Quantity::unit));
    let of = |[first, other]: [f64; 2]| (other - first).abs() / first.abs().max(other.abs()).max(least);
    line.pairs().flatten().map(of).reduce(f64::max).filter(|&change| change > 0.0)
}
