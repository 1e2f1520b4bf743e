//! The comparison of two surfaces as a page: `report.html`.
//!
//! In: the comparison, its maps and charts. Out: a [`Page`] that opens offline: how the second was laid over the first,
//! maps, curves, profiles, parameters.

use crate::findings::unit;
use crate::output::line_chart::LineChart;
use crate::output::report::{Block, KeyNumber, Page, PageSection, PageTable};
use crate::overlay::{SurfaceComparison, correlation_text};

/// Parameters at the head of the page.
const HEAD: [&str; 3] = ["Sa", "Sq", "Sk"];

/// The page.
pub(super) fn page(
    of: &SurfaceComparison,
    maps: Vec<(String, Vec<u8>)>,
    abbott: LineChart,
    profiles: LineChart,
) -> Page {
    let facts = of.facts().into_iter().map(|fact| fact.iter().map(|text| in_signs(text)).collect()).collect();
    let facts = PageTable { caption: "Alignment, marks and chain".to_owned(), columns: Vec::new(), rows: facts };
    let mut table = of.table().into_iter().map(|row| row.iter().map(|cell| in_cell(cell)).collect::<Vec<_>>());
    let columns = table.next().unwrap_or_default();
    let caption = "ISO 25178-2 on the points that both have".to_owned();
    let parameters = PageTable { caption, columns, rows: table.collect() };
    let mut numbers = vec![KeyNumber {
        name: "Correlation".to_owned(),
        value: correlation_text(of.aligned.alignment.correlation),
        unit: String::new(),
        definition: "of the heights of both on the points that they share, their planes off".to_owned(),
        note: String::new(),
        place: None,
    }];
    numbers.extend(HEAD.iter().filter_map(|symbol| {
        let row = parameters.rows.iter().find(|row| row[0] == *symbol)?;
        Some(KeyNumber {
            name: row[0].clone(),
            value: format!("{} \u{2192} {}", row[1], row[2]),
            unit: unit::signs(&row[4]),
            definition: of.rows().into_iter().find(|other| other.symbol == *symbol)?.definition,
            note: String::new(),
            place: None,
        })
    }));
    let pictures = maps.into_iter().map(|(title, png)| Block::Picture(title, png)).collect();
    let sections = vec![
        PageSection::new(
            "alignment",
            "Laid over each other",
            "The second surface is mirrored where that correlates clearly better, shifted and levelled; the first \
             keeps its place.",
            vec![Block::Table(facts)],
        ),
        PageSection::new(
            "maps",
            "Maps",
            "Heights after the chain to one scale, and the difference of the levelled surfaces before it.",
            pictures,
        ),
        PageSection::new("curves", "Curves", "", vec![Block::Lines(abbott), Block::Lines(profiles)]),
        PageSection::new(
            "parameters",
            "Parameters",
            "Both through the same chain; definitions are in comparison.csv beside this page.",
            vec![Block::Table(parameters)],
        ),
    ];
    Page {
        what: "comparison of surfaces",
        done: "compared",
        title: of.names.join(" and "),
        subtitle: "two surfaces of one place".to_owned(),
        operations: of.chain.iter().map(|step| in_signs(step)).collect(),
        complete: true,
        program: format!("gearcut {}", env!("CARGO_PKG_VERSION")),
        key_numbers: numbers,
        warnings: of.doubts(""),
        viewer: None,
        sections,
    }
}

/// Words with the signs of a page for their units.
fn in_signs(words: &str) -> String {
    words.replace(" um", " \u{b5}m").replace(" deg", "\u{b0}")
}

/// A cell of the table: a unit, or a number with the sign of a page.
fn in_cell(cell: &str) -> String {
    match (cell, cell.strip_prefix('-')) {
        (_, Some(number)) => format!("\u{2212}{number}"),
        ("um" | "um^3/um^2" | "1/um" | "1/um^2" | "deg" | "1", _) => unit::signs(cell),
        _ => cell.to_owned(),
    }
}
