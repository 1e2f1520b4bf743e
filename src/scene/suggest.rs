//! The known key, section or word nearest to a name that is none.
//!
//! In: a section and a name written in it. Out: the candidate to propose, if any is alike enough. Searched first among
//! the names of the same section (a slip of the finger, a forgotten unit), then among all (a key in the wrong section).
//! Always proposing the nearest one, however far, would send the reader the wrong way.

use strsim::normalized_damerau_levenshtein;

use super::keys::{Key, join};
use super::table::{KeyTable, TableSection};

/// Likeness from which a name of the same section is worth proposing: half of the letters in common.
const LIKE_ENOUGH_HERE: f64 = 0.5;
/// Likeness from which a name of another section is; stricter, because there are many.
const LIKE_ENOUGH_ELSEWHERE: f64 = 0.75;

/// Longest name compared: twice the longest known one; the comparison takes memory in proportion to the length.
const LONGEST_COMPARED: usize = 80;

/// A key or section to propose.
pub(super) enum Candidate<'a> {
    Key(&'a TableSection, &'static Key),
    Section(&'a TableSection),
}

impl Candidate<'_> {
    fn name(&self) -> &'static str {
        match self {
            Self::Key(_, key) => key.name,
            Self::Section(section) => section.name(),
        }
    }

    /// Whether this is the key `key` of `section`.
    pub fn is_key(&self, section: &TableSection, key: &Key) -> bool {
        matches!(self, Self::Key(holder, known) if holder.path == section.path && known.name == key.name)
    }

    /// What to do about a name written in `section` that probably means this.
    pub fn way_out(&self, section: &TableSection) -> String {
        match self {
            Self::Key(holder, key) if holder.path == section.path => {
                format!("write {} instead, or remove it", key.name)
            }
            Self::Key(holder, key) => format!("write {} under {}, or remove it", key.name, holder.header()),
            Self::Section(found) => format!("write {} instead, or remove it", found.header()),
        }
    }

    /// In the words of a message: with unit and range.
    pub fn words(&self) -> String {
        match self {
            Self::Key(section, key) => format!("`{}` {}", display_path(section, key), key.brackets()),
            Self::Section(section) => format!("`{}`", section.header()),
        }
    }
}

/// Path of a key as messages print it: `operation.offset_mm`.
pub(super) fn display_path(section: &TableSection, key: &Key) -> String {
    join(section.path, key.name).replace("[]", "")
}

/// The nearest known key or section to `name`, written in `section`.
pub(super) fn nearest<'a>(table: &'a KeyTable, section: &'a TableSection, name: &str) -> Option<Candidate<'a>> {
    if name.len() > LONGEST_COMPARED {
        return None;
    }
    let here = candidates(table, section);
    let elsewhere = table.sections().iter().flat_map(|section| candidates(table, section));
    best(here, name, LIKE_ENOUGH_HERE).or_else(|| best(elsewhere, name, LIKE_ENOUGH_ELSEWHERE))
}

/// The word nearest to one that is none of these, as a question behind what is wrong; empty where none is alike.
pub fn did_you_mean<'a>(words: impl IntoIterator<Item = &'a str>, written: &str) -> String {
    if written.len() > LONGEST_COMPARED {
        return String::new();
    }
    let alike = words.into_iter().map(|word| (likeness(written, word), word));
    let nearest = alike.filter(|(likeness, _)| *likeness >= LIKE_ENOUGH_HERE).max_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map_or_else(String::new, |(_, word)| format!("; did you mean {word}?"))
}

fn candidates<'a>(table: &'a KeyTable, section: &'a TableSection) -> impl Iterator<Item = Candidate<'a>> {
    let keys = section.keys.iter().map(move |key| Candidate::Key(section, key));
    keys.chain(table.children(section).map(Candidate::Section))
}

fn best<'a>(candidates: impl Iterator<Item = Candidate<'a>>, name: &str, least: f64) -> Option<Candidate<'a>> {
    let mut found: Option<(f64, Candidate<'a>)> = None;
    for candidate in candidates {
        let likeness = likeness(name, candidate.name());
        if likeness >= least && found.as_ref().is_none_or(|(best, _)| likeness > *best) {
            found = Some((likeness, candidate));
        }
    }
    found.map(|(_, candidate)| candidate)
}

/// 1 for equal names, 0 for nothing in common; a name that is a part of the other one counts as rather alike.
fn likeness(written: &str, known: &str) -> f64 {
    let [written, known] = [written, known].map(str::to_ascii_lowercase);
    let part = written.len() >= 4 && known.contains(&written);
    normalized_damerau_levenshtein(&written, &known).max(if part { 0.6 } else { 0.0 })
}
