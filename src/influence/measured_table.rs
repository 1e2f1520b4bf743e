//! Tables of others: CSV files with named columns.
//!
//! In: a file and the names of the columns that it must have, in any order, others beside them. Out: rows whose cells
//! are asked for by the column's number in that list, and errors that name file, line, column and value.
//!
//! Tables of spreadsheets with semicolons, tabs, UTF-16 or other spellings of the heads are refused by these words.
//! Road not taken: reading them. Where semicolons divide columns, commas may divide decimals, and a guess is no
//! measure.

use crate::regular_file;
use gearcut_core::error::{Error, Result};
use gearcut_core::terms::Side;
use std::path::{Path, PathBuf};

/// Largest file that is read, bytes: some ten million rows.
const LARGEST_FILE: u64 = 1 << 29;
/// Numbers beyond this are no measures, whatever their unit: squares of residuals would overflow.
const LARGEST_NUMBER: f64 = 1e12;

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
        let text = text(path)?;
        let mut reader = reader(&text);
        let heads = reader.headers().map_err(|reason| unreadable(reason.to_string()))?.clone();
        let place = |name: &str| heads.iter().position(|head| head == name);
        if let Some(missing) = names.iter().find(|name| !optional.contains(name) && place(name).is_none()) {
            let heads: Vec<&str> = heads.iter().collect();
            let spelled = other_spelling(&heads, &names);
            let why = spelled.unwrap_or_else(|| format!("it has no column {missing}"));
            let needed: Vec<&str> = names.into_iter().filter(|name| !optional.contains(name)).collect();
            return Err(unreadable(format!("{why}; its first line must have {}", needed.join(", "))));
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

/// What a file is by its first line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FirstLine {
    /// Numbers alone: the heights of a surface.
    Numbers,
    /// The names of columns.
    Columns(Vec<String>),
}

impl FirstLine {
    /// Reads it; `known` are the columns by which a table is known.
    ///
    /// # Errors
    /// A file that cannot be read, is empty, or is no CSV; columns of which none is known.
    pub fn of(path: &Path, known: &[&str]) -> Result<Self> {
        let unreadable = |reason: String| Error::Unreadable { path: path.to_owned(), reason };
        let text = text(path)?;
        let heads = reader(&text).headers().map_err(|reason| unreadable(reason.to_string()))?.clone();
        let heads: Vec<&str> = heads.iter().collect();
        if heads.iter().any(|head| known.contains(head)) {
            return Ok(Self::Columns(heads.into_iter().map(str::to_owned).collect()));
        }
        // Surfaces have other separators as well, and words for holes.
        let is_height = |cell: &str| ["", "bad", "---"].contains(&cell) || cell.parse::<f64>().is_ok();
        let cells = || heads.iter().flat_map(|head| head.split([';', '\t', ' ']));
        if cells().all(is_height) || heads[0].starts_with('#') {
            return Ok(Self::Numbers);
        }
        let spelled = other_spelling(&heads, known);
        let why = spelled.unwrap_or_else(|| format!("its first line, `{}`, names no known column", heads.join(",")));
        Err(unreadable(format!("{why}; a table of measured values has a column {}", known.join(" or "))))
    }
}

/// The bytes of a table, which are text in UTF-8.
fn text(path: &Path) -> Result<Vec<u8>> {
    let unreadable = |reason: &str| Error::Unreadable { path: path.to_owned(), reason: reason.to_owned() };
    let text =
        regular_file::read(path, LARGEST_FILE).map_err(|reason| Error::Unreadable { path: path.to_owned(), reason })?;
    if text.is_empty() {
        return Err(unreadable("it is empty"));
    }
    // Letters of UTF-16 are two bytes, of which one is 0 in European alphabets.
    if text.starts_with(&[0xff, 0xfe]) || text.starts_with(&[0xfe, 0xff]) || text.iter().take(64).any(|&byte| byte == 0)
    {
        return Err(unreadable("it is a table in UTF-16; save it as CSV in UTF-8"));
    }
    Ok(text)
}

/// In which other way a first line is written that has columns by their names; nothing where it has none of them.
fn other_spelling(heads: &[&str], names: &[&str]) -> Option<String> {
    for (separator, word) in [(';', "semicolons"), ('\t', "tabs")] {
        let mut cells = heads.iter().flat_map(|head| head.split(separator)).map(str::trim);
        if heads.iter().any(|head| head.contains(separator))
            && cells.any(|cell| names.iter().any(|name| cell.eq_ignore_ascii_case(name)))
        {
            return Some(format!("{word} separate its columns; write commas there, and points before decimals"));
        }
    }
    let other = |head: &&&str| names.iter().find(|name| head.eq_ignore_ascii_case(name) && head != name);
    let head = heads.iter().find(|head| other(head).is_some())?;
    Some(format!("its column `{head}` must be written `{}`", head.to_lowercase()))
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
    /// It is no number, or none that a measure can be.
    pub fn number(&self, column: usize) -> Result<f64> {
        self.number_within(column, LARGEST_NUMBER)
    }

    /// A cell as a number from `-most` to `most`.
    ///
    /// # Errors
    /// It is no such number.
    pub fn number_within(&self, column: usize, most: f64) -> Result<f64> {
        let value = self.cells[column].parse::<f64>().ok().filter(|value| value.abs() <= most);
        value.ok_or_else(|| self.wrong(column, &format!("a number from {:e} to {most:e}", -most)))
    }

    /// The flank that two cells name: number of a tooth, left or right.
    ///
    /// # Errors
    /// They name none.
    pub fn flank(&self, [tooth, flank]: [usize; 2]) -> Result<(u32, Side)> {
        let number = self.cell(tooth).parse().map_err(|_| self.wrong(tooth, "the number of a tooth"))?;
        let side = [Side::Left, Side::Right].into_iter().find(|side| side.name() == self.cell(flank));
        Ok((number, side.ok_or_else(|| self.wrong(flank, "left or right"))?))
    }

    /// The error of a row that says once more what another one says.
    pub fn repeats(&self, first: &Self, what: &str) -> Error {
        let reason = format!("line {}: {what} has a value in line {} already; write each once", self.line, first.line);
        Error::Unreadable { path: self.path.clone(), reason }
    }

    /// The error of a cell that is not what it should be.
    pub fn wrong(&self, column: usize, what: &str) -> Error {
        let reason = format!("line {}: `{}` = {:?} is not {what}", self.line, self.names[column], self.cells[column]);
        Error::Unreadable { path: self.path.clone(), reason }
    }
}
