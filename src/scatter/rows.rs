//! Rows of finished seeds on disk, kept while others are still being cut.
//!
//! In: a file of rows, whole or broken off. Out: the rows that are whole. A row is one line, written at once; what a
//! kill leaves is at most one line without its end, which is cut off before the next one is written.

use super::numbers::{NUMBERS, Values};
use crate::output::atomic::write_bytes_atomically;
use gearcut_core::error::{Error, Result};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{File, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// Rows by seed.
pub type Rows = BTreeMap<u32, Values>;

/// A file of rows that is being added to.
#[derive(Debug)]
pub struct RowFile {
    path: PathBuf,
    file: Mutex<File>,
}

/// First line: the seed and the numbers.
fn header() -> String {
    let heads = NUMBERS.iter().map(|number| number.column().head());
    std::iter::once("seed".to_owned()).chain(heads).collect::<Vec<_>>().join(",")
}

/// One row, its end included.
fn line(seed: u32, values: &Values) -> String {
    let mut line = seed.to_string();
    for value in values {
        line.push(',');
        if let Some(value) = value {
            // As tables are written: the shortest number that reads back as the same.
            let _ = write!(line, "{value:?}");
        }
    }
    line + "\n"
}

fn parse(line: &str) -> Option<(u32, Values)> {
    let mut fields = line.split(',');
    let seed = fields.next()?.parse().ok()?;
    let values: Option<Values> =
        fields.map(|field| if field.is_empty() { Some(None) } else { field.parse::<f64>().ok().map(Some) }).collect();
    Some((seed, values.filter(|values| values.len() == NUMBERS.len())?))
}

impl RowFile {
    /// Opens a file with the rows that it has; makes it where there is none.
    ///
    /// # Errors
    /// A file that cannot be read or written, or is another one.
    pub fn open(path: &Path) -> Result<(Self, Rows)> {
        let text =
            if path.exists() { std::fs::read_to_string(path).map_err(Error::reading(path))? } else { String::new() };
        let mut lines = text.split_inclusive('\n');
        let mut rows = Rows::new();
        if let Some(first) = lines.next() {
            if first.trim_end() != header() {
                let reason = "its columns are not those of this version; choose another folder with --out".to_owned();
                return Err(Error::Output { path: path.to_owned(), reason });
            }
            rows.extend(lines.filter_map(|line| parse(line.strip_suffix('\n')?)));
        }
        write(path, &rows)?;
        let file = OpenOptions::new().append(true).open(path).map_err(Error::writing(path))?;
        Ok((Self { path: path.to_owned(), file: Mutex::new(file) }, rows))
    }

    /// Adds a row.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&self, seed: u32, values: &Values) -> Result<()> {
        let mut file = self.file.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let written = file.write_all(line(seed, values).as_bytes()).and_then(|()| file.sync_data());
        written.map_err(Error::writing(&self.path))
    }
}

/// Writes all rows in the order of their seeds.
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, rows: &Rows) -> Result<()> {
    let lines = rows.iter().map(|(&seed, values)| line(seed, values));
    let text: String = std::iter::once(header() + "\n").chain(lines).collect();
    write_bytes_atomically(path, text.as_bytes())
}
