//! The rows of a study, read back: columns of parameters and of kept quantities.
//!
//! In: `rows.csv` and `columns.csv`, and the names of their columns. Out: [`StudyRows`]. Cases that failed are counted
//! and left out.

use super::kept::LAST_HEADS;
use gearcut_core::error::{Error, Result};
use std::path::Path;

/// Parameters and kept quantities of all cases that were made.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyRows {
    /// Numbers of these cases.
    pub cases: Vec<u64>,
    /// Cases that could not be made.
    pub failed: usize,
    /// The parameters.
    pub parameters: Vec<StudyColumn>,
    /// The kept quantities.
    pub kept: Vec<StudyColumn>,
}

/// A column of rows.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyColumn {
    /// Key of a parameter, or path of a quantity.
    pub name: String,
    /// Unit; empty for words.
    pub unit: String,
    /// A cell for each case.
    pub cells: Vec<String>,
}

impl StudyRows {
    /// Reads both files; `parameters` and `keep` name the columns in their order.
    ///
    /// # Errors
    /// Files that cannot be read, or are none of a study.
    pub fn read([rows, columns]: [&Path; 2], parameters: &[String], keep: &[String]) -> Result<Self> {
        let records = |path: &Path| -> Result<Vec<csv::StringRecord>> {
            let wrong = |reason: csv::Error| Error::Unreadable { path: path.to_owned(), reason: reason.to_string() };
            csv::Reader::from_path(path).and_then(|mut reader| reader.records().collect()).map_err(wrong)
        };
        let units: Vec<String> = records(columns)?.iter().map(|of| of.get(1).unwrap_or_default().to_owned()).collect();
        let names = parameters.iter().chain(keep);
        let column = |(place, name): (usize, &String)| StudyColumn {
            name: name.clone(),
            unit: units.get(place + 1).cloned().unwrap_or_default(),
            cells: Vec::new(),
        };
        let mut all: Vec<StudyColumn> = names.enumerate().map(column).collect();
        let (mut cases, mut failed) = (Vec::new(), 0);
        for record in records(rows)? {
            if record.get(all.len() + LAST_HEADS.len()).is_some_and(|error| !error.is_empty()) {
                failed += 1;
                continue;
            }
            cases.extend(record.get(0).and_then(|case| case.parse::<u64>().ok()));
            for (column, cell) in all.iter_mut().zip(record.iter().skip(1)) {
                column.cells.push(cell.to_owned());
            }
        }
        let kept = all.split_off(parameters.len());
        Ok(Self { cases, failed, parameters: all, kept })
    }
}

impl StudyColumn {
    /// Its numbers, each behind the place of its case; cells without one are left out.
    pub fn numbers(&self) -> Vec<(usize, f64)> {
        let number =
            |(place, cell): (usize, &String)| Some((place, cell.parse().ok().filter(|of: &f64| of.is_finite())?));
        self.cells.iter().enumerate().filter_map(number).collect()
    }
}
