//! The return strokes on the page: what was known of them before cutting.

use crate::findings::quantities::OPERATIONS;
use crate::findings::{Findings, Quantity, QuantityRow, Section};
use crate::output::line_chart::{LineChart, Panel};
use crate::output::report::{Block, PageSection, Tone};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::findings::answers;
use crate::process::shaping::quantities::returns::{
    ANGLE_AT, CLEARANCE_AT, DEPTH_AT, DIRECTION, PHI, RETRACTION_ANGLE, RETURN_PLACES, RETURN_STROKES,
};
use crate::steps::axes::charts::panel;

/// The section; none where the cutter is not drawn back.
pub fn section(job: &ShapingJob, found: &Findings) -> Option<PageSection> {
    let operations = found.parts(&OPERATIONS);
    let returns: Vec<(&str, &Section)> =
        operations.iter().filter_map(|of| Some((of.key.as_str(), of.group(&RETURN_STROKES)?))).collect();
    let direction = returns.first()?.1.text(&DIRECTION).to_owned();
    let blocks = returns.iter().flat_map(|&(name, section)| {
        let first = match section.of(&RETRACTION_ANGLE).and_then(Quantity::why) {
            Some(why) => Block::Note(format!("Return strokes of {name}: {why}.")),
            None => Block::Table(answers::table(section, &format!("Return strokes of {name}"))),
        };
        std::iter::once(first).chain(chart(job, name, section).map(Block::Lines))
    });
    let mut changed: Vec<&str> = returns.iter().flat_map(|(_, section)| answers::changes(section)).collect();
    changed.sort_unstable();
    changed.dedup();
    let known = returns.iter().all(|(_, section)| section.value(&RETRACTION_ANGLE).is_some());
    let (tone, words) = match (known, changed.is_empty()) {
        (false, _) => (Tone::Aside, "no findings".to_owned()),
        (true, true) => (Tone::Fine, "nothing to change".to_owned()),
        (true, false) => (Tone::Wrong, format!("a change is advised: {}", changed.join(", "))),
    };
    Some(PageSection::new(
        "returns",
        "Return strokes",
        format!(
            "For the return stroke the cutter is drawn back {direction}. What was known before cutting, of ideal work \
             and cutter; what the strokes of this run met is in results.json, under blank."
        ),
        blocks.collect(),
    )
    .judged(tone, words))
}

/// Over one period of the pitch curve.
fn chart(job: &ShapingJob, name: &str, section: &Section) -> Option<LineChart> {
    let table = section.table_of(&RETURN_PLACES).filter(|table| !table.is_empty())?;
    let curve = |row: &QuantityRow| table.points(&PHI, row);
    let pressure_deg = job.transverse.pressure_angle_rad.to_degrees();
    Some(LineChart {
        title: format!("{name} of {}: return strokes over one period of the pitch curve", job.scene.name),
        x_name: "polar angle φ".to_owned(),
        x_unit: "°".to_owned(),
        panels: vec![
            panel(
                ["retraction angle", "°"],
                vec![("normal to line of centres, positive where the radius grows", curve(&ANGLE_AT))],
                [("pressure angle", pressure_deg), ("pressure angle", -pressure_deg)],
            ),
            no_finer_than_um(panel(
                ["clearance from the teeth", "µm"],
                vec![("nearest edge", curve(&CLEARANCE_AT))],
                [("rubs below", 0.0)],
            )),
            no_finer_than_um(panel(["depth in stock", "µm"], vec![("deepest edge", curve(&DEPTH_AT))], [])),
        ],
    })
}

/// A panel whose ticks stand a micrometre apart at least: on a circle the room repeats from place to place, and its
/// last nanometres are the survey's own.
fn no_finer_than_um(panel: Panel) -> Panel {
    Panel { least_division: 1.0, ..panel }
}
