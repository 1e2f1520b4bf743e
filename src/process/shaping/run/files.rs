//! What a run writes about the gear as a whole: tables, charts, contact sheets and results.
//!
//! Maps of single flanks are written as the flanks are finished; everything here follows when all are.

use super::chip_files;
use crate::error::Result;
use crate::findings::Findings;
use crate::findings::RESULTS_FILE;
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::table::{Cell, write_table};
use crate::process::shaping::CutGear;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::measure::unevenness::ToothAllowance;
use crate::steps::parts::Part;
use crate::steps::sheets::write_sheets_and_deviations;
use crate::steps::{Tools, axes};
use crate::units::UM_PER_MM;
use std::path::Path;

/// Writes everything but the run record.
///
/// # Errors
/// Files that cannot be written.
pub fn write(job: &ShapingJob, cut: &CutGear, motion: &[OperationAxes], found: &Findings, tools: &Tools) -> Result<()> {
    let Tools { folder, notes, progress, parts, .. } = *tools;
    let step = progress.step("tables and charts", 3 + cut.report.allowances.len() as u64, "parts");
    write_flank_table(cut, &folder.path("tables/flanks.csv")?, job)?;
    write_tooth_table(cut, &folder.path("tables/teeth.csv")?)?;
    step.advance(1);
    for allowance in &cut.report.allowances {
        let name = &job.operations[allowance.operation].spec.name;
        let path = folder.path(format!("tables/allowance_{name}.csv"))?;
        write_allowance_table(&allowance.strokes, &allowance.envelope, allowance.rack_mm, &path)?;
        if parts.has(Part::Pictures) {
            let chart = unevenness_chart(job, &allowance.strokes, name);
            chart.write_svg(&folder.path(format!("pictures/unevenness_{name}.svg"))?)?;
        }
        step.advance(1);
    }
    chip_files::write_tables(job, &cut.chips, folder)?;
    if parts.has(Part::Chips) {
        chip_files::write_charts_and_maps(job, &cut.chips, folder, notes)?;
    }
    step.advance(1);
    if parts.has(Part::Axes) {
        for operation in motion {
            axes::write(operation, folder)?;
        }
    }
    step.advance(1);
    step.finish();
    write_sheets_and_deviations(job, &cut.maps, tools)?;
    folder.write_json(RESULTS_FILE, &found.to_json())
}

fn write_flank_table(cut: &CutGear, path: &Path, job: &ShapingJob) -> Result<()> {
    let mut columns: Vec<String> =
        ["tooth", "flank", "start_of_involute_mm", "tip_height_mm", "profile_length_mm"].map(str::to_owned).into();
    for operation in &job.operations[..job.operations.len() - 1] {
        for what in ["smallest", "largest", "mean"] {
            columns.push(format!("{}_{what}_stock_mm", operation.spec.name));
        }
    }
    columns.extend(
        [
            "lowest_um",
            "highest_um",
            "F_alpha_um",
            "f_f_alpha_um",
            "f_H_alpha_um",
            "F_beta_um",
            "f_f_beta_um",
            "f_H_beta_um",
            "largest_scallop_um",
        ]
        .map(str::to_owned),
    );
    let um = |value: Option<f64>| Cell::from(value.map(|v| v * UM_PER_MM));
    let rows = cut.report.flanks.iter().map(|f| {
        let mut row: Vec<Cell> = vec![
            f.tooth.into(),
            f.side.name().into(),
            f.form.height_mm.into(),
            f.tip.height_mm.into(),
            f.length_mm.into(),
        ];
        for stock in &f.stock {
            row.push(stock.map(|s| s.smallest.value_mm).into());
            row.push(stock.map(|s| s.largest.value_mm).into());
            row.push(stock.map(|s| s.mean_mm).into());
        }
        row.push(um(f.finished.map(|h| h[0].value_mm)));
        row.push(um(f.finished.map(|h| h[1].value_mm)));
        for deviation in [f.profile, f.lead] {
            row.push(um(deviation.map(|d| d.total_mm)));
            row.push(um(deviation.map(|d| d.form_mm)));
            row.push(um(deviation.map(|d| d.slope_mm)));
        }
        row.push(um(f.scallops.map(|s| s.largest.height_mm)));
        row
    });
    write_table(path, &columns.iter().map(String::as_str).collect::<Vec<_>>(), rows)
}

fn write_tooth_table(cut: &CutGear, path: &Path) -> Result<()> {
    let columns = [
        "tooth",
        "thickness_arc_mm",
        "thickness_chord_mm",
        "tip_land_mm",
        "left_single_pitch_um",
        "left_cumulative_pitch_um",
        "right_single_pitch_um",
        "right_cumulative_pitch_um",
        "runout_of_space_after_um",
    ];
    let report = &cut.report;
    let rows = report.thickness.iter().enumerate().map(|(i, thickness)| {
        let mut row: Vec<Cell> = vec![
            (i as u32 + 1).into(),
            thickness.map(|t| t.arc_mm).into(),
            thickness.map(|t| t.chord_mm).into(),
            report.tip_lands_mm.get(i).copied().into(),
        ];
        for side in &report.pitch {
            row.push(side.as_ref().map(|p| p.single_mm[i] * UM_PER_MM).into());
            row.push(side.as_ref().map(|p| p.cumulative_mm[i] * UM_PER_MM).into());
        }
        row.push(report.runout.as_ref().map(|r| r.radial_mm[i] * UM_PER_MM).into());
        row
    });
    write_table(path, &columns, rows)
}

fn write_allowance_table(
    strokes: &[ToothAllowance],
    envelope: &[ToothAllowance],
    rack_mm: f64,
    path: &Path,
) -> Result<()> {
    let columns = [
        "tooth",
        "A_x_mm",
        "A_y_mm",
        "B_x_mm",
        "B_y_mm",
        "C_x_mm",
        "C_y_mm",
        "D_x_mm",
        "D_y_mm",
        "AB_mm",
        "CD_mm",
        "unevenness_mean_denominator_percent",
        "unevenness_rack_denominator_percent",
        "envelope_AB_mm",
        "envelope_CD_mm",
        "envelope_unevenness_mean_denominator_percent",
    ];
    let rows = strokes.iter().zip(envelope).map(|(tooth, limit)| {
        let mut row: Vec<Cell> = vec![tooth.tooth.into()];
        for crossing in [tooth.a, tooth.b, tooth.c, tooth.d] {
            row.push(crossing.map(|c| c.point_mm.x).into());
            row.push(crossing.map(|c| c.point_mm.y).into());
        }
        row.extend([
            Cell::from(tooth.ab_mm()),
            tooth.cd_mm().into(),
            tooth.unevenness_mean_percent().into(),
            tooth.unevenness_rack_percent(rack_mm).into(),
            limit.ab_mm().into(),
            limit.cd_mm().into(),
            limit.unevenness_mean_percent().into(),
        ]);
        row
    });
    write_table(path, &columns, rows)
}

fn unevenness_chart(job: &ShapingJob, teeth: &[ToothAllowance], operation: &str) -> BarChart {
    BarChart {
        least_division: 0.0,
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
