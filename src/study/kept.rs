//! What a study keeps of a case: quantities by their paths in `results.json`, and words on how it went.
//!
//! In: findings, or the reason why there are none. Out: cells of a row. A key alone is one of the headline; a path is
//! that below `sections`, such as `operations.finish.axes.work_speed.peak`. A `*` is any text without a dot: such
//! paths are written out by the findings of a case.

use crate::findings::{Findings, Quantity, Severity, TableColumn};
use crate::scene::suggest::did_you_mean;
use gearcut_core::error::Refusal;
use std::collections::{BTreeMap, BTreeSet};

/// Cells behind the quantities of a row.
pub const LAST_HEADS: [&str; 5] = ["faults", "warnings", "notices", "missing", "error"];
/// What a reader sees of each of them.
pub const LAST_WORDS: [[&str; 2]; 5] = [
    ["1", "faults among the notices"],
    ["1", "warnings among the notices"],
    ["", "ids of all notices: docs/notices.md"],
    ["", "why kept quantities have no value: their paths, a colon, the reason; a bar between two reasons"],
    ["", "why the case could not be made"],
];
/// Why a quantity has no value that the findings of a case do not have.
const NOT_THERE: &str = "the case does not have it";
/// Between two reasons.
const BAR: &str = " | ";

/// The quantity at a path.
fn quantity<'a>(found: &'a Findings, path: &str) -> Option<&'a Quantity> {
    match path.rsplit_once('.') {
        None => found.headline(path),
        Some((section, key)) => found.at_path(section)?.quantity(key),
    }
}

/// Paths of all quantities.
fn paths(found: &Findings) -> Vec<String> {
    let mut paths: Vec<String> = found.headline.iter().map(|entry| entry.key.clone()).collect();
    found.walk(&mut |path, section| paths.extend(section.entries.iter().map(|entry| format!("{path}.{}", entry.key))));
    paths
}

/// Whether a path fits, `*` for any text without a dot.
fn fits(pattern: &[u8], path: &[u8]) -> bool {
    match pattern.split_first() {
        None => path.is_empty(),
        Some((b'*', rest)) => {
            let longest = path.iter().position(|&letter| letter == b'.').unwrap_or(path.len());
            (0..=longest).any(|taken| fits(rest, &path[taken..]))
        }
        Some((letter, rest)) => path.split_first().is_some_and(|(own, others)| own == letter && fits(rest, others)),
    }
}

/// The columns of kept quantities, known from the findings of a case: paths in the order in which they are kept, those
/// of a pattern in that of the results, none twice.
///
/// # Errors
/// A path that these findings do not have.
pub fn columns(found: &Findings, keep: &[String]) -> Result<Vec<TableColumn>, Refusal> {
    let all = paths(found);
    let mut seen = BTreeSet::new();
    let mut columns = Vec::new();
    for kept in keep {
        let mut own = all.iter().filter(|path| fits(kept.as_bytes(), path.as_bytes())).peekable();
        if own.peek().is_none() {
            return Err(unknown(kept, &all));
        }
        let new = own.filter(|path| seen.insert(*path));
        columns.extend(new.filter_map(|path| Some(column(path, quantity(found, path)?))));
    }
    Ok(columns)
}

fn column(path: &str, of: &Quantity) -> TableColumn {
    TableColumn {
        key: path.to_owned().into(),
        title: path.to_owned().into(),
        unit: of.unit().map(|unit| unit.to_owned().into()),
        definition: of.definition().to_owned().into(),
        why: None,
        chart: None,
    }
}

fn unknown(path: &str, all: &[String]) -> Refusal {
    let last = path.rsplit('.').next().unwrap_or(path);
    // Who knows the key and not the section gets the section: of several the one with most of the names.
    let named = |known: &str| known.split('.').filter(|name| path.split('.').any(|own| own == *name)).count();
    let same = all.iter().rev().filter(|known| known.rsplit('.').next() == Some(last)).max_by_key(|known| named(known));
    let hint = match same {
        Some(same) => format!("; did you mean {same}?"),
        None => did_you_mean(all.iter().map(String::as_str), path),
    };
    let problem = format!("`{path}` is no quantity of these cases{hint}");
    let way_out = "take keys of the headline, or paths below `sections` of results.json: docs/quantities.md";
    Refusal::new("keep", problem, way_out)
}

