//! Charts of an operation's chips over the work angle, for files and the page.

use crate::number_text::significant;
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::cut::chips::{ChipLedger, StrokeChips};
use crate::process::shaping::findings::deflection::of_stroke;
use crate::process::shaping::quantities::strokes::DEFLECTION;
use crate::process::shaping::tool::edge_polygon::EdgeSide;
use gearcut_core::units::UM_PER_MM;

/// Charts and colours end at this many times the 90th percentile: first strokes into the full blank would flatten
/// everything else.
const SHOWN_OVER_Q90: f64 = 2.0;

/// A curve of a chart: its name and its value at a stroke.
type Curve<'a> = (&'a str, &'a dyn Fn(&StrokeChips) -> f64);

/// Charts of an operation: load per stroke, and thickness and contact along the edge; on a machine that yields, its
/// deflection too.
pub fn charts(job: &ShapingJob, ledger: &ChipLedger, operation: usize) -> Vec<(&'static str, LineChart)> {
    let strokes = &ledger.operations[operation].strokes;
    let angles_deg = work_angles_deg(job, operation, strokes.len());
    let panel = |what: &str, unit: &str, curves: &[Curve]| {
        let values: Vec<_> = curves.iter().map(|(name, value)| (*name, strokes.iter().map(value).collect())).collect();
        panel(what, unit, &angles_deg, &values)
    };
    let chart = |what: &str, panels: Vec<Panel>| chart(job, operation, what, panels);
    let side = |side: EdgeSide| move |s: &StrokeChips| s.thickest_mm[side as usize] * UM_PER_MM;
    let contact = |side: EdgeSide| move |s: &StrokeChips| s.contact_mm[side as usize];
    let [right, tip, left] = EdgeSide::ALL;
    let mut charts = vec![
        (
            "load",
            chart(
                "chip section, forces and torques per stroke",
                vec![
                    panel(
                        "chip section",
                        "mm²",
                        &[("all chips", &|s| s.area_mm2), ("largest chip", &|s| s.largest_mm2)],
                    ),
                    panel(
                        "force",
                        "N",
                        &[
                            ("cutting force", &|s| s.cutting_n),
                            ("radial, on the tool", &|s| s.radial_n),
                            ("tangential, on the tool", &|s| s.tangential_n),
                        ],
                    ),
                    panel(
                        "torque",
                        "N m",
                        &[
                            ("work spindle", &|s| s.work_torque_nmm / 1e3),
                            ("cutter spindle", &|s| s.cutter_torque_nmm / 1e3),
                        ],
                    ),
                ],
            ),
        ),
        (
            "chips",
            chart(
                "chips along the edge per stroke",
                vec![
                    panel(
                        "largest thickness",
                        "µm",
                        &[("tip", &side(tip)), ("left flank", &side(left)), ("right flank", &side(right))],
                    ),
                    panel(
                        "contact length",
                        "mm",
                        &[("tip", &contact(tip)), ("left flank", &contact(left)), ("right flank", &contact(right))],
                    ),
                    panel("in the cut", "teeth", &[("cutter teeth that cut", &|s| f64::from(s.chips))]),
                ],
            ),
        ),
    ];
    charts.extend(deflection(job, operation, &angles_deg).map(|chart| ("deflection", chart)));
    charts
}

/// Deflection of every stroke; nothing on a rigid machine.
fn deflection(job: &ShapingJob, operation: usize, angles_deg: &[f64]) -> Option<LineChart> {
    if job.operations[operation].deflections.is_empty() {
        return None;
    }
    let names: Vec<String> = DEFLECTION.rows.iter().map(|row| row.title()).collect();
    let values: Vec<[f64; 6]> = (0..angles_deg.len()).map(|stroke| of_stroke(job, operation, stroke)).collect();
    let panel = |what: &str, unit: &str, kinds: [usize; 2]| {
        let curve = |kind: usize| (names[kind].as_str(), values.iter().map(|of| of[kind]).collect());
        panel(what, unit, angles_deg, &kinds.map(curve))
    };
    let panels = vec![
        panel("shift of the cutter", "µm", [0, 1]),
        panel("turn", "µrad", [2, 3]),
        panel("material left at the pitch point", "µm", [4, 5]),
    ];
    Some(chart(job, operation, "deflection of cutter and work per stroke", panels))
}

fn work_angles_deg(job: &ShapingJob, operation: usize, strokes: usize) -> Vec<f64> {
    let of = &job.operations[operation];
    (0..strokes).map(|stroke| of.work_angle_rad(stroke as f64).to_degrees()).collect()
}

fn chart(job: &ShapingJob, operation: usize, what: &str, panels: Vec<Panel>) -> LineChart {
    LineChart {
        title: format!("{} of {}: {what}", job.operations[operation].spec.name, job.scene.name),
        x_name: "work angle ψc".to_owned(),
        x_unit: "°".to_owned(),
        panels,
    }
}

/// Curves over the work angle, outliers left out and told.
fn panel(what: &str, unit: &str, angles_deg: &[f64], curves: &[(&str, Vec<f64>)]) -> Panel {
    let all = || curves.iter().flat_map(|(_, values)| values.iter().copied());
    let end = shown_end(all().map(f64::abs));
    let beyond = (0..angles_deg.len()).filter(|&i| curves.iter().any(|(_, values)| values[i].abs() > end)).count();
    let largest = all().fold(0.0, |most: f64, v| most.max(v.abs()));
    let note = match beyond {
        0 => String::new(),
        1 => format!(" (1 stroke of {} {unit} not shown)", significant(largest, 3)),
        _ => format!(" ({beyond} strokes up to {} {unit} not shown)", significant(largest, 3)),
    };
    let series = curves.iter().enumerate().map(|(index, (name, values))| {
        let shown = |&value: &f64| if value.abs() > end { f64::NAN } else { value };
        let points = angles_deg.iter().copied().zip(values.iter().map(shown)).collect();
        LineSeries { name: format!("{name}{}", if index == 0 { note.as_str() } else { "" }), points }
    });
    Panel {
        least_division: 0.0,
        value_name: what.to_owned(),
        unit: unit.to_owned(),
        series: series.collect(),
        limits: Vec::new(),
    }
}

/// Where a scale ends: beyond it lie only outliers.
pub fn shown_end(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.filter(|v| *v > 0.0).collect();
    values.sort_unstable_by(f64::total_cmp);
    match values.len() {
        0 => f64::INFINITY,
        n => {
            let end = SHOWN_OVER_Q90 * values[(n - 1) * 9 / 10];
            if values[n - 1] <= 1.5 * end { f64::INFINITY } else { end }
        }
    }
}
