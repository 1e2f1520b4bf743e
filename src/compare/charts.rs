//! Bars of every column that asks for them: all results in one picture, and where the gear repeats itself, the first
//! period and each result on a scale of its own, since one may be a fiftieth of the other.

use super::{Compared, letters};
use crate::findings::{Findings, Table, TableColumn};
use crate::output::bar_chart::{BarChart, BarSeries};

/// The charts with their file names; a result without such a table or row has no bars.
pub(super) fn charts(results: &[Compared]) -> Vec<(String, BarChart)> {
    let mut charts = Vec::new();
    for path in paths(results) {
        let tables: Vec<(&str, Option<&Table>)> =
            results.iter().map(|one| (one.name.as_str(), table(&one.findings, &path))).collect();
        let rows = |table: &&Table| table.rows.len();
        // The longest one, for the names of columns and rows.
        let Some(longest) = tables.iter().filter_map(|of| of.1).max_by_key(rows).filter(|table| rows(table) > 0) else {
            continue;
        };
        let period = tables.iter().filter_map(|of| of.1?.period_rows).max().map(|rows| rows as usize);
        for column in longest.columns.iter().filter(|column| column.bars) {
            let stem = format!("{path}.{}", column.key).replace('.', "_");
            let of = |count: usize, what: &str, tables: &[(&str, Option<&Table>)]| {
                chart(&path, what, longest, count, column, tables)
            };
            charts.push((stem.clone(), of(longest.rows.len(), "", &tables)));
            let Some(period) = period else { continue };
            let first = format!(", 1 to {period}: the first period");
            charts.push((format!("{stem}_first_period"), of(period, &first, &tables)));
            for (one, letter) in tables.iter().zip(letters()) {
                charts.push((format!("{stem}_{letter}"), of(period, &first, std::slice::from_ref(one))));
            }
        }
    }
    charts
}

/// Paths of all tables with bars, in the order in which the results first have them.
fn paths(results: &[Compared]) -> Vec<String> {
    let mut paths: Vec<String> = Vec::new();
    for one in results {
        one.findings.walk(&mut |path, section| {
            for table in section.tables.iter().filter(|table| table.columns.iter().any(|column| column.bars)) {
                let path = format!("{path}.{}", table.key);
                if !paths.contains(&path) {
                    paths.push(path);
                }
            }
        });
    }
    paths
}

fn table<'a>(findings: &'a Findings, path: &str) -> Option<&'a Table> {
    let (section, key) = path.rsplit_once('.')?;
    findings.find(section)?.table_of(key)
}

/// Bars of the first `count` rows of some tables.
fn chart(
    path: &str,
    what: &str,
    longest: &Table,
    count: usize,
    column: &TableColumn,
    tables: &[(&str, Option<&Table>)],
) -> BarChart {
    let names = |table: &Table| table.rows.iter().map(|row| row[0].name()).collect::<Vec<_>>();
    let categories: Vec<String> = names(longest).into_iter().take(count).collect();
    let series = tables.iter().map(|&(name, table)| {
        let values: Vec<(String, Option<f64>)> =
            table.map_or_else(Vec::new, |table| names(table).into_iter().zip(table.numbers(&column.key)).collect());
        let value = |category: &String| values.iter().find(|(name, _)| name == category).and_then(|(_, value)| *value);
        BarSeries { name: name.to_owned(), values: categories.iter().map(value).collect() }
    });
    BarChart {
        title: format!("{path}: {}{what}", column.definition),
        category_name: longest.columns[0].definition.to_string(),
        value_name: column.key.replace('_', " "),
        least_division: 0.0,
        unit: column.unit.as_deref().unwrap_or_default().to_owned(),
        series: series.collect(),
        categories,
    }
}
