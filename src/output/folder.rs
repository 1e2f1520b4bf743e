//! The folder of one run: whole under its final name, or not there at all.
//!
//! In: the final path. Out: paths to write to, inside a hidden sibling folder that takes the final name when
//! [`OutputFolder::finish`] is called.
//!
//! The rule: an existing folder is replaced only if gearcut wrote it, which its `run.json` proves, and only after the
//! new one is complete. Whatever else stands at the final name is refused before any work is done. A run that fails,
//! is stopped or is killed leaves the final name as it was.
//!
//! Road not taken: writing into the final folder and cleaning up after a failure. A killed run cleans up nothing, and
//! half of a new run among the files of an old one looks like a result.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::output::atomic::write_bytes_atomically;
use crate::{Error, Result};

/// File by which gearcut knows its own folders again.
pub const RUN_RECORD: &str = "run.json";

/// A folder that is being filled under a hidden name.
///
/// Dropped without [`finish`](Self::finish), it vanishes with everything in it.
#[derive(Debug)]
pub struct OutputFolder {
    final_path: PathBuf,
    temporary: TempDir,
}

impl OutputFolder {
    /// Opens a hidden folder beside `final_path`, whose missing parents are made.
    ///
    /// # Errors
    /// Something stands at `final_path` that gearcut did not write, or the place cannot be written to.
    pub fn create(final_path: &Path) -> Result<Self> {
        let name = final_path.file_name().ok_or_else(|| Error::Output {
            path: final_path.to_owned(),
            reason: "a folder for the results needs a name of its own; choose another one with --out".to_owned(),
        })?;
        check_replaceable(final_path)?;
        let parent = match final_path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        fs::create_dir_all(parent).map_err(Error::writing(parent))?;
        let prefix = format!(".{}.new-", name.to_string_lossy());
        let temporary = hidden_folder(parent, &prefix).map_err(Error::writing(final_path))?;
        Ok(Self { final_path: final_path.to_owned(), temporary })
    }

    /// Place of a file inside the folder, given relative to it; the subfolders on the way are made.
    ///
    /// # Errors
    /// A subfolder cannot be made.
    pub fn path(&self, relative: impl AsRef<Path>) -> Result<PathBuf> {
        let path = self.temporary.path().join(relative);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(Error::writing(parent))?;
        }
        Ok(path)
    }

    /// Writes a JSON document, indented, ending with a newline.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_json(&self, relative: impl AsRef<Path>, document: &serde_json::Value) -> Result<()> {
        write_bytes_atomically(&self.path(relative)?, format!("{document:#}\n").as_bytes())
    }

    /// The name that the folder gets at the end.
    pub fn final_path(&self) -> &Path {
        &self.final_path
    }

    /// Gives the folder its final name; an earlier run's folder there is removed afterwards.
    ///
    /// The folder must hold its own `run.json`, or the next run could not replace it. If the new name cannot be
    /// given, the earlier folder is put back.
    ///
    /// # Errors
    /// There is no `run.json`, somebody else's folder has appeared at the final name, or the system refuses to rename.
    pub fn finish(self) -> Result<PathBuf> {
        if !is_ours(self.temporary.path()) {
            return Err(Error::Output {
                path: self.final_path,
                reason: format!("the run wrote no {RUN_RECORD} that names gearcut as its program"),
            });
        }
        check_replaceable(&self.final_path)?;
        let name_given = if self.final_path.symlink_metadata().is_ok() {
            self.replace_earlier()
        } else {
            fs::rename(self.temporary.path(), &self.final_path).map_err(Error::writing(&self.final_path))
        };
        name_given?;
        let Self { final_path, temporary } = self;
        let _moved_away = temporary.keep();
        Ok(final_path)
    }

    /// Old folder aside, new folder in, old folder removed.
    fn replace_earlier(&self) -> Result<()> {
        let parent = self.temporary.path().parent().unwrap_or(Path::new("."));
        let name = self.final_path.file_name().unwrap_or_default().to_string_lossy();
        // The earlier folder moves into a folder of its own, so that its hidden name is surely free.
        let aside = hidden_folder(parent, &format!(".{name}.old-")).map_err(Error::writing(parent))?;
        let earlier = aside.path().join("earlier");
        fs::rename(&self.final_path, &earlier).map_err(Error::writing(&self.final_path))?;
        if let Err(source) = fs::rename(self.temporary.path(), &self.final_path) {
            if fs::rename(&earlier, &self.final_path).is_err() {
                let kept = aside.keep();
                return Err(Error::Output {
                    path: self.final_path.clone(),
                    reason: format!("{source}; the earlier results are in {}", kept.join("earlier").display()),
                });
            }
            return Err(Error::Io { action: "cannot write", path: self.final_path.clone(), source });
        }
        let aside_path = aside.path().to_owned();
        aside.close().map_err(|source| Error::Io {
            action: "the new results are in place, but the earlier ones cannot be removed from",
            path: aside_path,
            source,
        })
    }
}

/// Refuses a final path that must not be replaced.
fn check_replaceable(final_path: &Path) -> Result<()> {
    let refuse = |reason: String| Err(Error::Output { path: final_path.to_owned(), reason });
    match final_path.symlink_metadata() {
        Err(missing) if missing.kind() == std::io::ErrorKind::NotFound => Ok(()),
        Err(source) => Err(Error::Io { action: "cannot read", path: final_path.to_owned(), source }),
        Ok(found) if !found.is_dir() => {
            refuse("a file or a link of this name is in the way; remove it or choose another folder with --out".into())
        }
        Ok(_) if is_ours(final_path) => Ok(()),
        Ok(_) if is_empty(final_path) => Ok(()),
        Ok(_) => refuse(format!(
            "the folder exists and was not written by gearcut (it has no {RUN_RECORD} of gearcut's); \
             move it away or choose another folder with --out"
        )),
    }
}

/// Whether the folder's `run.json` names gearcut as the program that wrote it.
fn is_ours(folder: &Path) -> bool {
    fs::read(folder.join(RUN_RECORD))
        .ok()
        .and_then(|text| serde_json::from_slice::<serde_json::Value>(&text).ok())
        .is_some_and(|record| record.get("program").and_then(serde_json::Value::as_str) == Some("gearcut"))
}

/// Whether there is nothing to lose in the folder.
fn is_empty(folder: &Path) -> bool {
    fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_none())
}

/// New hidden folder that others may read as the user's umask says.
fn hidden_folder(parent: &Path, prefix: &str) -> std::io::Result<TempDir> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(prefix);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
    builder.tempdir_in(parent)
}
