//! The lines of a comparison, as CSV and for the terminal.

use std::path::Path;

use super::lines::Line;
use super::{Comparison, letters};
use crate::findings::{Datum, Quantity};
use crate::output::table::write_table;
use crate::output::text::significant;
use gearcut_core::Result;

/// Longest words that stand in a column of the terminal, characters.
const LONGEST_WORDS: usize = 20;

impl Comparison {
    pub(super) fn write_csv(&self, path: &Path) -> Result<()> {
        let values: Vec<String> = letters().take(self.results.len()).map(String::from).collect();
        let others = &values[1..];
        let differences: Vec<String> = others.iter().map(|letter| format!("difference_{letter}_minus_a")).collect();
        let ratios: Vec<String> = others.iter().map(|letter| format!("ratio_a_to_{letter}")).collect();
        let mut columns = vec!["quantity", "unit"];
        columns.extend(values.iter().chain(&differences).chain(&ratios).map(String::as_str));
        columns.push("definition");
        let mut names = vec![Datum::from("name"), Datum::Undefined];
        names.extend(self.results.iter().map(|one| Datum::from(one.name.as_str())));
        names.extend(differences.iter().chain(&ratios).map(|_| Datum::Undefined));
        names.push("name under which the result is shown".into());
        write_table(path, &columns, [names].into_iter().chain(self.lines.iter().map(cells)))
    }

    /// Titles, then one row per line: its values, difference and ratio where there are just two, the unit.
    pub(super) fn printed_rows<'a>(&self, lines: impl Iterator<Item = &'a Line>) -> Vec<Vec<String>> {
        let mut titles = vec![String::new()];
        titles.extend(self.results.iter().map(|one| one.name.clone()));
        let two = self.results.len() == 2;
        if two {
            titles.extend(["difference", "ratio"].map(str::to_owned));
        }
        titles.push("unit".into());
        let rows = lines.map(|line| {
            let mut row = vec![line.name.replace('_', " ")];
            row.extend(line.quantities.iter().map(|quantity| printed(quantity.as_ref())));
            if two {
                let number = |value: Option<f64>| value.map_or_else(String::new, shown);
                row.extend(line.differences().chain(line.ratios()).map(number));
            }
            row.push(match line.either().and_then(Quantity::unit) {
                None | Some("1") => String::new(),
                Some(unit) => unit.to_owned(),
            });
            row
        });
        [titles].into_iter().chain(rows).collect()
    }
}

/// A value this small is rounding in every unit that results have, and so is a ratio; the exact one is in the file.
const ROUNDING: f64 = 1e-9;

fn shown(value: f64) -> String {
    if value.abs() < ROUNDING { "0".to_owned() } else { significant(value, 4) }
}

fn cells(line: &Line) -> Vec<Datum> {
    let of = line.either();
    let mut cells = vec![line.name.as_str().into(), of.and_then(Quantity::unit).map_or(Datum::Undefined, Datum::from)];
    cells.extend(line.quantities.iter().map(|quantity| match quantity {
        Some(quantity) => quantity.words().map_or_else(|| quantity.value().into(), Datum::from),
        None => Datum::Undefined,
    }));
    cells.extend(line.differences().chain(line.ratios()).map(Datum::from));
    cells.push(of.map_or(Datum::Undefined, |quantity| quantity.definition().into()));
    cells
}

fn printed(quantity: Option<&Quantity>) -> String {
    let Some(quantity) = quantity else { return "none".to_owned() };
    match (quantity.value(), quantity.words()) {
        (Some(value), _) => shown(value),
        // Places are told at length in the file.
        (None, Some(words)) if words.chars().count() > LONGEST_WORDS => "told in the file".to_owned(),
        (None, Some(words)) => words.to_owned(),
        (None, None) => "none".to_owned(),
    }
}
