//! What a run writes about the gear as a whole: tables, charts, contact sheets, results and run record.
//!
//! Maps of single flanks are written as the flanks are finished; everything here follows when all are.

use super::{CutGear, Work, chip_files};
use crate::axes_report;
use crate::cut::Backend;
use crate::dexel::NO_PASS;
use crate::error::{Error, Result};
use crate::job::{GearJob, Job};
use crate::measure::unevenness::ToothAllowance;
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::colormap::ColourScale;
use crate::output::contact_sheet::{ContactSheet, Thumbnail, write_contact_sheet};
use crate::output::flank_maps::{CHIPS_SHOWN, FlankMaps, OperationMaps};
use crate::output::folder::OutputFolder;
use crate::output::results::{RESULTS_FILE, Results};
use crate::output::table::{Cell, write_table};
use crate::units::UM_PER_MM;
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::path::Path;

/// Writes everything but the run record.
///
/// # Errors
/// Files that cannot be written.
pub fn write(
    job: &Job,
    cut: &CutGear,
    results: &Results,
    folder: &OutputFolder,
    notes: &[(String, String)],
) -> Result<()> {
    write_flank_table(cut, &folder.path("tables/flanks.csv")?, job)?;
    write_tooth_table(cut, &folder.path("tables/teeth.csv")?)?;
    for allowance in &cut.report.allowances {
        let name = &job.operations[allowance.operation].spec.name;
        let path = folder.path(format!("tables/allowance_{name}.csv"))?;
        write_allowance_table(&allowance.strokes, &allowance.envelope, allowance.rack_mm, &path)?;
        let chart = unevenness_chart(job, &allowance.strokes, name);
        chart.write_png(&folder.path(format!("pictures/unevenness_{name}.png"))?)?;
        chart.write_svg(&folder.path(format!("pictures/unevenness_{name}.svg"))?)?;
    }
    write_contact_sheets(job, &cut.maps, folder)?;
    let (last, scale) = (&job.finishing().spec.name, deviation_scale(&cut.maps));
    cut.maps.par_iter().try_for_each(|map| map.write_deviation(folder, last, scale, notes))?;
    chip_files::write(job, &cut.chips, folder, notes)?;
    axes_report::write(job, folder)?;
    results.write(&folder.path(RESULTS_FILE)?)
}

