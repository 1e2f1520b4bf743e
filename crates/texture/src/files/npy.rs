//! NPY (NumPy Enhancement Proposal 1, version 1.0): heights as `<f8`, rows = y; spacing and notes in a JSON file of the
//! same name beside it.
//!
//! Read: any little- or big-endian float or signed integer of 2 to 8 bytes in C order, one array of two axes, heights
//! in um where neither the file beside nor its reader says otherwise.
//!
//! Road not taken: a crate for the format. Its header is one line; the crates bring a parser of Python literals for it.

use crate::error::FileFault;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::SurfaceFile;
use super::bounds::{self, kept_number, points};
use super::content::{Given, MeasuredContent, MeasuredFile};
use super::units::LengthUnit;
use crate::surface::Surface;
use crate::text::quoted;

const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";
/// Most bytes of the file beside: notes hold a scene and the record of a run.
const MOST_FACTS: u64 = 16 << 20;

/// `map.npy` -> `map.npy.json`.
pub(super) fn sidecar(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".json");
    name.into()
}

pub(super) fn encode_sidecar(file: &SurfaceFile) -> String {
    let notes: serde_json::Map<String, Value> =
        file.notes.iter().map(|(name, text)| (name.clone(), text.clone().into())).collect();
    let (dx, dy) = (file.surface.dx_um(), file.surface.dy_um());
    format!("{:#}\n", json!({"dx_um": dx, "dy_um": dy, "height_unit": "um", "rows": "y", "notes": notes}))
}

pub(super) fn encode(surface: &Surface) -> Vec<u8> {
    let mut header =
        format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}", surface.ny(), surface.nx());
    // Data begins at a multiple of 64 bytes; the header ends with a newline.
    let length = (MAGIC.len() + 2 + header.len() + 1).next_multiple_of(64);
    let padding = length - MAGIC.len() - 2 - header.len() - 1;
    header.extend(std::iter::repeat_n(' ', padding));
    header.push('\n');
    let mut bytes = MAGIC.to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(surface.heights_um().iter().flat_map(|z| z.to_le_bytes()));
    bytes
}

/// What the file beside an NPY file says, if there is one.
pub(super) fn facts_beside(path: &Path) -> Result<Option<Value>, FileFault> {
    let beside = sidecar(path);
    if !beside.exists() {
        return Ok(None);
    }
    let ((), text) = bounds::read(&beside, |_| Ok(((), MOST_FACTS))).map_err(|error| error.to_string())?;
    serde_json::from_slice(&text).map(Some).map_err(|reason| format!("{}: {reason}", beside.display()).into())
}

pub(super) fn decode(bytes: &[u8], facts: Option<&Value>, given: &Given) -> Result<MeasuredFile, FileFault> {
    let unit = facts.map(|f| &f["height_unit"]).filter(|unit| !unit.is_null());
    if let Some(unit) = unit.filter(|unit| **unit != "um") {
        return Err(format!(
            "the file beside it says its heights are in {}; only um are read",
            quoted(&unit.to_string())
        )
        .into());
    }
    let written = facts.and_then(|f| Some([f["dx_um"].as_f64()?, f["dy_um"].as_f64()?]));
    let Some([dx_um, dy_um]) = written.or(given.spacing_um) else {
        return Err(FileFault::Unsaid("an NPY file carries no spacing; give it with --spacing-um".to_owned()));
    };
    let notes = facts.and_then(|f| f["notes"].as_object()).into_iter().flatten();
    let notes = notes.map(|(name, text)| (name.clone(), text.as_str().unwrap_or_default().to_owned())).collect();
    let (shape, mut heights) = array(bytes)?;
    // The array itself is in um by the contract of this format, unless its reader says otherwise.
    let own = given.height_unit.filter(|_| unit.is_none()).unwrap_or(LengthUnit::Micrometre);
    for z in &mut heights {
        *z = kept_number(*z, *z * own.um());
    }
    let mut measured = MeasuredFile::new(MeasuredContent::new(shape[1], shape[0], dx_um, dy_um, heights)?, notes);
    let said = Given { height_unit: given.height_unit.filter(|_| unit.is_some()), ..*given };
    measured.agrees(&said)?;
    if unit.or(given.height_unit.map(|_| &Value::Null)).is_none() {
        measured.remarks.push("heights: um, as NPY files of no stated unit are read (--height-unit)".to_owned());
    }
    Ok(measured)
}

/// Shape and values.
fn array(bytes: &[u8]) -> Result<([usize; 2], Vec<f64>), FileFault> {
    let short = || "the NPY header is cut off".to_owned();
    let (start, length) = match bytes.get(6).ok_or_else(short)? {
        1 => {
            (10, usize::from(u16::from_le_bytes([*bytes.get(8).ok_or_else(short)?, *bytes.get(9).ok_or_else(short)?])))
        }
        2 | 3 => {
            let raw: [u8; 4] = bytes.get(8..12).ok_or_else(short)?.try_into().map_err(|_| short())?;
            (12, u32::from_le_bytes(raw) as usize)
        }
        other => return Err(format!("NPY version {other} is not known").into()),
    };
    let header = bytes.get(start..start + length).ok_or_else(short)?;
    let header = std::str::from_utf8(header).map_err(|_| "the NPY header is no text".to_owned())?;
    let after = |key: &str| {
        let at = header.find(&format!("'{key}'")).ok_or_else(|| format!("the NPY header has no `{key}`"))?;
        Ok::<_, String>(header[at + key.len() + 2..].trim_start_matches([':', ' ']))
    };
    let descr = after("descr")?.split('\'').nth(1).unwrap_or_default();
    if after("fortran_order")?.starts_with("True") {
        return Err("the array is in Fortran order; save it with numpy.ascontiguousarray".into());
    }
    let shape: Vec<usize> = after("shape")?
        .trim_start_matches('(')
        .split(')')
        .next()
        .unwrap_or_default()
        .split(',')
        .filter(|part| !part.trim().is_empty())
        .map(|part| part.trim().parse().map_err(|_| "the shape in the NPY header is not readable".to_owned()))
        .collect::<Result<_, _>>()?;
    let &[ny, nx] = shape.as_slice() else {
        return Err(format!("a surface is an array of two axes, not of {}", shape.len()).into());
    };
    let (big, kind) = match descr.split_at_checked(1) {
        Some((">", kind)) => (true, kind),
        Some(("<" | "|" | "=", kind)) => (false, kind),
        _ => (false, descr),
    };
    let size = match kind {
        "f4" | "i4" => 4,
        "f8" | "i8" => 8,
        "i2" => 2,
        other => {
            return Err(format!(
                "heights of type `{}` are not read; use float64, float32 or signed integers",
                quoted(other)
            )
            .into());
        }
    };
    let data = &bytes[start + length..];
    let count = points(nx, ny)?;
    if count * size > data.len() {
        return Err(format!("the array of {ny} x {nx} is cut off").into());
    }
    let value = |raw: &[u8]| {
        let mut little = [0; 8];
        for (i, byte) in raw.iter().enumerate() {
            little[if big { size - 1 - i } else { i }] = *byte;
        }
        match kind {
            "f4" => f64::from(f32::from_le_bytes([little[0], little[1], little[2], little[3]])),
            "i4" => f64::from(i32::from_le_bytes([little[0], little[1], little[2], little[3]])),
            "i2" => f64::from(i16::from_le_bytes([little[0], little[1]])),
            "i8" => i64::from_le_bytes(little) as f64,
            _ => f64::from_le_bytes(little),
        }
    };
    Ok(([ny, nx], data[..count * size].chunks_exact(size).map(value).collect()))
}
