//! Surfaces in files that metrology programs open, and back: X3P, SDF (binary and ASCII), SUR, NPY, CSV, and our EXR
//! maps.
//!
//! In and out: [`SurfaceFile`], heights in um on a regular grid with spacing, holes as NaN, and notes (frame, scene,
//! run record). What each format can carry:
//!
//! | format | heights | spacing | holes | notes |
//! | --- | --- | --- | --- | --- |
//! | `.x3p` (ISO 25178-72) | f64, m | f64 | NaN | in the comment of record 2 |
//! | `.sdf` (ISO 25178-71), binary or ASCII | f64, m or um | f64 | NaN, `BAD` read | in the trailer |
//! | `.sur` (Digital Surf) | i32 steps of 2e-9 of the range | f32 | a value of its own | none |
//! | `.npy` | f64, um | in a `.json` beside it | NaN | in the same `.json` |
//! | `.csv` | f64, um, shortest text that reads back | in comment lines | empty | in comment lines |
//! | `.exr` | f32, mm | f64 | NaN | header attributes |
//!
//! The same surface gives the same bytes: dates that a format demands are its word for "unknown", zip entries carry no
//! time. X3P is the one to archive: every reader that was tried opens it as it is written here.

mod bounds;
mod csv_text;
mod exr;
mod exr_header;
pub mod exr_map;
pub mod grid;
mod npy;
mod sdf;
mod sdf_ascii;
mod sdf_parts;
mod sur;
mod x3p;

use std::fmt::Write as _;
use std::path::Path;

use crate::atomic::write_bytes_atomically;
use crate::surface::Surface;
use crate::{Error, Result};
pub use bounds::MOST_POINTS;
use bounds::{MOST_BYTES_OF_MAPS, MOST_BYTES_OF_NUMBERS, MOST_BYTES_OF_TEXT, unreadable};

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
        Format::Csv => Ok(csv_text::encode(file).into_bytes()),
    };
    let bytes = bytes.map_err(|reason| Error::Unwritable { path: path.to_owned(), reason })?;
    write_bytes_atomically(path, &bytes)
}

/// Reads a surface; what the file is follows from its ending and its first bytes. `spacing_um` holds where the file
/// carries no spacing, and must not contradict it where it does.
///
/// # Errors
/// Files that cannot be read, are no regular files or larger than their format allows, are damaged, are none of these
/// formats, hold heights or spacings out of range ([`Surface::new`]), or carry no spacing when none is given.
pub fn read_surface(path: &Path, spacing_um: Option<SpacingUm>) -> Result<SurfaceFile> {
    let (kind, bytes) = bounds::read(path, |head| FileKind::of(head, path).map(|kind| (kind, kind.most_bytes())))?;
    let found = match kind {
        FileKind::X3p => x3p::decode(&bytes),
        FileKind::SdfBinary => sdf::decode(&bytes),
        FileKind::SdfAscii => sdf_ascii::decode(&bytes),
        FileKind::Sur => sur::decode(&bytes),
        FileKind::Npy => npy::facts_beside(path).and_then(|facts| npy::decode(&bytes, facts.as_ref(), spacing_um)),
        FileKind::Exr => exr::decode(&bytes),
        FileKind::Csv => csv_text::decode(&bytes, spacing_um),
    };
    let file = found.map_err(unreadable(path))?;
    if let Some([x, y]) = spacing_um {
        let (dx, dy) = (file.surface.dx_um(), file.surface.dy_um());
        if (dx - x).abs() > 1e-6 * x || (dy - y).abs() > 1e-6 * y {
            let reason = format!("the file says its points are {dx} x {dy} um apart, not {x} x {y} um");
            return Err(unreadable(path)(reason));
        }
    }
    Ok(file)
}

/// What a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum FileKind {
    X3p,
    SdfBinary,
    SdfAscii,
    Sur,
    Npy,
    Exr,
    Csv,
}

