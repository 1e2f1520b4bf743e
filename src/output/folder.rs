//! The folder of one run: whole under its final name, or not there at all.
//!
//! In: the final path. Out: paths to write to, inside a hidden folder beside it, whose files take the final name when
//! [`OutputFolder::finish`] is called, or the name with `.partial` behind it when
//! [`OutputFolder::finish_partial`] is.
//!
//! The rules:
//! - A complete result is replaced by a complete one with the same parts at least, in one step, and not before that is
//!   whole. What Ctrl-C leaves of a run goes to `NAME.partial`; the next complete run removes it.
//! - What gearcut did not write is never replaced: `run.json` proves what it wrote, file by file. Whatever else has the
//!   name is refused before any work is done, and so is a folder of gearcut's with a file of somebody else in it.
//! - What a result has replaced is removed when everything is said: see [`OutputFolder::take_name`].
//! - One run at a time writes to a name; a second one is refused.
//! - A run that fails or is killed leaves the names as they were. What a killed run leaves under its hidden name is
//!   removed by the next run to the same name.
//! - Results that are whole and cannot have their name are kept under another one, which the error tells.
//!
//! Road not taken: writing into the final folder and cleaning up after a failure. A killed run cleans up nothing, and
//! half of a new run among the files of an old one looks like a result.

mod steps;
mod workplace;

#[cfg(test)]
mod deaths;

use std::collections::HashSet;
use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::output::atomic::{is_temporary, write_bytes_atomically};
use gearcut_core::{Error, Result};
use serde_json::{Map, Value};
use steps::{Disk, Steps};
use workplace::{Workplace, with_ending};

/// File by which gearcut knows its own folders again.
pub const RUN_RECORD: &str = "run.json";

/// Key of the run record under which the names of all other files are.
pub const FILES: &str = "files";
/// Key of the run record under which they are with their checksums.
pub const CHECKSUMS: &str = "sha256";
/// Key of the run record under which the folder of the files that the scene names is, seen from the results.
pub const SCENE_FOLDER: &str = "scene_folder";
/// What file managers write into folders that somebody looks at.
const OF_FILE_MANAGERS: [&str; 4] = [".DS_Store", "Thumbs.db", "desktop.ini", ".directory"];

/// What stands behind the name of a run that Ctrl-C ended early.
const PARTIAL: &str = ".partial";

/// A folder that is being filled under a hidden name.
///
/// Dropped without [`finish`](Self::finish), it vanishes with everything in it.
#[derive(Debug)]
pub struct OutputFolder {
    final_path: PathBuf,
    name: OsString,
    workplace: Workplace,
}

impl OutputFolder {
    /// Opens a hidden folder beside `final_path`, whose missing parents are made.
    ///
    /// # Errors
    /// Something stands at `final_path` or its partial name that gearcut must not replace, another run writes there, or
    /// the place cannot be written to.
    pub fn create(final_path: &Path) -> Result<Self> {
        Self::create_by(final_path, Box::new(Disk))
    }

    /// No folder, for a run that keeps no file: a writer that asks for a path is refused.
    pub fn nowhere() -> Self {
        Self { final_path: PathBuf::new(), name: OsString::new(), workplace: Workplace::nowhere() }
    }

    /// Whether there is no folder.
    pub fn is_nowhere(&self) -> bool {
        self.workplace.is_nowhere()
    }

    /// [`create`](Self::create) for what a command writes: these parts, if it writes results in parts.
    ///
    /// # Errors
    /// As for `create`; another command wrote the folder, or it holds a complete result with more parts.
    pub fn create_of(final_path: &Path, command: &str, parts: &[&str]) -> Result<Self> {
        let refuse = |reason: String| Err(Error::Output { path: final_path.to_owned(), reason });
        if let Some(record) = record_of(final_path) {
            let other = record.get("command").and_then(Value::as_str).unwrap_or("cut");
            if other != command {
                return refuse(format!("the folder holds what `gearcut {other}` wrote; choose another one with --out"));
            }
            let written = record.get("written").and_then(Value::as_array).into_iter().flatten();
            let lost: Vec<&str> = written.filter_map(Value::as_str).filter(|part| !parts.contains(part)).collect();
            if !is_partial(final_path) && !lost.is_empty() {
                return refuse(format!(
                    "the folder holds a complete result with more than this run would write ({}); choose another \
                     folder with --out, or remove this one",
                    lost.join(", ")
                ));
            }
        }
        Self::create(final_path)
    }

