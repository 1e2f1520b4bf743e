//! `results.json`, schema version 4: the tree in a fixed order of keys, and its document of rules.
//!
//! A section is an object: `$title`, its quantities, tables and parts under their keys. Keys of the tree never begin
//! with `$`. A quantity's title is written where it differs from its key, its level
//! where it is not a detail.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::column::TableCells;
use super::datum::Datum;
use super::entry::{Advice, Entry};
use super::notice::Notice;
use super::quantity::Quantity;
use super::row::{ColumnChart, Level, title_of};
use super::table::{Table, TableColumn, table_file};
use super::tree::{Findings, Section};
use crate::regular_file;
use gearcut_core::{Error, Result};

/// Version of the layout. A change of keys or meanings raises it; new keys that old readers may overlook do not.
pub const SCHEMA_VERSION: u32 = 4;
/// Largest result that is read: a gear of a thousand teeth takes some megabytes.
const MOST_BYTES: u64 = 256 << 20;
/// Name of the file in an output folder.
pub const RESULTS_FILE: &str = "results.json";
/// The layout as a JSON Schema (draft 2020-12).
pub const SCHEMA: &str = include_str!("../../assets/results.schema.json");

/// Names of the levels in files.
pub(super) const LEVELS: [(Level, &str); 3] =
    [(Level::Headline, "headline"), (Level::Summary, "summary"), (Level::Detail, "detail")];

/// Names of the charts of columns in files.
pub(super) const CHARTS: [(ColumnChart, &str); 2] = [(ColumnChart::Bars, "bars"), (ColumnChart::Curve, "curve")];

impl Findings {
    /// The document.
    pub fn to_json(&self) -> Value {
        let headline = self.headline.iter().map(|entry| (entry.key.clone(), of_entry(entry)));
        let sections = self.sections.iter().map(|section| (section.key.clone(), of_section(section)));
        json!({
            "schema_version": SCHEMA_VERSION,
            "program": "gearcut",
            "program_version": self.program_version,
            "process": self.process,
            "scene": self.scene,
            "complete": self.complete,
            "headline": headline.collect::<Map<_, _>>(),
            "warnings": self.warnings.iter().map(of_warning).collect::<Vec<_>>(),
            "sections": sections.collect::<Map<_, _>>(),
        })
    }

    /// Reads the findings of a run from its output folder, or from the file itself.
    ///
    /// # Errors
    /// No such file, another schema version, or a file that is not of this layout.
    pub fn read(path: &Path) -> Result<Self> {
        let file = if path.is_dir() { path.join(RESULTS_FILE) } else { path.to_owned() };
        let refuse = |reason: String| Error::Unreadable { path: file.clone(), reason };
        let bytes = regular_file::read(&file, MOST_BYTES).map_err(refuse)?;
        let document: Value =
            serde_json::from_slice(&bytes).map_err(|reason| refuse(format!("it is not JSON: {reason}")))?;
        match document.get("schema_version").and_then(Value::as_u64) {
            Some(version) if version == u64::from(SCHEMA_VERSION) => {}
            Some(version) => {
                return Err(refuse(format!(
                    "it has schema version {version}, this gearcut reads {SCHEMA_VERSION}; cut the scene again"
                )));
            }
            None => return Err(refuse("it has no schema_version: it is not a gearcut result".to_owned())),
        }
        Self::from_json(&document).map_err(|reason| refuse(format!("it is not a complete result: {reason}")))
    }
}

fn of_warning(warning: &Notice) -> Value {
    let mut value = json!({"id": warning.id, "severity": warning.severity.name(), "text": warning.text});
    if let Some(section) = &warning.section {
        value["section"] = json!(section);
    }
    value
}

fn of_entry(entry: &Entry) -> Value {
    let mut value = of_quantity(&entry.quantity);
    if entry.title != title_of(&entry.key) {
        value["title"] = json!(entry.title);
    }
    if let Some((level, name)) = LEVELS.iter().find(|(level, _)| *level == entry.level)
        && *level != Level::Detail
    {
        value["level"] = json!(name);
    }
    if let Some(Advice { text, change }) = &entry.advice {
        value["advice"] = json!({"text": text, "change": change});
    }
    value
}

/// A quantity always has a form in JSON: its numbers are finite.
fn of_quantity(quantity: &Quantity) -> Value {
    serde_json::to_value(quantity).unwrap_or_default()
}

fn of_section(section: &Section) -> Value {
    let mut all = Map::new();
    all.insert("$title".to_owned(), json!(section.title));
    all.extend(section.entries.iter().map(|entry| (entry.key.clone(), of_entry(entry))));
    all.extend(section.tables.iter().map(|table| (table.key.clone(), of_table(table))));
    all.extend(section.sections.iter().map(|part| (part.key.clone(), of_section(part))));
    Value::Object(all)
}

fn of_table(table: &Table) -> Value {
    let rows = table.rows().take(if table.rows_in_file { 0 } else { table.len() });
    let rows = rows.map(|row| row.iter().map(Datum::to_json).collect::<Vec<_>>());
    let mut value = json!({
        "title": table.title,
        "columns": table.columns.iter().zip(&table.cells).map(of_column).collect::<Vec<_>>(),
        "rows": rows.collect::<Vec<_>>(),
    });
    if let Some(rows) = table.period_rows {
        value["period_rows"] = json!(rows);
    }
    if let Some(file) = table.file.as_deref().map(table_file) {
        value["file"] = json!(file);
    }
    if table.rows_in_file {
        value["rows_in_file"] = json!(true);
    }
    value
}

fn of_column((column, cells): (&TableColumn, &TableCells)) -> Value {
    let mut value = json!({
        "key": column.key,
        "unit": column.unit,
        "definition": column.definition,
        "type": cells.type_name(),
    });
    if column.title != title_of(&column.key) {
        value["title"] = json!(column.title);
    }
    if let Some(why) = &column.why {
        value["why"] = json!(why);
    }
    if let Some(chart) = column.chart
        && let Some((_, name)) = CHARTS.iter().find(|(own, _)| *own == chart)
    {
        value["chart"] = json!(name);
    }
    value
}