fn write_flank_table(cut: &CutGear, path: &Path, job: &Job) -> Result<()> {
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

fn unevenness_chart(job: &Job, teeth: &[ToothAllowance], operation: &str) -> BarChart {
    BarChart {
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

/// Colours of the deviations of all flanks, µm.
pub fn deviation_scale(maps: &[FlankMaps]) -> ColourScale {
    match ColourScale::diverging_over(maps.iter().map(|map| map.deviation_mm.as_slice())) {
        ColourScale::Diverging { limit } => ColourScale::Diverging { limit: limit * UM_PER_MM as f32 },
        scale @ ColourScale::Sequential { .. } => scale,
    }
}

/// Pass ids of one flank less its lowest; NaN where no pass came.
fn passes_from_first(ids: &[u32]) -> Vec<f32> {
    let first = ids.iter().copied().min().unwrap_or(0);
    ids.iter().map(|&id| if id == NO_PASS { f32::NAN } else { (id - first) as f32 }).collect()
}

/// All flanks on one picture: stock of each earlier operation; heights, deviations, passes and, where they are known, their chips after the last.
pub fn write_contact_sheets(job: &dyn GearJob, maps: &[FlankMaps], folder: &OutputFolder) -> Result<()> {
    let scales = super::map_operations(job);
    let last = scales.len() - 1;
    let scene = &job.scene().name;
    for (index, operation) in scales[..last].iter().enumerate() {
        write_stock_sheet(scene, operation, index, maps, folder)?;
    }
    let name = &scales[last].name;
    write_height_sheet(scene, name, maps, folder)?;
    write_sheet(
        &folder.path(format!("pictures/deviation_{name}.png"))?,
        &format!("{scene}: deviation after {name}, all flanks"),
        ["mean height of cell over the target", "µm"],
        deviation_scale(maps),
        maps,
        &maps.iter().map(|m| m.deviation_mm.iter().map(|&height| um(height)).collect()).collect::<Vec<_>>(),
    )?;
    let passes: Vec<Vec<f32>> = maps.iter().map(|m| passes_from_first(&m.passes[last])).collect();
    write_sheet(
        &folder.path(format!("pictures/passes_{name}.png"))?,
        &format!("{scene}: the passes of {name} in the order of time, all flanks"),
        ["pass id, counted from the flank's first", "1"],
        usual_span(&passes),
        maps,
        &passes,
    )?;
    let chips_um = |map: &FlankMaps| map.chips.last().map(|chips| chips.thickness_mm.iter().map(|&h| um(h)).collect());
    let chips: Vec<Vec<f32>> = maps.iter().filter_map(chips_um).collect();
    if chips.len() < maps.len() {
        return Ok(());
    }
    write_sheet(
        &folder.path(format!("pictures/chip_thickness_{name}.png"))?,
        &format!("{scene}: chips that left the finished surface, all flanks"),
        ["uncut chip thickness", "µm"],
        ColourScale::between_quantiles(chips.iter().map(Vec::as_slice), CHIPS_SHOWN),
        maps,
        &chips,
    )
}

/// Colours over the span of passes that the middle one of all flanks has: those that the end of the turn meets the start on span all of it.
fn usual_span(passes: &[Vec<f32>]) -> ColourScale {
    let largest = |flank: &Vec<f32>| flank.iter().copied().fold(1.0, f32::max);
    let mut spans: Vec<f32> = passes.iter().map(largest).collect();
    spans.sort_by(f32::total_cmp);
    ColourScale::Sequential { low: 0.0, high: spans.get(spans.len() / 2).copied().unwrap_or(1.0) }
}

fn um(height_mm: f32) -> f32 {
    height_mm * UM_PER_MM as f32
}

/// Stock of one earlier operation on all flanks.
fn write_stock_sheet(
    scene: &str,
    operation: &OperationMaps,
    index: usize,
    maps: &[FlankMaps],
    folder: &OutputFolder,
) -> Result<()> {
    let name = &operation.name;
    write_sheet(
        &folder.path(format!("pictures/stock_{name}.png"))?,
        &format!("{scene}: stock of {name}, all flanks"),
        ["normal stock", "mm"],
        operation.stock_scale,
        maps,
        &maps.iter().map(|m| m.stock_mm(index)).collect::<Vec<_>>(),
    )
}

/// Finished surface of all flanks.
fn write_height_sheet(scene: &str, operation: &str, maps: &[FlankMaps], folder: &OutputFolder) -> Result<()> {
    let values: Vec<Vec<f32>> = maps
        .iter()
        .map(|m| {
            m.highest_mm.last().map_or_else(Vec::new, |heights| heights.iter().map(|&height| um(height)).collect())
        })
        .collect();
    write_sheet(
        &folder.path(format!("pictures/heights_{operation}.png"))?,
        &format!("{scene}: finished surface after {operation}, all flanks"),
        ["height over the target, highest of cell", "µm"],
        ColourScale::heights_over(values.iter().map(Vec::as_slice)),
        maps,
        &values,
    )
}

fn write_sheet(
    path: &Path,
    title: &str,
    [quantity, unit]: [&str; 2],
    scale: ColourScale,
    maps: &[FlankMaps],
    values: &[Vec<f32>],
) -> Result<()> {
    if maps.is_empty() {
        return Ok(());
    }
    let labels: Vec<String> = maps.iter().map(|m| format!("{} {}", m.tooth, m.side.name())).collect();
    let thumbnails: Vec<Thumbnail> = maps
        .iter()
        .zip(&labels)
        .zip(values)
        .map(|((map, label), values)| Thumbnail { label, grid: &map.grid, values })
        .collect();
    write_contact_sheet(path, &ContactSheet { title, quantity, unit, scale, maps: &thumbnails })
}

/// What is needed to repeat the run and to trust its files.
///
/// # Errors
/// Files that cannot be read back for their checksums.
pub fn run_record(
    resolved_scene: &str,
    backend: &dyn Backend,
    backend_why: &str,
    work: &Work,
    folder: &OutputFolder,
) -> Result<Value> {
    let mut checksums = Map::new();
    collect_checksums(&folder.path("")?, "", &mut checksums)?;
    Ok(json!({
        "program": "gearcut",
        "program_version": env!("CARGO_PKG_VERSION"),
        "command": "cut",
        "scene": resolved_scene,
        "backend": backend.name(),
        "backend_why": backend_why,
        "backend_incidents": backend.incidents(),
        "stage_times": backend
            .stage_times()
            .iter()
            .map(|t| json!({"stage": t.stage, "batches": t.batches, "device_s": t.device_s}))
            .collect::<Vec<_>>(),
        "complete": !work.interrupted,
        "dexels": work.dexels,
        "dexel_passes": work.stats.dexel_passes,
        "dexels_cut": work.stats.dexels,
        "dexel_passes_per_dexel_cut": work.stats.dexel_passes as f64 / work.stats.dexels.max(1) as f64,
        "wall_time_s": work.elapsed.as_secs_f64(),
        "threads": rayon::current_num_threads(),
        "sha256": checksums,
    }))
}

fn collect_checksums(folder: &Path, prefix: &str, into: &mut Map<String, Value>) -> Result<()> {
    let mut entries: Vec<_> = std::fs::read_dir(folder)
        .and_then(Iterator::collect::<std::io::Result<Vec<_>>>)
        .map_err(Error::reading(folder))?;
    entries.sort_by_key(std::fs::DirEntry::file_name);
    for entry in entries {
        let path = entry.path();
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if path.is_dir() {
            collect_checksums(&path, &format!("{name}/"), into)?;
        } else {
            let digest = Sha256::digest(std::fs::read(&path).map_err(Error::reading(&path))?);
            let hex = digest.iter().fold(String::new(), |mut text, byte| {
                let _ = write!(text, "{byte:02x}");
                text
            });
            into.insert(name, Value::String(hex));
        }
    }
    Ok(())
}
