//! The whole gear from rays through the blank, on the page: volumes, gouges, interference, rubbing, faulty strokes.

use super::quantities;
use crate::findings::{Findings, Section};
use crate::output::report::{Block, PageSection};

/// The section; none where the whole blank was not cut.
pub fn section(found: &Findings) -> Option<PageSection> {
    let blank = found.find("blank")?;
    let part = |section: &Section| {
        let own = (!section.entries.is_empty()).then(|| Block::Table(quantities::table(section)));
        let inner = section.sections.iter().map(|inner| Block::Table(quantities::table(inner)));
        own.into_iter().chain(inner).collect::<Vec<_>>()
    };
    let mut blocks = vec![Block::Table(quantities::table(blank))];
    blocks.extend(blank.sections.iter().flat_map(part));
    Some(PageSection {
        id: "blank",
        title: "The whole gear".to_owned(),
        lead: "Rays through the whole blank: what was taken, what is left, and where the tool took what should have \
            stayed (tables/damage.csv has every place)."
            .to_owned(),
        blocks,
    })
}
