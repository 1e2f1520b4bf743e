//! Processes: a folder for each with its tool, linkage, target, passes, and what only it measures; and the table of
//! them.
//!
//! A process is what [`PROCESSES`] lists. The commands that cut, check and move axes go through [`Process`] and [`Job`]
//! and know no process by name; what its scenes may say is listed in [`crate::scene::PROCESSES`].
//!
//! Two traits, not one: a [`Job`] runs whole commands in the process's own order, from the shared steps; a
//! [`crate::job::GearJob`] answers what those steps ask (target profiles, surfaces of flanks, roots and tips). The road
//! not taken is one trait with a method for every measure: each new measure of one process would have to be thought of
//! in all.

pub mod hobbing;
pub mod shaping;

use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::output::folder::OutputFolder;
use crate::output::text::Sheet;
use crate::scene::Scene;
use crate::steps::{Tools, Work};
use serde_json::Value;

/// What came of a cut.
#[derive(Debug)]
pub struct CutDone {
    /// `results.json`.
    pub results: Value,
    /// Summary for the terminal.
    pub summary: String,
    /// How much work it was.
    pub work: Work,
}

/// A process of manufacture.
pub trait Process: Sync {
    /// What scenes call it.
    fn name(&self) -> &'static str;

    /// Makes a scene ready to cut.
    ///
    /// # Errors
    /// Geometry that cannot be cut; a scene for another process.
    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Job>>;
}

/// A scene made ready to cut.
pub trait Job: Sync {
    /// Cuts and measures, and writes everything but the run record; `frames` is how many pictures of the cut as it
    /// happens are drawn.
    ///
    /// # Errors
    /// Geometry, the backend, files. Ctrl-C is no error once a flank is finished.
    fn cut(&self, tools: &Tools, frames: Option<u32>) -> Result<CutDone>;

    /// Says what the scene means before anything is cut; gives what must be known before cutting.
    ///
    /// # Errors
    /// Geometry that cannot be cut.
    fn check(&self, sheet: &mut Sheet) -> Result<Vec<String>>;

    /// Writes axis tables, charts and programs, and says what the axes do; gives what must be known before they are
    /// used.
    ///
    /// # Errors
    /// Files that cannot be written; Ctrl-C.
    fn axes(&self, folder: &OutputFolder, interrupt: &Interrupt, sheet: &mut Sheet) -> Result<Vec<String>>;
}

/// All processes; a new one adds its line here.
pub const PROCESSES: [&dyn Process; 2] = [&shaping::Shaping, &hobbing::Hobbing];

/// Makes a scene ready to cut, by the process that its tool is for.
///
/// # Errors
/// Geometry that cannot be cut: see the parts.
pub fn prepare(scene: &Scene) -> Result<Box<dyn Job>> {
    let process = PROCESSES.into_iter().find(|process| process.name() == scene.process_name());
    process.expect("every process that scenes are read for is listed").prepare(scene)
}

#[cfg(test)]
mod tests {
    /// What scenes can be written for and what can be cut are the same processes.
    #[test]
    fn scenes_and_jobs_list_the_same_processes() {
        let jobs = super::PROCESSES.map(super::Process::name);
        assert_eq!(jobs, crate::scene::PROCESSES.map(|process| process.name));
    }
}
