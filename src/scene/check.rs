//! One value against its key: type, range, unit.
//!
//! In: a node of the tree and the key it was written for. Out: the checked value, still in the unit of the file, or the
//! fault with the place of the part that is wrong (one number of a list, not the list). Whole numbers pass where
//! numbers are asked for, never the other way round: `teeth = 24.0` is more likely a mistake than a wish.

use super::keys::{Key, Kind, PRINTED, Range};
use super::sources::{At, Sources};
use super::tree::{Node, TomlValue};
use super::values::Checked;
use gearcut_core::math::formula::{Formula, FormulaFault};

/// What is wrong with a value, and where exactly.
#[derive(Debug)]
pub(super) struct Fault {
    pub at: At,
    pub message: String,
}

/// Longest name of an operation: it becomes a folder.
const LONGEST_NAME: usize = 64;
/// Names that Windows keeps for devices.
const DEVICE_NAMES: &[&str] = &["con", "prn", "aux", "nul"];

/// The value of `node` if it fits `key`, which messages call `path`.
pub(super) fn check(path: &str, key: &Key, node: &Node, sources: &Sources) -> Result<Checked, Fault> {
    let one = One { path, key, sources };
    match key.kind {
        Kind::Number(range) => one.number(node, range, "").map(Checked::Number),
        Kind::Whole { min, max } => one.whole(node, min, max).map(Checked::Whole),
        Kind::Boolean => match node.value {
            TomlValue::Boolean(on) => Ok(Checked::Boolean(on)),
            _ => Err(one.wrong_type(node, "true or false")),
        },
        Kind::Word(words) => {
            let word = one.text(node)?;
            if words.contains(&word) { Ok(Checked::Text(word.to_owned())) } else { Err(one.refused(node)) }
        }
        Kind::Name => {
            let name = one.text(node)?;
            if is_folder_name(name) { Ok(Checked::Text(name.to_owned())) } else { Err(one.bad_name(node)) }
        }
        Kind::Path => {
            let text = one.text(node)?;
            if text.is_empty() || text.contains('\0') {
                Err(one.refused(node))
            } else {
                Ok(Checked::Text(text.to_owned()))
            }
        }
        Kind::Text { most } => {
            let text = if let TomlValue::Date(date) = &node.value { date } else { one.text(node)? };
            let printed = |letter: char| PRINTED.iter().any(|[from, to]| (*from..=*to).contains(&letter));
            let fits = (1..=most).contains(&text.chars().count()) && text.chars().all(printed);
            if fits { Ok(Checked::Text(text.to_owned())) } else { Err(one.refused(node)) }
        }
        Kind::Formula => {
            let text = one.text(node)?;
            Formula::parse(text).map_err(|fault| one.no_formula(node, text, &fault))?;
            Ok(Checked::Text(text.to_owned()))
        }
        Kind::Numbers { range, most } => one.numbers(node, range, most).map(Checked::Numbers),
        Kind::Pair(range) => {
            let pair = one.numbers(node, range, 2)?;
            if pair.len() == 2 { Ok(Checked::Numbers(pair)) } else { Err(one.count(node, pair.len(), "2 numbers")) }
        }
        Kind::Points { angle, radius, fewest, most } => {
            let points = one.points(node, angle, radius)?;
            if (fewest..=most).contains(&points.len()) {
                Ok(Checked::Points(points))
            } else {
                Err(one.count(node, points.len(), &format!("{fewest} to {most} points")))
            }
        }
    }
}

struct One<'a> {
    path: &'a str,
    key: &'a Key,
    sources: &'a Sources,
}

