//! The order of a whole run: scene -> job -> flanks (cut, measure, map, drop) -> gear -> files -> summary.
//!
//! The unit of work is one flank through all operations; flanks go to the cores in parallel and are written as they are finished, so memory grows with the cores and not with the
//! gear. The output folder appears under its name only when it is complete; Ctrl-C completes it with the flanks that are finished and says so.
//!
//! Here stands what all processes share; [`shaping`] and [`hobbing`] measure and write what is their own.

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
pub mod shaping;
mod summary;
mod tooth_results;

pub use shaping::{CutGear, cut_gear};

use crate::cut::{Backend, CutStats};
use crate::error::{Error, Result};
use crate::gear::generation::Side;
use crate::job::{GearJob, Prepared};
use crate::output::flank_maps::OperationMaps;
use crate::output::folder::OutputFolder;
use crate::output::interrupt::Interrupt;
use crate::output::progress::Progress;
use crate::scene::LoadedScene;
use crate::surface::SurfaceGrid;
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Duration;

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

/// Both flanks of every tooth, in order.
fn flanks_of(job: &dyn GearJob) -> Vec<(u32, Side)> {
    (1..=job.scene().gear.teeth).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]).collect()
}

/// What the maps need to know of the operations.
fn map_operations(job: &dyn GearJob) -> Vec<OperationMaps> {
    let operations = job.operations();
    let finishing_mm = operations.last().map_or(0.0, |(_, offset_mm)| *offset_mm);
    let pressure_angle_rad = job.scene().gear.transverse_pressure_angle_rad();
    let maps = operations
        .iter()
        .map(|(name, offset_mm)| OperationMaps::new(name, offset_mm - finishing_mm, pressure_angle_rad));
    maps.collect()
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

/// Everything that a run is done with.
struct Tools<'a> {
    /// The scene with every value written out.
    resolved: &'a str,
    backend: &'a dyn Backend,
    /// Why it was taken.
    backend_why: &'a str,
    progress: &'a Progress,
    interrupt: &'a Interrupt,
    folder: &'a OutputFolder,
    /// Scene and program, for the heads of files.
    notes: &'a [(String, String)],
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
    let tools =
        Tools { resolved: &resolved, backend, backend_why, progress, interrupt, folder: &folder, notes: &notes };
    let (results, summary, work) = match Prepared::new(&scene.scene)? {
        Prepared::Shaping(job) => shaping::run(&job, &tools, out, frames)?,
        Prepared::Hobbing(job) => {
            if frames.is_some() {
                progress.note("no frames are drawn: pictures of the cut as it happens exist for shaping only");
            }
            hobbing::run(&job, &tools, out)?
        }
    };
    let record = files::run_record(&resolved, backend, backend_why, &work, &folder)?;
    folder.write_json(crate::output::folder::RUN_RECORD, &record)?;
    for incident in backend.incidents() {
        progress.note(&incident);
    }
    Ok(Done { folder: folder.finish()?, summary, results, interrupted: work.interrupted })
}

/// Meshes of the whole gear and the scene's pictures of it; whether all pictures were drawn.
fn write_meshes_and_pictures(job: &dyn GearJob, flanks: Vec<SurfaceGrid>, tools: &Tools) -> Result<bool> {
    let Tools { backend, progress, interrupt, folder, notes, .. } = *tools;
    match meshes::gear(job, backend, flanks, progress) {
        Ok(solid) => {
            meshes::write_gear(job, &solid, folder, notes)?;
            let drawn = pictures::draw(job, backend, &solid, progress, interrupt, folder, notes)?;
            let asked = job.scene().pictures.len();
            if drawn < asked {
                progress.note(&format!("stopped: {drawn} of {asked} pictures are drawn"));
            }
            Ok(drawn == asked)
        }
        // What was cut and measured is not lost for a mesh.
        Err(Error::Refused(refusal)) => {
            progress
                .note(&format!("mesh/gear.* and its pictures are left out; mesh/blank.ply shows the gear. {refusal}"));
            Ok(true)
        }
        Err(error) => Err(error),
    }
}
