//! All notices: the table of their tables, what a command line denies and allows of them, and `docs/notices.md`.
//!
//! In: the rows of every subject and process. Out: rows by id, the verdict on a list of notices, the page with what
//! each says, why it matters and what to change.

use crate::findings::notice::NoticeRow;
use crate::findings::{Notice, Severity};
use crate::process::PROCESSES;
use crate::wrap::wrapped;
use std::str::FromStr;
use strsim::normalized_damerau_levenshtein;

/// Likeness from which an id is worth proposing: half of the letters in common.
const LIKE_ENOUGH: f64 = 0.5;
/// Letters of a line of the page.
const COLUMNS: usize = 120;

/// What the page begins with.
const INTRODUCTION: &str = "\
# Notices

What `check`, `axes`, `cut`, the page, `results.json` and the heads of programs warn of: what each notice
says (parameters in braces), why it matters, and what to change. `results.json` and the terminal give its id.

`--deny ID` and `--allow ID` of `check`, `cut`, `axes` and `pair` set exit codes: a notice that is denied ends with
exit code 3, a fault that is allowed does not. ID is an id of this page, or the beginning of several and a star, such
as `'texture.*'`. Where both name a notice, the longer name decides; of two alike the one that is denied.

This page is printed from the table of notices: `GEARCUT_BLESS=1 cargo test --test suite notices`.
";

/// All rows: what processes share, every process in its order, then what follows a cut.
pub fn rows() -> impl Iterator<Item = &'static NoticeRow> {
    let following = [
        crate::pair_job::notices::NOTICES,
        crate::influence::notices::NOTICES,
        crate::deviations::notices::NOTICES,
        crate::scatter::notices::NOTICES,
        crate::study::notices::NOTICES,
        crate::compare::notices::NOTICES,
    ];
    let of_processes = PROCESSES.iter().map(|process| process.notices);
    std::iter::once(crate::findings::notices::NOTICES).chain(of_processes).chain(following).flatten()
}

/// An id, or the beginning of ids and a star, such as `texture.*`; it covers one notice at least.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NoticePattern(String);

impl NoticePattern {
    /// How many letters of an id it names, one more where that is the whole; none where it does not cover the id.
    fn covers(&self, id: &str) -> Option<usize> {
        match self.0.strip_suffix('*') {
            Some(beginning) => id.starts_with(beginning).then_some(beginning.len()),
            None => (self.0 == id).then_some(id.len() + 1),
        }
    }
}

impl FromStr for NoticePattern {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let pattern = Self(text.to_owned());
        if rows().any(|row| pattern.covers(row.id).is_some()) {
            return Ok(pattern);
        }
        let names = rows().flat_map(|row| [row.id.to_owned(), format!("{}.*", group(row.id))]);
        let likeness = names.map(|name| (normalized_damerau_levenshtein(&name, text), name));
        let nearest = likeness.filter(|(like, _)| *like >= LIKE_ENOUGH).max_by(|a, b| a.0.total_cmp(&b.0));
        let proposed = nearest.map_or_else(|| ";".to_owned(), |(_, name)| format!("; did you mean {name}?"));
        Err(format!("no notice has this id{proposed} docs/notices.md lists them"))
    }
}

/// Which notices make a verdict bad: faults, but for what is allowed, and what is denied. Where both cover a notice,
/// the one that names more of its id decides; of two alike what is denied.
#[derive(Debug, Clone, Default)]
pub struct NoticeRules {
    /// What makes the verdict bad, whatever its severity.
    pub denied: Vec<NoticePattern>,
    /// Faults that do not.
    pub allowed: Vec<NoticePattern>,
}

impl NoticeRules {
    /// Whether a notice makes the verdict bad.
    pub fn is_bad(&self, notice: &Notice) -> bool {
        let named = |patterns: &[NoticePattern]| patterns.iter().filter_map(|of| of.covers(&notice.id)).max();
        match (named(&self.denied), named(&self.allowed)) {
            (None, None) => notice.severity == Severity::Fault,
            (denied, allowed) => denied >= allowed,
        }
    }
}

