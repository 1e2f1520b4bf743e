//! The order of a whole run: scene -> job -> flanks (cut, measure, map, drop) -> gear -> files -> summary.
//!
//! The unit of work is one flank through all operations; flanks go to the cores in parallel and are written as they are finished, so memory grows with the cores and not with the
//! gear. The output folder appears under its name only when it is complete; Ctrl-C completes it with the flanks that are finished and says so.

mod blank;
mod chip_files;
mod chip_results;
mod files;
mod frames;
pub mod hobbing;
mod meshes;
mod pictures;
mod report;
mod results;
mod summary;
mod tooth_results;

use crate::cut::{Backend, CutStats};
use crate::error::{Error, Result};
use crate::gcode;
use crate::gear::generation::Side;
use crate::job::{HobCutter, Job, Prepared};
use crate::measure::chips::ChipLedger;
use crate::measure::{FlankReport, GearReport, flank_report, gear_report};
use crate::output::flank_maps::{FlankMaps, OperationMaps};
use crate::output::folder::OutputFolder;
use crate::output::interrupt::Interrupt;
use crate::output::progress::Progress;
use crate::output::report::REPORT_FILE;
use crate::scene::LoadedScene;
use crate::surface::SurfaceGrid;
use crate::texture;
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// How much work a run was.
#[derive(Debug, Clone, Copy)]
pub struct Work {
    /// What the backend met.
    pub stats: CutStats,
    /// Dexels cut, all operations.
    pub dexels: u64,
    /// Wall time of cutting and measuring, files of flanks included.
    pub elapsed: Duration,
    /// Stopped by the user before all flanks were done.
    pub interrupted: bool,
}

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
    let flanks: Vec<(u32, Side)> =
        (1..=job.scene.gear.teeth).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]).collect();
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
        let maps = FlankMaps::sample(tooth, side, [&cut.field.arcs_mm(), &cut.field.leads_mm], &cut.layers, spacing_mm);
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

/// Runs something over all flanks in parallel; nothing for those that were left out. The first failure stops the rest; what it was is kept, not the flanks' order of arrival.
fn all_flanks<T: Send>(
    flanks: &[(u32, Side)],
    cut_one: impl Fn(&(u32, Side)) -> Result<Option<T>> + Sync,
) -> Result<Vec<Option<T>>> {
    let failure = Mutex::new(None);
    let finished = flanks
        .par_iter()
        .map(|flank| {
            if failure.lock().is_ok_and(|f: std::sync::MutexGuard<Option<Error>>| f.is_some()) {
                return None;
            }
            cut_one(flank).unwrap_or_else(|error| {
                if let Ok(mut first) = failure.lock() {
                    first.get_or_insert(error);
                }
                None
            })
        })
        .collect();
    match failure.into_inner().unwrap_or_default() {
        Some(error) => Err(error),
        None => Ok(finished),
    }
}

/// What the maps need to know of the operations.
fn map_operations(job: &Job) -> Vec<OperationMaps> {
    let finishing_mm = job.finishing().spec.offset_mm;
    job.operations
        .iter()
        .map(|o| OperationMaps::new(&o.spec.name, o.spec.offset_mm - finishing_mm, job.scene.gear.pressure_angle_rad))
        .collect()
}

/// A finished run.
#[derive(Debug)]
pub struct Done {
    /// Where the files are.
    pub folder: PathBuf,
    /// Summary for the terminal.
    pub summary: String,
    /// `results.json`.
    pub results: serde_json::Value,
    /// Whether Ctrl-C ended it early.
    pub interrupted: bool,
}

