//! `gearcut cut`: the whole job.

use std::path::PathBuf;
use std::sync::Arc;

use crate::interrupt::Interrupt;
use crate::library::Job;
use crate::process;
use crate::progress::{Progress, ProgressMode};
use crate::steps::parts::{Part, Parts};
use gearcut_core::Error;

use super::args::{CutArguments, SceneArguments};
use super::failure::Failure;
use super::folder::listening;
use super::{backend, print};

/// Runs the command; what Ctrl-C ended early is a failure that tells where its results are.
pub fn run(arguments: &CutArguments) -> Result<(), Failure> {
    let SceneArguments { scene: path, settings } = &arguments.scene;
    let load = if arguments.draft { process::load_draft } else { process::load };
    let scene = load(path, settings)?;
    let parts = match (arguments.only.as_slice(), arguments.draft) {
        ([], false) => Parts::all(),
        ([], true) => Parts::of([Part::Report]),
        (names, _) => Parts::named(names.iter().map(String::as_str)),
    };
    let out = arguments.out.clone().unwrap_or_else(|| {
        let whole = scene.scene.output.folder.clone();
        let whole = whole.unwrap_or_else(|| PathBuf::from("out").join(&scene.scene.name));
        beside(whole, arguments.draft, parts)
    });
    let progress = Progress::new(ProgressMode::choose(arguments.run.compute.quiet, arguments.json));
    let interrupt = Interrupt::listen().map_err(listening(&out))?;
    let choice = backend::chosen(arguments.run.compute.backend, arguments.on_gpu_failure)?;
    progress.note(&backend::note(&choice));
    let scene = Arc::new(scene);
    let explained = |error| Failure::of_scene(&scene, error);
    let job = Job::new(Arc::clone(&scene)).map_err(explained)?.on(choice);
    let done = job
        .run()
        .show(&progress)
        .until(&interrupt)
        .only(parts)
        .frames(arguments.frames)
        .into_folder(&out)
        .map_err(explained)?;
    if arguments.json {
        let text = serde_json::to_string_pretty(&done.findings.to_json())
            .map_err(|reason| Error::Output { path: done.folder.path.clone(), reason: reason.to_string() })?;
        print::to_stdout(&format!("{text}\n"))?;
    } else if !arguments.run.compute.quiet {
        print::sheet(if arguments.verbose { &done.summary.whole } else { &done.summary.brief })?;
    }
    let folder = done.folder.cleared()?;
    if done.interrupted {
        return Err(Failure::ended_early(&folder, &out));
    }
    Failure::verdict(&done.findings.warnings, &arguments.run.verdict.rules())
}

/// The folder for what is less than a whole result: beside it, so that it does not take its place.
fn beside(whole: PathBuf, draft: bool, parts: Parts) -> PathBuf {
    let word = match (draft, parts == Parts::all()) {
        (true, _) => "_draft",
        (false, false) => "_part",
        (false, true) => return whole,
    };
    let mut name = whole.into_os_string();
    name.push(word);
    name.into()
}
