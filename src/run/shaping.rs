//! Shaping scenes: cut and measured flank by flank, chips, blank, and what is written about the gear as a whole.

use super::{
    Tools, Work, all_flanks, blank, files, flanks_of, frames, map_operations, meshes, report, results, summary,
    write_meshes_and_pictures,
};
use crate::cut::{Backend, CutStats};
use crate::error::{Error, Result};
use crate::gcode;
use crate::gear::generation::Side;
use crate::job::Job;
use crate::measure::chips::{ChipLedger, last_chips};
use crate::measure::{FlankReport, GearReport, flank_report, gear_report};
use crate::output::flank_maps::FlankMaps;
use crate::output::folder::OutputFolder;
use crate::output::interrupt::Interrupt;
use crate::output::progress::Progress;
use crate::output::report::REPORT_FILE;
use crate::surface::SurfaceGrid;
use crate::texture;
use serde_json::Value;
use std::path::Path;
use std::time::{Duration, Instant};

/// A cut and measured gear, before anything is written about it as a whole.
#[derive(Debug)]
pub struct CutGear {
    /// What was measured.
    pub report: GearReport,
    /// What every stroke takes away.
    pub chips: ChipLedger,
    /// Maps of all finished flanks at map spacing, in order.
    pub maps: Vec<FlankMaps>,
    /// Surfaces of all finished flanks at mesh spacing, in order.
    pub surfaces: Vec<SurfaceGrid>,
    /// What the backend met.
    pub stats: CutStats,
    /// Dexels cut, all operations.
    pub dexels: u64,
    /// Wall time of cutting and measuring, files of flanks included.
    pub elapsed: Duration,
    /// Stopped by the user before all flanks were done.
    pub interrupted: bool,
}

/// One flank, done.
struct Finished {
    report: FlankReport,
    maps: FlankMaps,
    surface: SurfaceGrid,
    stats: CutStats,
    dexels: u64,
}

/// Cuts and measures all flanks of a job; maps go to `folder` as soon as a flank is done.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error: what is finished is returned.
pub fn cut_gear(
    job: &Job,
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
    folder: Option<(&OutputFolder, &[(String, String)])>,
) -> Result<CutGear> {
    let started = Instant::now();
    let chips = follow_chips(job, progress, interrupt)?;
    let operations = map_operations(job);
    let flanks = flanks_of(job);
    let step = progress.step("cut", flanks.len() as u64, "flanks");
    let cut_one = |&(tooth, side): &(u32, Side)| -> Result<Option<Finished>> {
        if interrupt.is_raised() {
            return Ok(None);
        }
        let generation = job.target_generation();
        let target = job.target_flank(&generation, tooth, side)?;
        let cut = job.cut(backend, job.flank_field(&target))?;
        let report = flank_report::measure(job, &target, &cut);
        let spacing_mm = job.scene.output.map_spacing_mm;
        let places = [&cut.field.arcs_mm()[..], &cut.field.leads_mm];
        let mut maps = FlankMaps::sample(tooth, side, places, &cut.layers, spacing_mm);
        maps.chips = last_chips(job, &cut.field.at([&maps.dexels[0], &maps.dexels[1]]));
        let surface = SurfaceGrid::new(&cut.field, &cut.layers, job.scene.output.mesh_spacing_mm);
        if let Some((folder, notes)) = folder {
            maps.write(folder, &operations, notes)?;
            meshes::write_flank(job, &surface, tooth, side, folder)?;
        }
        step.advance(1);
        let dexels = (cut.field.len() * cut.layers.len()) as u64;
        Ok(Some(Finished { report, maps, surface, stats: cut.stats, dexels }))
    };
    let finished = all_flanks(&flanks, cut_one)?;
    step.finish();
    let interrupted = finished.iter().any(Option::is_none);
    let (mut reports, mut maps, mut surfaces) = (Vec::new(), Vec::new(), Vec::new());
    let (mut stats, mut dexels) = (CutStats::default(), 0);
    for flank in finished.into_iter().flatten() {
        reports.push(flank.report);
        maps.push(flank.maps);
        surfaces.push(flank.surface);
        stats += flank.stats;
        dexels += flank.dexels;
    }
    let report = gear_report::measure(job, backend, reports)?;
    Ok(CutGear { report, chips, maps, surfaces, stats, dexels, elapsed: started.elapsed(), interrupted })
}

/// All strokes in order of time, space by space.
fn follow_chips(job: &Job, progress: &Progress, interrupt: &Interrupt) -> Result<ChipLedger> {
    let step = progress.step("chips", u64::from(job.scene.gear.teeth), "tooth spaces");
    let chips = ChipLedger::new(job, &|| {
        step.advance(1);
        !interrupt.is_raised()
    });
    step.finish();
    chips.ok_or(Error::Interrupted)
}

/// Cuts a job and writes everything; `frames` is how many pictures of the cut as it happens are drawn.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error once a flank is finished.
pub(super) fn run(job: &Job, tools: &Tools, out: &Path, frames: Option<u32>) -> Result<(Value, String, Work)> {
    let Tools { resolved, backend, backend_why, progress, interrupt, folder, notes } = *tools;
    // A window that lies on no flank, or too large a blank field, is refused before the first cut.
    texture::windows(job)?;
    job.blank_grid()?;
    let gear = cut_gear(job, backend, progress, interrupt, Some((folder, notes)))?;
    if gear.report.flanks.is_empty() {
        return Err(Error::Interrupted);
    }
    let textures = texture::measure(job, backend, progress, interrupt)?;
    let whole = if gear.interrupted { None } else { blank::cut(job, backend, progress, interrupt)? };
    if let Some((_, report)) = &whole {
        blank::write_table_of_damage(job, report, folder)?;
    }
    let blank = whole.as_ref().map(|(cut, report)| blank::results(job, cut, report));
    let results = results::results(job, &gear, blank, &textures);
    files::write(job, &gear, &results, folder, notes)?;
    texture::write(job, &textures, folder, notes)?;
    let mut interrupted = whole.is_none();
    if let Some((cut, _)) = &whole {
        meshes::write_blank(job, cut, folder)?;
        interrupted |= !write_meshes_and_pictures(job, gear.surfaces.clone(), tools)?;
        if let Some(count) = frames {
            let drawn = frames::draw(job, count, progress, interrupt, folder)?;
            if drawn < count {
                progress.note(&format!("stopped: {drawn} of {count} frames are drawn"));
                interrupted = true;
            }
        }
    }
    for note in gcode::write_all(job, folder)? {
        progress.note(&note);
    }
    let words = report::RunWords { resolved_scene: resolved, backend: &backend.name(), backend_why };
    report::page(job, &gear, &results, &words, folder)?.write(&folder.path(REPORT_FILE)?)?;
    let summary = summary::summary(job, &gear, &results, out, &backend.name());
    let CutGear { stats, dexels, elapsed, .. } = gear;
    let results = serde_json::to_value(&results)
        .map_err(|reason| Error::Output { path: out.to_owned(), reason: reason.to_string() })?;
    Ok((results, summary, Work { stats, dexels, elapsed, interrupted }))
}
