//! All flanks on one picture each: stock, heights, deviations, passes, chips; and single flanks on pictures of their
//! own.

use super::gear_maps::{GearMaps, finished_heights_um, um};
use super::parts::Part;
use super::{Tools, operation_names};
use crate::colormap::ColourScale;
use crate::job::GearJob;
use crate::output::contact_sheet::{ContactSheet, Thumbnail, write_contact_sheet};
use crate::output::flank_maps::{CHIP_QUANTITY, CHIPS_SHOWN, FlankMaps, NO_PASS_CAME};
use crate::output::folder::OutputFolder;
use crate::texture::SampledWindow;
use gearcut_core::error::{Error, Result};
use gearcut_core::terms::Side;
use rayon::prelude::*;
use std::path::Path;

/// Pass ids of one flank less its lowest; NaN where no pass came.
fn passes_from_first(ids: &[f32]) -> Vec<f32> {
    let first = ids.iter().copied().fold(f32::NAN, f32::min);
    ids.iter().map(|&id| id - first).collect()
}

/// Sheets of all flanks, and pictures of those that the scene wants by themselves, those of texture windows among them.
///
/// # Errors
/// Files that cannot be written.
pub fn write_sheets_and_flanks(
    job: &dyn GearJob,
    maps: &GearMaps,
    windows: &[SampledWindow],
    tools: &Tools,
) -> Result<()> {
    let Tools { folder, progress, parts, .. } = *tools;
    if parts.has(Part::Pictures) {
        let step = progress.step("sheets", 1, "set");
        write_contact_sheets(job, maps, folder)?;
        step.advance(1);
        step.finish();
    }
    if parts.has(Part::Maps) {
        let windows: Vec<(u32, Side)> =
            windows.iter().map(|sampled| (sampled.window.tooth, sampled.window.side)).collect();
        let drawn =
            if job.scene().output.draws_all_flanks { maps.flanks.iter().collect() } else { maps.drawn(&windows) };
        let step = progress.step("flank pictures", drawn.len() as u64, "flanks");
        let operations = operation_names(job);
        drawn.par_iter().try_for_each(|map| {
            map.draw(folder, &operations, maps.stock_scales.last().copied(), maps.deviation_scale)?;
            step.advance(1);
            Ok::<(), Error>(())
        })?;
        step.finish();
    }
    Ok(())
}

/// All flanks on one picture: stock of each earlier operation; heights, deviations, passes and, where they are known,
/// their chips after the last.
///
/// # Errors
/// Files that cannot be written.
fn write_contact_sheets(job: &dyn GearJob, gear: &GearMaps, folder: &OutputFolder) -> Result<()> {
    let maps = &gear.flanks;
    let operations = operation_names(job);
    let Some((name, earlier)) = operations.split_last() else { return Ok(()) };
    let scene = &job.scene().name;
    for (index, operation) in earlier.iter().enumerate() {
        write_stock_sheet(scene, operation, index, gear, folder)?;
    }
    write_height_sheet(scene, name, gear, folder)?;
    write_sheet(
        &folder.path(format!("pictures/deviation_{name}.png"))?,
        &format!("{scene}: deviation after {name}, all flanks"),
        ["mean normal deviation of cell", "µm"],
        gear.deviation_scale,
        maps,
        &maps.iter().map(|map| um(map.deviation_mm())).collect::<Vec<_>>(),
    )?;
    let passes: Vec<Vec<f32>> = maps.iter().map(|m| passes_from_first(&m.latest_pass)).collect();
    write_sheet(
        &folder.path(format!("pictures/passes_{name}.png"))?,
        &format!("{scene}: the passes of {name} in the order of time, all flanks"),
        ["latest pass of cell, counted from the flank's first", "1"],
        usual_span(&passes),
        maps,
        &passes,
    )?;
    let chips_um = |map: &FlankMaps| map.chips.last().map(|chips| um(&chips.thickness_mm));
    let chips: Vec<Vec<f32>> = maps.iter().filter_map(chips_um).collect();
    if chips.len() < maps.len() {
        return Ok(());
    }
    write_sheet(
        &folder.path(format!("pictures/chip_thickness_{name}.png"))?,
        &format!("{scene}: chips that left the finished surface, all flanks"),
        [CHIP_QUANTITY, "µm"],
        ColourScale::between_quantiles(chips.iter().map(Vec::as_slice), CHIPS_SHOWN),
        maps,
        &chips,
    )
}

/// Colours over the span of passes that the middle one of all flanks has: those that the end of the turn meets the
/// start on span all of it.
fn usual_span(passes: &[Vec<f32>]) -> ColourScale {
    let largest = |flank: &Vec<f32>| flank.iter().copied().fold(1.0, f32::max);
    let mut spans: Vec<f32> = passes.iter().map(largest).collect();
    spans.sort_by(f32::total_cmp);
    ColourScale::Sequential { low: 0.0, high: spans.get(spans.len() / 2).copied().unwrap_or(1.0) }
}

/// Stock of one earlier operation on all flanks.
fn write_stock_sheet(scene: &str, name: &str, index: usize, gear: &GearMaps, folder: &OutputFolder) -> Result<()> {
    write_sheet(
        &folder.path(format!("pictures/stock_{name}.png"))?,
        &format!("{scene}: stock of {name}, all flanks"),
        ["normal stock, mean of cell", "mm"],
        gear.stock_scales[index],
        &gear.flanks,
        &gear.flanks.iter().map(|m| m.mean_stock_mm(index)).collect::<Vec<_>>(),
    )
}

/// Finished surface of all flanks.
fn write_height_sheet(scene: &str, operation: &str, maps: &GearMaps, folder: &OutputFolder) -> Result<()> {
    let values: Vec<Vec<f32>> = maps.flanks.iter().map(finished_heights_um).collect();
    write_sheet(
        &folder.path(format!("pictures/heights_{operation}.png"))?,
        &format!("{scene}: finished surface after {operation}, all flanks"),
        ["normal deviation, highest of cell", "µm"],
        maps.height_scale,
        &maps.flanks,
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
    write_contact_sheet(path, &ContactSheet { title, quantity, unit, scale, missing: NO_PASS_CAME, maps: &thumbnails })
}
