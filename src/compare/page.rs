//! The comparison as a page: `report.html`.
//!
//! In: the comparison, its charts and difference maps. Out: a [`Page`] that opens offline: what changed most, the maps,
//! the charts, and every line of headline and summary. Every detail stands in `comparison.csv` beside it.

use super::lines::Line;
use super::maps::MapSheet;
use super::notices::{HasFaults, HasNotices, Stopped};
use super::{Comparison, ranked};
use crate::findings::notice::{Severity, count_words};
use crate::findings::{Level, unit};
use crate::output::bar_chart::BarChart;
use crate::output::line_chart::LineChart;
use crate::output::report::{Block, KeyNumber, Page, PageSection, PageTable, Tone};

/// Numbers that stand at the head of the page.
const HEAD: usize = 4;

/// The page.
pub(super) fn page(
    of: &Comparison,
    bars: Vec<(String, BarChart)>,
    curves: Vec<(String, LineChart)>,
    maps: Vec<MapSheet>,
) -> Page {
    let names: Vec<&str> = of.results.iter().map(|one| one.name.as_str()).collect();
    let ranked = ranked::ranked(&of.lines, &ranked::limits_um(&of.results));
    let first: Vec<&Line> = ranked.iter().take(ranked::FIRST).map(|(line, _)| *line).collect();
    let lines: Vec<&Line> = of.lines.iter().filter(|line| line.level <= Level::Summary).collect();
    let mut changed = Vec::new();
    if !first.is_empty() {
        changed.push(Block::Table(table(of, "Changed most", first.iter().copied())));
    }
    let words = of.beside_changes(!first.is_empty());
    changed.extend((!words.is_empty()).then(|| Block::Note(format!("{}.", words.join("; ")))));
    let maps: Vec<Block> = maps
        .into_iter()
        .map(|map| match map.png {
            Some(png) => Block::Picture(map.title, png),
            None => Block::Note(format!("{}.", map.title)),
        })
        .collect();
    let charts = bars.into_iter().map(|(_, chart)| Block::Bars(chart));
    let charts: Vec<Block> = charts.chain(curves.into_iter().map(|(_, chart)| Block::Lines(chart))).collect();
    let sections = [
        PageSection::new(
            "changed",
            "What changed most",
            "The largest differences from the first result, over the limit where a figure has one, else over the \
             larger of both values.",
            changed,
        ),
        PageSection::new(
            "maps",
            "Difference maps",
            "Deviations of every finished flank, and the allowance before the last operation, less those of the first \
            result, each to one scale. Flanks that lie on other grids are left out.",
            maps,
        ),
        PageSection::new("charts", "Side by side", "", charts),
        PageSection::new(
            "all",
            "Headline and summary",
            "Every other number is in comparison.csv beside this page, with unit and definition.",
            vec![Block::Table(table(of, "Headline and summary", lines.iter().copied()))],
        )
        .judged(Tone::Aside, format!("{} numbers side by side", lines.len())),
    ];
    let stopped = of.results.iter().filter(|one| !one.findings.complete);
    let stopped = stopped.map(|one| Stopped { name: &one.name }.notice());
    // A page without a word of them would call results with faults sound.
    let warned = of.results.iter().filter(|one| !one.findings.warnings.is_empty());
    let warned = warned.map(|one| {
        let warnings = &one.findings.warnings;
        let (name, counts) = (&one.name, count_words(warnings));
        let faulty = warnings.iter().any(|warning| warning.severity == Severity::Fault);
        if faulty { HasFaults { name, counts }.notice() } else { HasNotices { name, counts }.notice() }
    });
    Page {
        what: "comparison",
        done: "compared",
        title: names.join(" and "),
        subtitle: format!("results of {}", of.results[0].findings.process),
        operations: of.results.iter().map(|one| format!("{}: scene {}", one.name, one.findings.scene)).collect(),
        complete: true,
        program: format!("gearcut {}", env!("CARGO_PKG_VERSION")),
        key_numbers: first.iter().take(HEAD).map(|line| key_number(of, line)).collect(),
        warnings: stopped.chain(warned).collect(),
        viewer: None,
        sections: sections.into_iter().filter(|section| !section.blocks.is_empty()).collect(),
    }
}

fn table<'a>(of: &Comparison, caption: &str, lines: impl Iterator<Item = &'a Line>) -> PageTable {
    let mut rows = of.printed_rows(lines).into_iter().map(with_signs);
    let columns = rows.next().unwrap_or_default();
    PageTable { caption: caption.to_owned(), columns, rows: rows.collect() }
}

/// A row of the terminal with the signs of a page: numbers with their minus, the unit, which comes last, with its own.
fn with_signs(mut row: Vec<String>) -> Vec<String> {
    let last = row.len() - 1;
    row[last] = unit::signs(&row[last]);
    for cell in &mut row[1..last] {
        if let Some(number) = cell.strip_prefix('-').filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit())) {
            *cell = format!("\u{2212}{number}");
        }
    }
    row
}

fn key_number(of: &Comparison, line: &Line) -> KeyNumber {
    let rows = of.printed_rows(std::iter::once(line));
    let cells = with_signs(rows[1].clone());
    let values = &cells[1..=of.results.len()];
    KeyNumber {
        name: line.title.clone(),
        value: values.join(" \u{2192} "),
        unit: cells[cells.len() - 1].clone(),
        definition: line.either().map_or_else(String::new, |quantity| quantity.definition().to_owned()),
        note: if line.name == line.key() {
            String::new()
        } else {
            line.name.replace('.', " \u{203a} ").replace('_', " ")
        },
        place: None,
    }
}
