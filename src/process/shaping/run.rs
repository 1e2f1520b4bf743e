//! Shaping scenes: cut and measured flank by flank, chips, blank, and what is written about the gear as a whole.

mod blank;
mod chip_files;
mod files;
mod frames;

use super::report;
use crate::cut::{Backend, CutStats};
use crate::error::{Error, Result};
use crate::findings::Findings;
use crate::interrupt::Interrupt;
use crate::output::flank_maps::FlankMaps;
use crate::output::progress::Progress;
use crate::process::CutDone;
use crate::process::shaping::Job;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::chips::{ChipLedger, last_chips};
use crate::process::shaping::findings;
use crate::process::shaping::measure::{FlankReport, GearReport, flank_report, gear_report};
use crate::steps::parts::{Part, Parts};
use crate::steps::report::RunWords;
use crate::steps::{
    FlankFiles, Tools, Work, all_flanks, axes, flanks_of, map_operations, meshes, needs_maps, needs_surfaces, stages,
    summary, write_meshes_and_pictures, write_programs, write_report,
};
use crate::surface::SurfaceGrid;
use crate::terms::Side;
use crate::texture;
use std::time::{Duration, Instant};

/// A cut and measured gear, before anything is written about it as a whole.
#[derive(Debug)]
pub struct CutGear {
    /// What was measured.
    pub report: GearReport,
    /// What every stroke takes away.
    pub chips: ChipLedger,
    /// Maps of all finished flanks at map spacing, in order; empty where nothing that is written needs them.
    pub maps: Vec<FlankMaps>,
    /// Surfaces of all finished flanks at mesh spacing, in order; empty where nothing that is written needs them.
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
    maps: Option<FlankMaps>,
    surface: Option<SurfaceGrid>,
    stats: CutStats,
    dexels: u64,
}

/// Cuts and measures all flanks of a job; maps and meshes of flanks go to `folder` as soon as a flank is done, if they
/// are among the parts that it shall hold.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error: what is finished is returned.
pub fn cut_gear(
    job: &Job,
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
    folder: Option<FlankFiles<'_>>,
) -> Result<CutGear> {
    let parts = folder.map_or(Parts::all(), |(.., parts)| parts);
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
        let maps = needs_maps(parts).then(|| {
            let places = [&cut.field.arcs_mm()[..], &cut.field.leads_mm];
            let mut maps = FlankMaps::sample(tooth, side, places, &cut.layers, job.scene.output.map_spacing_mm);
            maps.chips = last_chips(job, &cut.field.at([&maps.dexels[0], &maps.dexels[1]]));
            maps
        });
        let mesh_spacing_mm = job.scene.output.mesh_spacing_mm;
        let surface = needs_surfaces(job, parts).then(|| SurfaceGrid::new(&cut.field, &cut.layers, mesh_spacing_mm));
        if let Some((folder, notes, _)) = folder {
            if let Some(maps) = maps.as_ref().filter(|_| parts.has(Part::Maps)) {
                maps.write(folder, &operations, notes)?;
            }
            if let Some(surface) = surface.as_ref().filter(|_| parts.has(Part::Meshes)) {
                meshes::write_flank(job, surface, tooth, side, folder)?;
            }
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
        maps.extend(flank.maps);
        surfaces.extend(flank.surface);
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
pub(super) fn run(job: &Job, tools: &Tools, frames: Option<u32>) -> Result<CutDone> {
    let Tools { resolved, backend, backend_why, progress, interrupt, folder, parts, notes } = *tools;
    progress.plan(stages::plan(
        job,
        tools,
        frames,
        &stages::Costs { before: &[("chips", 0.05)], flank_s: 0.03, blank_s: 0.04 },
    ));
    // A window that lies on no flank, or too large a blank field, is refused before the first cut.
    texture::windows(job)?;
    job.blank_grid()?;
    let gear = cut_gear(job, backend, progress, interrupt, Some((folder, notes, parts)))?;
    if gear.report.flanks.is_empty() {
        return Err(Error::Interrupted);
    }
    let textures = texture::measure(job, backend, progress, interrupt)?;
    let whole = if gear.interrupted { None } else { blank::cut(job, backend, progress, interrupt)? };
    if let Some((_, report)) = &whole {
        blank::write_table_of_damage(job, report, folder)?;
    }
    let motion = OperationAxes::of_job(job);
    let mut sections = findings::sections(job, &gear.report, &gear.chips, &motion);
    sections.extend(whole.as_ref().map(|(cut, report)| findings::blank::findings(job, cut, report)));
    sections.push(texture::findings(job, &textures));
    let found = Findings {
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        process: "shaping".to_owned(),
        scene: job.scene.name.clone(),
        complete: !gear.interrupted,
        headline: findings::headline(job, &gear.report, &gear.chips, &motion),
        warnings: findings::warnings(&gear.report, &gear.stats, gear.interrupted, &motion),
        sections,
    };
    let results = found.to_json();
    files::write(job, &gear, &motion, &results, tools)?;
    if parts.has(Part::Texture) {
        texture::write(job, &textures, folder, notes)?;
    }
    let mut interrupted = whole.is_none();
    if let Some((cut, _)) = &whole {
        if parts.has(Part::Meshes) {
            meshes::write_blank(job, cut, folder)?;
        }
        interrupted |= !write_meshes_and_pictures(job, gear.surfaces.clone(), tools)?;
        if let Some(count) = frames {
            let drawn = frames::draw(job, count, progress, interrupt, folder)?;
            if drawn < count {
                progress.note(&format!("stopped: {drawn} of {count} frames are drawn"));
                interrupted = true;
            }
        }
    }
    if parts.has(Part::Axes) {
        write_programs(progress, || axes::write_programs(&motion, folder))?;
    }
    if parts.has(Part::Report) {
        let words = RunWords { resolved_scene: resolved, backend: &backend.name_in_files(), backend_why };
        write_report(tools, || report::page(job, &gear, &found, &motion, &words, folder))?;
    }
    let out = folder.results_path(!interrupted);
    let work = Work { stats: gear.stats, dexels: gear.dexels, elapsed: gear.elapsed, interrupted };
    let flanks = gear.report.flanks.len();
    let summary = summary::text(&job.scene.gear, &found, flanks, &work, &out, &backend.name());
    Ok(CutDone { results, summary, work })
}
