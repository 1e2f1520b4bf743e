//! Folders that grow while work of hours is done, and go on where a stopped run ended.
//!
//! In: rows of numbers by a key, as they are found. Out: those that are there already. A row is one line, written at
//! once and forced to the disk; what a kill leaves is at most one line without its end, which is cut off before the
//! next one is written. The folder has a run record that says it is not complete, so that the next run may replace it.
//!
//! Who writes there holds the lock of an [`super::folder::OutputFolder`] of the same name.

use crate::output::atomic::write_bytes_atomically;
use crate::output::folder::RUN_RECORD;
use gearcut_core::error::{Error, Result};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::fmt::{Display, Write as _};
use std::fs::{self, File, OpenOptions};
use std::io::Write as _;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::{Mutex, PoisonError};

/// Numbers of a row; those that do not exist are none.
pub type RowValues = Vec<Option<f64>>;
/// Rows by their keys.
pub type KeyedRows<K> = BTreeMap<K, RowValues>;

/// Makes a folder that is to grow, with the record of what it holds; one that has a record stays as it is.
///
/// # Errors
/// The folder or its record cannot be written.
pub fn begin(folder: &Path, record: &Map<String, Value>) -> Result<()> {
    if folder.join(RUN_RECORD).exists() {
        return Ok(());
    }
    fs::create_dir_all(folder).map_err(Error::writing(folder))?;
    let mut unfinished = record.clone();
    unfinished.insert("complete".to_owned(), json!(false));
    write_bytes_atomically(&folder.join(RUN_RECORD), format!("{:#}\n", Value::Object(unfinished)).as_bytes())
}

/// What the rows of a file are.
#[derive(Debug, Clone)]
pub struct RowKind {
    /// First line.
    pub header: String,
    /// How many numbers each row has; `None`: any.
    pub numbers: Option<usize>,
}

impl RowKind {
    fn parse<K: FromStr>(&self, line: &str) -> Option<(K, RowValues)> {
        let mut fields = line.split(',');
        let key = fields.next()?.parse().ok()?;
        let number = |field: &str| if field.is_empty() { Some(None) } else { field.parse::<f64>().ok().map(Some) };
        let values: RowValues = fields.map(number).collect::<Option<_>>()?;
        self.numbers.is_none_or(|numbers| values.len() == numbers).then_some((key, values))
    }

    /// Writes all rows in the order of their keys.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write<K: Display>(&self, path: &Path, rows: &KeyedRows<K>) -> Result<()> {
        let lines = rows.iter().map(|(key, values)| line(key, values));
        let text: String = std::iter::once(self.header.clone() + "\n").chain(lines).collect();
        write_bytes_atomically(path, text.as_bytes())
    }
}

/// One row, its end included.
fn line<K: Display>(key: &K, values: &RowValues) -> String {
    let mut line = key.to_string();
    for value in values {
        line.push(',');
        if let Some(value) = value {
            // As tables are written: the shortest number that reads back as the same.
            let _ = write!(line, "{value:?}");
        }
    }
    line + "\n"
}

/// A file of rows that is being added to.
#[derive(Debug)]
pub struct RowFile<K> {
    path: PathBuf,
    file: Mutex<File>,
    key: PhantomData<fn(K)>,
}

impl<K: Display + FromStr + Ord> RowFile<K> {
    /// Opens a file with the rows that it has; makes it where there is none.
    ///
    /// # Errors
    /// A file that cannot be read or written, or is another one.
    pub fn open(path: &Path, kind: &RowKind) -> Result<(Self, KeyedRows<K>)> {
        let text = if path.exists() { fs::read_to_string(path).map_err(Error::reading(path))? } else { String::new() };
        let mut lines = text.split_inclusive('\n');
        let mut rows = KeyedRows::new();
        if let Some(first) = lines.next() {
            if first.trim_end() != kind.header {
                let reason = "its columns are not those of this version; choose another folder with --out".to_owned();
                return Err(Error::Output { path: path.to_owned(), reason });
            }
            rows.extend(lines.filter_map(|line| kind.parse(line.strip_suffix('\n')?)));
        }
        kind.write(path, &rows)?;
        let file = OpenOptions::new().append(true).open(path).map_err(Error::writing(path))?;
        Ok((Self { path: path.to_owned(), file: Mutex::new(file), key: PhantomData }, rows))
    }

    /// Adds a row.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&self, key: &K, values: &RowValues) -> Result<()> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let written = file.write_all(line(key, values).as_bytes()).and_then(|()| file.sync_data());
        written.map_err(Error::writing(&self.path))
    }
}
