//! What a reader must know before trusting the numbers or the gear: one list, made by a job and its run, of notices
//! whose words are rows of tables.
//!
//! In: rows of `notices!`, each with an id, a severity, a sentence with named parameters, why it matters, what to
//! change and a page of the documentation; a job and its run fill in the parameters. Out: [`ranked`], the list in the
//! order in which everybody shows it: `check`, `axes`, the summary and `results.json` of `cut`, the report, the heads
//! of programs. No renderer adds to it or leaves anything out.
//!
//! A row is a type whose fields are its parameters, so that a sentence without one of them does not compile, and
//! neither does a row that nothing says. Rows of one id say the same of different processes. A row stands in the
//! `notices.rs` of its subject; `crate::notices` lists them all.
//!
//! Roads not taken: warnings in the sections that they are about. A reader of one place then misses those of another,
//! and the page counted fewer than the terminal. Parameters as a map beside a template that is filled when it is shown:
//! a missing one is found by the reader.

use super::unit;
use std::borrow::Cow;

/// How much a notice weighs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// How to read a number, or what was left out because it does not exist here. The gear may be as it should.
    Note,
    /// The gear or its machine may be refused on the shop floor: undercut, a force or chip beyond what is usual, an
    /// axis beyond its limit, strokes that rub, deviations.
    Warning,
    /// The gear is damaged, a program must not be run, or a part of the run is missing. `gearcut cut` ends
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

/// A row of the table of notices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoticeRow {
    /// Its name, such as `flank.undercut`: the subject, a dot, what is wrong. Rows of one id say the same of different
    /// processes.
    pub id: &'static str,
    /// How much it weighs.
    pub severity: Severity,
    /// When it is a fault, where it weighs less otherwise.
    pub fault_where: Option<&'static str>,
    /// The sentence, its parameters in braces.
    pub says: &'static str,
    /// Why it matters.
    pub why: &'static str,
    /// What to change.
    pub advice: &'static str,
    /// Page of the documentation, below `docs/`.
    pub page: &'static str,
}

/// What a row says of a gear.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Notice {
    /// Id of its row.
    pub id: Cow<'static, str>,
    /// How much it weighs.
    pub severity: Severity,
    /// What is wrong, where, and what to do about it; units as files write them.
    pub text: String,
    /// Path of the section whose numbers it is about, where it is about one section alone.
    pub section: Option<String>,
}

impl Notice {
    /// From the parts that files have; rows make their own.
    pub(crate) fn new(id: impl Into<Cow<'static, str>>, severity: Severity, text: impl Into<String>) -> Self {
        Self { id: id.into(), severity, text: text.into(), section: None }
    }

    /// About the numbers of the section at this path alone.
    #[must_use]
    pub fn about(self, section: impl Into<String>) -> Self {
        Self { section: Some(section.into()), ..self }
    }

    /// A fault where `is_grave`; only rows with a word on that may become one.
    #[must_use]
    pub(crate) fn fault_where(self, is_grave: bool) -> Self {
        if is_grave { Self { severity: Severity::Fault, ..self } } else { self }
    }

    /// The same with units in the signs of a page.
    #[must_use]
    pub fn with_signs(&self) -> Self {
        Self { text: unit::sentence_with_signs(&self.text), ..self.clone() }
    }

    /// As a line of a program's head: `fault: ...`.
    pub fn line(&self) -> String {
        format!("{}: {}", self.severity.name(), self.text)
    }

    /// As a line of the terminal, its id behind it.
    pub fn line_with_id(&self) -> String {
        format!("{} [{}]", self.line(), self.id)
    }
}

