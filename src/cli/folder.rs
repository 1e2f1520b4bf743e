//! Output folders of the commands that do not cut.
//!
//! The rule: what `gearcut cut` wrote is replaced by `gearcut cut` alone. Axis tables and comparisons would otherwise
//! wipe out a long run whose folder was named by mistake.
//!
//! They listen for Ctrl-C only so that their hidden folders vanish: they take seconds, and what they have so far is no
//! result.

use std::path::{Component, Path, PathBuf};

use super::print::to_stderr;
use crate::influence::known_cuts::KnownCuts;
use crate::interrupt::Interrupt;
use crate::output::folder::OutputFolder;
use gearcut_core::{Error, Result};
use serde_json::{Map, Value, json};

/// What a run record says beyond the program and the command.
pub type Record = Vec<(&'static str, Value)>;

/// Fills the folder `path` with the files of `command`: `write` writes them and tells what the run record says beyond
/// the program and the command. The folder's name is given back with what `write` returned.
///
/// # Errors
/// Something stands there that this command did not write; a file cannot be written; Ctrl-C.
pub fn fill<T>(
    path: &Path,
    command: &str,
    write: impl FnOnce(&OutputFolder, &Interrupt) -> Result<(Record, T)>,
) -> Result<(PathBuf, T)> {
    let interrupt = Interrupt::listen().map_err(listening(path))?;
    let folder = OutputFolder::create_of(path, command, &[])?;
    let written = || {
        let (record, value) = write(&folder, &interrupt)?;
        interrupt.check()?;
        write_record(&folder, command, true, record)?;
        Ok(value)
    };
    let value = written().map_err(|error| folder.explain(error))?;
    Ok((folder.finish()?, value))
}

/// The same for work of minutes, which keeps what is finished: `write` also tells whether that is all. Files that are
/// not all go to the partial name; whether they are all is given back, too. Under that name cuts grow meanwhile: after
/// Ctrl-C or a kill the next run takes up those that it would make itself.
///
/// # Errors
/// As for [`fill`]; Ctrl-C before anything is finished.
pub fn fill_partly<T>(
    path: &Path,
    command: &str,
    write: impl FnOnce(&OutputFolder, &Interrupt, &KnownCuts) -> Result<(Record, T, bool)>,
) -> Result<(PathBuf, T, bool)> {
    let interrupt = Interrupt::listen().map_err(listening(path))?;
    let folder = OutputFolder::create_of(path, command, &[])?;
    let known = KnownCuts::growing_in(&folder.results_path(false), record_of(command, false))?;
    let written = || {
        let (more, value, complete) = write(&folder, &interrupt, &known)?;
        if !complete {
            known.write(&folder)?;
        }
        write_record(&folder, command, complete, more)?;
        Ok((value, complete))
    };
    let written = written().map_err(|error| folder.explain(error));
    let [made, taken] = known.made_and_taken();
    if taken > 0 {
        let cuts = if taken == 1 { "1 cut is that".to_owned() } else { format!("{taken} cuts are those") };
        to_stderr(&format!("note: {cuts} of a run that was stopped; {made} were made now"));
    }
    match written {
        // The file of cuts is closed before its folder gets another name: systems refuse that while it is open.
        Ok((value, complete)) => {
            drop(known);
            let path = if complete { folder.finish()? } else { folder.finish_partial()? };
            Ok((path, value, complete))
        }
        // What is refused of the scene is refused again: cuts for it are of no use to anybody.
        Err(refused @ (Error::Refused(_) | Error::Scene(_) | Error::Unreadable { .. })) => {
            known.forget()?;
            Err(refused)
        }
        // A full disk is emptied, a driver comes back: as after a kill, the next run takes the cuts up.
        Err(failed) => {
            if let Some((count, place)) = known.kept() {
                let place = place.display();
                to_stderr(&format!("note: {count} finished cuts stay in {place}; the same command goes on with them"));
            }
            Err(failed)
        }
    }
}

/// The beginning of a run record.
fn record_of(command: &str, complete: bool) -> Map<String, Value> {
    let mut record = Map::new();
    record.insert("program".to_owned(), json!("gearcut"));
    record.insert("program_version".to_owned(), json!(env!("CARGO_PKG_VERSION")));
    record.insert("command".to_owned(), json!(command));
    if !complete {
        record.insert("complete".to_owned(), json!(false));
    }
    record
}

fn write_record(folder: &OutputFolder, command: &str, complete: bool, more: Record) -> Result<()> {
    let mut record = record_of(command, complete);
    record.extend(more.into_iter().map(|(key, value)| (key.to_owned(), value)));
    folder.write_record(record)
}

/// What could not be listened for.
pub fn listening(path: &Path) -> impl FnOnce(std::io::Error) -> Error {
    let path = path.to_owned();
    move |source| Error::Io { action: "cannot listen for Ctrl-C before writing", path, source }
}

/// Name of a folder that may be given as `.`, `out/a/` or by the results file in it.
pub fn name_of(path: &Path) -> String {
    let folder = if path.is_file() { path.parent().unwrap_or(path) } else { path };
    let named = |path: &Path| match path.components().next_back() {
        Some(Component::Normal(name)) => Some(name.to_string_lossy().into_owned()),
        _ => None,
    };
    named(folder)
        .or_else(|| folder.canonicalize().ok().as_deref().and_then(named))
        .unwrap_or_else(|| "results".to_owned())
}
