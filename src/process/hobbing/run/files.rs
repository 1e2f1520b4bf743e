//! Tables, contact sheets and results of a hobbed gear.

use crate::error::Result;
use crate::findings::Findings;
use crate::findings::RESULTS_FILE;
use crate::output::table::{Cell, write_table};
use crate::process::hobbing::measure::flank_report::HeightSummary;
use crate::process::hobbing::{HobCutter, HobbedGear, HobbingJob};
use crate::steps::{Tools, sheets};
use crate::units::UM_PER_MM;
use std::path::Path;

/// Writes what belongs to the gear as a whole.
///
/// # Errors
/// Files that cannot be written.
pub fn write(cutter: &HobCutter, gear: &HobbedGear, found: &Findings, tools: &Tools) -> Result<()> {
    let (job, folder) = (cutter.job, tools.folder);
    write_flank_table(job, gear, &folder.path("tables/flanks.csv")?)?;
    sheets::write_sheets_and_deviations(cutter, &gear.maps, tools)?;
    folder.write_json(RESULTS_FILE, &found.to_json())
}

fn write_flank_table(job: &HobbingJob, gear: &HobbedGear, path: &Path) -> Result<()> {
    let mut columns: Vec<String> =
        ["tooth", "flank", "start_of_involute_mm", "undercut", "profile_length_mm"].map(str::to_owned).into();
    for operation in &job.operations[..job.operations.len() - 1] {
        columns.extend(["smallest", "largest", "mean"].map(|what| format!("{}_{what}_stock_mm", operation.spec.name)));
    }
    let measures = [
        "lowest_um",
        "highest_um",
        "mean_um",
        "Sq_um",
        "F_alpha_um",
        "f_f_alpha_um",
        "f_H_alpha_um",
        "F_beta_um",
        "f_f_beta_um",
        "f_H_beta_um",
    ];
    columns.extend(measures.map(str::to_owned));
    let um = |value: Option<f64>| Cell::from(value.map(|v| v * UM_PER_MM));
    let rows = gear.flanks.iter().map(|f| {
        let mut row: Vec<Cell> = vec![
            f.tooth.into(),
            f.side.name().into(),
            f.form_height_mm.into(),
            if f.undercut { "yes" } else { "no" }.into(),
            f.length_mm.into(),
        ];
        for stock in &f.stock {
            let part = |value: fn(&HeightSummary) -> f64| Cell::from(stock.as_ref().map(value));
            row.extend([part(|s| s.lowest_mm), part(|s| s.highest_mm), part(|s| s.mean_mm)]);
        }
        let height = |value: fn(&HeightSummary) -> f64| um(f.finished.as_ref().map(value));
        row.extend([height(|h| h.lowest_mm), height(|h| h.highest_mm), height(|h| h.mean_mm), height(|h| h.rms_mm)]);
        for deviation in [&f.profile, &f.helix] {
            row.extend([
                um(deviation.as_ref().map(|d| d.total_mm)),
                um(deviation.as_ref().map(|d| d.form_mm)),
                um(deviation.as_ref().map(|d| d.slope_mm)),
            ]);
        }
        row
    });
    write_table(path, &columns.iter().map(String::as_str).collect::<Vec<_>>(), rows)
}
