//! Layers and gears for the terminal.

use super::numbers::NUMBERS;
use super::statistics::Spread;
use super::{FlankWish, Scatter};
use crate::number_text::significant;
use crate::scene::Scene;

/// Digits in tables on the terminal.
const DIGITS: u32 = 3;
/// What is smaller is rounding, um: far below an atom.
const ROUNDING: f64 = 1e-6;

/// Layers, and median and interval of the gears.
pub fn printed(scene: &Scene, found: &Scatter) -> String {
    let FlankWish { tooth, side } = found.flank;
    let heading = format!("{}: tooth {tooth} {}", scene.name, side.name());
    let spread = found.gears.map(|gears| spread_sheet(gears, &found.spreads()));
    cases_sheet(&heading, found) + &spread.unwrap_or_default()
}

/// Cases in columns, numbers in rows: a terminal is higher than it is wide.
fn cases_sheet(heading: &str, found: &Scatter) -> String {
    let cell = |value: Option<f64>| value.map_or("none".to_owned(), shown);
    let names = found.cases.iter().map(|(case, _)| case.name.clone());
    let mut rows = vec![std::iter::once("layers".to_owned()).chain(names).collect()];
    for (number, known) in NUMBERS.iter().enumerate() {
        let values = found.cases.iter().map(|(_, values)| cell(values[number]));
        rows.push(std::iter::once(known.as_column().head()).chain(values).collect());
    }
    format!("{heading}\n\n{}", aligned(&rows))
}

/// Medians and intervals as text.
fn spread_sheet(seeds: u32, spreads: &[Option<Spread>]) -> String {
    let mut rows = vec![["number", "5 %", "median", "95 %"].map(str::to_owned).to_vec()];
    for (number, spread) in NUMBERS.iter().zip(spreads) {
        let numbers = spread.map_or([const { String::new() }; 3], |of| [of.low, of.median, of.high].map(shown));
        rows.push(std::iter::once(number.as_column().head()).chain(numbers).collect());
    }
    format!("\n{seeds} gears\n\n{}", aligned(&rows))
}

fn shown(value: f64) -> String {
    if value.abs() < ROUNDING { "0".to_owned() } else { significant(value, DIGITS) }
}

/// Rows with columns of one width, the first to the left, the others to the right.
fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|c| c.chars().count()).max();
    let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    let mut text = String::new();
    for row in rows {
        let cells = row.iter().zip(&widths).enumerate();
        let cells: Vec<String> = cells
            .map(
                |(column, (cell, &width))| {
                    if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
                },
            )
            .collect();
        text.push_str(cells.join("  ").trim_end());
        text.push('\n');
    }
    text
}
