//! The backend that the command line asks for.

use super::args::{BackendChoice, GpuFailureChoice, RunArguments};
use super::drivers;
use gearcut::Error;
use gearcut::backend::{BackendWish, Choice, OnFailure, choose};
use gearcut::output::progress::{Progress, ProgressMode};

/// The backend, `auto` unless the command line names one; the program may be started anew for it ([`drivers`]), so that
/// nothing but reading comes before.
///
/// # Errors
/// A GPU was asked for and there is none.
pub fn chosen(wish: Option<BackendChoice>, on_failure: GpuFailureChoice) -> Result<Choice, Error> {
    let wish = wish.unwrap_or(BackendChoice::Auto);
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

/// Backend, the processor unless the command line names one, and progress of a command that cuts on few places; it is
/// shown as events where `json` says so.
///
/// # Errors
/// As for [`chosen`].
pub fn of_few_places(arguments: &RunArguments, json: bool) -> Result<(Choice, Progress), Error> {
    let wish = arguments.backend.unwrap_or(BackendChoice::Cpu);
    let choice = chosen(Some(wish), GpuFailureChoice::Redo)?;
    let progress = Progress::new(ProgressMode::choose(arguments.quiet, json));
    if wish != BackendChoice::Cpu {
        progress.note(&note(&choice));
    }
    Ok((choice, progress))
}

/// What was taken, and why.
pub fn note(choice: &Choice) -> String {
    format!("backend: {} ({})", choice.backend.name(), choice.why)
}
