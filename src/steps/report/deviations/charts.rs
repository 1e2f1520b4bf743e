//! The lines of an inspection as a table, which `gearcut calibrate` and `gearcut diagnose` read back.
//!
//! In: an inspection. Out: a row for each place of the profiles and helices that the sheet shows, in their evaluated
//! parts, and one for each flank of the cumulative pitch deviations. Profiles and helices stand at the flank's own
//! places u and v, whatever the process calls the places of its traces; their deviations are normal ones, those of
//! pitch arcs of the pitch curve. What is not measured has no row.

use super::{Inspection, SIDES, TracedFlank, traced};
use crate::findings::Table;
use crate::findings::quantities::inspection::{CHART, CHART_DEVIATION, CHART_U, CHART_V};
use crate::findings::quantities::teeth::{FLANK, TOOTH};
use crate::measure::deviation::{Trace, TraceDeviation};
use crate::output::table::write_table;
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use std::path::Path;

/// Places beyond the ends of an evaluated part by no more than this are in it, mm.
const SAME_MM: f64 = 1e-9;

/// A row.
struct ChartPlace {
    chart: &'static str,
    tooth: u32,
    side: Side,
    /// Where a normal deviation is; none of pitch.
    at_mm: Option<[f64; 2]>,
    deviation_mm: f64,
}

/// Writes the table.
///
/// # Errors
/// The file cannot be written.
pub(super) fn write(inspection: &Inspection, path: &Path) -> Result<()> {
    let mut rows = Vec::new();
    for (side, _) in SIDES {
        for flank in traced(inspection, side, |flank| flank.profile.1.map(|of| of.total_mm)) {
            let u_mm = |i: usize| flank.lines.arcs_mm[i];
            rows.extend(line("profile", flank, flank.profile, |i| [u_mm(i), flank.lines.profile_v_mm]));
        }
        for flank in traced(inspection, side, |flank| flank.lead.1.map(|of| of.total_mm)) {
            let v_mm = &flank.lead.0.places_mm;
            rows.extend(line("helix", flank, flank.lead, |i| [flank.lines.lead_arc_mm, v_mm[i]]));
        }
    }
    for (pitch, (side, _)) in inspection.gear.pitch.iter().zip(SIDES) {
        let cumulative = pitch.iter().flat_map(|pitch| &pitch.cumulative_mm);
        rows.extend((1_u32..).zip(cumulative).map(|(tooth, &deviation_mm)| ChartPlace {
            chart: "pitch",
            tooth,
            side,
            at_mm: None,
            deviation_mm,
        }));
    }
    let table = Table::over("charts", "Charts of the inspection", rows)
        .column(&CHART, |row| row.chart)
        .column(&TOOTH, |row| row.tooth)
        .column(&FLANK, |row| row.side.name())
        .column(&CHART_U, |row| row.at_mm.map(|[u_mm, _]| u_mm))
        .column(&CHART_V, |row| row.at_mm.map(|[_, v_mm]| v_mm))
        .column(&CHART_DEVIATION, |row| row.deviation_mm * UM_PER_MM);
    write_table(path, &table.into())
}

/// Rows of the evaluated part of a trace.
fn line(
    chart: &'static str,
    flank: &TracedFlank,
    (trace, deviation): (&Trace, Option<TraceDeviation>),
    place_mm: impl Fn(usize) -> [f64; 2],
) -> Vec<ChartPlace> {
    let Some([from_mm, to_mm]) = deviation.map(|of| of.between_mm) else { return Vec::new() };
    let inside = |place: f64| place >= from_mm - SAME_MM && place <= to_mm + SAME_MM;
    let places = (0..trace.places_mm.len()).filter(|&i| inside(trace.places_mm[i]));
    let row = |i: usize| ChartPlace {
        chart,
        tooth: flank.tooth,
        side: flank.side,
        at_mm: Some(place_mm(i)),
        deviation_mm: trace.heights_mm[i],
    };
    places.map(row).collect()
}