impl One<'_> {
    fn written(&self, node: &Node) -> String {
        self.sources.written(&node.at)
    }

    fn fault(node: &Node, message: String) -> Fault {
        Fault { at: node.at.clone(), message }
    }

    /// `wanted` says what the key takes; its unit and range follow where they say more.
    fn wrong_type(&self, node: &Node, wanted: &str) -> Fault {
        let (path, kind, written) = (self.path, node.kind(), self.written(node));
        let brackets = match self.key.kind {
            Kind::Number(_) | Kind::Numbers { .. } | Kind::Pair(_) | Kind::Points { .. } | Kind::Word(_) => {
                format!(" {}", self.key.brackets())
            }
            Kind::Whole { min, max } => format!(", {min} to {max}"),
            Kind::Boolean | Kind::Name | Kind::Path | Kind::Formula | Kind::Text { .. } => String::new(),
        };
        Self::fault(node, format!("`{path}` takes {wanted}{brackets}, not {kind}: {written}"))
    }

    fn refused(&self, node: &Node) -> Fault {
        Self::fault(node, format!("`{}` = {} is not allowed: {}", self.path, self.written(node), self.key.allowed()))
    }

    /// The fault of a formula, at its place in the text between the quotes.
    fn no_formula(&self, node: &Node, text: &str, fault: &FormulaFault) -> Fault {
        let character = text[..fault.at.start].chars().count() + 1;
        let message = format!("`{}`, character {character}: {}", self.path, fault.message);
        let at = match &node.at {
            // Text with escapes is not what stands in the file: the whole of it is blamed.
            At::Scene(span) => match self.sources.text.get(span.clone()).and_then(|written| written.find(text)) {
                Some(quote) => At::Scene(span.start + quote + fault.at.start..span.start + quote + fault.at.end),
                None => node.at.clone(),
            },
            other => other.clone(),
        };
        Fault { at, message }
    }

    fn bad_name(&self, node: &Node) -> Fault {
        let (path, written) = (self.path, self.written(node));
        let rule =
            format!("1 to {LONGEST_NAME} letters, digits, _ and -, not beginning with -, not a device name of Windows");
        Self::fault(node, format!("`{path}` = {written} cannot be a folder name: {rule}"))
    }

    fn count(&self, node: &Node, found: usize, wanted: &str) -> Fault {
        Self::fault(node, format!("`{}` takes {wanted}, not {found}", self.path))
    }

    fn text<'n>(&self, node: &'n Node) -> Result<&'n str, Fault> {
        if let TomlValue::Text(text) = &node.value { Ok(text) } else { Err(self.wrong_type(node, "text in quotes")) }
    }

    /// A finite number in the range; `part` says which part of the value it is ("angle ").
    fn number(&self, node: &Node, range: Range, part: &str) -> Result<f64, Fault> {
        let number = match node.value {
            TomlValue::Number(number) => number,
            TomlValue::Whole(number) => number as f64,
            TomlValue::Unusable => {
                let written = self.written(node);
                return Err(Self::fault(
                    node,
                    format!("`{}`: {part}{written} is not a finite number {}", self.path, self.key.brackets()),
                ));
            }
            _ => return Err(self.wrong_type(node, "a number")),
        };
        if range.contains(number) {
            return Ok(number);
        }
        let unit = match (part, self.key.unit) {
            ("angle ", _) => " deg",
            ("radius ", _) => " mm",
            (_, "") => "",
            (_, unit) => &format!(" {unit}"),
        };
        let written = self.written(node);
        let message = format!("`{}`: {part}{written} is out of range: {range}{unit}", self.path);
        Err(Self::fault(node, message))
    }

    fn whole(&self, node: &Node, min: u32, max: u32) -> Result<u32, Fault> {
        let number = match node.value {
            TomlValue::Whole(number) => u32::try_from(number).ok(),
            TomlValue::Unusable => None,
            _ => return Err(self.wrong_type(node, "a whole number")),
        };
        number.filter(|number| (min..=max).contains(number)).ok_or_else(|| {
            let written = self.written(node);
            Self::fault(node, format!("`{}`: {written} is out of range: whole number, {min} to {max}", self.path))
        })
    }

    fn list<'n>(&self, node: &'n Node) -> Result<&'n [Node], Fault> {
        if let TomlValue::List(items) = &node.value { Ok(items) } else { Err(self.wrong_type(node, "a list")) }
    }

    fn numbers(&self, node: &Node, range: Range, most: usize) -> Result<Vec<f64>, Fault> {
        let items = self.list(node)?;
        if items.len() > most {
            return Err(self.count(node, items.len(), &format!("at most {most} numbers")));
        }
        items.iter().map(|item| self.number(item, range, "")).collect()
    }

    /// Points whose angles increase.
    fn points(&self, node: &Node, angle: Range, radius: Range) -> Result<Vec<[f64; 2]>, Fault> {
        let mut points: Vec<[f64; 2]> = Vec::new();
        for item in self.list(node)? {
            let TomlValue::List(pair) = &item.value else {
                return Err(self.wrong_type(item, "points [angle, radius]"));
            };
            let [first, second] = pair.as_slice() else {
                return Err(self.count(item, pair.len(), "2 numbers [angle, radius] for each point"));
            };
            let point = [self.number(first, angle, "angle ")?, self.number(second, radius, "radius ")?];
            if let Some([last, _]) = points.last().filter(|last| point[0] <= last[0]) {
                let message = format!("`{}`: angle {} does not increase after {last}", self.path, point[0]);
                return Err(Self::fault(first, message));
            }
            points.push(point);
        }
        Ok(points)
    }
}

/// Whether every file system takes `name` as a folder.
fn is_folder_name(name: &str) -> bool {
    let plain = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-'));
    let lower = name.to_ascii_lowercase();
    let numbered = |stem: &str| lower.strip_prefix(stem).is_some_and(|rest| rest.len() == 1 && rest != "0");
    let device = DEVICE_NAMES.contains(&lower.as_str())
        || ["com", "lpt"].iter().any(|stem| numbered(stem) && lower.ends_with(|c: char| c.is_ascii_digit()));
    plain && !device && !name.is_empty() && name.len() <= LONGEST_NAME && !name.starts_with('-')
}