impl FileKind {
    /// By its first bytes, or by its ending where text begins with heights.
    fn of(head: &[u8], path: &Path) -> std::result::Result<Self, String> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        let starts: [(&[u8], Self); 6] = [
            (b"PK\x03\x04", Self::X3p),
            (b"bISO-", Self::SdfBinary),
            (b"DIGITAL SURF", Self::Sur),
            (b"DSCOMPRESSED", Self::Sur),
            (b"\x93NUMPY", Self::Npy),
            (&[0x76, 0x2f, 0x31, 0x01], Self::Exr),
        ];
        if let Some((_, kind)) = starts.into_iter().find(|(start, _)| head.starts_with(start)) {
            Ok(kind)
        } else if head.trim_ascii_start().starts_with(b"aISO-") {
            Ok(Self::SdfAscii)
        } else if ["csv", "txt", "asc"].contains(&ending.as_str()) {
            Ok(Self::Csv)
        } else {
            Err("not an X3P, SDF, SUR, NPY, CSV or EXR file".to_owned())
        }
    }

    fn most_bytes(self) -> u64 {
        match self {
            Self::X3p | Self::SdfBinary | Self::Sur | Self::Npy => MOST_BYTES_OF_NUMBERS,
            Self::Exr => MOST_BYTES_OF_MAPS,
            Self::SdfAscii | Self::Csv => MOST_BYTES_OF_TEXT,
        }
    }
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

/// Reads numbers from bytes, little endian; running out of them is an error that names the place.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn at(&self, start: usize, length: usize) -> std::result::Result<&'a [u8], String> {
        start.checked_add(length).and_then(|end| self.0.get(start..end)).ok_or_else(|| {
            format!("the file ends at byte {} before what must stand at {start} to {}", self.0.len(), start + length)
        })
    }

    fn array<const N: usize>(&self, start: usize) -> std::result::Result<[u8; N], String> {
        Ok(self.at(start, N)?.try_into().expect("a slice of N bytes"))
    }

    fn u16(&self, start: usize) -> std::result::Result<u16, String> {
        Ok(u16::from_le_bytes(self.array(start)?))
    }

    fn i16(&self, start: usize) -> std::result::Result<i16, String> {
        Ok(i16::from_le_bytes(self.array(start)?))
    }

    fn i32(&self, start: usize) -> std::result::Result<i32, String> {
        Ok(i32::from_le_bytes(self.array(start)?))
    }

    fn f32(&self, start: usize) -> std::result::Result<f32, String> {
        Ok(f32::from_le_bytes(self.array(start)?))
    }

    fn f64(&self, start: usize) -> std::result::Result<f64, String> {
        Ok(f64::from_le_bytes(self.array(start)?))
    }
}

/// Number types of raw heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Raw {
    I8,
    I16,
    I32,
    F32,
    F64,
}

impl Raw {
    fn bytes(self) -> usize {
        match self {
            Self::I8 => 1,
            Self::I16 => 2,
            Self::I32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Little-endian values; `count` of them must be there.
    fn values(self, bytes: &[u8], count: usize) -> std::result::Result<Vec<f64>, String> {
        let size = self.bytes();
        let wanted = count.checked_mul(size).ok_or("the size in the header is too large")?;
        if bytes.len() < wanted {
            return Err(format!("{count} heights need {wanted} bytes, but only {} are there", bytes.len()));
        }
        let value = |raw: &[u8]| match (self, raw) {
            (Self::I8, &[a]) => f64::from(i8::from_le_bytes([a])),
            (Self::I16, &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
            (Self::I32, &[a, b, c, d]) => f64::from(i32::from_le_bytes([a, b, c, d])),
            (Self::F32, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
            (Self::F64, &[a, b, c, d, e, f, g, h]) => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
            _ => f64::NAN,
        };
        Ok(bytes[..wanted].chunks_exact(size).map(value).collect())
    }

    /// The smallest value: how SDF marks what was not measured.
    fn smallest(self) -> f64 {
        match self {
            Self::I8 => f64::from(i8::MIN),
            Self::I16 => f64::from(i16::MIN),
            Self::I32 => f64::from(i32::MIN),
            Self::F32 => f64::from(f32::MIN),
            Self::F64 => f64::MIN,
        }
    }
}

#[cfg(test)]
mod tests;
