//! Parameters of a study: a key of the scene and the values that it takes.
//!
//! In: words of a command line, or values of a study file. Out: [`StudyParameter`]. A value is kept as the text of
//! TOML that a setting of the scene takes, so that a number, a word, a list and a whole table are alternatives alike.
//!
//! The law of ranges: `a..b/n` is n values evenly from a to b, both included; `a..b/n log` evenly in their logarithms.
//! Ends that are written as whole numbers make whole numbers, the nearest ones. A normal distribution has its values at
//! the same shares of its cases as a range has them of its length.

use statrs::distribution::{ContinuousCDF, Normal};
use std::str::FromStr;

/// Most values of one parameter.
const MOST_VALUES: u32 = 1_000_000;

/// A key and its values.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyParameter {
    /// Path of the key, such as `gear.teeth`, or of a table.
    pub key: String,
    /// Its values.
    pub choice: ParameterValues,
}

/// Values of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum ParameterValues {
    /// Each of these, as texts of TOML.
    Values(Vec<String>),
    /// One between these for each sample.
    Between(ValueRange),
    /// One of a normal distribution for each sample.
    Normal(NormalValues),
}

/// Values that scatter about a mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalValues {
    mean: f64,
    deviation: f64,
}

impl NormalValues {
    /// By mean and standard deviation, checked.
    ///
    /// # Errors
    /// In words: numbers that are no distribution.
    pub fn new([mean, deviation]: [f64; 2]) -> Result<Self, String> {
        if mean.is_finite() && deviation.is_finite() && deviation > 0.0 {
            return Ok(Self { mean, deviation });
        }
        Err(format!("{mean}, {deviation} is no mean with a standard deviation, which must be above 0"))
    }

    /// The text of the value that this share of all values is below.
    pub fn at(&self, share: f64) -> String {
        // The last share of a Latin hypercube may be all of them.
        let share = share.clamp(f64::EPSILON, 1.0 - f64::EPSILON);
        format!("{:?}", self.mean + self.deviation * Normal::standard().inverse_cdf(share))
    }
}

/// From one number to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValueRange {
    /// Ends, the smaller one first.
    pub ends: [f64; 2],
    /// Evenly in logarithms.
    pub log: bool,
    /// Whole numbers alone.
    pub whole: bool,
}

impl ValueRange {
    /// Checked.
    ///
    /// # Errors
    /// In words: ends that are no range.
    pub fn new(ends: [f64; 2], log: bool, whole: bool) -> Result<Self, String> {
        let [first, last] = ends;
        if !(first.is_finite() && last.is_finite() && first < last) {
            return Err(format!("{first} to {last} is no range: the first end must be the smaller one"));
        }
        if log && first <= 0.0 {
            return Err(format!("{first} to {last} has no logarithms: both ends must be above 0"));
        }
        Ok(Self { ends, log, whole })
    }

    /// The text of the value at a share of the range.
    pub fn at(&self, share: f64) -> String {
        let [first, last] = self.ends;
        let value = match (share, self.log) {
            (0.0, _) => first,
            (1.0, _) => last,
            (_, false) => first + share * (last - first),
            (_, true) => (first.ln() + share * (last / first).ln()).exp(),
        };
        // Debug writes every number so that it reads back as the same, and as a number of TOML.
        if self.whole { format!("{:.0}", value.round()) } else { format!("{value:?}") }
    }

    /// `count` values, both ends included.
    ///
    /// # Errors
    /// In words: too few or too many of them, whole numbers that come twice.
    pub fn values(&self, count: u32) -> Result<Vec<String>, String> {
        if !(2..=MOST_VALUES).contains(&count) {
            return Err(format!("{count} values are no range; take 2 to {MOST_VALUES}"));
        }
        let share = |place: u32| f64::from(place) / f64::from(count - 1);
        let values: Vec<String> = (0..count).map(|place| self.at(share(place))).collect();
        if values.windows(2).any(|pair| pair[0] == pair[1]) {
            let [first, last] = self.ends;
            return Err(format!(
                "{count} whole numbers from {first} to {last} are not all different; take fewer, or write the ends \
                 with a decimal point"
            ));
        }
        Ok(values)
    }
}

/// Key and the rest of `KEY=...`.
fn split<'a>(text: &'a str, form: &str) -> Result<(&'a str, &'a str), String> {
    let wrong = || format!("`{text}` is no parameter: write {form}");
    let (key, values) = text.split_once('=').ok_or_else(wrong)?;
    if key.trim().is_empty() || values.trim().is_empty() { Err(wrong()) } else { Ok((key.trim(), values.trim())) }
}

/// `KEY=a,b,c`: each of these values.
#[derive(Debug, Clone, PartialEq)]
pub struct GridWords(pub StudyParameter);

impl FromStr for GridWords {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (key, values) = split(text, "KEY=a,b,c, such as gear.teeth=20,24,28")?;
        Ok(Self(StudyParameter { key: key.to_owned(), choice: ParameterValues::Values(separated(values)) }))
    }
}

/// Values between commas; those in brackets, braces and quotes do not count.
fn separated(values: &str) -> Vec<String> {
    let (mut found, mut depth, mut quoted) = (vec![String::new()], 0_i32, false);
    for letter in values.chars() {
        match letter {
            '"' => quoted = !quoted,
            '[' | '{' if !quoted => depth += 1,
            ']' | '}' if !quoted => depth -= 1,
            ',' if !quoted && depth == 0 => {
                found.push(String::new());
                continue;
            }
            _ => {}
        }
        found.last_mut().expect("there is one").push(letter);
    }
    found.into_iter().map(|value| value.trim().to_owned()).collect()
}

/// `KEY=a..b/n`, or `KEY=a..b/n log`: values evenly from a to b. `KEY=a..b`, or `KEY=a..b log`: one between them for
/// each sample.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeWords(pub StudyParameter);

impl FromStr for RangeWords {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form = "KEY=a..b/n or KEY=a..b/n log, such as machine.back_off_mm=0.2..1.0/5; without /n, one value \
            between them for each sample";
        let (key, words) = split(text, form)?;
        let wrong = || format!("`{text}` is no range: write {form}");
        let (words, log) = match words.strip_suffix("log") {
            Some(words) => (words.trim_end(), true),
            None => (words, false),
        };
        let (ends, count) = words.split_once('/').map_or((words, None), |(ends, count)| (ends, Some(count)));
        let (first, last) = ends.split_once("..").ok_or_else(wrong)?;
        let number = |text: &str| text.trim().parse::<f64>().map_err(|_| wrong());
        let whole = [first, last].iter().all(|end| end.trim().parse::<i64>().is_ok());
        let range =
            ValueRange::new([number(first)?, number(last)?], log, whole).map_err(|why| format!("`{text}`: {why}"))?;
        let choice = match count {
            None => ParameterValues::Between(range),
            Some(count) => {
                let count = count.trim().parse().map_err(|_| wrong())?;
                ParameterValues::Values(range.values(count).map_err(|why| format!("`{text}`: {why}"))?)
            }
        };
        Ok(Self(StudyParameter { key: key.to_owned(), choice }))
    }
}
