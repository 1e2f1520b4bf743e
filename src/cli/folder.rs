//! Output folders of the commands that do not cut.
//!
//! The rule: what `gearcut cut` wrote is replaced by `gearcut cut` alone. Axis tables and comparisons would otherwise
//! wipe out a long run whose folder was named by mistake.
//!
//! They listen for Ctrl-C only so that their hidden folders vanish: they take seconds, and what they have so far is no
//! result.

use std::path::{Component, Path, PathBuf};

use gearcut::interrupt::Interrupt;
use gearcut::output::folder::{OutputFolder, RUN_RECORD};
use gearcut::{Error, Result};
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
    let (path, value, _) = fill_partly(path, command, |folder, interrupt| {
        let (record, value) = write(folder, interrupt)?;
        interrupt.check()?;
        Ok((record, value, true))
    })?;
    Ok((path, value))
}

/// The same for work of minutes, which keeps what is finished: `write` also tells whether that is all. Files that are
/// not all go to the partial name; whether they are all is given back, too.
///
/// # Errors
/// As for [`fill`]; Ctrl-C before anything is finished.
pub fn fill_partly<T>(
    path: &Path,
    command: &str,
    write: impl FnOnce(&OutputFolder, &Interrupt) -> Result<(Record, T, bool)>,
) -> Result<(PathBuf, T, bool)> {
    let interrupt = Interrupt::listen().map_err(listening(path))?;
    let folder = OutputFolder::create_of(path, command, &[])?;
    let written = || {
        let (more, value, complete) = write(&folder, &interrupt)?;
        let mut record = Map::new();
        record.insert("program".to_owned(), json!("gearcut"));
        record.insert("program_version".to_owned(), json!(env!("CARGO_PKG_VERSION")));
        record.insert("command".to_owned(), json!(command));
        if !complete {
            record.insert("complete".to_owned(), json!(false));
        }
        record.extend(more.into_iter().map(|(key, value)| (key.to_owned(), value)));
        folder.write_json(RUN_RECORD, &Value::Object(record))?;
        Ok((value, complete))
    };
    let (value, complete) = written().map_err(|error| folder.explain(error))?;
    let path = if complete { folder.finish()? } else { folder.finish_partial()? };
    Ok((path, value, complete))
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