/// A value as it stands in a file: a number by the shortest text that reads back as the same.
fn text(of: &Quantity) -> String {
    match (of.whole(), of.value()) {
        (Some(count), _) => count.to_string(),
        (None, Some(value)) => format!("{value:?}"),
        (None, None) => of.words().unwrap_or_default().to_owned(),
    }
}

/// How a case went.
pub type CaseOutcome = Result<Findings, String>;

/// Cells of the kept quantities and of how it went, as they stand in a file; a quantity that is not there is empty.
pub fn cells(outcome: &CaseOutcome, paths: &[String]) -> Vec<String> {
    let empty = String::new;
    match outcome {
        Ok(found) => {
            let cell = |path: &String| quantity(found, path).map_or_else(empty, text);
            let count = |severity| found.warnings.iter().filter(|of| of.severity == severity).count().to_string();
            let ids: Vec<&str> = found.warnings.iter().map(|notice| &*notice.id).collect();
            let last =
                [count(Severity::Fault), count(Severity::Warning), ids.join(" "), missing(found, paths), empty()];
            paths.iter().map(cell).chain(last).collect()
        }
        Err(reason) => {
            let last = LAST_HEADS.iter().skip(1).map(|_| empty());
            paths.iter().map(|_| empty()).chain(last).chain([reason.clone()]).collect()
        }
    }
}

/// Which of the kept quantities a case has no value of, and why.
fn missing(found: &Findings, paths: &[String]) -> String {
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for path in paths {
        let why = quantity(found, path).map_or(Some(NOT_THERE), Quantity::why);
        let Some(why) = why else { continue };
        match reasons.iter_mut().find(|(known, _)| *known == why) {
            Some((_, paths)) => paths.push(path),
            None => reasons.push((why, vec![path])),
        }
    }
    let words = |(why, paths): (&str, Vec<&str>)| format!("{}: {}", paths.join(" "), why.replace('|', "/"));
    reasons.into_iter().map(words).collect::<Vec<_>>().join(BAR)
}

/// How many cases have no value of a quantity for a reason, from the cells of rows; in the order of paths and reasons.
pub fn counted_missing<'a>(cells: impl Iterator<Item = &'a str>) -> BTreeMap<[String; 2], usize> {
    let mut counts = BTreeMap::new();
    for part in cells.flat_map(|cell| cell.split(BAR)) {
        let Some((paths, why)) = part.split_once(": ") else { continue };
        for path in paths.split(' ') {
            *counts.entry([path.to_owned(), why.to_owned()]).or_default() += 1;
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_is_any_text_without_a_dot() {
        let star = |pattern: &str, path: &str| fits(pattern.as_bytes(), path.as_bytes());
        assert!(star("teeth.*.left.F_pi", "teeth.tooth_01.left.F_pi") && star("*.*", "a.b") && star("F_*", "F_alpha"));
        assert!(!star("teeth.*.F_pi", "teeth.tooth_01.left.F_pi") && !star("*", "a.b") && !star("F_*", "f_alpha"));
        assert!(star("a*b*c", "axxbyyc") && !star("a*b*c", "axxbyy"));
    }

    #[test]
    fn reasons_are_counted_by_quantity() {
        let cells = ["a b.c: no mark", "", "a: no mark | b.c: it has none: see there"];
        let found = counted_missing(cells.into_iter());
        let expected = [(["a", "no mark"], 2), (["b.c", "it has none: see there"], 1), (["b.c", "no mark"], 1)];
        let expected = expected.map(|([path, why], count)| ([path.to_owned(), why.to_owned()], count));
        assert_eq!(found.into_iter().collect::<Vec<_>>(), expected);
    }
}
