//! The backend that the command line asks for.

use super::args::{BackendChoice, FewPlacesArguments, GpuFailureChoice};
use super::drivers;
use gearcut::Error;
use gearcut::backend::{BackendWish, Choice, OnFailure, choose};
use gearcut::output::progress::{Progress, ProgressMode};

/// The backend; the program may be started anew for it ([`drivers`]), so that nothing but reading comes before.
///
/// # Errors
/// A GPU was asked for and there is none.
pub fn chosen(wish: BackendChoice, on_failure: GpuFailureChoice) -> Result<Choice, Error> {
    if wish != BackendChoice::Cpu {
        drivers::without_window_system();
    }
    let wish = match wish {
        BackendChoice::Auto => BackendWish::Auto,
        BackendChoice::Gpu => BackendWish::Gpu,
        BackendChoice::Cpu => BackendWish::Cpu,
    };
    let on_failure = match on_failure {
        GpuFailureChoice::Redo => OnFailure::RedoNatively,
        GpuFailureChoice::Stop => OnFailure::Stop,
    };
    choose(wish, on_failure)
}

/// Backend and progress of a command that cuts on few places.
///
/// # Errors
/// As for [`chosen`].
pub fn of_few_places(arguments: &FewPlacesArguments) -> Result<(Choice, Progress), Error> {
    of_few_places_with_events(arguments, false)
}

/// The same; progress is shown as events where `json` says so.
///
/// # Errors
/// As for [`chosen`].
pub fn of_few_places_with_events(arguments: &FewPlacesArguments, json: bool) -> Result<(Choice, Progress), Error> {
    let choice = chosen(arguments.backend, GpuFailureChoice::Redo)?;
    let progress = Progress::new(ProgressMode::choose(arguments.quiet, json));
    if arguments.backend != BackendChoice::Cpu {
        progress.note(&note(&choice));
    }
    Ok((choice, progress))
}

/// What was taken, and why.
pub fn note(choice: &Choice) -> String {
    format!("backend: {} ({})", choice.backend.name(), choice.why)
}
