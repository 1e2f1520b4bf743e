//! The ring on the page: what the cutter can do in it, along the pitch curve.

use crate::findings::{Findings, Table};
use crate::output::line_chart::{LineChart, Panel};
use crate::output::report::{Block, PageSection};
use crate::output::text::significant;
use crate::process::shaping::ShapingJob;
use crate::steps::axes::charts::panel;

/// The section; none for an external gear.
pub fn section(job: &ShapingJob, found: &Findings) -> Option<PageSection> {
    let ring = found.find("ring")?;
    let table = ring.table_of("teeth")?;
    let mut blocks = Vec::new();
    if table.rows.len() > 1 {
        blocks.push(Block::Lines(LineChart {
            title: format!("{}: the cutter in the ring, over one period of the pitch curve", job.scene.name),
            x_name: "polar angle φ".to_owned(),
            x_unit: "°".to_owned(),
            panels: panels(job, table),
        }));
    }
    blocks.push(Block::Note(words(ring, job.cutter.teeth)));
    Some(PageSection {
        id: "ring",
        title: "The cutter in the ring".to_owned(),
        lead: "What was known before cutting: where the cutter rolls, how far its involute reaches on the flanks, and \
               how far its base sets the tips back."
            .to_owned(),
        blocks,
    })
}

fn panels(job: &ShapingJob, table: &Table) -> Vec<Panel> {
    let curve = |key: &str| {
        let value = |value: Option<f64>| value.unwrap_or(f64::NAN);
        table.numbers("phi").map(value).zip(table.numbers(key).map(value)).collect::<Vec<_>>()
    };
    let sides = |stem: &str| {
        ["left", "right"].map(|side| (side, curve(&format!("{stem}_{side}")))).into_iter().collect::<Vec<_>>()
    };
    vec![
        panel(
            ["radius of curvature", "mm"],
            vec![("pitch curve", curve("radius_of_curvature"))],
            [("pitch radius of the cutter", job.cutter.pitch_radius_mm)],
        ),
        panel(["involute reaches", "mm"], sides("involute"), [("tip", job.blank.addendum_mm)]),
        panel(["tip relief", "µm"], sides("tip_relief"), []),
    ]
}

fn words(ring: &crate::findings::Section, teeth: u32) -> String {
    let rolling = ring.number("rolling_teeth").map_or("–".to_owned(), |count| significant(count, 3));
    let corners = match ring.number("tip_corner_depth") {
        Some(0.0) => " Its tip corners come clear of the teeth beside their space.".to_owned(),
        Some(mm) => format!(" Its tip corners cut {} mm into teeth beside their space.", significant(mm, 3)),
        None => String::new(),
    };
    format!("The cutter has {teeth} teeth; up to {rolling} roll everywhere.{corners}")
}
