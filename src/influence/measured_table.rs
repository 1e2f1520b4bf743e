//! Tables of others: CSV files with named columns.
//!
//! In: a file and the names of the columns that it must have, in any order, others beside them. Out: rows whose cells
//! are asked for by the column's number in that list, and errors that name file, line, column and value.

use crate::regular_file;
use gearcut_core::error::{Error, Result};
use std::path::{Path, PathBuf};

/// Largest file that is read, bytes: some ten million rows.
const LARGEST_FILE: u64 = 1 << 29;

/// A table.
#[derive(Debug, Clone)]
pub struct MeasuredTable<const N: usize> {
    /// Rows in the order of the file; at least one.
    pub rows: Vec<MeasuredRow<N>>,
}

/// One of its rows.
#[derive(Debug, Clone)]
pub struct MeasuredRow<const N: usize> {
    path: PathBuf,
    line: u64,
    names: [&'static str; N],
    cells: [String; N],
}

impl<const N: usize> MeasuredTable<N> {
    /// Reads a table with these columns; `optional` ones among them may be missing, and have empty cells then.
    ///
    /// # Errors
    /// A file that cannot be read or is no CSV; columns that are missing; no rows.
    pub fn read(path: &Path, names: [&'static str; N], optional: &[&str]) -> Result<Self> {
        let unreadable = |reason: String| Error::Unreadable { path: path.to_owned(), reason };
        let text = regular_file::read(path, LARGEST_FILE).map_err(unreadable)?;
        let mut reader = reader(&text);
        let heads = reader.headers().map_err(|reason| unreadable(reason.to_string()))?.clone();
        let place = |name: &str| heads.iter().position(|head| head == name);
        if let Some(missing) = names.iter().find(|name| !optional.contains(name) && place(name).is_none()) {
            let all = names.join(", ");
            return Err(unreadable(format!("it has no column {missing}; its first line must have {all}")));
        }
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|reason| unreadable(reason.to_string()))?;
            let line = record.position().map_or(0, csv::Position::line);
            let cell = |name| place(name).and_then(|place| record.get(place)).unwrap_or_default().to_owned();
            rows.push(MeasuredRow { path: path.to_owned(), line, names, cells: names.map(cell) });
        }
        if rows.is_empty() {
            return Err(unreadable("it has no rows".to_owned()));
        }
        Ok(Self { rows })
    }
}

/// Columns that a table has.
///
/// # Errors
/// A file that cannot be read or is no CSV.
pub fn heads(path: &Path) -> Result<Vec<String>> {
    let unreadable = |reason: String| Error::Unreadable { path: path.to_owned(), reason };
    let text = regular_file::read(path, LARGEST_FILE).map_err(unreadable)?;
    let heads = reader(&text).headers().map_err(|reason| unreadable(reason.to_string()))?.clone();
    Ok(heads.iter().map(str::to_owned).collect())
}

fn reader(text: &[u8]) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text)
}

impl<const N: usize> MeasuredRow<N> {
    /// A cell as it is written.
    pub fn cell(&self, column: usize) -> &str {
        &self.cells[column]
    }

    /// A cell as a number.
    ///
    /// # Errors
    /// It is no finite number.
    pub fn number(&self, column: usize) -> Result<f64> {
        let value = self.cells[column].parse::<f64>().ok().filter(|value| value.is_finite());
        value.ok_or_else(|| self.wrong(column, "a number"))
    }

    /// The error of a cell that is not what it should be.
    pub fn wrong(&self, column: usize, what: &str) -> Error {
        let reason = format!("line {}: `{}` = {:?} is not {what}", self.line, self.names[column], self.cells[column]);
        Error::Unreadable { path: self.path.clone(), reason }
    }
}
