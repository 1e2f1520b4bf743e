//! The table of all quantities: what processes share and what each adds, as one list and as a page of the docs.
//!
//! In: the groups of [`crate::findings::quantities`], of every process, and of the commands that have results of their
//! own. Out: [`groups`], and [`markdown`], which is `docs/quantities.md`.

use crate::findings::quantities::SHARED;
use crate::findings::{QuantityGroup, QuantityRow, unit};
use crate::process::PROCESSES;
use crate::wrap::wrapped;
use crate::{compare, influence, pair_job, scatter, study, texture};
use std::fmt::Write as _;

/// Widest line of the page but for tables, characters.
const COLUMNS: usize = 120;

/// All groups, those that processes share first.
pub fn groups() -> Vec<&'static QuantityGroup> {
    let own = PROCESSES.iter().flat_map(|process| process.quantities);
    let others = [
        texture::quantities::QUANTITIES,
        pair_job::quantities::QUANTITIES,
        influence::quantities::QUANTITIES,
        scatter::quantities::QUANTITIES,
        study::quantities::QUANTITIES,
        compare::quantities::QUANTITIES,
    ];
    SHARED.iter().chain(own).chain(others.into_iter().flatten()).copied().collect()
}

/// The page of the docs.
pub fn markdown() -> String {
    let lead = "What `results.json` and tables can hold: key, symbol, unit, definition, and the reasons for which \
        there may be no value. The same key is the same quantity in every process. `<...>` is a name of the scene or a \
        number. This page is printed from the table in the source.";
    let mut page = format!("# Quantities\n\n{}", paragraph(lead));
    for group in groups() {
        let place = paragraph(&format!("Where: {}.", group.place.replace('<', "\\<")));
        let _ = write!(page, "\n## {}\n\n{place}\n", group.title);
        page.push_str("| key | symbol | unit | definition | no value because |\n| --- | --- | --- | --- | --- |\n");
        for row in group.rows {
            page.push_str(&line(row));
        }
    }
    page
}

/// Lines of a page.
fn paragraph(words: &str) -> String {
    wrapped(words, COLUMNS).join("\n") + "\n"
}

fn line(row: &QuantityRow) -> String {
    let unit = if row.unit.is_empty() { "words".to_owned() } else { unit::signs(row.unit) };
    let source = if row.source.is_empty() { String::new() } else { format!(" ({})", row.source) };
    let cells = [
        format!("`{}`", row.key),
        row.symbol.to_owned(),
        unit,
        format!("{}{source}", unit::sentence_with_signs(row.definition)),
        row.reasons.join("; "),
    ];
    format!("| {} |\n", cells.map(|cell| cell.replace('|', "\\|")).join(" | "))
}