/// Cuts a scene and writes everything into `out`.
///
/// `backend_why` says why this backend was taken; `frames` is how many pictures of the cut as it happens are drawn. The output folder is opened before the work begins, so that a bad path fails at once.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error once a flank is finished.
pub fn cut(
    scene: &LoadedScene,
    out: &Path,
    backend: &dyn Backend,
    backend_why: &str,
    progress: &Progress,
    interrupt: &Interrupt,
    frames: Option<u32>,
) -> Result<Done> {
    let folder = OutputFolder::create(out)?;
    let resolved = scene.resolved_toml();
    // Timings stay out of maps: the same scene gives the same bytes.
    let run =
        serde_json::json!({"program": "gearcut", "version": env!("CARGO_PKG_VERSION"), "backend": backend.name()});
    let notes = [("run".to_owned(), run.to_string()), ("scene".to_owned(), resolved.clone())];
    let job = match Prepared::new(&scene.scene)? {
        Prepared::Shaping(job) => *job,
        Prepared::Hobbing(job) => {
            // Too large a blank field is refused before the first cut.
            job.blank_grid()?;
            let gear = hobbing::cut_gear(&job, backend, progress, interrupt, Some((&folder, &notes)))?;
            let cutter = HobCutter::new(&job)?;
            let whole =
                if gear.work.interrupted { None } else { hobbing::blank::cut(&cutter, progress, interrupt)? };
            let results = hobbing::write(&job, &gear, whole.as_ref().map(|whole| (&cutter, whole)), &folder)?;
            let summary = hobbing::summary(&job, &gear, out, &backend.name());
            let mut work = gear.work;
            work.interrupted |= whole.is_none();
            let done = (results, summary, work);
            return finish(done, &resolved, backend, backend_why, progress, folder);
        }
    };
    // A window that lies on no flank, or too large a blank field, is refused before the first cut.
    texture::windows(&job)?;
    job.blank_grid()?;
    let gear = cut_gear(&job, backend, progress, interrupt, Some((&folder, &notes)))?;
    if gear.report.flanks.is_empty() {
        return Err(Error::Interrupted);
    }
    let textures = texture::measure(&job, backend, progress, interrupt)?;
    let whole = if gear.interrupted { None } else { blank::cut(&job, progress, interrupt)? };
    if let Some((_, report)) = &whole {
        blank::write_table_of_damage(&job, report, &folder)?;
    }
    let blank = whole.as_ref().map(|(cut, report)| blank::results(&job, cut, report));
    let results = results::results(&job, &gear, blank, &textures);
    files::write(&job, &gear, &results, &folder, &notes)?;
    texture::write(&job, &textures, &folder, &notes)?;
    let mut interrupted = whole.is_none();
    if let Some((cut, _)) = &whole {
        meshes::write_blank(&job, cut, &folder)?;
        match meshes::gear(&job, backend, gear.surfaces.clone(), progress) {
            Ok(solid) => {
                meshes::write_gear(&job, &solid, &folder, &notes)?;
                let drawn = pictures::draw(&job, backend, &solid, progress, interrupt, &folder, &notes)?;
                if drawn < job.scene.pictures.len() {
                    progress.note(&format!("stopped: {drawn} of {} pictures are drawn", job.scene.pictures.len()));
                    interrupted = true;
                }
            }
            // What was cut and measured is not lost for a mesh.
            Err(Error::Refused(refusal)) => progress
                .note(&format!("mesh/gear.* and its pictures are left out; mesh/blank.ply shows the gear. {refusal}")),
            Err(error) => return Err(error),
        }
        if let Some(count) = frames {
            let drawn = frames::draw(&job, count, progress, interrupt, &folder)?;
            if drawn < count {
                progress.note(&format!("stopped: {drawn} of {count} frames are drawn"));
                interrupted = true;
            }
        }
    }
    for note in gcode::write_all(&job, &folder)? {
        progress.note(&note);
    }
    let words = report::RunWords { resolved_scene: &resolved, backend: &backend.name(), backend_why };
    report::page(&job, &gear, &results, &words, &folder)?.write(&folder.path(REPORT_FILE)?)?;
    let summary = summary::summary(&job, &gear, &results, out, &backend.name());
    let CutGear { stats, dexels, elapsed, .. } = gear;
    let results = serde_json::to_value(&results)
        .map_err(|reason| Error::Output { path: out.to_owned(), reason: reason.to_string() })?;
    let done = (results, summary, Work { stats, dexels, elapsed, interrupted });
    finish(done, &resolved, backend, backend_why, progress, folder)
}

/// Run record, incidents, the folder under its name.
fn finish(
    (results, summary, work): (serde_json::Value, String, Work),
    resolved: &str,
    backend: &dyn Backend,
    backend_why: &str,
    progress: &Progress,
    folder: OutputFolder,
) -> Result<Done> {
    let record = files::run_record(resolved, backend, backend_why, &work, &folder)?;
    folder.write_json(crate::output::folder::RUN_RECORD, &record)?;
    for incident in backend.incidents() {
        progress.note(&incident);
    }
    Ok(Done { folder: folder.finish()?, summary, results, interrupted: work.interrupted })
}
