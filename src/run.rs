//! The order of a whole run: scene -> job -> flanks (cut, measure, map, drop) -> gear -> files -> summary.
//!
//! The unit of work is one flank through all operations; flanks go to the cores in parallel and are written as they are
//! finished, so memory grows with the cores and not with the gear. The output folder appears under its name only when
//! it is complete; what Ctrl-C leaves of it, the flanks that are finished and what follows from them, goes to a folder
//! beside it.
//!
//! Nothing here knows a process by name: [`crate::process::Job`] cuts itself with the shared [`crate::steps`].

use crate::cut::Backend;
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::output::folder::OutputFolder;
use crate::output::progress::Progress;
use crate::process::{self, CutDone};
use crate::scene::LoadedScene;
use crate::steps::parts::Parts;
use crate::steps::{Tools, record};
use std::path::{Path, PathBuf};

/// A finished run.
#[derive(Debug)]
pub struct Done {
    /// Where the files are: the folder that was asked for, or the partial one beside it.
    pub folder: PathBuf,
    /// Summary for the terminal.
    pub summary: String,
    /// `results.json`.
    pub results: serde_json::Value,
    /// Whether Ctrl-C ended it early.
    pub interrupted: bool,
}

/// What a run writes.
#[derive(Debug, Clone, Copy)]
pub struct Outputs {
    /// Beyond the numbers.
    pub parts: Parts,
    /// Pictures of the cut as it happens, if any.
    pub frames: Option<u32>,
}

/// Cuts a scene and writes everything into `out`.
///
/// `backend_why` says why this backend was taken. The output folder is opened before the work begins, so that a bad
/// path fails at once.
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
    outputs: Outputs,
) -> Result<Done> {
    let Outputs { parts, frames } = outputs;
    let folder = OutputFolder::create(out)?;
    let resolved = scene.resolved_toml();
    // Times and threads stand in the run record alone: the same scene gives the same bytes.
    let run = serde_json::json!({"program": "gearcut", "version": env!("CARGO_PKG_VERSION"), "backend": backend.name_in_files()});
    let notes = [("run".to_owned(), run.to_string()), ("scene".to_owned(), resolved.clone())];
    let tools =
        Tools { resolved: &resolved, backend, backend_why, progress, interrupt, folder: &folder, parts, notes: &notes };
    let written = || -> Result<CutDone> {
        let done = process::prepare(&scene.scene)?.cut(&tools, frames)?;
        let record = record::run_record(&tools, &done.work)?;
        folder.write_json(crate::output::folder::RUN_RECORD, &record)?;
        Ok(done)
    };
    let CutDone { results, summary, work } = written().map_err(|error| folder.explain(error))?;
    for incident in backend.incidents() {
        progress.note(&incident);
    }
    let folder = if work.interrupted { folder.finish_partial()? } else { folder.finish()? };
    Ok(Done { folder, summary, results, interrupted: work.interrupted })
}
