//! `gearcut cut`: the whole job.

use gearcut::output::progress::ProgressMode;
use gearcut::scene;

use super::args::CutArguments;
use super::failure::Failure;

/// Runs the command.
pub fn run(arguments: &CutArguments) -> Result<(), Failure> {
    let _scene = scene::load(&arguments.scene.scene, &arguments.scene.settings)?;
    let _progress = ProgressMode::choose(arguments.quiet, arguments.json);
    Ok(())
}
