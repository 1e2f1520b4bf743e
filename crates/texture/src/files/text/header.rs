//! What the lines above a table of heights say: units, spacing, numbers of points, names of columns.
//!
//! In: comment lines (`#`, `%`) and lines of words above the first row. Out: [`TextHeader`]. A line is a key and a
//! value, parted by `=`, `:` or the separator of the table, with the unit behind the value, in brackets behind the key,
//! or as its last word (`dx_um`). Keys are those of Gwyddion's and Keyence's exports, of this program, and what
//! instruments write in plain words. A known key with a value that cannot be one is refused. Lines that name a unit
//! under a key that is not known are kept, to be quoted where a unit is missing.
//!
//! Road not taken: reading what other programs mean by the length of a side. Gwyddion's is points times spacing,
//! others' is one spacing less; only Gwyddion's, known by its `Channel` line, is taken.

use super::super::notes_of;
use super::super::units::LengthUnit;
use crate::error::FileFault;
use crate::text::quoted;

/// A length with its unit, where it has one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Length {
    pub(super) value: f64,
    pub(super) unit: Option<LengthUnit>,
    /// Half of the last digit that was written, as a share of the value.
    pub(super) rounding: f64,
    pub(super) line: usize,
}

/// What a column holds, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TextColumn {
    X,
    Y,
    Z,
}

/// Everything that the lines say.
#[derive(Debug, Default)]
pub(super) struct TextHeader {
    /// The file is one of this program: cells are as they are, empty ones holes.
    pub(super) own: bool,
    pub(super) notes: Vec<(String, String)>,
    pub(super) height_unit: Option<LengthUnit>,
    pub(super) spacing_unit: Option<LengthUnit>,
    pub(super) spacing: [Option<Length>; 2],
    /// Sides of Gwyddion's exports, points times spacing.
    pub(super) sides: [Option<Length>; 2],
    pub(super) counts: [Option<(usize, usize)>; 2],
    /// Names of two or three columns, with units.
    pub(super) columns: Vec<(TextColumn, Option<LengthUnit>)>,
    /// Lines that name a unit and were not understood.
    pub(super) unclear: Vec<String>,
    channel: bool,
}

