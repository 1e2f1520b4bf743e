//! The ring on the page: what the cutter can do in it, along the pitch curve.

use crate::findings::{Findings, QuantityRow, Table};
use crate::output::line_chart::{LineChart, Panel};
use crate::output::report::{Block, PageSection};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::findings::answers;
use crate::process::shaping::quantities::ring::{
    CORNERS_IN, CORNERS_OUT, INVOLUTE_LEFT, INVOLUTE_RIGHT, PHI, PRINTED_MODULE, RADIUS, RING, RING_TEETH,
    ROLLING_MODULE, START_LEFT, START_RIGHT, TIP_RELIEF_LEFT, TIP_RELIEF_RIGHT,
};
use crate::steps::axes::charts::panel;

/// The section; none for an external gear.
pub fn section(job: &ShapingJob, found: &Findings) -> Option<PageSection> {
    let ring = found.group(&RING)?;
    let table = ring.table_of(&RING_TEETH)?;
    let mut blocks = Vec::new();
    let withheld = ring.entries.first().and_then(|entry| entry.quantity.why());
    if withheld.is_none() {
        blocks.push(Block::Table(answers::table(ring, "Before cutting")));
    }
    if let Some(why) = withheld {
        blocks.push(Block::Note(format!("Findings on the cutter in the ring: {why}.")));
    } else if table.len() > 1 {
        blocks.push(Block::Lines(LineChart {
            title: format!("{}: the cutter in the ring, over one period of the pitch curve", job.scene.name),
            x_name: "polar angle φ".to_owned(),
            x_unit: "°".to_owned(),
            panels: panels(job, table),
        }));
    } else {
        blocks.push(Block::Note("The pitch curve is a circle: all this is the same on every tooth.".to_owned()));
    }
    Some(PageSection::new(
        RING.key,
        "The cutter in the ring",
        "What was known before cutting: where the cutter rolls and how large the module may be, how far its \
               involute reaches on the flanks and how far its base sets the tips back, and how near its tip corners \
               come to the teeth beside their space.",
        blocks,
    ))
}

fn panels(job: &ShapingJob, table: &Table) -> Vec<Panel> {
    let curve = |row: &QuantityRow| table.points(&PHI, row);
    let two = |names: [&'static str; 2], rows: [&QuantityRow; 2]| names.into_iter().zip(rows.map(curve)).collect();
    let flanks = |rows| two(["left flanks", "right flanks"], rows);
    vec![
        panel(
            ["radius of curvature", "mm"],
            vec![("pitch curve", curve(&RADIUS))],
            [("pitch radius of the cutter", job.cutter.pitch_radius_mm)],
        ),
        panel(
            ["limit of the module", "mm"],
            two(["the cutter rolls", "printed condition of undercut"], [&ROLLING_MODULE, &PRINTED_MODULE]),
            [("module", job.scene.gear.module_mm)],
        ),
        panel(["flanks begin at height", "mm"], flanks([&START_LEFT, &START_RIGHT]), []),
        panel(
            ["flanks end at height", "mm"],
            flanks([&INVOLUTE_LEFT, &INVOLUTE_RIGHT]),
            [("tip", job.blank.addendum_mm)],
        ),
        panel(["tips set back", "µm"], flanks([&TIP_RELIEF_LEFT, &TIP_RELIEF_RIGHT]), []),
        panel(
            ["room of tip corners", "mm"],
            two(["on the way in", "on the way out"], [&CORNERS_IN, &CORNERS_OUT]),
            [("cuts below", 0.0)],
        ),
    ]
}
