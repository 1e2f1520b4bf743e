//! The order of a whole run: scene -> job -> flanks (cut, measure, map, drop) -> gear -> files -> summary.
//!
//! The unit of work is one flank through all operations; flanks go to the cores in parallel and are written as they are finished, so memory grows with the cores and not with the
//! gear. The output folder appears under its name only when it is complete; Ctrl-C completes it with the flanks that are finished and says so.

mod blank;
mod files;
mod frames;
mod meshes;
mod pictures;
mod report;
mod results;
mod summary;
mod tooth_results;

use crate::cut::{Backend, CutStats};
use crate::error::{Error, Result};
use crate::gear::generation::Side;
use crate::job::Job;
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

/// A cut and measured gear, before anything is written about it as a whole.
#[derive(Debug)]
pub struct CutGear {
    /// What was measured.
    pub report: GearReport,
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
        let maps = FlankMaps::sample(tooth, side, &cut.field, &cut.layers, spacing_mm);
        let surface = SurfaceGrid::new(&cut.field, &cut.layers, job.scene.output.mesh_spacing_mm);
        if let Some((folder, notes)) = folder {
            maps.write(folder, &operations, notes)?;
            meshes::write_flank(job, &surface, tooth, side, folder)?;
        }
        step.advance(1);
        let dexels = (cut.field.len() * cut.layers.len()) as u64;
        Ok(Some(Finished { report, maps, surface, stats: cut.stats, dexels }))
    };
    // The first failure stops the rest; what it was is kept, not the flanks' order of arrival.
    let failure = Mutex::new(None);
    let finished: Vec<Option<Finished>> = flanks
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
    if let Some(error) = failure.into_inner().unwrap_or_default() {
        return Err(error);
    }
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
    Ok(CutGear { report, maps, surfaces, stats, dexels, elapsed: started.elapsed(), interrupted })
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
    pub results: crate::output::results::Results,
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
    let job = Job::new(scene.scene.clone())?;
    // A window that lies on no flank is refused before the first cut.
    texture::windows(&job)?;
    // Too large a blank field is refused before anything is cut.
    job.blank_grid()?;
    let resolved = scene.resolved_toml();
    // Timings stay out of maps: the same scene gives the same bytes.
    let run =
        serde_json::json!({"program": "gearcut", "version": env!("CARGO_PKG_VERSION"), "backend": backend.name()});
    let notes = [("run".to_owned(), run.to_string()), ("scene".to_owned(), resolved.clone())];
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
    if !gear.interrupted {
        let solid = meshes::gear(&job, backend, gear.surfaces.clone(), progress)?;
        meshes::write_gear(&job, &solid, &folder, &notes)?;
        let drawn = pictures::draw(&job, backend, &solid, progress, interrupt, &folder, &notes)?;
        if drawn < job.scene.pictures.len() {
            progress.note(&format!("stopped: {drawn} of {} pictures are drawn", job.scene.pictures.len()));
        }
        if let Some(count) = frames {
            let drawn = frames::draw(&job, count, progress, interrupt, &folder)?;
            if drawn < count {
                progress.note(&format!("stopped: {drawn} of {count} frames are drawn"));
            }
        }
    }
    let words = report::RunWords { resolved_scene: &resolved, backend: &backend.name(), backend_why };
    report::page(&job, &gear, &results, &words)?.write(&folder.path(REPORT_FILE)?)?;
    let record = files::run_record(&resolved, backend, backend_why, &gear, &folder)?;
    folder.write_json(crate::output::folder::RUN_RECORD, &record)?;
    for incident in backend.incidents() {
        progress.note(&incident);
    }
    let summary = summary::summary(&job, &gear, &results, out, &backend.name());
    Ok(Done { folder: folder.finish()?, summary, results, interrupted: gear.interrupted })
}
