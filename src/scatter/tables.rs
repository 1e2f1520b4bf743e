//! Tables of layers and seeds, for other programs and for the terminal.

use super::numbers::{NUMBERS, Values};
use super::statistics::Spread;
use crate::output::text::significant;
use std::fmt::Write as _;

/// Digits in tables on the terminal.
const DIGITS: u32 = 3;
/// What is smaller is rounding, um: far below an atom.
const ROUNDING: f64 = 1e-6;

/// Rows of cases, columns of numbers; empty where a number does not exist.
pub fn layers_csv(names: &[&str], values: &[Values]) -> String {
    let keys: Vec<&str> = std::iter::once("layers").chain(NUMBERS.iter().map(|number| number.key)).collect();
    let mut text = keys.join(",") + "\n";
    for (name, values) in names.iter().zip(values) {
        text.push_str(name);
        for value in values {
            text.push(',');
            text.push_str(&value.map_or(String::new(), |value| value.to_string()));
        }
        text.push('\n');
    }
    text
}

/// A row for every number with its median and interval.
pub fn scatter_csv(spreads: &[Option<Spread>]) -> String {
    let mut text = String::from("number,gears,low_5_percent,median,high_95_percent,definition\n");
    for (number, spread) in NUMBERS.iter().zip(spreads) {
        let values = spread
            .map_or("0,,,".to_owned(), |Spread { count, low, median, high }| format!("{count},{low},{median},{high}"));
        let _ = writeln!(text, "{},{values},\"{}\"", number.key, number.definition);
    }
    text
}

/// Cases in columns, numbers in rows, as text.
pub fn sheet(heading: &str, names: &[&str], values: &[Values]) -> String {
    let cell = |value: Option<f64>| value.map_or("none".to_owned(), shown);
    let header: Vec<String> = NUMBERS.iter().map(|number| number.key.to_owned()).collect();
    let body = names.iter().zip(values).map(|(name, values)| {
        std::iter::once((*name).to_owned()).chain(values.iter().map(|&value| cell(value))).collect()
    });
    let rows: Vec<Vec<String>> =
        std::iter::once(std::iter::once("layers".to_owned()).chain(header).collect()).chain(body).collect();
    // Numbers beside each other in rows: a terminal is higher than it is wide.
    let columns: Vec<Vec<String>> =
        (0..rows[0].len()).map(|column| rows.iter().map(|row| row[column].clone()).collect()).collect();
    format!("{heading}\n\n{}", aligned(&columns))
}

/// Medians and intervals as text.
pub fn spread_sheet(seeds: u32, spreads: &[Option<Spread>]) -> String {
    let mut rows = vec![["number", "5 %", "median", "95 %"].map(str::to_owned).to_vec()];
    for (number, spread) in NUMBERS.iter().zip(spreads) {
        let numbers = spread.map_or([const { String::new() }; 3], |of| [of.low, of.median, of.high].map(shown));
        rows.push(std::iter::once(number.key.to_owned()).chain(numbers).collect());
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