    /// [`create`](Self::create) on any file system.
    fn create_by(final_path: &Path, steps: Box<dyn Steps>) -> Result<Self> {
        let name = final_path.file_name().ok_or_else(|| Error::Output {
            path: final_path.to_owned(),
            reason: "a folder for the results needs a name of its own; choose another one with --out".to_owned(),
        })?;
        check_replaceable(final_path)?;
        check_partial(&partial_path(final_path))?;
        let parent = match final_path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        fs::create_dir_all(parent).map_err(Error::writing(parent))?;
        let workplace = Workplace::take(parent, name, steps)?;
        Ok(Self { final_path: final_path.to_owned(), name: name.to_owned(), workplace })
    }

    /// Place of a file inside the folder, given relative to it; the subfolders on the way are made.
    ///
    /// # Errors
    /// A subfolder cannot be made; there is no folder.
    pub fn path(&self, relative: impl AsRef<Path>) -> Result<PathBuf> {
        if self.is_nowhere() {
            let path = relative.as_ref().to_owned();
            return Err(Error::Output { path, reason: "this run keeps no file".to_owned() });
        }
        let path = self.workplace.new_files().join(relative);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(Error::writing(parent))?;
        }
        Ok(path)
    }

    /// Files written so far, relative to the folder, with `/` between names, in order.
    ///
    /// # Errors
    /// A subfolder cannot be read.
    pub fn written(&self) -> Result<Vec<String>> {
        files_in(&self.workplace.new_files())
    }

    /// Writes the run record, the last file of all: with the names of all others, by which the next run to this name
    /// knows what it may replace. A record with their checksums has the names already.
    ///
    /// # Errors
    /// A subfolder cannot be read; the file cannot be written.
    pub fn write_record(&self, mut record: Map<String, Value>) -> Result<()> {
        if !record.contains_key(CHECKSUMS) {
            record.insert(FILES.to_owned(), self.written()?.into());
        }
        self.write_json(RUN_RECORD, &Value::Object(record))
    }

    /// Writes a JSON document, indented, ending with a newline.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_json(&self, relative: impl AsRef<Path>, document: &Value) -> Result<()> {
        write_bytes_atomically(&self.path(relative)?, format!("{document:#}\n").as_bytes())
    }

    /// The name that the folder gets at the end of a complete run, or of one that Ctrl-C ended early.
    pub fn results_path(&self, complete: bool) -> PathBuf {
        if complete { self.final_path.clone() } else { partial_path(&self.final_path) }
    }

    /// An error of work in this folder as the user should read it: files by the names that they would have had, and
    /// what has become of the earlier results.
    pub fn explain(&self, error: Error) -> Error {
        let hidden = self.workplace.new_files();
        let named = |path: &Path| path.strip_prefix(&hidden).ok().map(|relative| self.final_path.join(relative));
        let untouched = if self.final_path.symlink_metadata().is_ok() {
            format!("the earlier results in {} are untouched", self.final_path.display())
        } else {
            "nothing was left behind".to_owned()
        };
        match error {
            Error::Io { action, path, source } if named(&path).is_some() => Error::Io {
                action,
                path: named(&path).unwrap_or(path),
                source: io::Error::new(source.kind(), format!("{source}; {untouched}")),
            },
            Error::Output { path, reason } if named(&path).is_some() => {
                Error::Output { path: named(&path).unwrap_or(path), reason: format!("{reason}; {untouched}") }
            }
            other => other,
        }
    }

    /// Gives the complete folder its final name; an earlier result there and a partial one beside it are removed
    /// afterwards.
    ///
    /// # Errors
    /// As for [`take_name`](Self::take_name); what was there before cannot be removed.
    pub fn finish(self) -> Result<PathBuf> {
        self.take_name()?.cleared()
    }

    /// Gives the folder of a run that was ended early the partial name, in place of an earlier one of that kind. What
    /// has the final name stays there.
    ///
    /// # Errors
    /// As for [`take_partial_name`](Self::take_partial_name); what was there before cannot be removed.
    pub fn finish_partial(self) -> Result<PathBuf> {
        self.take_partial_name()?.cleared()
    }

    /// Gives the complete folder its final name. An earlier result there and a partial one beside it are out of sight
    /// then: a thousand files take a second to remove, and what was found can be said before.
    ///
    /// The folder must hold its own `run.json`, or the next run could not replace it.
    ///
    /// # Errors
    /// There is no `run.json`, somebody else's folder has appeared at the final name, or the system refuses to rename:
    /// then the new results are kept under the name that the error tells.
    pub fn take_name(self) -> Result<NamedResult> {
        self.check_record()?;
        let name = self.final_path.clone();
        let published = check_replaceable(&name).and_then(|()| self.publish(&name));
        if let Err(error) = published {
            return Err(self.keep(error));
        }
        self.settle(&self.final_path)?;
        let partial = self.results_path(false);
        if is_partial(&partial) {
            self.workplace.discard(&partial).map_err(|source| Error::Io {
                action: "the new results are in place, but the partial ones of an earlier run cannot be removed:",
                path: partial,
                source,
            })?;
        }
        Ok(NamedResult { path: self.final_path, workplace: self.workplace })
    }

    /// Gives the folder of a run that was ended early the partial name.
    ///
    /// Its `run.json` must say `"complete": false`, or the next run could not replace it.
    ///
    /// # Errors
    /// As for [`take_name`](Self::take_name).
    pub fn take_partial_name(self) -> Result<NamedResult> {
        self.check_record()?;
        let partial = self.results_path(false);
        let published = check_partial(&partial).and_then(|()| self.publish(&partial));
        if let Err(error) = published {
            return Err(self.keep(error));
        }
        self.settle(&partial)?;
        Ok(NamedResult { path: partial, workplace: self.workplace })
    }

    /// Forces everything that is written to the disk, as [`finish`](Self::finish) does with what is not there yet: a
    /// run that measures its time calls it before it writes its record.
    ///
    /// # Errors
    /// The disk is full or refuses.
    pub fn force_to_disk(&self) -> Result<()> {
        let new = self.workplace.new_files();
        self.workplace.force_to_disk().map_err(Error::writing(&new))
    }

    fn check_record(&self) -> Result<()> {
        if is_ours(&self.workplace.new_files()) {
            return Ok(());
        }
        Err(Error::Output {
            path: self.final_path.clone(),
            reason: format!("the run wrote no {RUN_RECORD} that names gearcut as its program"),
        })
    }

    fn publish(&self, name: &Path) -> Result<()> {
        self.workplace.publish(name).map_err(Error::writing(name))
    }

    /// Forces the new name to the disk.
    fn settle(&self, name: &Path) -> Result<()> {
        self.workplace.settle().map_err(|source| Error::Io {
            action: "the new results are in place, but a power cut may undo that:",
            path: name.to_owned(),
            source,
        })
    }

    /// Keeps results that cannot have their name under another one, and says so with the reason.
    fn keep(mut self, error: Error) -> Error {
        let where_kept = match self.workplace.keep(&self.name) {
            Ok(kept) => format!("the results of this run are in {}", kept.display()),
            Err(_) => {
                let hidden = self.workplace.new_files();
                self.workplace.leave();
                format!("the results of this run are in {} until the next run to this name", hidden.display())
            }
        };
        match error {
            Error::Io { action, path, source } => {
                Error::Io { action, path, source: io::Error::new(source.kind(), format!("{source}; {where_kept}")) }
            }
            Error::Output { path, reason } => Error::Output { path, reason: format!("{reason}; {where_kept}") },
            other => other,
        }
    }
}