/// What a key is about.
#[derive(Clone, Copy)]
enum LineRole {
    Own,
    Channel,
    Notes,
    HeightUnit,
    AnyUnit,
    SpacingUnit,
    Spacing(&'static [usize]),
    Side(usize),
    Count(usize),
    Scale,
}

/// Keys in small letters, words parted by one blank.
const ROLES: [(LineRole, &[&str]); 13] = [
    (LineRole::Own, &["gearcut surface"]),
    (LineRole::Channel, &["channel"]),
    (LineRole::Notes, &["notes"]),
    (
        LineRole::HeightUnit,
        &[
            "value unit",
            "value units",
            "z unit",
            "z units",
            "unit z",
            "units z",
            "zunit",
            "height unit",
            "height units",
            "unit of heights",
            "data unit",
            "data units",
        ],
    ),
    (LineRole::AnyUnit, &["unit", "units"]),
    (
        LineRole::SpacingUnit,
        &[
            "xy unit",
            "xy units",
            "unit xy",
            "x unit",
            "x units",
            "unit x",
            "y unit",
            "y units",
            "unit y",
            "lateral unit",
            "lateral units",
            "spacing unit",
        ],
    ),
    (
        LineRole::Spacing(&[0, 1]),
        &[
            "xy calibration",
            "pixel size",
            "pixelsize",
            "pixel spacing",
            "point spacing",
            "spacing",
            "step",
            "step size",
            "sampling",
            "sampling interval",
            "sampling distance",
            "lateral sampling",
        ],
    ),
    (
        LineRole::Spacing(&[0]),
        &["dx", "x spacing", "spacing x", "x step", "step x", "x increment", "increment x", "delta x", "pixel size x"],
    ),
    (
        LineRole::Spacing(&[1]),
        &["dy", "y spacing", "spacing y", "y step", "step y", "y increment", "increment y", "delta y", "pixel size y"],
    ),
    (LineRole::Side(0), &["width"]),
    (LineRole::Side(1), &["height"]),
    (LineRole::Count(0), &["nx", "columns", "number of columns", "horizontal", "x points", "points x", "numpoints"]),
    (LineRole::Count(1), &["ny", "rows", "number of rows", "vertical", "y points", "points y", "numprofiles"]),
];

/// Words of a key that says by what the heights are to be multiplied.
const FACTORS: [&str; 5] = ["scale", "factor", "multiplier", "scaling", "gain"];
/// Words of a key that is about heights.
const OF_HEIGHTS: [&str; 5] = ["z", "height", "heights", "value", "data"];

impl TextHeader {
    /// Takes in one line above the table, its comment sign taken off.
    pub(super) fn line(&mut self, line: &str, number: usize) -> Result<Understood, FileFault> {
        let (key, value) = parted(line);
        let (words, key_unit) = key_words(&key);
        let about = |k: &str| words.split(' ').any(|word| word == k);
        let known = ROLES.iter().find(|(_, keys)| keys.contains(&words.as_str())).map(|(role, _)| *role);
        let scales = FACTORS.iter().any(|k| about(k)) && OF_HEIGHTS.iter().any(|k| about(k));
        let Some(role) = known.or(scales.then_some(LineRole::Scale)) else {
            self.unknown(line, number);
            return Ok(Understood::No);
        };
        let at = |reason: String| FileFault::Malformed(format!("line {number}: `{}`: {reason}", quoted(line.trim())));
        let unit_of =
            |name: &str| LengthUnit::of(name).ok_or_else(|| at(format!("`{}` is no unit of length", quoted(name))));
        match role {
            LineRole::Own => {
                self.own = true;
                if value.contains("heights in um") {
                    self.height_unit = Some(LengthUnit::Micrometre);
                }
            }
            LineRole::Channel => self.channel = true,
            LineRole::Notes => self.notes = notes_of(line.split_once('=').map_or("", |(_, json)| json)),
            LineRole::HeightUnit => self.set_height_unit(unit_of(&value)?).map_err(|fault| at(fault.to_string()))?,
            LineRole::AnyUnit => match LengthUnit::of(&value) {
                Some(unit) => self.set_height_unit(unit).map_err(|fault| at(fault.to_string()))?,
                None => {
                    self.keep(line, number);
                    return Ok(Understood::No);
                }
            },
            LineRole::SpacingUnit => self.spacing_unit = Some(unit_of(&value)?),
            LineRole::Spacing(axes) => {
                let length = length(&value, key_unit, number).map_err(|reason| at(format!("{reason} (a spacing)")))?;
                for &axis in axes {
                    self.spacing[axis] = Some(length);
                }
            }
            // `Height: 24 um` is a side in Gwyddion's exports alone, and a number of points in others.
            LineRole::Side(axis) => match length(&value, key_unit, number) {
                Ok(length) if length.unit.is_some() => self.sides[axis] = Some(length),
                _ => {
                    self.unknown(line, number);
                    return Ok(Understood::No);
                }
            },
            LineRole::Count(axis) => {
                let count = value.parse().map_err(|_| at("it is no number of points".to_owned()))?;
                self.counts[axis] = Some((count, number));
            }
            LineRole::Scale => {
                if number_of(&value).is_none_or(|(factor, _)| factor != 1.0) {
                    return Err(at(
                        "heights are to be multiplied by it, which is not done here: save the surface with \
                                   heights in a unit of length"
                            .to_owned(),
                    ));
                }
            }
        }
        Ok(Understood::Yes)
    }

    /// Names of `count` columns with their units, in the line above the first row.
    pub(super) fn names(&mut self, cells: &[String], number: usize) {
        let found: Option<Vec<_>> = cells.iter().map(|cell| column(cell)).collect();
        let Some(found) = found.filter(|found| (2..=3).contains(&found.len())) else { return };
        self.unclear.retain(|line| !line.starts_with(&format!("line {number}:")));
        self.columns = found;
    }

    /// Sides count where the file is one of Gwyddion's.
    pub(super) fn finish(&mut self) {
        for side in &mut self.sides {
            if let Some(length) = side.filter(|_| !self.channel) {
                self.unclear.push(format!("line {}: the length of a side", length.line));
                *side = None;
            }
        }
    }

