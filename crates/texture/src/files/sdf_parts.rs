//! What both forms of SDF share (ISO 25178-71): maker, dates, numbers of the types of heights, the trailer with notes.

use super::raw::Raw;
use super::{notes_json, notes_of};
use crate::error::FileFault;

/// Who wrote the file.
pub(super) const MAKER: &str = "gearcut";
/// The format demands dates; zeros are its custom for "not recorded". A clock's would make every file differ.
pub(super) const UNKNOWN_DATE: &str = "000000000000";
/// Trailer line that carries the notes.
const NOTES: &str = "Notes";

/// Trailer with the notes; empty without any.
pub(super) fn trailer_text(notes: &[(String, String)]) -> String {
    if notes.is_empty() {
        return String::new();
    }
    format!("{NOTES} = {}\n*\n", notes_json(notes))
}

/// Notes of a trailer: our own line, else the whole text as a comment.
pub(super) fn trailer_notes(trailer: &str) -> Vec<(String, String)> {
    let own = trailer.lines().filter_map(|line| line.split_once('=')).find(|(key, _)| key.trim() == NOTES);
    notes_of(own.map_or_else(|| trailer.trim_matches(['*', '\n', '\r', ' ', '\0']), |(_, json)| json))
}

/// Number of a type of heights.
pub(super) fn type_code(raw: Raw) -> u8 {
    match raw {
        Raw::U8 => 0,
        Raw::U16 => 1,
        Raw::U32 => 2,
        Raw::F32 => 3,
        Raw::I8 => 4,
        Raw::I16 => 5,
        Raw::I32 => 6,
        Raw::F64 => 7,
    }
}

/// Type of heights by its number.
pub(super) fn raw_type(code: u8) -> Result<Raw, FileFault> {
    [Raw::U8, Raw::U16, Raw::U32, Raw::F32, Raw::I8, Raw::I16, Raw::I32, Raw::F64]
        .into_iter()
        .find(|&raw| type_code(raw) == code)
        .ok_or_else(|| FileFault::NotRead(format!("heights of SDF type {code} are not read")))
}
