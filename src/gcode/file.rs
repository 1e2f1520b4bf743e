//! A program as a file.

use crate::regular_file;
use gearcut_core::error::{Error, Result};
use std::path::Path;

/// Largest file.
const MOST_BYTES: u64 = 256 << 20;

/// Reads a program file by what `read` makes of its text.
///
/// # Errors
/// The file cannot be read, or what `read` refuses, with the file's name.
pub fn read_file<T>(path: &Path, read: impl FnOnce(&str) -> Result<T, String>) -> Result<T> {
    let unreadable = |reason: String| Error::Unreadable { path: path.to_owned(), reason };
    let bytes = regular_file::read(path, MOST_BYTES).map_err(unreadable)?;
    let text = String::from_utf8(bytes).map_err(|_| unreadable("it is not text".to_owned()))?;
    read(&text).map_err(unreadable)
}
