//! What a reader must know before trusting the numbers or the gear: one list, made by a job and its run.
//!
//! In: sentences of the job (known before anything is cut) and of its run (known afterwards), each with a severity.
//! Out: [`ranked`], the list in the order in which everybody shows it: `check`, `axes`, the summary and `results.json`
//! of `cut`, the report, the heads of programs. No renderer adds to it or leaves anything out.
//!
//! Road not taken: warnings in the sections that they are about. A reader of one place then misses those of another,
//! and the page counted fewer than the terminal.

use super::unit;

/// How much a warning weighs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// How to read a number, or what was left out because it does not exist here. The gear may be as it should.
    Note,
    /// The gear or its machine may be refused on the shop floor: undercut, a force or chip beyond what is usual, an
    /// axis beyond its limit, strokes that rub, deviations.
    Warning,
    /// The gear is damaged, a program must not be run, or something that was asked for is not there. `gearcut cut` ends
    /// with exit code 3.
    Fault,
}

impl Severity {
    /// All, the gravest first.
    pub const ALL: [Self; 3] = [Self::Fault, Self::Warning, Self::Note];

    /// `fault`, `warning` or `note`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fault => "fault",
            Self::Warning => "warning",
            Self::Note => "note",
        }
    }
}

/// A sentence with its severity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// How much it weighs.
    pub severity: Severity,
    /// What is wrong, where, and what to do about it; units as files write them.
    pub text: String,
    /// Path of the section whose numbers it is about, where it is about one section alone.
    pub section: Option<String>,
}

impl Warning {
    /// The gear is damaged, a program must not be run, or something that was asked for is not there.
    pub fn fault(text: impl Into<String>) -> Self {
        Self { severity: Severity::Fault, text: text.into(), section: None }
    }

    /// The gear or its machine may be refused on the shop floor.
    pub fn warn(text: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, text: text.into(), section: None }
    }

    /// How to read a number.
    pub fn note(text: impl Into<String>) -> Self {
        Self { severity: Severity::Note, text: text.into(), section: None }
    }

    /// About the numbers of the section at this path alone.
    #[must_use]
    pub fn about(self, section: impl Into<String>) -> Self {
        Self { section: Some(section.into()), ..self }
    }

    /// The same with units in the signs of a page.
    #[must_use]
    pub fn with_signs(&self) -> Self {
        Self { text: unit::sentence_with_signs(&self.text), ..self.clone() }
    }

    /// As a line: `fault: ...`.
    pub fn line(&self) -> String {
        format!("{}: {}", self.severity.name(), self.text)
    }
}

/// The list as it is shown: the gravest first, otherwise as it was made, nothing twice.
pub fn ranked(warnings: impl IntoIterator<Item = Warning>) -> Vec<Warning> {
    let mut list: Vec<Warning> = Vec::new();
    for warning in warnings {
        if !list.contains(&warning) {
            list.push(warning);
        }
    }
    list.sort_by_key(|warning| std::cmp::Reverse(warning.severity));
    list
}

/// How many there are of each severity: "1 fault, 3 warnings, 1 note", or "no warnings".
pub fn count_words(warnings: &[Warning]) -> String {
    let counts = Severity::ALL.into_iter().filter_map(|severity| {
        let count = warnings.iter().filter(|warning| warning.severity == severity).count();
        let plural = if count == 1 { "" } else { "s" };
        (count > 0).then(|| format!("{count} {}{plural}", severity.name()))
    });
    let words: Vec<String> = counts.collect();
    if words.is_empty() { "no warnings".to_owned() } else { words.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gravest_comes_first_and_nothing_twice() {
        let made = [
            Warning::note("a"),
            Warning::warn("b"),
            Warning::warn("b"),
            Warning::fault("c"),
            Warning::warn("b").about("texture"),
        ];
        let list = ranked(made);
        let lines: Vec<String> = list.iter().map(Warning::line).collect();
        assert_eq!(lines, ["fault: c", "warning: b", "warning: b", "note: a"]);
        assert_eq!(count_words(&list), "1 fault, 2 warnings, 1 note");
        assert_eq!(count_words(&[]), "no warnings");
    }

    #[test]
    fn pages_read_signs() {
        assert_eq!(Warning::note("5 um deep at 3 deg of roll").with_signs().text, "5 µm deep at 3° of roll");
    }
}
