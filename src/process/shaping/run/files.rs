//! What a run writes about the gear as a whole: tables, charts and contact sheets.
//!
//! Maps of single flanks are written as the flanks are finished; everything here follows when all are.

use super::chip_files;
use crate::findings::Findings;
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::table::write_tables;
use crate::process::shaping::CutGear;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::gear::measure::unevenness::ToothAllowance;
use crate::steps::attempts::Attempts;
use crate::steps::parts::Part;
use crate::steps::sheets::write_sheets_and_flanks;
use crate::steps::{Tools, axes};
use crate::texture::SampledWindow;
use gearcut_core::error::Result;

/// Writes tables, charts, chips and sheets.
///
/// # Errors
/// Ctrl-C.
pub fn write(
    job: &ShapingJob,
    cut: &CutGear,
    (motion, windows): (&[OperationAxes], &[SampledWindow]),
    found: &Findings,
    tools: &Tools,
    attempts: &mut Attempts,
) -> Result<()> {
    let Tools { folder, notes, progress, parts, .. } = *tools;
    let step = progress.step("tables and charts", 3 + cut.report.allowances.len() as u64, "parts");
    attempts.of("tables", write_tables(found, folder))?;
    step.advance(1);
    for allowance in &cut.report.allowances {
        let name = &job.operations[allowance.operation].spec.name;
        if parts.has(Part::Pictures) {
            let chart = unevenness_chart(job, &allowance.strokes, name);
            let write = || chart.write_svg(&folder.path(format!("pictures/unevenness_{name}.svg"))?);
            attempts.of("chart of the unevenness", write())?;
        }
        step.advance(1);
    }
    if parts.has(Part::Chips) {
        attempts.of("charts and maps of chips", chip_files::write(job, &cut.chips, folder, notes))?;
    }
    step.advance(1);
    if parts.has(Part::Axes) {
        for operation in motion {
            attempts.of("table and charts of the axes", axes::write(operation, folder))?;
        }
    }
    step.advance(1);
    step.finish();
    attempts.of("sheets and pictures of flanks", write_sheets_and_flanks(job, &cut.maps, windows, tools))?;
    Ok(())
}

fn unevenness_chart(job: &ShapingJob, teeth: &[ToothAllowance], operation: &str) -> BarChart {
    BarChart {
        has_mean: true,
        least_division: 0.0,
        limits: Vec::new(),
        title: format!("{}: unevenness of the allowance after {operation}", job.scene.name),
        category_name: "tooth".to_owned(),
        categories: teeth.iter().map(|t| t.tooth.to_string()).collect(),
        value_name: "|AB - CD| / mean".to_owned(),
        unit: "%".to_owned(),
        series: vec![BarSeries {
            name: operation.to_owned(),
            values: teeth.iter().map(ToothAllowance::unevenness_mean_percent).collect(),
        }],
    }
}
