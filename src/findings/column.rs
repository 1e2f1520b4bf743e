//! The values of a column, all of one type.
//!
//! In: numbers, counts or words of Rust, each of which may be missing. Out: [`TableCells`], which a writer takes whole:
//! CSV cell by cell, Parquet as an array.
//!
//! Road not taken: rows of values of any type. A reader had to find out what a column holds, and an empty one did not
//! say.

use super::datum::Datum;

/// Values of a column; none where there is no value, for the column's reason.
#[derive(Debug, Clone, PartialEq)]
pub enum TableCells {
    /// Finite numbers.
    Numbers(Vec<Option<f64>>),
    /// Counts.
    Counts(Vec<Option<u64>>),
    /// Words.
    Words(Vec<Option<String>>),
}

/// What a column can hold: numbers, counts, words, and each of them where there may be none.
pub trait TableCell: Sized {
    /// The cells of a column.
    fn cells(values: impl Iterator<Item = Option<Self>>) -> TableCells;
}

impl TableCell for f64 {
    /// NaN and infinity become none: no file has a word for them.
    fn cells(values: impl Iterator<Item = Option<Self>>) -> TableCells {
        TableCells::Numbers(values.map(|value| value.filter(|value| value.is_finite())).collect())
    }
}

impl TableCell for u64 {
    fn cells(values: impl Iterator<Item = Option<Self>>) -> TableCells {
        TableCells::Counts(values.collect())
    }
}

impl TableCell for u32 {
    fn cells(values: impl Iterator<Item = Option<Self>>) -> TableCells {
        u64::cells(values.map(|count| count.map(u64::from)))
    }
}

impl TableCell for usize {
    fn cells(values: impl Iterator<Item = Option<Self>>) -> TableCells {
        u64::cells(values.map(|count| count.map(|count| count as u64)))
    }
}

impl TableCell for String {
    fn cells(values: impl Iterator<Item = Option<Self>>) -> TableCells {
        TableCells::Words(values.collect())
    }
}

impl TableCell for &str {
    fn cells(values: impl Iterator<Item = Option<Self>>) -> TableCells {
        String::cells(values.map(|word| word.map(str::to_owned)))
    }
}

impl<T: TableCell> TableCell for Option<T> {
    fn cells(values: impl Iterator<Item = Option<Self>>) -> TableCells {
        T::cells(values.map(Option::flatten))
    }
}

impl TableCells {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(cells) => cells.len(),
            Self::Counts(cells) => cells.len(),
            Self::Words(cells) => cells.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The value in a row; none beyond the last.
    pub fn datum(&self, row: usize) -> Datum {
        match self {
            Self::Numbers(cells) => cells.get(row).copied().flatten().into(),
            Self::Counts(cells) => cells.get(row).copied().flatten().into(),
            Self::Words(cells) => cells.get(row).cloned().flatten().into(),
        }
    }

    /// Without its values, and of the same type.
    pub(super) fn clear(&mut self) {
        match self {
            Self::Numbers(cells) => cells.clear(),
            Self::Counts(cells) => cells.clear(),
            Self::Words(cells) => cells.clear(),
        }
    }

    /// The type by its name in files.
    pub(super) fn type_name(&self) -> &'static str {
        match self {
            Self::Numbers(_) => "number",
            Self::Counts(_) => "count",
            Self::Words(_) => "word",
        }
    }

    /// No cells of the type of this name, if there is one.
    pub(super) fn of_type(name: &str) -> Option<Self> {
        [Self::Numbers(Vec::new()), Self::Counts(Vec::new()), Self::Words(Vec::new())]
            .into_iter()
            .find(|cells| cells.type_name() == name)
    }

    /// With one more value; none where it is of another type.
    pub(super) fn and(mut self, value: &Datum) -> Option<Self> {
        match (&mut self, value) {
            (Self::Numbers(cells), Datum::Number(_) | Datum::Count(_) | Datum::Undefined) => cells.push(value.number()),
            (Self::Counts(cells), Datum::Count(count)) => cells.push(Some(*count)),
            (Self::Words(cells), Datum::Word(word)) => cells.push(Some(word.clone())),
            (Self::Counts(cells), Datum::Undefined) => cells.push(None),
            (Self::Words(cells), Datum::Undefined) => cells.push(None),
            _ => return None,
        }
        Some(self)
    }

    /// With one more value as a table of text has it, empty where there is none; none where it is of another type.
    pub fn and_text(self, text: &str) -> Option<Self> {
        let value = match &self {
            _ if text.is_empty() => Datum::Undefined,
            Self::Numbers(_) => Datum::Number(text.parse().ok()?),
            Self::Counts(_) => Datum::Count(text.parse().ok()?),
            Self::Words(_) => text.into(),
        };
        self.and(&value)
    }
}