/// Results under their name. What had it before is removed with this, at the latest by the next run to the name.
#[derive(Debug)]
pub struct NamedResult {
    /// Their folder.
    pub path: PathBuf,
    workplace: Workplace,
}

impl NamedResult {
    /// Removes what had the name before.
    ///
    /// # Errors
    /// It cannot be removed.
    pub fn cleared(self) -> Result<PathBuf> {
        self.workplace.clear().map_err(|source| Error::Io {
            action: "the new results are in place, but the earlier ones cannot be removed from beside",
            path: self.path.clone(),
            source,
        })?;
        Ok(self.path)
    }
}

/// Name of what Ctrl-C leaves of a run to `final_path`.
fn partial_path(final_path: &Path) -> PathBuf {
    final_path.with_file_name(with_ending(final_path.file_name().unwrap_or_default(), PARTIAL))
}

/// Refuses a final path that must not be replaced.
fn check_replaceable(final_path: &Path) -> Result<()> {
    let refuse = |reason: String| Err(Error::Output { path: final_path.to_owned(), reason });
    match final_path.symlink_metadata() {
        Err(missing) if missing.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(source) => Err(Error::Io { action: "cannot read", path: final_path.to_owned(), source }),
        Ok(found) if !found.is_dir() => {
            refuse("a file or a link of this name is in the way; remove it or choose another folder with --out".into())
        }
        Ok(_) if is_ours(final_path) => match foreign_file(final_path)? {
            None => Ok(()),
            Some(name) => refuse(format!(
                "the folder holds {name}, which gearcut did not write; move it away or choose another folder with --out"
            )),
        },
        Ok(_) if is_empty(final_path) => Ok(()),
        Ok(_) => refuse(format!(
            "the folder exists and was not written by gearcut (it has no {RUN_RECORD} of gearcut's); \
             move it away or choose another folder with --out"
        )),
    }
}

