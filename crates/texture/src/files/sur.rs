//! SUR and PRO (Digital Surf): 512 bytes of header, then whole numbers of height steps.
//!
//! Numbers are little endian. Spacing and step are f32 here (1e-7 of the value): fine for looking at, not for
//! archiving. Written with 32 bits, the steps spread over the range of heights, no offset (a reader loses it), the
//! micro sign as the single byte 0xB5 (readers fail on two). Read: 16 and 32 bits, any unit of length, offset, deflated
//! heights (`DSCOMPRESSED`), profiles, and surfaces that call themselves profiles, as Gwyddion's do. What the header
//! says of replicas, inversion and levelling is said, and nothing is turned for it.

use super::SurfaceFile;
use super::bounds::{factor, points, side};
use super::content::{MeasuredContent, MeasuredFile};
use super::raw::{Bytes, Raw};
use super::units::LengthUnit;
use crate::error::FileFault;
use crate::text::quoted;
use flate2::read::ZlibDecoder;
use std::io::Read;

const HEADER: usize = 512;
/// Unit of every axis as it is written.
const MICROMETRE: &[u8] = b"\xB5m";
/// Steps from the middle to the largest height.
const STEPS: f64 = 1.0e9;

pub(super) fn encode(file: &SurfaceFile) -> Result<Vec<u8>, FileFault> {
    let surface = &file.surface;
    let side = |count: usize| i32::try_from(count).map_err(|_| format!("{count} points a side are too many"));
    let (nx, ny) = (side(surface.nx())?, side(surface.ny())?);
    let points = side(surface.heights_um().len())?;
    let largest = surface.heights_um().iter().filter(|z| !z.is_nan()).fold(0.0_f64, |m, z| m.max(z.abs()));
    let step = ((if largest > 0.0 { largest / STEPS } else { 1e-9 }) as f32).max(f32::MIN_POSITIVE);
    let steps = |z: f64| (z / f64::from(step)).round() as i32;
    let measured = || surface.heights_um().iter().filter(|z| !z.is_nan()).map(|&z| steps(z));
    let (low, high) = (measured().min().unwrap_or(0), measured().max().unwrap_or(0));
    let invalid = low - 2;

    let mut bytes = vec![0; HEADER];
    let mut put = |at: usize, part: &[u8]| bytes[at..at + part.len()].copy_from_slice(part);
    put(0, b"DIGITAL SURF");
    put(14, &1_i16.to_le_bytes()); // one object
    put(16, &1_i16.to_le_bytes()); // version
    put(18, &2_i16.to_le_bytes()); // a surface
    put(20, format!("{:<30}{:<30}", "gearcut", "").as_bytes());
    put(86, &i16::from(surface.holes() > 0).to_le_bytes());
    put(98, &32_i16.to_le_bytes());
    for (at, value) in [(100, low), (104, high), (108, nx), (112, ny), (116, points)] {
        put(at, &value.to_le_bytes());
    }
    for (at, value) in [(120, surface.dx_um() as f32), (124, surface.dy_um() as f32), (128, step)] {
        put(at, &value.to_le_bytes());
    }
    for (at, name) in [(132, b"X"), (148, b"Y"), (164, b"Z")] {
        put(at, &[b' '; 16]);
        put(at, name);
    }
    for at in [180, 196, 212, 228, 244, 260] {
        put(at, &[b' '; 16]);
        put(at, MICROMETRE);
    }
    for at in [276, 280, 284] {
        put(at, &1_f32.to_le_bytes());
    }
    bytes.extend(surface.heights_um().iter().flat_map(|z| if z.is_nan() { invalid } else { steps(*z) }.to_le_bytes()));
    Ok(bytes)
}

/// Kinds of objects that are read: a profile, a surface, a series of surfaces.
const KINDS: [i16; 3] = [1, 2, 6];

