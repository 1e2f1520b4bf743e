//! Rows of finished seeds on disk, kept while others are still being cut ([`crate::output::growing`]).

use super::numbers::NUMBERS;
use crate::findings::table::table_file;
use crate::output::growing::{KeyedRows, RowFile, RowKind};
use gearcut_core::error::Result;
use std::path::Path;

/// The file in its folder, without its ending.
const FILE: &str = "seeds";

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

/// Opens the file of a folder with the rows that it has; makes it where there is none.
///
/// # Errors
/// A file that cannot be read or written, or is another one.
pub fn open(folder: &Path) -> Result<(SeedFile, Rows)> {
    RowFile::open(&folder.join(table_file(FILE)), &kind())
}

/// Writes all rows of a folder in the order of their seeds.
///
/// # Errors
/// The file cannot be written.
pub fn write(folder: &Path, rows: &Rows) -> Result<()> {
    kind().write(&folder.join(table_file(FILE)), rows)
}
