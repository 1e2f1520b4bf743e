//! Surfaces in files that metrology programs open, and back: X3P, SDF (binary and ASCII), SUR, NPY, CSV, and our EXR
//! maps; GWY, AL3D and text of any program are read.
//!
//! Out: [`SurfaceFile`], heights in um on a regular grid with spacing, holes as NaN, and notes (frame, scene, run
//! record). In: [`MeasuredFile`], a surface or a trace of one line, with remarks on how it was read. What each format
//! can carry:
//!
//! | format | heights | spacing | holes | notes |
//! | --- | --- | --- | --- | --- |
//! | `.x3p` (ISO 25178-72) | f64, m | f64 | NaN | in the comment of record 2 |
//! | `.sdf` (ISO 25178-71), binary or ASCII | f64, m or um | f64 | NaN, `BAD` read | in the trailer |
//! | `.sur` (Digital Surf) | i32 steps of 2e-9 of the range | f32 | a value of its own | none |
//! | `.npy` | f64, um | in a `.json` beside it | NaN | in the same `.json` |
//! | `.csv` | f64, um, shortest text that reads back | in comment lines | empty | in comment lines |
//! | other text | in the unit it says, or that is given | said or given | empty, `nan`, `bad`, `---` | none |
//! | `.gwy` (Gwyddion), read | f64, m | f64 | NaN; masks are remarked | none |
//! | `.al3d` (Alicona), read | f32, m | f64 | a value of its own and above | none |
//! | `.exr` | f32, mm | f64 | NaN | header attributes |
//!
//! The same surface gives the same bytes: dates that a format demands are its word for "unknown", zip entries carry no
//! time. X3P is the one to archive: every reader that was tried opens it as it is written here.

mod al3d;
mod bounds;
mod content;
mod exr;
#[cfg(not(target_family = "wasm"))]
mod exr_header;
pub mod exr_map;
pub mod grid;
mod gwy;
mod kind;
mod npy;
mod raw;
mod sdf;
mod sdf_ascii;
mod sdf_parts;
mod sur;
mod text;
mod units;
mod x3p;

use crate::error::FileFault;
use std::fmt::Write as _;
use std::path::Path;

use crate::atomic::write_bytes_atomically;
use crate::surface::Surface;
use crate::{Error, Result};
pub use bounds::MOST_POINTS;
use bounds::unreadable;
pub use content::{Given, MeasuredContent, MeasuredFile};
use kind::FileKind;
pub use units::LengthUnit;

/// A surface as it stands in a file.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFile {
    /// Heights and spacing.
    pub surface: Surface,
    /// Texts by name: `frame`, `scene`, `run`, `quantity` and the like.
    pub notes: Vec<(String, String)>,
}

/// Formats that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// ISO 25178-72.
    X3p,
    /// ISO 25178-71, binary.
    SdfBinary,
    /// ISO 25178-71, ASCII.
    SdfAscii,
    /// Digital Surf, 32 bits.
    Sur,
    /// NumPy array with a JSON file beside it.
    Npy,
    /// Comma-separated heights under comment lines.
    Csv,
}

/// Spacing for files that carry none, um: along x and y.
pub type SpacingUm = [f64; 2];

/// Writes a surface.
///
/// # Errors
/// A surface that the format cannot hold, and files that cannot be written.
pub fn write_surface(path: &Path, format: Format, file: &SurfaceFile) -> Result<()> {
    let bytes = match format {
        Format::X3p => x3p::encode(file),
        Format::SdfBinary => sdf::encode(file),
        Format::SdfAscii => sdf_ascii::encode(file),
        Format::Sur => sur::encode(file),
        Format::Npy => {
            write_bytes_atomically(&npy::sidecar(path), npy::encode_sidecar(file).as_bytes())?;
            Ok(npy::encode(&file.surface))
        }
        Format::Csv => Ok(text::encode(file).into_bytes()),
    };
    let bytes = bytes.map_err(|fault| Error::Unwritable { path: path.to_owned(), fault })?;
    write_bytes_atomically(path, &bytes)
}

/// Reads a surface; what the file is follows from its first bytes, and for text from its ending. `spacing_um` holds
/// where the file carries no spacing, and must not contradict it where it does.
///
/// # Errors
/// As [`read`]; also a file that holds a trace.
pub fn read_surface(path: &Path, spacing_um: Option<SpacingUm>) -> Result<SurfaceFile> {
    read(path, &Given::spacing(spacing_um))?.into_surface().map_err(unreadable(path, None))
}

/// Reads a surface or a trace. What is `given` holds where the file does not say it, and must not contradict it where
/// it does.
///
/// # Errors
/// Files that cannot be read, are no regular files or larger than their format allows, are damaged, are none of these
/// formats, hold heights or spacings out of range ([`Surface::new`]), or leave open what is not given.
pub fn read(path: &Path, given: &Given) -> Result<MeasuredFile> {
    let (kind, bytes) = bounds::read(path, |head| FileKind::of(head, path).map(|kind| (kind, kind.most_bytes())))?;
    decoded(kind, &bytes, path, given).map_err(unreadable(path, Some(kind.name())))
}

/// What the bytes of a file of a kind hold; `path` for the file beside it.
fn decoded(kind: FileKind, bytes: &[u8], path: &Path, given: &Given) -> Result<MeasuredFile, FileFault> {
    let measured = match kind {
        FileKind::X3p => x3p::decode(bytes),
        FileKind::SdfBinary => sdf::decode(bytes),
        FileKind::SdfAscii => sdf_ascii::decode(bytes),
        FileKind::Sur => sur::decode(bytes),
        FileKind::Gwy => gwy::decode(bytes, given.use_mask),
        FileKind::Al3d => al3d::decode(bytes),
        FileKind::Npy => npy::facts_beside(path).and_then(|facts| npy::decode(bytes, facts.as_ref(), given)),
        FileKind::Exr => exr::decode(bytes),
        FileKind::Text => text::decode(bytes, given),
    }?;
    if given.use_mask && kind != FileKind::Gwy {
        return Err("the file has no mask of its own: leave --use-mask out".into());
    }
    // Text and NPY compare what they say themselves: they may say nothing.
    if !matches!(kind, FileKind::Text | FileKind::Npy) {
        measured.agrees(given)?;
    }
    Ok(measured)
}

/// Notes as one line of JSON in ASCII, for formats with room for a text.
fn notes_json(notes: &[(String, String)]) -> String {
    let map: serde_json::Map<String, serde_json::Value> =
        notes.iter().map(|(name, text)| (name.clone(), text.clone().into())).collect();
    let mut out = String::new();
    for c in serde_json::Value::Object(map).to_string().chars() {
        // A star ends a section of an SDF file; inside JSON it can be written as a number.
        if c.is_ascii() && c != '*' {
            out.push(c);
        } else {
            let mut units = [0; 2];
            for unit in c.encode_utf16(&mut units) {
                let _ = write!(out, "\\u{unit:04x}");
            }
        }
    }
    out
}

/// Notes out of [`notes_json`]; any other text becomes the note `comment`.
fn notes_of(text: &str) -> Vec<(String, String)> {
    let text = text.trim();
    match serde_json::from_str::<serde_json::Map<String, serde_json::Value>>(text) {
        Ok(map) => map
            .into_iter()
            .map(|(name, value)| {
                let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
                (name, text)
            })
            .collect(),
        Err(_) if text.is_empty() => Vec::new(),
        Err(_) => vec![("comment".to_owned(), text.to_owned())],
    }
}

#[cfg(test)]
mod tests;
