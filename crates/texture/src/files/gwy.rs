//! GWY, Gwyddion's own format, read: objects within objects, each with its name, its bytes and named components.
//!
//! `GWYP`, then an object `GwyContainer`: a name that ends with zero, the number of bytes, components. A component:
//! name, a letter for its type, its value; numbers are little endian. Channels are the fields `/0/data`, `/1/data`,
//! ...; a field has `xres`, `yres`, `xreal`, `yreal` (points times spacing), heights row by row, and the units of both.
//! The first channel of lengths is read, others are remarked. A mask marks points of any meaning: it makes holes where
//! that is wished, and is remarked. Source: the format's description in Gwyddion's user guide.

use super::bounds::{kept_number, points, side};
use super::content::{MeasuredContent, MeasuredFile};
use super::raw::{Bytes, Raw};
use super::units::LengthUnit;
use crate::error::FileFault;
use crate::text::quoted;

/// One component of an object.
struct Component<'a> {
    name: &'a str,
    kind: u8,
    /// Bytes of the value; of arrays without their count, of objects without their size.
    value: &'a [u8],
}

/// Reads the first channel of lengths; `use_mask`: what its mask marks are holes.
pub(super) fn decode(bytes: &[u8], use_mask: bool) -> Result<MeasuredFile, FileFault> {
    let (name, inner, _) = object(&bytes[4.min(bytes.len())..])?;
    if name != "GwyContainer" {
        return Err(format!("it holds a `{}`, no container of channels", quoted(name)).into());
    }
    let components = components(inner)?;
    let number_of = |component: &Component| {
        let number = component.name.strip_prefix('/')?.strip_suffix("/data")?.parse::<u32>().ok()?;
        (component.kind == b'o').then_some(number)
    };
    let mut channels: Vec<(u32, &Component)> = components.iter().filter_map(|c| Some((number_of(c)?, c))).collect();
    channels.sort_by_key(|(number, _)| *number);
    let mut problem = "it has no channel".to_owned();
    for (number, channel) in &channels {
        let mask = components.iter().find(|c| c.kind == b'o' && c.name == format!("/{number}/mask"));
        if use_mask && mask.is_none() {
            problem = format!("channel {number} has no mask: leave --use-mask out");
            continue;
        }
        let masked = mask.filter(|_| use_mask).map(|mask| values(mask.value)).transpose()?;
        match field(channel.value, masked.as_deref()) {
            Ok(content) => {
                let mut measured = MeasuredFile::new(content, Vec::new());
                let title = components.iter().find(|c| c.name == format!("/{number}/data/title"));
                let title = title.map(|c| quoted(&String::from_utf8_lossy(c.value))).unwrap_or_default();
                if channels.len() > 1 {
                    let count = channels.len();
                    measured.remarks.push(format!("channel {number} `{title}` of {count}: the first of heights"));
                }
                measured.remarks.extend(mask.map(|_| {
                    let is = if use_mask { "holes" } else { "heights here (--use-mask makes them holes)" };
                    format!("it has a mask: what it marks are {is}")
                }));
                return Ok(measured);
            }
            Err(reason) => problem = format!("channel {number}: {reason}"),
        }
    }
    Err(problem.into())
}

/// Components of a field.
fn of_field(value: &[u8]) -> Result<Vec<Component<'_>>, FileFault> {
    let (name, inner, _) = object(value)?;
    if name != "GwyDataField" {
        return Err(format!("it is a `{}`, no field of heights", quoted(name)).into());
    }
    components(inner)
}

/// Values of a field without units, such as a mask.
fn values(value: &[u8]) -> Result<Vec<f64>, FileFault> {
    let components = of_field(value)?;
    let data = components.iter().find(|c| c.name == "data" && c.kind == b'D').ok_or("its mask has no `data`")?;
    Raw::F64.values(data.value, data.value.len() / 8)
}

