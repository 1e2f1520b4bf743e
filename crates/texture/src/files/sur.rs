//! SUR (Digital Surf, uncompressed): 512 bytes of header, then whole numbers of height steps.
//!
//! Numbers are little endian. Spacing and step are f32 here (1e-7 of the value): fine for looking at, not for
//! archiving. Written with 32 bits, the steps spread over the range of heights, no offset (a reader loses it), the
//! micro sign as the single byte 0xB5 (readers fail on two). Read: 16 and 32 bits, any metric unit, offset.

use super::bounds::{factor, points, side};
use super::{Bytes, Raw, SurfaceFile};
use crate::surface::Surface;
use crate::text::quoted;

const HEADER: usize = 512;
/// Unit of every axis as it is written.
const MICROMETRE: &[u8] = b"\xB5m";
/// Steps from the middle to the largest height.
const STEPS: f64 = 1.0e9;

pub(super) fn encode(file: &SurfaceFile) -> Result<Vec<u8>, String> {
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

pub(super) fn decode(bytes: &[u8]) -> Result<SurfaceFile, String> {
    let all = Bytes(bytes);
    if !bytes.starts_with(b"DIGITAL SURF") {
        return Err("compressed SUR files are not read; save the surface uncompressed".to_owned());
    }
    let kind = all.i16(18)?;
    if ![2, 6].contains(&kind) {
        return Err(format!(
            "the file holds an object of type {kind}; only surfaces (2) and surface series (6) are read"
        ));
    }
    let raw = match all.i16(98)? {
        16 => Raw::I16,
        32 => Raw::I32,
        bits => return Err(format!("heights of {bits} bits are not read")),
    };
    let has_holes = all.i16(86)? != 0;
    let low = f64::from(all.i32(100)?);
    let (nx, ny) = (side(all.i32(108)?)?, side(all.i32(112)?)?);
    let unit = |at: usize| all.at(at, 16).and_then(metres);
    let [x_m, y_m, z_m] = [unit(180)?, unit(196)?, unit(212)?];
    let [dx, dy, step] = [all.f32(120)?, all.f32(124)?, all.f32(128)?].map(f64::from);
    let step = factor("the step of heights", step)?;
    let offset = f64::from(all.f32(474)?);
    if !offset.is_finite() {
        return Err(format!("the offset of heights is {offset}"));
    }
    let comment = usize::from(all.u16(334)?);
    let private = usize::from(all.u16(336)?);
    let data = all.at(HEADER + comment + private, bytes.len().saturating_sub(HEADER + comment + private))?;
    let count = points(nx, ny)?;
    let height = |z: f64| if has_holes && z == low - 2.0 { f64::NAN } else { (z * step + offset) * z_m * 1e6 };
    let heights = raw.values(data, count)?.into_iter().map(height).collect();
    Ok(SurfaceFile { surface: Surface::new(nx, ny, dx * x_m * 1e6, dy * y_m * 1e6, heights)?, notes: Vec::new() })
}

/// Metres in a unit of 16 bytes, whatever alphabet its micro sign is from.
fn metres(unit: &[u8]) -> Result<f64, String> {
    let end = unit.iter().position(|&b| b == 0).unwrap_or(unit.len());
    let name = unit[..end].trim_ascii();
    match name {
        b"m" => Ok(1.0),
        b"mm" => Ok(1e-3),
        b"um" | b"\xB5m" | b"\xC2\xB5m" | b"\xCE\xBCm" | b"\xE6m" => Ok(1e-6),
        b"nm" => Ok(1e-9),
        b"pm" => Ok(1e-12),
        other => Err(format!("the unit `{}` is not a metric length", quoted(&String::from_utf8_lossy(other)))),
    }
}
