//! A table of findings as a chart along the curve on the terminal: some of its rows, with bars.
//!
//! In: a table and what of it is shown. Out: rows at even distances and those with the largest bars, so that no
//! extreme falls between two rows.

use crate::findings::{Datum, QuantityRow, Table};
use crate::output::text::Sheet;

/// Rows at even distances, at most.
const ROWS: usize = 12;
/// Characters of a full bar that stands alone, and beside others or many columns: lines fit a terminal of 80.
const WIDTHS: [usize; 2] = [16, 8];
/// Columns of values that leave room for the wide bar.
const MOST_BESIDE_A_WIDE_BAR: usize = 5;

/// A column that is shown.
pub struct Shown {
    /// What it is in the table.
    pub row: &'static QuantityRow,
    /// What it is called.
    pub heading: &'static str,
    /// Digits behind the point.
    pub decimals: usize,
    /// The value that fills a bar beside it, if it has one.
    pub full: Option<f64>,
}

/// A column of values alone.
pub fn values(row: &'static QuantityRow, heading: &'static str, decimals: usize) -> Shown {
    Shown { row, heading, decimals, full: None }
}

/// A column with bars, full at a value.
pub fn bars(row: &'static QuantityRow, heading: &'static str, decimals: usize, full: f64) -> Shown {
    Shown { full: Some(full), ..values(row, heading, decimals) }
}

/// Largest value of some columns: what fills their bars.
pub fn largest(table: &Table, rows: &[&QuantityRow]) -> f64 {
    rows.iter().flat_map(|row| table.values(row)).flatten().fold(0.0, f64::max)
}

/// Adds the chart.
pub fn print(sheet: &mut Sheet, table: &Table, shown: &[Shown]) {
    let step = table.len().div_ceil(ROWS).max(1);
    let mut rows: Vec<usize> = (0..table.len()).step_by(step).collect();
    for of in shown.iter().filter(|of| of.full.is_some()) {
        let numbers = table.values(of.row).enumerate().filter_map(|(row, number)| Some((row, number?)));
        rows.extend(numbers.reduce(|a, b| if b.1 > a.1 { b } else { a }).map(|(row, _)| row));
    }
    rows.sort_unstable();
    rows.dedup();
    let heading = shown.iter().flat_map(|of| {
        let bar = of.full.map(|_| String::new());
        std::iter::once(of.heading.to_owned()).chain(bar)
    });
    let with_bars = shown.iter().filter(|of| of.full.is_some()).count();
    let width = WIDTHS[usize::from(with_bars > 1 || shown.len() > MOST_BESIDE_A_WIDE_BAR)];
    let line = |row: usize| shown.iter().flat_map(move |of| cells(table, row, of, width)).collect::<Vec<_>>();
    let lines: Vec<Vec<String>> = std::iter::once(heading.collect()).chain(rows.into_iter().map(line)).collect();
    sheet.table(&lines);
}

/// Value, and bar if it has one, so many characters wide.
fn cells(table: &Table, row: usize, of: &Shown, width: usize) -> Vec<String> {
    let Some(column) = table.column(of.row.key) else { return Vec::new() };
    let unit = table.columns[column].unit.as_deref().filter(|&unit| unit != "1").unwrap_or_default();
    let cell = table.cells[column].datum(row);
    let number = cell.number();
    let value = match cell {
        Datum::Word(word) => word,
        _ => number.map_or("-".to_owned(), |number| format!("{number:.*} {unit}", of.decimals).trim_end().to_owned()),
    };
    let bar = of.full.map(|full| {
        let share = if full > 0.0 { number.unwrap_or(0.0) / full } else { 0.0 };
        format!("|{:<width$}|", "#".repeat((width as f64 * share.clamp(0.0, 1.0)).round() as usize))
    });
    std::iter::once(value).chain(bar).collect()
}
