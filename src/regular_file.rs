//! Files of others, read whole: regular ones, up to a size.
//!
//! A device has no end, and opening a pipe waits for its other end without a word: both are refused before they are
//! opened.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::Path;

/// The bytes of a regular file.
///
/// # Errors
/// In words: why it cannot be read, or that it is larger than `most` bytes.
pub fn read(path: &Path, most: u64) -> Result<Vec<u8>, String> {
    let facts = fs::metadata(path).map_err(|error| reason(&error))?;
    if facts.is_dir() {
        return Err("it is a folder".to_owned());
    }
    if !facts.is_file() {
        return Err("it is a device, pipe or socket: save it as a file first".to_owned());
    }
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(most + 1).read_to_end(&mut bytes));
    match read {
        Err(error) => Err(reason(&error)),
        Ok(_) if bytes.len() as u64 > most => Err(format!("it is larger than {} MB", most >> 20)),
        Ok(_) => Ok(bytes),
    }
}

/// Reason in words that are the same on every system, where they are common.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        io::ErrorKind::PermissionDenied => "it may not be read".to_owned(),
        io::ErrorKind::IsADirectory => "it is a folder".to_owned(),
        _ => error.to_string(),
    }
}
