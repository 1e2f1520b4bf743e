//! `gearcut check`: what a scene means, before anything is cut.
//!
//! One part per question: is this the pitch curve I meant, what does the tool do to the teeth, can the machine follow,
//! what will the cut cost. A scene whose cut will be faulty is told so by the exit code as well.

use super::args::SceneArguments;
use super::failure::Failure;
use super::print;
use gearcut::output::text::Sheet;
use gearcut::process;

/// Runs the command.
pub fn run(arguments: &SceneArguments) -> Result<(), Failure> {
    let scene = process::load(&arguments.scene, &arguments.settings)?;
    let mut sheet = Sheet::default();
    let checked = print::waiting("check", || process::prepare(&scene.scene).and_then(|job| job.check(&mut sheet)));
    let warnings = checked.map_err(|error| Failure::of_scene(&scene, error))?;
    print::sheet(&sheet.into_text())?;
    print::warnings(&warnings);
    Failure::verdict(&warnings)
}