pub(super) fn decode(bytes: &[u8]) -> Result<MeasuredFile, FileFault> {
    let all = Bytes(bytes);
    let kind = all.i16(18)?;
    if !KINDS.contains(&kind) {
        return Err(format!(
            "the file holds an object of type {kind}; only profiles (1), surfaces (2) and surface series (6) are read"
        )
        .into());
    }
    let raw = match all.i16(98)? {
        16 => Raw::I16,
        32 => Raw::I32,
        bits => return Err(FileFault::NotRead(format!("heights of {bits} bits are not read"))),
    };
    let has_holes = all.i16(86)? != 0;
    let low = f64::from(all.i32(100)?);
    let (nx, ny) = (side(all.i32(108)?)?, side(all.i32(112)?)?);
    let unit = |at: usize| all.at(at, 16).and_then(micrometres);
    // The second axis of a profile is none.
    let y_um = if ny == 1 { 1.0 } else { unit(196)? };
    let (x_um, z_um) = (unit(180)?, unit(212)?);
    let [dx, dy, step] = [all.f32(120)?, all.f32(124)?, all.f32(128)?].map(f64::from);
    let step = factor("the step of heights", step)?;
    let offset = f64::from(all.f32(474)?);
    if !offset.is_finite() {
        return Err(format!("the offset of heights is {offset}").into());
    }
    let start = HEADER + usize::from(all.u16(334)?) + usize::from(all.u16(336)?);
    let data = all.at(start, bytes.len().saturating_sub(start))?;
    let count = points(nx, ny)?;
    let inflated;
    let data = if bytes.starts_with(b"DSCOMPRESSED") {
        inflated = inflate(data, count * raw.bytes())?;
        &inflated
    } else {
        data
    };
    let height = |z: f64| if has_holes && z == low - 2.0 { f64::NAN } else { (z * step + offset) * z_um };
    let heights = raw.values(data, count)?.into_iter().map(height).collect();
    let mut measured = MeasuredFile::new(MeasuredContent::new(nx, ny, dx * x_um, dy * y_um, heights)?, Vec::new());
    let mut remark = |condition: bool, words: String| {
        if condition {
            measured.remarks.push(words);
        }
    };
    remark(kind == 1 && ny > 1, format!("the file calls itself a profile, but holds {ny} lines: read as a surface"));
    let objects = all.i16(14)?;
    remark(objects > 1, format!("the file holds {objects} objects: the first is read"));
    let (replica, inverted) = (all.i16(288)? != 0, all.i16(290)? != 0);
    let turned = if inverted { "and inverted" } else { "and not inverted (--invert)" };
    remark(replica, format!("the file calls itself the surface of a replica {turned}"));
    remark(inverted && !replica, "the file calls itself inverted".to_owned());
    remark(all.i16(292)? != 0, "the file calls itself levelled".to_owned());
    Ok(measured)
}

/// The streams of a compressed file, together of `most` bytes: their number, the sizes of each in full and deflated,
/// then the streams.
fn inflate(data: &[u8], most: usize) -> Result<Vec<u8>, FileFault> {
    let all = Bytes(data);
    let count = all.u32(0)?;
    let mut start = usize::try_from(count).ok().and_then(|n| n.checked_mul(8)?.checked_add(4)).unwrap_or(usize::MAX);
    let mut out = Vec::new();
    // A stream has its sizes in the file, so that their number is bounded by its length.
    all.at(4, start.saturating_sub(4))?;
    for stream in 0..count as usize {
        let (full, deflated) = (all.u32(4 + 8 * stream)? as usize, all.u32(8 + 8 * stream)? as usize);
        if full > most - out.len() {
            return Err(format!("its streams inflate to more than the {most} bytes of its points").into());
        }
        let before = out.len();
        let packed = all.at(start, deflated)?;
        let limit = (full + 1) as u64;
        let inflated = ZlibDecoder::new(packed).take(limit).read_to_end(&mut out);
        inflated.map_err(|reason| format!("its compressed heights are damaged: {reason}"))?;
        if out.len() - before != full {
            return Err(format!("stream {} does not inflate to the {full} bytes of its header", stream + 1).into());
        }
        start += deflated;
    }
    Ok(out)
}

/// Micrometres in a unit of 16 bytes, whatever alphabet its micro sign is from.
fn micrometres(unit: &[u8]) -> Result<f64, FileFault> {
    let end = unit.iter().position(|&b| b == 0).unwrap_or(unit.len());
    let name = unit[..end].trim_ascii();
    // 0xE6 is the micro sign of old DOS programs; other single bytes are Latin-1.
    let latin = || name.iter().map(|&b| if b == 0xe6 { '\u{b5}' } else { char::from(b) }).collect();
    let name = std::str::from_utf8(name).map_or_else(|_| latin(), str::to_owned);
    let found = LengthUnit::of(&name).map(LengthUnit::um);
    found.ok_or_else(|| format!("the unit `{}` is not a length", quoted(&name)).into())
}
