//! The ring on the page: what the cutter can do in it, along the pitch curve.

use crate::findings::{Findings, Table};
use crate::output::line_chart::{LineChart, Panel};
use crate::output::report::{Block, PageSection};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::findings::answers;
use crate::steps::axes::charts::panel;

/// The section; none for an external gear.
pub fn section(job: &ShapingJob, found: &Findings) -> Option<PageSection> {
    let ring = found.find("ring")?;
    let table = ring.table_of("teeth")?;
    let mut blocks = Vec::new();
    let withheld = ring.entries.first().and_then(|entry| entry.quantity.why());
    if withheld.is_none() {
        blocks.push(Block::Table(answers::table(ring, "Before cutting")));
    }
    if let Some(why) = withheld {
        blocks.push(Block::Note(format!("What is told of the cutter in the ring is {why}.")));
    } else if table.rows.len() > 1 {
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
        "ring",
        "The cutter in the ring",
        "What was known before cutting: where the cutter rolls and how large the module may be, how far its \
               involute reaches on the flanks and how far its base sets the tips back, and how near its tip corners \
               come to the teeth beside their space.",
        blocks,
    ))
}

fn panels(job: &ShapingJob, table: &Table) -> Vec<Panel> {
    let curve = |key: &str| {
        let value = |value: Option<f64>| value.unwrap_or(f64::NAN);
        table.numbers("phi").map(value).zip(table.numbers(key).map(value)).collect::<Vec<_>>()
    };
    let two = |names: [&'static str; 2], keys: [&str; 2]| {
        names.into_iter().zip(keys.map(curve)).collect::<Vec<(&str, Vec<(f64, f64)>)>>()
    };
    let flanks = |stem: &str| {
        let [left, right] = ["left", "right"].map(|side| format!("{stem}_{side}"));
        two(["left flanks", "right flanks"], [&left, &right])
    };
    vec![
        panel(
            ["radius of curvature", "mm"],
            vec![("pitch curve", curve("radius_of_curvature"))],
            [("pitch radius of the cutter", job.cutter.pitch_radius_mm)],
        ),
        panel(
            ["limit of the module", "mm"],
            two(["the cutter rolls", "printed condition of undercut"], ["rolling_module", "printed_module"]),
            [("module", job.scene.gear.module_mm)],
        ),
        panel(["flanks begin at height", "mm"], flanks("start"), []),
        panel(["flanks end at height", "mm"], flanks("involute"), [("tip", job.blank.addendum_mm)]),
        panel(["tips set back", "µm"], flanks("tip_relief"), []),
        panel(
            ["room of tip corners", "mm"],
            two(["on the way in", "on the way out"], ["corners_in", "corners_out"]),
            [("cuts below", 0.0)],
        ),
    ]
}