/// A table of notices: for each row a type with the parameters as fields, whose `notice()` says it, and all rows as
/// `NOTICES`.
///
/// ```text
/// /// Why it matters.
/// Type: Severity [or Fault where "when"] "id", "page.md", (parameters),
///     "sentence with {parameters}" [+ "advice that ends the sentence" | ; "advice beside it"]
/// ```
macro_rules! notices {
    ($(
        $(#[doc = $why:literal])+
        $name:ident: $severity:ident $(or Fault where $grave:literal)? $id:literal, $page:literal,
        ($($parameter:ident),*), $says:literal $(+ $spoken:literal)? $(; $advice:literal)?
    )*) => {
        $(
            $(#[doc = $why])+
            #[allow(non_camel_case_types, clippy::struct_field_names, reason = "a parameter's type is named as it is")]
            pub(crate) struct $name<$($parameter),*> { $(pub(crate) $parameter: $parameter),* }

            #[allow(non_camel_case_types, reason = "as above")]
            impl<$($parameter: std::fmt::Display),*> $name<$($parameter),*> {
                pub(crate) fn notice(self) -> $crate::findings::Notice {
                    let Self { $($parameter),* } = self;
                    let text = format!(concat!($says $(, $spoken)?), $($parameter = $parameter),*);
                    $crate::findings::Notice::new($id, $crate::findings::Severity::$severity, text)
                }
            }
        )*

        /// The rows of this table.
        pub(crate) const NOTICES: &[$crate::findings::notice::NoticeRow] = &[$(
            $crate::findings::notice::NoticeRow {
                id: $id,
                severity: $crate::findings::Severity::$severity,
                fault_where: [$(Some($grave),)? None][0],
                says: concat!($says $(, $spoken)?),
                why: concat!($($why),+),
                advice: concat!($($spoken)? $($advice)?),
                page: $page,
            }
        ),*];
    };
}
pub(crate) use notices;

/// The list as it is shown: the gravest first, otherwise as it was made, nothing twice.
pub fn ranked(warnings: impl IntoIterator<Item = Notice>) -> Vec<Notice> {
    let mut list: Vec<Notice> = Vec::new();
    for warning in warnings {
        if !list.contains(&warning) {
            list.push(warning);
        }
    }
    list.sort_by_key(|warning| std::cmp::Reverse(warning.severity));
    list
}

/// How many there are of each severity: "1 fault, 3 warnings, 1 note", or "no warnings".
pub fn count_words(warnings: &[Notice]) -> String {
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

    notices! {
        /// Deep
        /// cuts.
        Deep: Warning or Fault where "it is deeper than a gouge" "flank.deep", "results.md", (depth_um, tooth),
            "tooth {tooth} is cut {depth_um} um deep: " + "leave more stock"
        /// One.
        Plain: Note "flank.plain", "results.md", (), "nothing else"; "nothing to change"
    }

    fn made(severity: Severity, text: &str) -> Notice {
        Notice::new("flank.made", severity, text)
    }

    #[test]
    fn the_gravest_comes_first_and_nothing_twice() {
        use Severity::{Fault, Note, Warning};
        let list = ranked([
            made(Note, "a"),
            made(Warning, "b"),
            made(Warning, "b"),
            made(Fault, "c"),
            made(Warning, "b").about("texture"),
        ]);
        let lines: Vec<String> = list.iter().map(Notice::line).collect();
        assert_eq!(lines, ["fault: c", "warning: b", "warning: b", "note: a"]);
        assert_eq!(count_words(&list), "1 fault, 2 warnings, 1 note");
        assert_eq!(count_words(&[]), "no warnings");
    }

    #[test]
    fn pages_read_signs() {
        let note = made(Severity::Note, "5 um deep at 3 deg of roll");
        assert_eq!(note.with_signs().text, "5 µm deep at 3° of roll");
    }

    #[test]
    fn a_row_is_said_with_its_parameters() {
        let deep = || Deep { depth_um: 3.5, tooth: "7 left" }.notice();
        let line = "tooth 7 left is cut 3.5 um deep: leave more stock";
        assert_eq!(deep().line_with_id(), format!("warning: {line} [flank.deep]"));
        assert_eq!(deep().fault_where(true).line(), format!("fault: {line}"));
        assert_eq!(Plain {}.notice().line(), "note: nothing else");
        let [deep, plain] = NOTICES else { panic!("two rows") };
        assert_eq!([deep.why, deep.advice], [" Deep cuts.", "leave more stock"]);
        assert_eq!([deep.fault_where, plain.fault_where], [Some("it is deeper than a gouge"), None]);
        assert_eq!([plain.says, plain.advice], ["nothing else", "nothing to change"]);
    }
}