    fn set_height_unit(&mut self, unit: LengthUnit) -> Result<(), FileFault> {
        match self.height_unit.replace(unit) {
            Some(before) if before != unit => Err(format!("heights are in {before} by a line above it").into()),
            _ => Ok(()),
        }
    }

    /// Keeps a line whose key is not known if it names a unit; `in` is one in brackets only.
    fn unknown(&mut self, line: &str, number: usize) {
        let names_unit = |word: &str| word != "in" && LengthUnit::of(word).is_some();
        let words = line.split(|c: char| c.is_whitespace() || "[](){}/;,:=\"".contains(c));
        if words.into_iter().any(names_unit) || line.contains("[in]") || line.contains("(in)") {
            self.keep(line, number);
        }
    }

    fn keep(&mut self, line: &str, number: usize) {
        self.unclear.push(format!("line {number}: `{}`", quoted(line.trim())));
    }
}

/// Whether a line above the table says something that is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Understood {
    Yes,
    No,
}

/// Key and value of a line, quotation marks off.
fn parted(line: &str) -> (String, String) {
    let plain = |text: &str| text.replace('"', "").trim().trim_end_matches([',', ';']).trim().to_owned();
    match line.find(['=', ':', '\t', ';']).or_else(|| line.find(',')) {
        Some(place) => {
            // The unit may be a cell of its own.
            let value = line[place + 1..].replace(['\t', ';'], " ").replace("\",", " ").replace(",\"", " ");
            (plain(&line[..place]), plain(&value))
        }
        None => (plain(line), String::new()),
    }
}

/// A key in small letters without its unit, and the unit: `dx_um`, `Pixel size [um]`.
fn key_words(key: &str) -> (String, Option<LengthUnit>) {
    let (key, bracketed) = match key.split_once(['[', '(']) {
        Some((key, rest)) => (key, LengthUnit::of(rest.trim_end_matches([']', ')', ' ']))),
        None => (key, None),
    };
    let small = key.to_lowercase();
    let mut words: Vec<&str> = small.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let last = words.last().filter(|word| **word != "in" && words.len() > 1 && bracketed.is_none());
    let last = last.and_then(|word| LengthUnit::of(word));
    if last.is_some() {
        words.pop();
    }
    (words.join(" "), bracketed.or(last))
}

/// A number with decimal point or comma, and half of its last digit.
pub(super) fn number_of(text: &str) -> Option<(f64, f64)> {
    let text = text.trim();
    let with_point = if text.contains('.') { text.to_owned() } else { text.replacen(',', ".", 1) };
    let value: f64 = with_point.parse().ok().filter(|value: &f64| value.is_finite())?;
    let (digits, exponent) = with_point.split_once(['e', 'E']).unwrap_or((&with_point, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len() as i32);
    Some((value, 0.5 * 10_f64.powi(exponent.parse::<i32>().ok()?.checked_sub(decimals)?)))
}

/// `20.00 um`, or a bare number whose unit the key has.
fn length(text: &str, key_unit: Option<LengthUnit>, line: usize) -> Result<Length, FileFault> {
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.,eE".contains(c))).unwrap_or(text.len());
    let no_length = || format!("`{}` is no length", quoted(text));
    let (value, half_digit) = number_of(text[..end].trim_end_matches([',', ';'])).ok_or_else(no_length)?;
    let unit = match text[end..].trim() {
        "" => key_unit,
        name => {
            let unit = LengthUnit::of(name).ok_or_else(no_length)?;
            if key_unit.is_some_and(|of_key| of_key != unit) {
                return Err("two units for one length".into());
            }
            Some(unit)
        }
    };
    Ok(Length { value, unit, rounding: (half_digit / value).abs(), line })
}

/// A column by its name: `X [mm]`, `z/um`, `Height (nm)`.
fn column(name: &str) -> Option<(TextColumn, Option<LengthUnit>)> {
    let (words, unit) = key_words(&name.replace(['/', '"'], " ").replace(" in ", " "));
    let first = words.split(' ').next().unwrap_or_default();
    let column = match first {
        "x" | "position" | "distance" | "length" | "weg" => TextColumn::X,
        "y" => TextColumn::Y,
        "z" | "height" | "profile" | "depth" | "h\u{f6}he" | "hoehe" => TextColumn::Z,
        _ => return None,
    };
    Some((column, unit))
}
