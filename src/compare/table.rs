//! The lines of a comparison, as CSV and for the terminal.
//!
//! Lines are read from the structs' own serialised form, so that every number that joins the headline joins the comparison.

use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use super::{Comparison, Line};
use crate::Result;
use crate::output::quantity::Quantity;
use crate::output::results::{OperationResults, Results};
use crate::output::table::{Cell, write_table};
use crate::output::text::significant;

/// Columns before and after those that carry the names of the results.
const COLUMNS: [&str; 6] = ["quantity", "unit", "a", "b", "difference_b_minus_a", "definition"];

/// Headline numbers, then the spreads of unevenness of each operation that has any.
pub(super) fn lines(a: &Results, b: &Results) -> Vec<Line> {
    let mut lines = paired("", quantities(&a.headline), &quantities(&b.headline));
    for operation in &a.operations {
        let Some(other) = b.operations.iter().find(|other| other.name == operation.name) else { continue };
        let label = format!("{}.unevenness", operation.name);
        let (of_a, of_b) = (spreads(operation), spreads(other));
        if of_a.iter().chain(&of_b).any(|(_, quantity)| quantity.value().is_some()) {
            lines.extend(paired(&label, of_a, &of_b));
        }
    }
    lines
}

fn paired(label: &str, a: Vec<(String, Quantity)>, b: &[(String, Quantity)]) -> Vec<Line> {
    let name = |key: &str| if label.is_empty() { key.to_owned() } else { format!("{label}.{key}") };
    let partner = |key: &str| b.iter().find(|(other, _)| other == key).map(|(_, quantity)| quantity.clone());
    a.into_iter().map(|(key, quantity)| Line { name: name(&key), b: partner(&key), a: Some(quantity) }).collect()
}

/// Every quantity of a struct under its key; structs inside it give keys with dots.
fn quantities(of: &impl Serialize) -> Vec<(String, Quantity)> {
    let mut found = Vec::new();
    if let Ok(value) = serde_json::to_value(of) {
        collect("", &value, &mut found);
    }
    found
}

fn collect(prefix: &str, value: &Value, found: &mut Vec<(String, Quantity)>) {
    let Value::Object(entries) = value else { return };
    for (key, entry) in entries {
        let name = if prefix.is_empty() { key.clone() } else { format!("{prefix}.{key}") };
        match serde_json::from_value::<Quantity>(entry.clone()) {
            Ok(quantity) => found.push((name, quantity)),
            Err(_) => collect(&name, entry, found),
        }
    }
}

fn spreads(operation: &OperationResults) -> Vec<(String, Quantity)> {
    quantities(&operation.unevenness)
}

impl Line {
    fn either(&self) -> Option<&Quantity> {
        self.a.as_ref().or(self.b.as_ref())
    }

    fn values(&self) -> [Option<f64>; 2] {
        [&self.a, &self.b].map(|quantity| quantity.as_ref().and_then(Quantity::value))
    }

    fn difference(&self) -> Option<f64> {
        let [a, b] = self.values();
        let units = [&self.a, &self.b].map(|quantity| quantity.as_ref().and_then(Quantity::unit));
        (units[0] == units[1]).then_some(())?;
        Some(b? - a?)
    }
}

impl Comparison {
    pub(super) fn write_csv(&self, path: &Path) -> Result<()> {
        let names = vec![
            Cell::from("name"),
            Cell::Empty,
            self.a.name.as_str().into(),
            self.b.name.as_str().into(),
            Cell::Empty,
            "name under which the result is shown".into(),
        ];
        let numbers = self.lines.iter().map(|line| {
            let [a, b] = line.values();
            let unit = line.either().and_then(Quantity::unit).map_or(Cell::Empty, Cell::from);
            let definition = line.either().map_or(Cell::Empty, |quantity| quantity.definition().into());
            vec![line.name.as_str().into(), unit, a.into(), b.into(), line.difference().into(), definition]
        });
        write_table(path, &COLUMNS, [names].into_iter().chain(numbers))
    }

    pub(super) fn printed_rows(&self) -> Vec<Vec<String>> {
        let titles = vec![String::new(), self.a.name.clone(), self.b.name.clone(), "difference".into(), "unit".into()];
        let text = |value: Option<f64>| value.map_or_else(|| "none".to_owned(), |value| significant(value, 4));
        let rows = self.lines.iter().map(|line| {
            let [a, b] = line.values();
            let difference = line.difference().map_or_else(String::new, |value| significant(value, 4));
            let unit = match line.either().and_then(Quantity::unit) {
                None | Some("1") => String::new(),
                Some(unit) => unit.to_owned(),
            };
            vec![line.name.replace('_', " "), text(a), text(b), difference, unit]
        });
        [titles].into_iter().chain(rows).collect()
    }
}
