//! Folders that grow while work of hours is done, and go on where a stopped run ended.
//!
//! In: lines as they are found, such as rows of numbers by a key. Out: those that are there already. A line is written
//! at once, so that a kill does not take it, and forced to the disk every second, so that a power cut takes no more.
//! What a kill leaves is at most one line without its end, which is cut off before the next one is written. The folder
//! has a run record that says it is not complete, so that the next run may replace it.
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
use std::time::Duration;
use web_time::Instant;

/// Between two moments at which lines are forced to the disk.
const FORCED_EVERY: Duration = Duration::from_secs(1);

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
        write_lines(path, &self.first_line(), rows.iter().map(|(key, values)| line(key, values)))
    }

    fn first_line(&self) -> String {
        self.header.clone() + "\n"
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

/// Lines of a file that is being added to; the first one says what the others are. All have their ends.
#[derive(Debug)]
pub struct LineFile {
    path: PathBuf,
    /// The file, and when it was last forced to the disk.
    file: Mutex<(File, Instant)>,
}

impl LineFile {
    /// First line and the others of a file; `None`: there is none.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(path: &Path) -> Result<Option<(String, Vec<String>)>> {
        let text = if path.exists() { fs::read_to_string(path).map_err(Error::reading(path))? } else { String::new() };
        let mut lines = text.split_inclusive('\n').filter(|line| line.ends_with('\n')).map(str::to_owned);
        Ok(lines.next().map(|first| (first, lines.collect())))
    }

    /// Writes the lines that are known, and opens the file for more.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn create(path: &Path, first: &str, lines: impl IntoIterator<Item = impl AsRef<str>>) -> Result<Self> {
        write_lines(path, first, lines)?;
        let file = OpenOptions::new().append(true).open(path).map_err(Error::writing(path))?;
        Ok(Self { path: path.to_owned(), file: Mutex::new((file, Instant::now())) })
    }

    /// Adds a line.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&self, line: &str) -> Result<()> {
        let mut guard = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let (file, forced) = &mut *guard;
        file.write_all(line.as_bytes()).map_err(Error::writing(&self.path))?;
        if forced.elapsed() >= FORCED_EVERY {
            file.sync_data().map_err(Error::writing(&self.path))?;
            *forced = Instant::now();
        }
        Ok(())
    }
}

/// Writes a file of lines, completely or not at all.
fn write_lines(path: &Path, first: &str, lines: impl IntoIterator<Item = impl AsRef<str>>) -> Result<()> {
    let mut text = first.to_owned();
    lines.into_iter().for_each(|line| text.push_str(line.as_ref()));
    write_bytes_atomically(path, text.as_bytes())
}

/// A file of rows that is being added to.
#[derive(Debug)]
pub struct RowFile<K> {
    lines: LineFile,
    key: PhantomData<fn(K)>,
}

impl<K: Display + FromStr + Ord> RowFile<K> {
    /// Opens a file with the rows that it has; makes it where there is none.
    ///
    /// # Errors
    /// A file that cannot be read or written, or is another one.
    pub fn open(path: &Path, kind: &RowKind) -> Result<(Self, KeyedRows<K>)> {
        let mut rows = KeyedRows::new();
        if let Some((first, lines)) = LineFile::read(path)? {
            if first != kind.first_line() {
                let reason = "its columns are not those of this version; choose another folder with --out".to_owned();
                return Err(Error::Output { path: path.to_owned(), reason });
            }
            rows.extend(lines.iter().filter_map(|line| kind.parse(line.trim_end_matches('\n'))));
        }
        let known = rows.iter().map(|(key, values)| line(key, values));
        let lines = LineFile::create(path, &kind.first_line(), known)?;
        Ok((Self { lines, key: PhantomData }, rows))
    }

    /// Adds a row.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&self, key: &K, values: &RowValues) -> Result<()> {
        self.lines.add(&line(key, values))
    }
}
