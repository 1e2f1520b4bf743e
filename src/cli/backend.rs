//! The backend that the command line asks for.

use super::args::{BackendChoice, ComputeArguments, GpuFailureChoice};
use super::drivers;
use crate::backend::{BackendWish, Choice, OnFailure, choose};
use crate::interrupt::Interrupt;
use crate::process;
use crate::progress::{Progress, ProgressMode};
use crate::scene::Scene;
use crate::steps::backend_trial::BackendTrial;
use gearcut_core::Error;
use serde_json::{Value, json};

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

/// Backend, the processor unless the command line names one, and progress of a command that cuts on few places of a
/// scene; it is shown as events where `json` says so.
///
/// # Errors
/// As for [`chosen`]; a GPU on trial that fails, or a scene that cannot be cut.
pub fn of_few_places(arguments: &ComputeArguments, json: bool, scene: &Scene) -> Result<(Choice, Progress), Error> {
    let wish = arguments.backend.unwrap_or(BackendChoice::Cpu);
    let mut choice = chosen(Some(wish), GpuFailureChoice::Redo)?;
    if choice.on_trial {
        choice = tried(choice, scene)?;
    }
    let progress = Progress::new(ProgressMode::choose(arguments.quiet, json));
    if wish != BackendChoice::Cpu {
        progress.note(&note(&choice));
    }
    Ok((choice, progress))
}

/// A choice on trial, settled on tiles of the scene.
fn tried(choice: Choice, scene: &Scene) -> Result<Choice, Error> {
    let mut trial = None;
    process::prepare(scene)?.with_gear(&mut |gear| {
        trial = Some(BackendTrial::new(gear, choice.backend.as_ref(), false, &Interrupt::default())?);
        Ok(())
    })?;
    Ok(match trial {
        Some(trial) => trial.settle(choice),
        None => choice,
    })
}

/// What run records say of it.
pub fn record(choice: &Choice) -> [(&'static str, Value); 2] {
    [("backend", json!(choice.backend.name())), ("backend_why", json!(choice.why))]
}

/// What was taken, and why.
pub fn note(choice: &Choice) -> String {
    format!("backend: {} ({})", choice.backend.name(), choice.why)
}