/// Subject of an id.
fn group(id: &str) -> &str {
    id.split_once('.').map_or(id, |(group, _)| group)
}

/// `docs/notices.md`.
pub fn markdown() -> String {
    let mut rows: Vec<&NoticeRow> = rows().collect();
    rows.sort_by_key(|row| row.id); // rows of one id stay in order
    let mut text = vec![INTRODUCTION.to_owned()];
    let (mut last_group, mut last_id) = ("", "");
    for row in rows {
        if group(row.id) != last_group {
            last_group = group(row.id);
            text.push(format!("\n## {last_group}\n"));
        }
        if row.id != last_id {
            last_id = row.id;
            text.push(format!("\n### `{last_id}`\n"));
        }
        let mut paragraph = |words: &str, margin: &str| {
            let lines = wrapped(words, COLUMNS - margin.len()).into_iter().map(|line| format!("{margin}{line}\n"));
            text.push(format!("\n{}", lines.collect::<String>()));
        };
        paragraph(row.says, "> ");
        let severity = match row.fault_where {
            Some(when) => format!("A {}; a fault where {when}.", row.severity.name()),
            None => format!("A {}.", row.severity.name()),
        };
        let advice = if row.says.ends_with(row.advice) { String::new() } else { format!(" {}", row.advice) };
        let page = row.page.trim_end_matches(".md");
        paragraph(&format!("{severity} {}{advice} See [{page}]({}).", row.why.trim(), row.page), "");
    }
    text.concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn rules(denied: &[&str], allowed: &[&str]) -> NoticeRules {
        let read = |texts: &[&str]| texts.iter().map(|text| text.parse().expect("an id")).collect();
        NoticeRules { denied: read(denied), allowed: read(allowed) }
    }

    #[test]
    fn rows_are_whole_and_rows_of_one_id_weigh_the_same() {
        for row in rows() {
            let id = row.id;
            assert!(
                id.split('.').count() == 2 && id.chars().all(|c| c.is_ascii_lowercase() || "._".contains(c)),
                "{id}"
            );
            assert!(row.why.trim().ends_with('.') && !row.advice.is_empty(), "{id} says why and what to change");
            assert!(row.says.ends_with(row.advice) || row.advice.ends_with(['.', '?']), "{id}: {}", row.advice);
            assert!(Path::new("docs").join(row.page).exists(), "{id}: {} is no page", row.page);
            for other in rows().filter(|other| other.id == id) {
                assert_eq!(other.severity, row.severity, "{id}");
                assert!(std::ptr::eq(other, row) || other.says != row.says, "{id} says one thing twice");
            }
        }
        assert!(rows().count() > 80);
    }

    #[test]
    fn the_longer_name_decides() {
        let of = |id: &'static str, severity| Notice::new(id, severity, "");
        let gouge = of("flank.gouge", Severity::Fault);
        let marks = of("texture.few_marks", Severity::Note);
        let none = rules(&[], &[]);
        assert!(none.is_bad(&gouge) && !none.is_bad(&marks));
        assert!(!rules(&[], &["flank.*"]).is_bad(&gouge) && rules(&["texture.*"], &[]).is_bad(&marks));
        assert!(rules(&["flank.gouge"], &["flank.*"]).is_bad(&gouge));
        assert!(!rules(&["*"], &["texture.few_marks"]).is_bad(&marks) && rules(&["*"], &[]).is_bad(&marks));
        assert!(rules(&["flank.gouge"], &["flank.gouge"]).is_bad(&gouge), "of two alike what is denied");
        assert!(!rules(&["hob.*"], &[]).is_bad(&marks));
    }

    #[test]
    fn an_unknown_id_is_refused_with_the_nearest() {
        let refused = |text: &str| text.parse::<NoticePattern>().expect_err("no id");
        assert!(refused("flank.guge").contains("did you mean flank.gouge?"), "{}", refused("flank.guge"));
        assert!(refused("textur.*").contains("did you mean texture.*?"), "{}", refused("textur.*"));
        assert!(!refused("zzzzzzzz").contains("did you mean"));
    }
}
