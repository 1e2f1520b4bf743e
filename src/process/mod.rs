//! Processes: a folder for each with its tool, linkage, target, passes, and what only it measures; and the table of
//! them.
//!
//! A process is what [`PROCESSES`] lists: what its scenes may say, and how one is made ready. The reader of scenes and
//! the commands that cut, check and move axes go through [`Process`] and [`ProcessJob`] and know no process by name.
//!
//! Two traits, not one: a [`ProcessJob`] runs whole commands in the process's own order, from the shared steps; a
//! [`crate::job::GearJob`] answers what those steps ask (target profiles, surfaces of flanks, roots and tips). The road
//! not taken is one trait with a method for every measure: each new measure of one process would have to be thought of
//! in all.

pub mod bevel;
pub mod hobbing;
pub mod shaping;

use crate::findings::notice::NoticeRow;
use crate::findings::{Findings, Notice, QuantityGroup};
use crate::interrupt::Interrupt;
use crate::job::GearJob;
use crate::output::folder::OutputFolder;
use crate::output::text::Sheet;
use crate::scene::draft::draft_settings;
use crate::scene::{self, KeyTable, LoadedScene, Scene, SceneErrors, SceneProcess};
use crate::steps::summary::Summary;
use crate::steps::{Tools, Work};
use gearcut_core::error::Result;
use std::path::Path;
use std::sync::LazyLock;

/// What came of a cut.
#[derive(Debug)]
pub struct CutDone {
    /// What was found; `results.json` is the same tree.
    pub findings: Findings,
    /// Summary for the terminal.
    pub summary: Summary,
    /// How much work it was.
    pub work: Work,
}

/// A process of manufacture.
#[derive(Debug)]
pub struct Process {
    /// What its scenes may say.
    pub scene: &'static SceneProcess,
    /// What it warns of beside what all processes share.
    pub notices: &'static [NoticeRow],
    /// Quantities that only it finds.
    pub quantities: &'static [&'static QuantityGroup],
    /// Makes a scene ready to cut; it refuses geometry that cannot be cut, and scenes of other processes.
    pub prepare: fn(&Scene) -> Result<Box<dyn ProcessJob>>,
    /// Peaks of the axes against their limits, and nothing that only teeth need.
    pub axis_peaks: fn(&Scene) -> Result<Findings>,
}

/// A scene made ready to cut.
pub trait ProcessJob: Send + Sync {
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
    fn check(&self, sheet: &mut Sheet) -> Result<Vec<Notice>>;

    /// What must be known before cutting, without the cost of [`Self::check`].
    ///
    /// # Errors
    /// Geometry that cannot be cut.
    fn foreseen(&self) -> Result<Vec<Notice>>;

    /// Those of them that follow from the shapes of gear and tool alone, undercut, pointed teeth, interference in
    /// rings: where others take long, they can follow a hand that draws a gear.
    ///
    /// # Errors
    /// Geometry that cannot be cut.
    fn foreseen_of_shapes(&self) -> Result<Vec<Notice>>;

    /// Charts of the axes as SVG, by the names of their files without endings.
    ///
    /// # Errors
    /// A chart that cannot be drawn.
    fn axis_charts(&self) -> Result<Vec<(String, String)>>;

    /// Shows the gear to `visit`, with which single flanks can be cut.
    ///
    /// # Errors
    /// Those of `visit`; more passes than can be numbered.
    fn with_gear(&self, visit: &mut dyn FnMut(&dyn GearJob) -> Result<()>) -> Result<()>;

    /// Makes another scene ready, whose errors differ, or some of its keys; what both have in common may be taken over,
    /// such as targets. The job is the same as that of [`prepare`].
    ///
    /// # Errors
    /// Geometry that cannot be cut.
    fn with_errors_of(&self, scene: &Scene) -> Result<Box<dyn ProcessJob>> {
        prepare(scene)
    }

    /// Writes axis tables, charts and programs, and says what the axes do; gives what must be known before they are
    /// used.
    ///
    /// # Errors
    /// Files that cannot be written; Ctrl-C.
    fn axes(&self, folder: &OutputFolder, interrupt: &Interrupt, sheet: &mut Sheet) -> Result<Vec<Notice>>;
}

/// All processes; a new one adds its line here.
pub static PROCESSES: &[&Process] = &[&shaping::PROCESS, &hobbing::PROCESS, &bevel::PROCESS];

/// The keys of all scenes.
pub fn table() -> &'static KeyTable {
    static TABLE: LazyLock<KeyTable> =
        LazyLock::new(|| KeyTable::new(&PROCESSES.iter().map(|process| process.scene).collect::<Vec<_>>()));
    &TABLE
}

/// Loads the scene file at `path`, with `--set` arguments put in.
///
/// # Errors
/// All problems of the scene, each with its place and a way out.
pub fn load(path: &Path, settings: &[String]) -> Result<LoadedScene, SceneErrors> {
    scene::load(path, settings, table())
}

/// Loads the scene file at `path` as a draft of itself; what is set comes last and wins.
///
/// # Errors
/// All problems of the scene, each with its place and a way out.
pub fn load_draft(path: &Path, settings: &[String]) -> Result<LoadedScene, SceneErrors> {
    let whole = load(path, settings)?;
    let mut draft = load(path, &[draft_settings(&whole.scene).as_slice(), settings].concat())?;
    draft.scene.is_draft = true;
    Ok(draft)
}

/// Reads a scene from text; see [`scene::parse`].
///
/// # Errors
/// All problems of the scene, each with its place and a way out.
pub fn parse(text: &str, file_name: &str, base_dir: &Path, settings: &[String]) -> Result<LoadedScene, SceneErrors> {
    scene::parse(text, file_name, base_dir, settings, table())
}

/// Makes a scene ready to cut, by the process that its tool is for.
///
/// # Errors
/// Geometry that cannot be cut: see the parts.
pub fn prepare(scene: &Scene) -> Result<Box<dyn ProcessJob>> {
    (of(scene).prepare)(scene)
}

/// Peaks of the axes against their limits; exceeded ones are its only notices.
///
/// # Errors
/// Motion that leads to no pose, cutters and linkages that cannot be.
pub fn axis_peaks(scene: &Scene) -> Result<Findings> {
    (of(scene).axis_peaks)(scene)
}

fn of(scene: &Scene) -> &'static Process {
    let process = PROCESSES.iter().find(|process| process.scene.name == scene.process_name());
    process.expect("scenes are read for the processes of the table")
}