/// Refuses a partial name that must not be replaced: under it, too, somebody may keep what is complete.
fn check_partial(partial: &Path) -> Result<()> {
    check_replaceable(partial)?;
    if is_ours(partial) && !is_partial(partial) {
        return Err(Error::Output {
            path: partial.to_owned(),
            reason:
                "the folder holds complete results under the name for partial ones; move it away or choose another \
                     folder with --out"
                    .to_owned(),
        });
    }
    Ok(())
}

/// A file in a folder of gearcut's that its record does not name; none where the record has no names, as those of
/// earlier versions and of runs that are still growing.
fn foreign_file(folder: &Path) -> Result<Option<String>> {
    let Some(record) = record_of(folder) else { return Ok(None) };
    let names: HashSet<&str> = match (record.get(CHECKSUMS), record.get(FILES)) {
        (Some(Value::Object(checksums)), _) => checksums.keys().map(String::as_str).collect(),
        (_, Some(Value::Array(files))) => files.iter().filter_map(Value::as_str).collect(),
        _ => return Ok(None),
    };
    let is_known = |file: &str| {
        let name = file.rsplit('/').next().unwrap_or(file);
        file == RUN_RECORD || names.contains(file) || OF_FILE_MANAGERS.contains(&name) || is_temporary(name)
    };
    Ok(files_in(folder)?.into_iter().find(|file| !is_known(file)))
}

/// Files below a folder, relative to it, with `/` between names, in order.
fn files_in(folder: &Path) -> Result<Vec<String>> {
    fn inside(folder: &Path, before: &str, found: &mut Vec<String>) -> Result<()> {
        for entry in fs::read_dir(folder).map_err(Error::reading(folder))? {
            let entry = entry.map_err(Error::reading(folder))?;
            let name = format!("{before}{}", entry.file_name().to_string_lossy());
            if entry.file_type().map_err(Error::reading(folder))?.is_dir() {
                inside(&entry.path(), &format!("{name}/"), found)?;
            } else {
                found.push(name);
            }
        }
        Ok(())
    }
    let mut found = Vec::new();
    inside(folder, "", &mut found)?;
    found.sort_unstable();
    Ok(found)
}

/// Whether gearcut wrote the folder.
fn is_ours(folder: &Path) -> bool {
    record_of(folder).is_some()
}

/// Whether gearcut wrote the folder and Ctrl-C ended it early.
fn is_partial(folder: &Path) -> bool {
    record_of(folder).is_some_and(|record| record.get("complete") == Some(&Value::Bool(false)))
}

/// The folder's `run.json`, if it names gearcut as the program that wrote it.
fn record_of(folder: &Path) -> Option<Value> {
    let text = fs::read(folder.join(RUN_RECORD)).ok()?;
    let record: Value = serde_json::from_slice(&text).ok()?;
    (record.get("program")? == "gearcut").then_some(record)
}

/// Whether there is nothing to lose in the folder.
fn is_empty(folder: &Path) -> bool {
    fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_none())
}
