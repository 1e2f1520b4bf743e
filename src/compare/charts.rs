//! Bars of every column that asks for them: all results in one picture, and where the gear repeats itself, the first
//! period and each result on a scale of its own, since one may be a fiftieth of the other. Curves of every column that
//! asks for those: all results in one picture, a panel for each column of a table.

use super::{Compared, letters};
use crate::findings::{ColumnChart, Findings, Table, TableColumn, unit};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::output::table;
use gearcut_core::Result;

/// The charts with their file names; a result without such a table or row has no bars.
pub(super) fn charts(results: &[Compared]) -> Vec<(String, BarChart)> {
    let mut charts = Vec::new();
    for path in paths(results, ColumnChart::Bars) {
        let tables: Vec<(&str, Option<&Table>)> =
            results.iter().map(|one| (one.name.as_str(), table_at(&one.findings, &path))).collect();
        let rows = |table: &&Table| table.len();
        // The longest one, for the names of columns and rows.
        let Some(longest) = tables.iter().filter_map(|of| of.1).max_by_key(rows).filter(|table| rows(table) > 0) else {
            continue;
        };
        let period = tables.iter().filter_map(|of| of.1?.period_rows).max().map(|rows| rows as usize);
        for column in longest.columns.iter().filter(|column| column.chart == Some(ColumnChart::Bars)) {
            let stem = format!("{path}.{}", column.key).replace('.', "_");
            let of = |count: usize, what: &str, tables: &[(&str, Option<&Table>)]| {
                chart(what, longest, count, column, tables)
            };
            charts.push((stem.clone(), of(longest.len(), "", &tables)));
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

/// The charts of curves with their file names.
///
/// # Errors
/// Rows that a result has in a file which cannot be read.
pub(super) fn curves(results: &[Compared]) -> Result<Vec<(String, LineChart)>> {
    let of_path = |path: String| {
        let mut panels: Vec<Panel> = Vec::new();
        let mut title = String::new();
        let mut x = (String::new(), String::new());
        for one in results {
            let Some(table) = table_at(&one.findings, &path) else { continue };
            let table = table::with_rows(table, &one.folder)?;
            title.clone_from(&table.title);
            x = (table.columns[0].title.to_string(), signs(&table.columns[0]));
            for (k, column) in table.columns.iter().enumerate() {
                if column.chart != Some(ColumnChart::Curve) {
                    continue;
                }
                let value = |row: usize, k: usize| table.cells[k].datum(row).number().unwrap_or(f64::NAN);
                let points = (0..table.len()).map(|row| (value(row, 0), value(row, k))).collect();
                let series = LineSeries { name: one.name.clone(), points };
                let name = column.title.to_string();
                match panels.iter_mut().find(|panel| panel.value_name == name) {
                    Some(panel) => panel.series.push(series),
                    None => panels.push(Panel {
                        value_name: name,
                        unit: signs(column),
                        series: vec![series],
                        limits: Vec::new(),
                        least_division: least_division(column),
                    }),
                }
            }
        }
        Ok((path.replace('.', "_"), LineChart { title, x_name: x.0, x_unit: x.1, panels }))
    };
    paths(results, ColumnChart::Curve).into_iter().map(of_path).collect()
}

/// A micrometre to a division at least: on a finer axis equal results look apart.
fn least_division(column: &TableColumn) -> f64 {
    match column.unit.as_deref() {
        Some("um") => 1.0,
        Some("mm") => 1e-3,
        _ => 0.0,
    }
}

fn signs(column: &TableColumn) -> String {
    column.unit.as_deref().map_or_else(String::new, unit::signs)
}

/// Paths of all tables with such columns, in the order in which the results first have them.
fn paths(results: &[Compared], chart: ColumnChart) -> Vec<String> {
    let mut paths: Vec<String> = Vec::new();
    for one in results {
        one.findings.walk(&mut |path, section| {
            let drawn = |table: &&Table| table.columns.iter().any(|column| column.chart == Some(chart));
            for table in section.tables.iter().filter(drawn) {
                let path = format!("{path}.{}", table.key);
                if !paths.contains(&path) {
                    paths.push(path);
                }
            }
        });
    }
    paths
}

fn table_at<'a>(findings: &'a Findings, path: &str) -> Option<&'a Table> {
    let (section, key) = path.rsplit_once('.')?;
    findings.at_path(section)?.table_at(key)
}

/// Bars of the first `count` rows of some tables.
fn chart(
    what: &str,
    longest: &Table,
    count: usize,
    column: &TableColumn,
    tables: &[(&str, Option<&Table>)],
) -> BarChart {
    let categories: Vec<String> = longest.names().take(count).collect();
    let series = tables.iter().map(|&(name, table)| {
        let values: Vec<(String, Option<f64>)> =
            table.map_or_else(Vec::new, |table| table.names().zip(table.numbers(&column.key)).collect());
        let value = |category: &String| values.iter().find(|(name, _)| name == category).and_then(|(_, value)| *value);
        BarSeries { name: name.to_owned(), values: categories.iter().map(value).collect() }
    });
    BarChart {
        has_mean: true,
        limits: Vec::new(),
        title: format!("{}: {}{what}", longest.title, column.title),
        category_name: longest.columns[0].definition.to_string(),
        value_name: column.title.to_string(),
        least_division: least_division(column),
        unit: column.unit.as_deref().unwrap_or_default().to_owned(),
        series: series.collect(),
        categories,
    }
}
