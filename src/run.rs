//! The order of a whole run: scene -> job -> flanks (cut, measure, map, drop) -> gear -> files -> summary.
//!
//! The unit of work is one flank through all operations; flanks go to the cores in parallel and are written as they are
//! finished, so memory grows with the cores and not with the gear. The output folder appears under its name only when
//! it is complete; what Ctrl-C leaves of it, the flanks that are finished and what follows from them, goes to a folder
//! beside it.
//!
//! Nothing here knows a process by name: its job cuts itself with the shared `crate::steps`.

use crate::backend::Choice;
use crate::findings::Findings;
use crate::interrupt::Interrupt;
use crate::output::folder::{NamedResult, OutputFolder, SCENE_FOLDER};
use crate::process::{CutDone, ProcessJob};
use crate::progress::{Progress, ProgressMode};
use crate::scene::LoadedScene;
use crate::steps::backend_trial::BackendTrial;
use crate::steps::parts::{Parts, Stage, Stages};
use crate::steps::summary::Summary;
use crate::steps::{Tools, record};
use gearcut_core::cut::Backend;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::error::Result;
use std::path::Path;

/// A finished run.
#[derive(Debug)]
pub struct Done {
    /// Where the files are: the folder that was asked for, or the partial one beside it. An earlier result of that name
    /// is removed with this at the latest.
    pub folder: NamedResult,
    /// Summary for the terminal.
    pub summary: Summary,
    /// What was found; `results.json` is the same tree.
    pub findings: Findings,
    /// Whether Ctrl-C ended it early.
    pub interrupted: bool,
}

/// A run to be made: a scene, what cuts it, and what differs from the defaults (silent, not to be stopped, everything
/// written, no frames).
pub struct Run<'a> {
    scene: &'a LoadedScene,
    prepared: &'a dyn ProcessJob,
    choice: &'a Choice,
    progress: Option<&'a Progress>,
    interrupt: Interrupt,
    parts: Parts,
    stages: Stages,
    frames: Option<u32>,
}

impl<'a> Run<'a> {
    /// A run of a scene that was made ready, on a backend; [`crate::Job::run`] has all three.
    pub fn new(scene: &'a LoadedScene, prepared: &'a dyn ProcessJob, choice: &'a Choice) -> Self {
        let (interrupt, parts) = (Interrupt::default(), Parts::all());
        Self { scene, prepared, choice, progress: None, interrupt, parts, stages: Stages::ALL, frames: None }
    }

    /// Shows steps, time left and notes.
    #[must_use]
    pub fn show(self, progress: &'a Progress) -> Self {
        Self { progress: Some(progress), ..self }
    }

    /// Ends early, and keeps what is finished, once the flag is raised.
    #[must_use]
    pub fn until(self, interrupt: &Interrupt) -> Self {
        Self { interrupt: interrupt.clone(), ..self }
    }

    /// Writes the numbers and these parts, and leaves out what they do not need.
    #[must_use]
    pub fn only(self, parts: Parts) -> Self {
        Self { parts, ..self }
    }

    /// Makes these measurements beside those of flanks; numbers of others are not among what is found.
    #[must_use]
    pub fn stages(self, stages: Stages) -> Self {
        Self { stages, ..self }
    }

    /// Draws so many pictures of the cut as it happens.
    #[must_use]
    pub fn frames(self, frames: Option<u32>) -> Self {
        Self { frames, ..self }
    }

    /// Cuts and measures, and keeps no file. A GPU that nobody asked for by name is not tried.
    ///
    /// # Errors
    /// Geometry, the backend. Ctrl-C is no error once a flank is finished.
    pub fn found(self) -> Result<Findings> {
        let (native, quiet) = (Cpu::default(), Progress::new(ProgressMode::Quiet));
        let tools = Tools {
            resolved: "",
            backend: self.choice.untried(&native),
            backend_why: &self.choice.why,
            progress: self.progress.unwrap_or(&quiet),
            interrupt: &self.interrupt,
            folder: &OutputFolder::nowhere(),
            parts: Parts::of([]),
            stages: self.stages,
            notes: &[],
        };
        let mut found = self.prepared.cut(&tools, None)?.findings;
        found.retain(&|path| self.stages.find(path));
        Ok(found)
    }

    /// Cuts and writes everything into `out`, which is opened before the work begins, so that a bad path fails at once.
    ///
    /// # Errors
    /// Geometry, the backend, files. Ctrl-C is no error once a flank is finished.
    pub fn into_folder(self, out: &Path) -> Result<Done> {
        let Self { scene, prepared, choice, progress, interrupt, parts, stages, frames } = self;
        let quiet = Progress::new(ProgressMode::Quiet);
        let progress = progress.unwrap_or(&quiet);
        let mut trial = None;
        if choice.on_trial {
            prepared.with_gear(&mut |gear| {
                let with_blank = stages.has(Stage::Blank);
                trial = Some(BackendTrial::new(gear, choice.backend.as_ref(), with_blank, &interrupt)?);
                Ok(())
            })?;
        }
        let native = Cpu::default();
        let gpu = choice.backend.as_ref();
        let faster = trial.as_ref().map(|trial| trial.backends(gpu, &native));
        let backend = faster.as_ref().map_or(gpu, |faster| faster as &dyn Backend);
        let backend_why = trial.map_or_else(|| choice.why.clone(), |trial| format!("{}, {}", choice.why, trial.why()));
        if choice.on_trial {
            progress.note(&format!("backend: {} ({backend_why})", backend.name()));
        }
        let folder = OutputFolder::create_of(out, "cut", &parts.names())?;
        let resolved = scene.resolved_toml();
        // Times and threads stand in the run record alone: the same scene gives the same bytes.
        let run = serde_json::json!({
            "program": "gearcut",
            "version": env!("CARGO_PKG_VERSION"),
            "backend": backend.name_in_files(),
        });
        let sha256 = record::sha256_hex(resolved.as_bytes());
        let notes = [("run", run.to_string()), ("scene", resolved.clone()), ("scene_sha256", sha256)]
            .map(|(name, text)| (name.to_owned(), text));
        let tools = Tools {
            resolved: &resolved,
            backend,
            backend_why: &backend_why,
            progress,
            interrupt: &interrupt,
            folder: &folder,
            parts,
            stages,
            notes: &notes,
        };
        let written = || -> Result<CutDone> {
            let done = prepared.cut(&tools, frames)?;
            let checksums = record::checksums(&tools)?;
            let step = progress.step("to the disk", 1, "folder");
            folder.force_to_disk()?;
            step.advance(1);
            step.finish();
            let mut record = record::run_record(&tools, &done.work, done.findings.complete, &checksums);
            if let Some(files) = scene.folder_of_files(out)? {
                record.insert(SCENE_FOLDER.to_owned(), files.into());
            }
            folder.write_record(record)?;
            Ok(done)
        };
        let CutDone { findings, summary, work } = written().map_err(|error| folder.explain(error))?;
        for incident in backend.incidents() {
            progress.note(&incident);
        }
        let folder = if findings.complete { folder.take_name()? } else { folder.take_partial_name()? };
        Ok(Done { folder, summary, findings, interrupted: work.interrupted })
    }
}
