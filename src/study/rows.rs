//! The rows of a study, read back: columns of parameters and of kept quantities.
//!
//! In: `rows.csv` and `columns.csv`. Out: [`StudyRows`]. Cases that failed are counted by their reasons and left out.

use super::kept::LAST_HEADS;
use gearcut_core::error::{Error, Result};
use std::collections::BTreeMap;
use std::path::Path;

/// Parameters and kept quantities of all cases that were made.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyRows {
    /// Numbers of these cases.
    pub cases: Vec<u64>,
    /// The parameters.
    pub parameters: Vec<StudyColumn>,
    /// The kept quantities.
    pub kept: Vec<StudyColumn>,
    /// Why kept quantities have no value, case by case.
    pub missing: Vec<String>,
    /// Why cases failed, and the first of each reason.
    pub reasons: BTreeMap<String, (usize, u64)>,
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
    /// Reads both files, of which the columns behind that of the case are so many parameters.
    ///
    /// # Errors
    /// Files that cannot be read, or are none of a study.
    pub fn read([rows, columns]: [&Path; 2], parameters: usize) -> Result<Self> {
        let records = |path: &Path| -> Result<Vec<csv::StringRecord>> {
            let wrong = |reason: csv::Error| Error::Unreadable { path: path.to_owned(), reason: reason.to_string() };
            csv::Reader::from_path(path).and_then(|mut reader| reader.records().collect()).map_err(wrong)
        };
        let column = |of: &csv::StringRecord| {
            let [head, unit, path] = [0, 1, 3].map(|place| of.get(place).unwrap_or_default().to_owned());
            StudyColumn { name: if path.is_empty() { head } else { path }, unit, cells: Vec::new() }
        };
        let about = records(columns)?;
        let own = about.len().saturating_sub(LAST_HEADS.len()).max(1);
        let mut all: Vec<StudyColumn> = about[1..own].iter().map(column).collect();
        let mut read = Self {
            cases: Vec::new(),
            parameters: Vec::new(),
            kept: Vec::new(),
            missing: Vec::new(),
            reasons: BTreeMap::new(),
        };
        for record in records(rows)? {
            let case = record.get(0).and_then(|case| case.parse::<u64>().ok()).unwrap_or_default();
            let [missing, error] = [2, 1].map(|back| record.get(record.len() - back).unwrap_or_default());
            if !error.is_empty() {
                read.reasons.entry(error.to_owned()).or_insert((0, case)).0 += 1;
                continue;
            }
            read.cases.push(case);
            read.missing.push(missing.to_owned());
            for (column, cell) in all.iter_mut().zip(record.iter().skip(1)) {
                column.cells.push(cell.to_owned());
            }
        }
        read.kept = all.split_off(parameters);
        read.parameters = all;
        Ok(read)
    }

    /// How many cases could not be made.
    pub fn failed(&self) -> usize {
        self.reasons.values().map(|(cases, _)| cases).sum()
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
