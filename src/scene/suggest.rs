//! The known key or section nearest to a name that is none.
//!
//! First among the names of the same section (a slip of the finger, a forgotten unit), then among all
//! (a key in the wrong section).

use strsim::normalized_damerau_levenshtein;

use super::keys::{self, Key, Section, join};

/// Likeness from which a name of the same section is worth proposing: half of the letters in common.
const LIKE_ENOUGH_HERE: f64 = 0.5;
/// Likeness from which a name of another section is; stricter, because there are many.
const LIKE_ENOUGH_ELSEWHERE: f64 = 0.75;

/// A key or section to propose.
enum Candidate {
    Key(&'static Section, &'static Key),
    Section(&'static Section),
}

impl Candidate {
    fn name(&self) -> &'static str {
        match self {
            Self::Key(_, key) => key.name,
            Self::Section(section) => section.name(),
        }
    }

    /// In the words of a message: with unit and range.
    fn words(&self) -> String {
        match self {
            Self::Key(section, key) => format!("`{}` {}", display_path(section, key), key.brackets()),
            Self::Section(section) => format!("`{}`", section.header()),
        }
    }
}

/// Path of a key as messages print it: `operation.offset_mm`.
pub(super) fn display_path(section: &Section, key: &Key) -> String {
    join(section.path, key.name).replace("[]", "")
}

/// The nearest known name to `name`, written in `section`, in the words of a message.
pub(super) fn nearest(section: &'static Section, name: &str) -> Option<String> {
    let here = candidates(section);
    let elsewhere = keys::sections().flat_map(candidates);
    best(here, name, LIKE_ENOUGH_HERE)
        .or_else(|| best(elsewhere, name, LIKE_ENOUGH_ELSEWHERE))
        .map(|found| found.words())
}

fn candidates(section: &'static Section) -> impl Iterator<Item = Candidate> {
    let keys = section.keys.iter().map(move |key| Candidate::Key(section, key));
    keys.chain(section.children().map(Candidate::Section))
}

fn best(candidates: impl Iterator<Item = Candidate>, name: &str, least: f64) -> Option<Candidate> {
    let mut found: Option<(f64, Candidate)> = None;
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
    let written = written.to_ascii_lowercase();
    let part = written.len() >= 4 && known.contains(&written);
    normalized_damerau_levenshtein(&written, known).max(if part { 0.6 } else { 0.0 })
}