/// Heights of a field; holes where `mask` is above zero.
fn field(value: &[u8], mask: Option<&[f64]>) -> Result<MeasuredContent, FileFault> {
    let components = of_field(value)?;
    let find = |name: &str, kind: u8| {
        components.iter().find(|c| c.name == name && c.kind == kind).ok_or_else(|| format!("it has no `{name}`"))
    };
    let count = |name: &str| side(Bytes(find(name, b'i')?.value).i32(0)?);
    let real = |name: &str| Bytes(find(name, b'd')?.value).f64(0);
    let unit = |name: &str| -> Result<f64, FileFault> {
        let (_, inner, _) = object(find(name, b'o')?.value)?;
        let inner = self::components(inner)?;
        let text = inner.iter().find(|c| c.name == "unitstr").map(|c| String::from_utf8_lossy(c.value).into_owned());
        let text = text.unwrap_or_default();
        LengthUnit::of(&text)
            .map(LengthUnit::um)
            .ok_or_else(|| format!("`{}` is no unit of length", quoted(&text)).into())
    };
    let (nx, ny) = (count("xres")?, count("yres")?);
    let total = points(nx, ny)?;
    let (across, up) = (unit("si_unit_xy")?, unit("si_unit_z")?);
    let heights = Raw::F64.values(find("data", b'D')?.value, total)?;
    if mask.is_some_and(|mask| mask.len() != total) {
        return Err("its mask has another number of points".into());
    }
    let masked = |i: usize| mask.is_some_and(|mask| mask[i] > 0.0);
    let heights = heights.into_iter().enumerate();
    let heights = heights.map(|(i, z)| if masked(i) { f64::NAN } else { kept_number(z, z * up) }).collect();
    MeasuredContent::new(nx, ny, real("xreal")? / nx as f64 * across, real("yreal")? / ny as f64 * across, heights)
}

/// Name and inner bytes of the object that `bytes` begin with, and its whole length.
fn object(bytes: &[u8]) -> Result<(&str, &[u8], usize), FileFault> {
    let (name, start) = word(bytes)?;
    let size = Bytes(bytes).u32(start)? as usize;
    let inner = Bytes(bytes).at(start + 4, size)?;
    Ok((name, inner, start + 4 + size))
}

/// A text that ends with zero, and where what follows begins.
fn word(bytes: &[u8]) -> Result<(&str, usize), FileFault> {
    let end = bytes.iter().position(|&b| b == 0).ok_or("a name without an end")?;
    Ok((std::str::from_utf8(&bytes[..end]).map_err(|_| "a name that is no text")?, end + 1))
}

/// All components of an object.
fn components(mut bytes: &[u8]) -> Result<Vec<Component<'_>>, FileFault> {
    let mut found = Vec::new();
    while !bytes.is_empty() {
        let (name, start) = word(bytes)?;
        let &kind = bytes.get(start).ok_or("a component without a type")?;
        let rest = &bytes[start + 1..];
        let (skip, length) = extent(kind, rest)?;
        found.push(Component { name, kind, value: Bytes(rest).at(skip, length)? });
        // A text ends with a zero of its own.
        bytes = &rest[(skip + length + usize::from(kind == b's')).min(rest.len())..];
    }
    Ok(found)
}

/// Bytes before a value and bytes of it; of an object all its bytes.
fn extent(kind: u8, rest: &[u8]) -> Result<(usize, usize), FileFault> {
    let count = || Bytes(rest).u32(0).map(|count| count as usize);
    let sized = |count: usize, size: usize| count.checked_mul(size).ok_or("an array larger than the file".to_owned());
    Ok(match kind {
        b'b' | b'c' => (0, 1),
        b'i' => (0, 4),
        b'q' | b'd' => (0, 8),
        b's' => (0, word(rest)?.1 - 1),
        b'o' => (0, object(rest)?.2),
        b'C' => (4, count()?),
        b'I' => (4, sized(count()?, 4)?),
        b'Q' | b'D' => (4, sized(count()?, 8)?),
        b'S' | b'O' => {
            let mut length = 0;
            for _ in 0..count()? {
                let left = rest.get(4 + length..).unwrap_or_default();
                length += if kind == b'S' { word(left)?.1 } else { object(left)?.2 };
            }
            (4, length)
        }
        other => return Err(format!("a component of type {other:#x}").into()),
    })
}
