//! Words of a program: letters with numbers, block by block, comments left out; and how large the numbers may be.
//!
//! A number that no machine has is refused where it is read: behind it distances overflow, and nothing that is said of
//! the program is true.

use crate::machine::AxisKind;
use std::ops::RangeInclusive;

/// Largest magnitude of a position along an axis, mm: some ten times the largest gears that are cut.
const MOST_MM: f64 = 1e5;
/// Largest magnitude of an angle, deg: a degree for each of the strokes that a scene may have, a hundred times over. An
/// f64 still tells 1e-7 deg there.
const MOST_DEG: f64 = 1e9;
/// Speeds, feeds and times of a program, in their units: wide of anything that turns, far from overflow.
const RATES: RangeInclusive<f64> = 1e-9..=1e9;

/// A word: letter, number, and the text for messages.
pub struct Word<'a> {
    /// Upper-case letter.
    pub letter: char,
    /// Its number.
    pub number: f64,
    /// As it stands in the program.
    pub text: &'a str,
}

impl Word<'_> {
    /// Its number as a position of an axis, mm or deg.
    ///
    /// # Errors
    /// No machine goes there.
    pub fn position(&self, kind: AxisKind) -> Result<f64, String> {
        let (most, unit) = match kind {
            AxisKind::Linear => (MOST_MM, "mm"),
            AxisKind::Rotary => (MOST_DEG, "deg"),
        };
        if self.number.abs() <= most {
            Ok(self.number)
        } else {
            Err(self.beyond(&format!("{:e} to {most:e} {unit}", -most)))
        }
    }

    /// Its number as a speed, a feed or a time, above zero.
    ///
    /// # Errors
    /// It is so small or large that what follows from it has no end.
    pub fn rate(&self) -> Result<f64, String> {
        let [least, most] = [RATES.start(), RATES.end()];
        if RATES.contains(&self.number) { Ok(self.number) } else { Err(self.beyond(&format!("{least:e} to {most:e}"))) }
    }

    fn beyond(&self, range: &str) -> String {
        format!("word `{}`: the number {:e} is out of range; {range} is allowed", cut(self.text), self.number)
    }
}

/// Takes block after block; `block` says whether the program has ended. Gives the number of lines, and whether an end
/// was there; errors name the line. A `%` alone in its line begins a program, before everything else, or ends it.
///
/// # Errors
/// Line and word of what is malformed, and whatever a control would not read any more.
pub fn blocks(
    text: &str,
    mut block: impl FnMut(&[Word]) -> Result<bool, String>,
) -> Result<(usize, Result<(), String>), String> {
    let (mut lines, mut begun, mut ended, mut tape_ended) = (0, false, false, false);
    for (index, line) in text.lines().enumerate() {
        lines = index + 1;
        let line = line.trim();
        if tape_ended && !line.is_empty() {
            return Err(format!("line {lines}: `{}` comes after the `%` at which a control stops reading", cut(line)));
        }
        if line == "%" {
            tape_ended = std::mem::replace(&mut begun, true);
            continue;
        }
        begun |= !line.is_empty();
        let words = words(line).map_err(|why| format!("line {lines}: {why}"))?;
        if ended && !words.is_empty() {
            return Err(format!("line {lines}: a block after the end of the program"));
        }
        ended |= block(&words).map_err(|why| format!("line {lines}: {why}"))?;
    }
    let cut_off = || format!("line {lines}: the program ends without M30: it may have been cut off");
    Ok((lines, if ended { Ok(()) } else { Err(cut_off()) }))
}

/// Splits a line into words, comments left out.
fn words(line: &str) -> Result<Vec<Word<'_>>, String> {
    let mut found = Vec::new();
    let mut rest = line.trim();
    while let Some(first) = rest.chars().next() {
        if first == ';' {
            break;
        }
        if first == '%' {
            return Err(format!("`{}`: a `%` must be alone in its line", cut(rest)));
        }
        if first == '(' {
            let Some(end) = rest.find(')') else { return Err(format!("the comment `{}` is not closed", cut(rest))) };
            rest = rest[end + 1..].trim_start();
            continue;
        }
        if !first.is_ascii_alphabetic() {
            return Err(format!("`{}` does not begin with a letter", cut(rest)));
        }
        let number = rest[1..].trim_start();
        let digits =
            number.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '+' | '-'))).unwrap_or(number.len());
        let text = &rest[..rest.len() - number.len() + digits];
        let value: f64 =
            number[..digits].parse().map_err(|_| format!("word `{}`: no number after the letter", cut(text)))?;
        if !value.is_finite() {
            return Err(format!("word `{}`: the number is too large", cut(text)));
        }
        found.push(Word { letter: first.to_ascii_uppercase(), number: value, text });
        rest = number[digits..].trim_start();
    }
    Ok(found)
}

fn cut(text: &str) -> String {
    let mut short: String = text.chars().take(24).collect();
    if short.len() < text.len() {
        short.push_str("...");
    }
    short
}
