//! The errors that the cut followed, on the page.

use super::quantities;
use crate::findings::quantities::program::MACHINE_ERRORS;
use crate::findings::{self, Findings, unit};
use crate::output::report::{Block, PageSection, PageTable, Tone};

/// The layers that are on, and where to learn what each of them does; none on a machine without errors.
pub fn section(found: &Findings) -> Option<PageSection> {
    let section = found.group(&MACHINE_ERRORS)?;
    let rows = section.entries.iter().map(|entry| {
        let words = entry.quantity.words().unwrap_or_default();
        vec![entry.heading(), unit::sentence_with_signs(words), unit::sentence_with_signs(entry.quantity.definition())]
    });
    let table = PageTable {
        caption: "Layers of errors that are on".to_owned(),
        columns: ["Layer", "Sizes", "What it is"].map(str::to_owned).into(),
        rows: rows.collect(),
    };
    let layers: Vec<String> = section.entries.iter().map(findings::Entry::heading).collect();
    let command = Block::Note(
        "What each layer makes alone, what is left without it, and how gears of other seeds scatter: gearcut scatter \
         SCENE."
            .to_owned(),
    );
    let turn = section.sections.iter().map(|turn| Block::Table(quantities::table(turn)));
    Some(
        PageSection::new(
            "machine-errors",
            section.title.clone(),
            "The cut followed them, the target does not: every deviation on this page has them in it.",
            [Block::Table(table)].into_iter().chain(turn).chain([command]).collect(),
        )
        .judged(Tone::Aside, format!("on: {}", layers.join(", "))),
    )
}
