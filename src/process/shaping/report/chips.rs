//! Chips and cutting forces on the page.

use crate::findings::Findings;
use crate::findings::quantities::OPERATIONS;
use crate::findings::quantities::cutting::LARGEST_FORCE;
use crate::output::report::{Block, PageSection, Tone};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::cut::chips::ChipLedger;
use crate::process::shaping::quantities::strokes::{DEFLECTION, VIBRATION};
use crate::process::shaping::quantities::{CHIPS, LARGEST_SECTION};
use crate::process::shaping::report::chip_charts::charts;
use crate::steps::report::{headline_words, quantities};

/// What the strokes of every operation take, and what that asks of cutter and machine.
pub fn section(job: &ShapingJob, ledger: &ChipLedger, found: &Findings) -> PageSection {
    let operations = found.parts(&OPERATIONS);
    let blocks = operations.iter().enumerate().filter_map(|(index, operation)| {
        let chips = operation.group(&CHIPS)?;
        let mut charts = charts(job, ledger, index).into_iter().map(|(_, chart)| Block::Lines(chart));
        let heading = Block::Heading(format!("{}: chips and cutting forces", operation.key));
        let mut blocks = vec![heading];
        blocks.extend(charts.next());
        blocks.push(Block::Table(quantities::table(chips)));
        let along: Vec<Block> = charts.next().into_iter().collect();
        blocks.push(Block::Folded("Thickness and contact along the edge".to_owned(), along));
        if let Some(deflection) = operation.group(&DEFLECTION) {
            blocks.push(Block::Heading(format!("{}: deflection of cutter and work", operation.key)));
            blocks.extend(charts);
            blocks.push(Block::Table(quantities::table(deflection)));
        }
        if let Some(vibration) = operation.group(&VIBRATION) {
            blocks.push(Block::Heading(format!("{}: vibration of cutter and work", operation.key)));
            blocks.push(Block::Table(quantities::table(vibration)));
        }
        Some(blocks)
    });
    PageSection::new(
        "chips",
        "Chips and forces",
        "What every stroke takes, from the chip ledger, and the force and torques that follow from the material \
            (tables/chips_<operation>.csv has every stroke, chips/ maps along the edge).",
        blocks.flatten().collect(),
    )
    .judged(Tone::Aside, headline_words(found, &[&LARGEST_SECTION, &LARGEST_FORCE]))
}
