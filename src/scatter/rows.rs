//! Rows of finished seeds on disk, kept while others are still being cut ([`crate::output::growing`]).

use super::numbers::NUMBERS;
use crate::output::growing::{KeyedRows, RowFile, RowKind};
use gearcut_core::error::Result;
use std::path::Path;

/// Name of the file in its folder.
pub const FILE: &str = "seeds.csv";

/// Rows by seed.
pub type Rows = KeyedRows<u32>;
/// A file of rows that is being added to.
pub type SeedFile = RowFile<u32>;

/// The seed and the numbers.
fn kind() -> RowKind {
    let heads = NUMBERS.iter().map(|number| number.as_column().head());
    let header = std::iter::once("seed".to_owned()).chain(heads).collect::<Vec<_>>().join(",");
    RowKind { header, numbers: Some(NUMBERS.len()) }
}

/// Opens a file with the rows that it has; makes it where there is none.
///
/// # Errors
/// A file that cannot be read or written, or is another one.
pub fn open(path: &Path) -> Result<(SeedFile, Rows)> {
    RowFile::open(path, &kind())
}

/// Writes all rows in the order of their seeds.
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, rows: &Rows) -> Result<()> {
    kind().write(path, rows)
}
