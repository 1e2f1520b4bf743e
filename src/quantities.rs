//! The table of all quantities: what processes share and what each adds, as one list and as a page of the docs.
//!
//! In: the groups of [`crate::findings::quantities`], of every process, and of the commands that have results of their
//! own. Out: [`groups`], and [`markdown`], which is `docs/quantities.md`.

use crate::findings::quantities::SHARED;
use crate::findings::{QuantityGroup, QuantityRow, unit};
use crate::measure::topography::{Parameter, parameters};
use crate::process::PROCESSES;
use crate::wrap::wrapped;
use crate::{compare, deviations, influence, pair_job, scatter, study, texture};
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
        deviations::quantities::QUANTITIES,
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
        section(&mut page, group.title, group.place, group.rows.iter().map(|row| line(row)));
    }
    for (title, place, list) in parameters() {
        section(
            &mut page,
            title,
            place,
            list.iter().map(|of| cells(&of.symbol, &of.symbol, of.unit, &of.definition, "")),
        );
    }
    page
}

/// Parameters of surface texture: title, place, and what there is.
pub fn parameters() -> [(&'static str, &'static str, Vec<Parameter>); 2] {
    let [areal, profile] = parameters::all().unwrap_or_default();
    [
        ("Areal parameters (ISO 25178-2)", "texture.<operation>.<window>.parameters", areal),
        ("Profile parameters (ISO 21920-2)", "roughness.<operation>.<window and direction>", profile),
    ]
}

fn section(page: &mut String, title: &str, place: &str, lines: impl Iterator<Item = String>) {
    let place = paragraph(&format!("Where: {}.", place.replace('<', "\\<")));
    let _ = write!(page, "\n## {title}\n\n{place}\n");
    page.push_str("| key | symbol | unit | definition | no value because |\n| --- | --- | --- | --- | --- |\n");
    page.extend(lines);
}

/// Lines of a page.
fn paragraph(words: &str) -> String {
    wrapped(words, COLUMNS).join("\n") + "\n"
}

fn line(row: &QuantityRow) -> String {
    let source = if row.source.is_empty() { String::new() } else { format!(" ({})", row.source) };
    let definition = format!("{}{source}", row.definition);
    cells(row.key, row.symbol, row.unit, &definition, &row.reasons.join("; "))
}

fn cells(key: &str, symbol: &str, unit: &str, definition: &str, reasons: &str) -> String {
    let unit = if unit.is_empty() { "words".to_owned() } else { unit::signs(unit) };
    let definition = unit::sentence_with_signs(definition);
    let cells = [format!("`{key}`"), symbol.to_owned(), unit, definition, reasons.to_owned()];
    format!("| {} |\n", cells.map(|cell| cell.replace('|', "\\|")).join(" | "))
}
