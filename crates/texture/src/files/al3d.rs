//! AL3D, the files of Alicona's focus-variation instruments, read.
//!
//! `AliconaImaging`, zero, carriage return, line feed; then tags of 52 bytes: a name of 20 and a value of 30, both text
//! that a zero ends, and a line end. `Version` and `TagCount` come first, the latter without these two. Heights are
//! 32-bit floats in metres from `DepthImageOffset` on, row by row, every row filled up to a multiple of 8 bytes; from
//! `InvalidPixelValue` on they are holes. Little endian.
//!
//! Textures and the map of repeatability are not read; the latter hides points in Alicona's own program, and is
//! remarked. Source: AL3D File Format Specification 1.0 (2005) and Bruker Alicona File Formats 1.0 (2025), as the
//! documentation of surfalize 0.19.2 cites them; the files of the tests were written by surfalize.

use super::bounds::{kept_number, points};
use super::content::{MeasuredContent, MeasuredFile};
use super::raw::{Bytes, Raw};
use crate::error::FileFault;
use crate::text::quoted;

/// Before the tags.
const START: &[u8] = b"AliconaImaging\0\r\n";
/// Bytes of a tag, and of its name.
const TAG: usize = 52;
const NAME: usize = 20;
/// Bytes that a row is a multiple of.
const ROW_STEP: usize = 8;
/// Most tags: those of the specification are some twenty.
const MOST_TAGS: usize = 1000;
/// Holes where the file does not say what marks them.
const HOLE: f32 = 3e15;

/// Reads the depth image.
pub(super) fn decode(bytes: &[u8]) -> Result<MeasuredFile, FileFault> {
    if !bytes.starts_with(START) {
        return Err("the head of the AL3D file is damaged".into());
    }
    let bytes = Bytes(bytes);
    let tag = |index: usize| -> Result<(String, String), FileFault> {
        let raw = bytes.at(START.len() + index * TAG, TAG)?;
        let text = |raw: &[u8]| -> String {
            raw.iter().take_while(|byte| **byte != 0).map(|&byte| char::from(byte)).collect()
        };
        if !raw.ends_with(b"\r\n") {
            return Err(format!("tag {} of the AL3D file has no line end", index + 1).into());
        }
        Ok((text(&raw[..NAME]), text(&raw[NAME..TAG - 2]).trim().to_owned()))
    };
    let count: usize = match (tag(0)?, tag(1)?) {
        ((version, _), (name, count)) if version == "Version" && name == "TagCount" => {
            count.parse().ok().filter(|count| *count <= MOST_TAGS).ok_or_else(|| wrong("TagCount", &count))?
        }
        _ => return Err("the AL3D file does not begin with Version and TagCount".into()),
    };
    let tags = (2..count + 2).map(tag).collect::<Result<Vec<_>, FileFault>>()?;
    let said = |name: &str| tags.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str());
    let value = |name: &str| said(name).ok_or_else(|| format!("the AL3D file has no `{name}`"));
    let whole = |name: &str| value(name)?.parse::<usize>().map_err(|_| wrong(name, said(name).unwrap_or_default()));
    let spacing_um = |name: &str| {
        let metres = value(name)?.parse::<f64>().ok().filter(|metres| *metres > 0.0 && metres.is_finite());
        metres.map(|metres| metres * 1e6).ok_or_else(|| wrong(name, said(name).unwrap_or_default()))
    };
    let (nx, ny) = (whole("Cols")?, whole("Rows")?);
    let (dx_um, dy_um) = (spacing_um("PixelSizeXMeter")?, spacing_um("PixelSizeYMeter")?);
    // Words that are no number, such as NaN, leave the mark of the specification.
    let hole = said("InvalidPixelValue").and_then(|text| text.parse().ok()).filter(|mark: &f32| mark.is_finite());
    let hole = f64::from(hole.unwrap_or(HOLE));
    let mut heights_um = Vec::with_capacity(points(nx, ny)?);
    let row_bytes = (nx * Raw::F32.bytes()).next_multiple_of(ROW_STEP);
    let start = whole("DepthImageOffset")?;
    for row in 0..ny {
        let place =
            row.checked_mul(row_bytes).and_then(|bytes| bytes.checked_add(start)).ok_or("rows beyond any file")?;
        let metres = Raw::F32.values(bytes.at(place, nx * Raw::F32.bytes())?, nx)?;
        heights_um.extend(metres.into_iter().map(|z| if z < hole { kept_number(z, z * 1e6) } else { f64::NAN }));
    }
    let mut measured = MeasuredFile::new(MeasuredContent::new(nx, ny, dx_um, dy_um, heights_um)?, Vec::new());
    if said("DepthImageResPtr").is_some() {
        measured.remarks.push("it has a map of repeatability, which is not applied: all heights count".to_owned());
    }
    Ok(measured)
}

fn wrong(name: &str, value: &str) -> String {
    format!("`{name}` of the AL3D file is `{}`", quoted(value))
}
