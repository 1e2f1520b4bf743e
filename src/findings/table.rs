//! A table of findings: columns with unit and definition, rows of numbers, counts and words.
//!
//! A table holds what is the same for every row, such as the allowances of all teeth; a value with a place or a reason
//! of its own is an entry of a section instead.

use std::borrow::Cow;

/// Columns and rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Key in its section.
    pub key: String,
    /// What it shows.
    pub title: String,
    /// Columns; the first names the rows.
    pub columns: Vec<Column>,
    /// Rows of as many cells as there are columns.
    pub rows: Vec<Vec<Datum>>,
    /// Rows after which the gear's shape repeats, if it does.
    pub period_rows: Option<u32>,
}

/// One column.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Key.
    pub key: Cow<'static, str>,
    /// Unit; none for words.
    pub unit: Option<Cow<'static, str>>,
    /// What its values are.
    pub definition: Cow<'static, str>,
    /// Why a value may be missing; none where none ever is.
    pub why: Option<Cow<'static, str>>,
    /// Whether comparisons draw it as bars over the first column.
    pub bars: bool,
}

/// One value.
#[derive(Debug, Clone, PartialEq)]
pub enum Datum {
    /// A number in the column's unit.
    Number(f64),
    /// A count.
    Count(u64),
    /// A word.
    Word(String),
    /// None, for the column's reason.
    Undefined,
}

impl Table {
    /// An empty table.
    pub fn new(key: &str, title: &str, columns: Vec<Column>) -> Self {
        Self { key: key.to_owned(), title: title.to_owned(), columns, rows: Vec::new(), period_rows: None }
    }

    /// The table with these rows.
    #[must_use]
    pub fn with_rows(mut self, rows: impl IntoIterator<Item = Vec<Datum>>) -> Self {
        self.rows.extend(rows);
        debug_assert!(self.rows.iter().all(|row| row.len() == self.columns.len()), "{}: a cell per column", self.key);
        self
    }

    /// Where the column of this key stands.
    pub fn column(&self, key: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.key == key)
    }

    /// Numbers of a column, row by row; none for words, for what is undefined and for an unknown key.
    pub fn numbers(&self, key: &str) -> impl Iterator<Item = Option<f64>> {
        let column = self.column(key);
        self.rows.iter().map(move |row| row.get(column?)?.number())
    }
}

impl Column {
    /// A column of numbers or counts.
    pub fn new(key: &'static str, unit: &'static str, definition: &'static str) -> Self {
        Self { key: key.into(), unit: Some(unit.into()), definition: definition.into(), why: None, bars: false }
    }

    /// A column of words.
    pub fn words(key: &'static str, definition: &'static str) -> Self {
        Self { key: key.into(), unit: None, definition: definition.into(), why: None, bars: false }
    }

    /// The column, in which a value may be missing for this reason.
    #[must_use]
    pub fn or(mut self, why: &'static str) -> Self {
        self.why = Some(why.into());
        self
    }

    /// The column, drawn as bars by comparisons.
    #[must_use]
    pub fn as_bars(mut self) -> Self {
        self.bars = true;
        self
    }
}

impl Datum {
    /// The number or count.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            Self::Count(count) => Some(*count as f64),
            Self::Word(_) | Self::Undefined => None,
        }
    }

    /// The cell as the name of its row.
    pub fn name(&self) -> String {
        match self {
            Self::Number(value) => value.to_string(),
            Self::Count(count) => count.to_string(),
            Self::Word(word) => word.clone(),
            Self::Undefined => String::new(),
        }
    }
}

impl From<f64> for Datum {
    /// NaN and infinity become undefined: no file has a word for them.
    fn from(value: f64) -> Self {
        if value.is_finite() { Self::Number(value) } else { Self::Undefined }
    }
}

impl From<Option<f64>> for Datum {
    fn from(value: Option<f64>) -> Self {
        value.map_or(Self::Undefined, Self::from)
    }
}

impl From<u64> for Datum {
    fn from(count: u64) -> Self {
        Self::Count(count)
    }
}

impl From<u32> for Datum {
    fn from(count: u32) -> Self {
        Self::Count(count.into())
    }
}

impl From<&str> for Datum {
    fn from(word: &str) -> Self {
        Self::Word(word.to_owned())
    }
}
