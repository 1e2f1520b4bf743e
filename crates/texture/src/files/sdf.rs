//! SDF binary (ISO 25178-71, version ISO-1.0): an 81-byte header, heights row by row, notes as a trailer.
//!
//! Little endian. 0 `bISO-1.0`, 8 maker, 18 and 30 dates, 42 points, 44 rows (16 bits: at most 65535 a side), 46, 54
//! spacing in m, 62 metres per unit of height, 70 resolution (-1: unknown), 78 compression, 79 type of heights, 80
//! check, 81 heights. Version ISO-2.0, whose sizes have 32 bits, and the older BCR dialect, which also has types
//! without sign, are read too; one row is a trace.

use super::SurfaceFile;
use super::bounds::{factor, kept_number, points, side};
use super::content::{MeasuredContent, MeasuredFile};
use super::raw::{Bytes, Raw};
use super::sdf_parts::{MAKER, UNKNOWN_DATE, raw_type, trailer_notes, trailer_text, type_code};
use crate::error::FileFault;
use crate::text::quoted;

/// Micrometres in a metre.
const UM_PER_M: f64 = 1e6;

pub(super) fn encode(file: &SurfaceFile) -> Result<Vec<u8>, FileFault> {
    let surface = &file.surface;
    let side = |count: usize| {
        u16::try_from(count).map_err(|_| format!("an SDF file holds at most 65535 points a side, not {count}"))
    };
    let mut bytes = b"bISO-1.0".to_vec();
    bytes.extend(format!("{MAKER:<10}{UNKNOWN_DATE}{UNKNOWN_DATE}").as_bytes());
    bytes.extend(side(surface.nx())?.to_le_bytes());
    bytes.extend(side(surface.ny())?.to_le_bytes());
    for value in [surface.dx_um() / UM_PER_M, surface.dy_um() / UM_PER_M, 1.0 / UM_PER_M, -1.0] {
        bytes.extend(value.to_le_bytes());
    }
    bytes.extend([0, type_code(Raw::F64), 0]);
    bytes.extend(surface.heights_um().iter().flat_map(|z| z.to_le_bytes()));
    bytes.extend(trailer_text(&file.notes).as_bytes());
    Ok(bytes)
}

pub(super) fn decode(bytes: &[u8]) -> Result<MeasuredFile, FileFault> {
    let all = Bytes(bytes);
    let (nx, ny, rest) = match all.at(0, 8)? {
        b"bISO-1.0" | b"bBCR-1.0" | b"bBCR-0.0" => (usize::from(all.u16(42)?), usize::from(all.u16(44)?), 46),
        b"bISO-2.0" => (side(all.i32(42)?)?, side(all.i32(46)?)?, 50),
        other => return Err(format!("SDF version `{}` is not known", quoted(&String::from_utf8_lossy(other))).into()),
    };
    let [dx, dy] = [all.f64(rest)?, all.f64(rest + 8)?];
    let scale = factor("the scale of heights", all.f64(rest + 16)?)?;
    let [compression, code, _check]: [u8; 3] = all.array(rest + 32)?;
    if compression != 0 {
        return Err(FileFault::NotRead("compressed SDF files are not read".to_owned()));
    }
    let raw = raw_type(code)?;
    let data = all.at(rest + 35, bytes.len().saturating_sub(rest + 35))?;
    let count = points(nx, ny)?;
    let mark = raw.mark_of_holes();
    let heights = raw.values(data, count)?.into_iter();
    let heights =
        heights.map(|z| if Some(z) == mark { f64::NAN } else { kept_number(z, z * (scale * UM_PER_M)) }).collect();
    let trailer = String::from_utf8_lossy(&data[count * raw.bytes()..]).into_owned();
    let content = MeasuredContent::new(nx, ny, dx * UM_PER_M, dy * UM_PER_M, heights)?;
    Ok(MeasuredFile::new(content, trailer_notes(&trailer)))
}
