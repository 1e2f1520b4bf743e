//! `gearcut cut`: the whole job.

use std::path::PathBuf;

use gearcut::cut::choice::{BackendWish, choose};
use gearcut::cut::gpu::{GpuOptions, OnGpuFailure};
use gearcut::output::interrupt::Interrupt;
use gearcut::output::progress::{Progress, ProgressMode};
use gearcut::{Error, run, scene};

use super::args::{BackendChoice, CutArguments, GpuFailureChoice};
use super::failure::Failure;
use super::print;

/// Runs the command; true if all flanks were cut, false if Ctrl-C ended it early.
pub fn run(arguments: &CutArguments) -> Result<bool, Failure> {
    let scene = scene::load(&arguments.scene.scene, &arguments.scene.settings)?;
    let default = || PathBuf::from("out").join(&scene.scene.name);
    let out = arguments.out.clone().or_else(|| scene.scene.output.folder.clone()).unwrap_or_else(default);
    let progress = Progress::new(ProgressMode::choose(arguments.quiet, arguments.json));
    let interrupt = Interrupt::listen().map_err(|source| Error::Io {
        action: "cannot listen for Ctrl-C",
        path: out.clone(),
        source,
    })?;
    let wish = match arguments.backend {
        BackendChoice::Auto => BackendWish::Auto,
        BackendChoice::Gpu => BackendWish::Gpu,
        BackendChoice::Cpu => BackendWish::Cpu,
    };
    let on_failure = match arguments.on_gpu_failure {
        GpuFailureChoice::Redo => OnGpuFailure::RedoNatively,
        GpuFailureChoice::Stop => OnGpuFailure::Stop,
    };
    let choice = choose(wish, GpuOptions { on_failure, ..GpuOptions::default() }).map_err(Error::from)?;
    progress.note(&format!("backend: {} ({})", choice.backend.name(), choice.why));
    let done = run::cut(&scene, &out, choice.backend.as_ref(), &choice.why, &progress, &interrupt, arguments.frames)
        .map_err(|error| Failure::of_scene(&scene, error))?;
    if arguments.json {
        let text = serde_json::to_string_pretty(&done.results)
            .map_err(|reason| Error::Output { path: done.folder.clone(), reason: reason.to_string() })?;
        print::to_stdout(&format!("{text}\n"))?;
    } else if !arguments.quiet {
        print::to_stdout(&done.summary)?;
    }
    Ok(!done.interrupted)
}
