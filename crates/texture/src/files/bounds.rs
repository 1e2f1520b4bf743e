//! Bounds of what is read: regular files of a size that their format can have, and surfaces that fit into memory.
//!
//! A surface takes up to 110 bytes a point while it is evaluated, robust filters included: one of the most points 0.9
//! GB. A file need not be large for that. X3P and EXR are compressed, and zeros shrink to a thousandth; so the bound is
//! one of points, whatever the file has in bytes. Maps are read as they are and evaluated nowhere: theirs is one of
//! values.
//!
//! Road not taken: reading pipes. A pipe may wait for ever in silence, and formats with a directory at their end need
//! all of it anyway; a file costs one more word on the command line.

use crate::error::FileFault;
use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use crate::text::quoted;
use crate::{Error, Result};

/// Points that a surface in a file may have.
pub const MOST_POINTS: usize = 8_000_000;
/// Values that a map in a file may have, all channels together: 0.4 GB.
pub(super) const MOST_VALUES: usize = 100_000_000;
/// Bytes of a height in formats of raw numbers.
const BYTES_PER_NUMBER: u64 = 8;
/// Bytes of a height in formats of text, its separator included: all digits of an f64 are 24.
const BYTES_PER_WORD: u64 = 32;
/// Bytes for headers, notes and trailers.
const ROOM_FOR_NOTES: u64 = 64 << 20;
/// Bytes at the start of a file by which formats are told apart.
const HEAD: u64 = 64;

/// Most bytes of a map.
pub(super) const MOST_BYTES_OF_MAPS: u64 = MOST_VALUES as u64 * BYTES_PER_NUMBER + ROOM_FOR_NOTES;
/// Most bytes of a file of raw numbers.
pub(super) const MOST_BYTES_OF_NUMBERS: u64 = MOST_POINTS as u64 * BYTES_PER_NUMBER + ROOM_FOR_NOTES;
/// Most bytes of a file of text.
pub(super) const MOST_BYTES_OF_TEXT: u64 = MOST_POINTS as u64 * BYTES_PER_WORD + ROOM_FOR_NOTES;

/// Number of points of a grid that a header declares.
pub(super) fn points(nx: usize, ny: usize) -> std::result::Result<usize, FileFault> {
    nx.checked_mul(ny).filter(|&count| count <= MOST_POINTS).ok_or_else(|| {
        FileFault::TooLarge(format!(
            "the header declares {nx} x {ny} points, more than {MOST_POINTS}, which take 1 GB of memory while they are \
             evaluated: crop or thin the surface where it was measured"
        ))
    })
}

/// Reads a regular file; `what` finds out from its first bytes what it is and how large it may be.
pub(super) fn read<T>(
    path: &Path,
    what: impl FnOnce(&[u8]) -> std::result::Result<(T, u64), FileFault>,
) -> Result<(T, Vec<u8>)> {
    let refused = unreadable(path, None);
    // Before it is opened: opening a pipe waits for its other end.
    let facts = fs::metadata(path).map_err(Error::reading(path))?;
    if !facts.is_file() {
        let is = if facts.is_dir() { "a folder" } else { "a device, pipe or socket" };
        return Err(refused(FileFault::NotRead(format!(
            "it is {is}; surfaces are read from regular files: save it as one first"
        ))));
    }
    let mut file = File::open(path).map_err(Error::reading(path))?;
    let mut bytes = Vec::new();
    (&mut file).take(HEAD).read_to_end(&mut bytes).map_err(Error::reading(path))?;
    let (found, most) = what(&bytes).map_err(&refused)?;
    let too_large = || {
        let sentence = format!("it is larger than the {most} bytes that a surface in this format can have");
        refused(FileFault::TooLarge(sentence))
    };
    if facts.len() > most {
        return Err(too_large());
    }
    let no_room = |_| refused(FileFault::TooLarge(format!("its {} bytes do not fit into memory", facts.len())));
    bytes.try_reserve_exact(facts.len() as usize).map_err(no_room)?;
    // A file may grow while it is read, or not know its length.
    file.take(most - bytes.len() as u64 + 1).read_to_end(&mut bytes).map_err(Error::reading(path))?;
    if bytes.len() as u64 > most { Err(too_large()) } else { Ok((found, bytes)) }
}

/// Why a file cannot be used, fit to print.
pub(super) fn unreadable(path: &Path, format: Option<&'static str>) -> impl Fn(FileFault) -> Error {
    move |fault| Error::Unreadable { path: path.to_owned(), format, fault }
}

/// `value` made of the number `raw` of a file: a number too large for f64 stays a number, which is refused as a height,
/// where infinity would pass as a hole.
pub(super) fn kept_number(raw: f64, value: f64) -> f64 {
    if raw.is_finite() { value.clamp(f64::MIN, f64::MAX) } else { value }
}

/// A height written as text; `nan` and `inf` are holes, digits always a number.
pub(super) fn height(word: &str) -> std::result::Result<f64, FileFault> {
    let value: f64 = word.parse().map_err(|_| format!("`{}` is not a height", quoted(word)))?;
    let raw = if word.contains(|c: char| c.is_ascii_digit()) { 0.0 } else { value };
    Ok(kept_number(raw, value))
}

/// A factor from a header.
pub(super) fn factor(name: &str, value: f64) -> std::result::Result<f64, FileFault> {
    let usable = value.is_finite() && value != 0.0;
    usable.then_some(value).ok_or_else(|| format!("{name} is {value}; it must be a number other than 0").into())
}

/// A number of points from a header.
pub(super) fn side(count: i32) -> std::result::Result<usize, FileFault> {
    usize::try_from(count).map_err(|_| format!("a side of {count} points").into())
}
