//! Which lines of a comparison changed most: the first to read.
//!
//! In: the lines, and the limits that the results hold their figures against. Out: those of headline and summary by
//! their change, the largest first. A change is the largest difference from the first result over a scale: the figure's
//! own limit (of its class of ISO 1328-1, or the drawing's), where it has one; else the larger of both values, or what
//! is worth telling in that unit where both are smaller: 10 nm beside 1 nm is no change, and neither is what rounding
//! leaves beside 0. Of lines with one key or with the same values (a number of the headline stands below its path as
//! well, and one quantity below every operation) the one that changed most is there.

use super::Compared;
use super::lines::{Line, is_rounding};
use crate::findings::quantities::inspection::{FIGURE, FIGURE_LIMIT, FIGURES, INSPECTION};
use crate::findings::{Level, Quantity};
use std::collections::{HashMap, HashSet};

/// Lines that are printed first.
pub(super) const FIRST: usize = 8;

/// A value of this unit that is worth telling: what a drawing or an inspection machine resolves, and of units that are
/// listed nowhere (counts, rates, angles in seconds of arc) one.
fn worth_telling(unit: Option<&str>) -> f64 {
    match unit {
        Some("mm" | "mm^2" | "kN" | "um^3/um^2") => 1e-3,
        Some("1" | "cm^3/min" | "deg/s") => 0.01,
        _ => 1.0,
    }
}

/// Limits of figures by their symbols, um, as the first result that has one states them.
pub(super) fn limits_um(results: &[Compared]) -> HashMap<String, f64> {
    let mut limits_um = HashMap::new();
    for one in results {
        let Some(table) = one.findings.group(&INSPECTION).and_then(|section| section.table_of(&FIGURES)) else {
            continue;
        };
        for (symbol, limit_um) in table.words(&FIGURE).zip(table.values(&FIGURE_LIMIT)) {
            if let (Some(symbol), Some(limit_um)) = (symbol, limit_um.filter(|um| *um > 0.0)) {
                limits_um.entry(symbol.to_owned()).or_insert(limit_um);
            }
        }
    }
    limits_um
}

/// The lines with their changes, the largest first; of equal ones as they stand. Lines that did not change are left
/// out.
pub(super) fn ranked<'a>(lines: &'a [Line], limits_um: &HashMap<String, f64>) -> Vec<(&'a Line, f64)> {
    let read = lines.iter().filter(|line| line.level <= Level::Summary);
    let mut ranked: Vec<(&Line, f64)> = read.filter_map(|line| Some((line, change(line, limits_um)?))).collect();
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
fn change(line: &Line, limits_um: &HashMap<String, f64>) -> Option<f64> {
    let unit = line.either().and_then(Quantity::unit);
    // Figures of an inspection end with their symbols.
    let symbol = line.title.rsplit(' ').next().unwrap_or_default();
    let limit_um = limits_um.get(symbol).filter(|_| unit == Some("um"));
    let scale = |[first, other]: [f64; 2]| {
        limit_um.copied().unwrap_or_else(|| first.abs().max(other.abs()).max(worth_telling(unit)))
    };
    let of = |pair: [f64; 2]| {
        let apart = (pair[1] - pair[0]).abs();
        if is_rounding(apart) { 0.0 } else { apart / scale(pair) }
    };
    line.pairs().flatten().map(of).reduce(f64::max).filter(|&change| change > 0.0)
}
