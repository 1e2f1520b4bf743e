//! SDF ASCII (ISO 25178-71): header lines `Name = value`, a star, heights, a star, trailer, a star.
//!
//! Heights are written in um (`Zscale` 1e-6) with the fewest digits that read back the same, one line per row; holes as
//! `NaN`, which every reader that was tried takes, where `BAD` fails in one. Both are read, and so are header names in
//! any case, the BCR dialect, and one row as a trace.

use crate::error::FileFault;
use std::fmt::Write as _;

use super::SurfaceFile;
use super::bounds::{factor, height, kept_number, points};
use super::content::{MeasuredContent, MeasuredFile};
use super::sdf_parts::{MAKER, UNKNOWN_DATE, raw_type, trailer_notes, trailer_text};
use super::text::characters;
use crate::text::quoted;

pub(super) fn encode(file: &SurfaceFile) -> Result<Vec<u8>, FileFault> {
    let surface = &file.surface;
    let (nx, ny) = (surface.nx(), surface.ny());
    if nx.max(ny) > usize::from(u16::MAX) {
        return Err(format!("an SDF file holds at most 65535 points a side, not {}", nx.max(ny)).into());
    }
    let mut text = format!(
        "aISO-1.0\nManufacID = {MAKER}\nCreateDate = {UNKNOWN_DATE}\nModDate = {UNKNOWN_DATE}\n\
         NumPoints = {nx}\nNumProfiles = {ny}\nXscale = {:e}\nYscale = {:e}\nZscale = 1e-6\n\
         Zresolution = -1\nCompression = 0\nDataType = 7\nCheckType = 0\n*\n",
        surface.dx_um() * 1e-6,
        surface.dy_um() * 1e-6
    );
    for y in 0..ny {
        for (x, z) in surface.row(y).iter().enumerate() {
            let separator = if x > 0 { " " } else { "" };
            let _ = if z.is_nan() { write!(text, "{separator}NaN") } else { write!(text, "{separator}{z:?}") };
        }
        text.push('\n');
    }
    text.push_str("*\n");
    text.push_str(&trailer_text(&file.notes));
    Ok(text.into_bytes())
}

pub(super) fn decode(bytes: &[u8]) -> Result<MeasuredFile, FileFault> {
    let (text, _) = characters(bytes)?;
    let mut parts = text.splitn(3, '*');
    let (header, data) = (parts.next().unwrap_or_default(), parts.next().ok_or("the header does not end with a star")?);
    let field = |name: &str| {
        let line = header.lines().filter_map(|line| line.split_once('='));
        let line = line.into_iter().find(|(key, _)| key.trim().eq_ignore_ascii_case(name));
        line.map(|(_, value)| value.trim()).ok_or_else(|| format!("the header has no `{name}`"))
    };
    let number = |name: &str| {
        let value = field(name)?;
        value.parse::<f64>().map_err(|_| format!("`{name} = {}` is not a number", quoted(value)))
    };
    let side = |name: &str| {
        let value = field(name)?;
        value.parse::<usize>().map_err(|_| format!("`{name} = {}` is not a count", quoted(value)))
    };
    let (nx, ny) = (side("NumPoints")?, side("NumProfiles")?);
    let count = points(nx, ny)?;
    let (dx, dy, scale) = (number("Xscale")?, number("Yscale")?, factor("Zscale", number("Zscale")?)?);
    let code = number("DataType")?;
    let mark =
        if code.fract() == 0.0 && code >= 0.0 { raw_type(code as u8)? } else { raw_type(u8::MAX)? }.mark_of_holes();
    let heights = data
        .split_whitespace()
        // One more than there should be is enough to see that they do not fit.
        .take(count + 1)
        .map(|word| {
            if word.eq_ignore_ascii_case("bad") || word.eq_ignore_ascii_case("nan") {
                return Ok(f64::NAN);
            }
            let hint = if word.contains(',') { ": SDF has decimal points" } else { "" };
            let value = height(word).map_err(|fault| format!("{fault}{hint}"))?;
            Ok(if Some(value) == mark { f64::NAN } else { kept_number(value, value * (scale * 1e6)) })
        })
        .collect::<Result<Vec<f64>, FileFault>>()?;
    let content = MeasuredContent::new(nx, ny, dx * 1e6, dy * 1e6, heights)?;
    Ok(MeasuredFile::new(content, trailer_notes(parts.next().unwrap_or_default())))
}
