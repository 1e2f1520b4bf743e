//! The hidden folder beside a result where one run works, and the lock that makes it the only one.
//!
//! In: the parent and the name of the result. Out: `.NAME.gearcut/` with `new/` to fill, and the moves that give
//! `new/` a name of its own.
//!
//! | in it | what it is |
//! | --- | --- |
//! | `lock` | locked by the run at work; the system unlocks it when the process ends, however it ends |
//! | `new/` | the files of this run; after an exchange of names what had the name before |
//! | `earlier/NAME` | the earlier result, for the moment between two renames where names cannot be exchanged |
//! | `discarded/` | what is being removed |
//!
//! The law: who holds the lock finds in there only what a dead run left. An earlier result whose name is free is put
//! back; the rest is removed. The lock is the first thing made and the last one removed, so a hidden folder with
//! something in it but no lock is not gearcut's and is left alone.
//!
//! Roads not taken: hidden names drawn by chance, which a later run cannot tell from those of a run at work; a file
//! with a process number, which stays when the process is killed, and whose number another process gets.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use same_file::Handle;

use super::RUN_RECORD;
use super::steps::{Disk, Steps};
use gearcut_core::{Error, Result};

const LOCK: &str = "lock";
const NEW: &str = "new";
const EARLIER: &str = "earlier";
const DISCARDED: &str = "discarded";

/// First word of a lock file.
const PROGRAM: &str = "gearcut";

/// Often enough for the moments in which another run removes its own hidden folder.
const ATTEMPTS: u32 = 100;

/// A hidden folder that this process alone works in; it vanishes when dropped.
#[derive(Debug)]
pub(super) struct Workplace {
    folder: PathBuf,
    /// Where results have their names.
    parent: PathBuf,
    steps: Box<dyn Steps>,
    /// Not removed at the end.
    is_left: bool,
    /// Whether the files are on the disk, but for the record.
    is_forced: AtomicBool,
    /// Holds the lock; none where no file is kept.
    lock: Option<File>,
}

impl Workplace {
    /// Takes the workplace for `parent/name`, puts back or removes what dead runs left, and makes `new/`.
    ///
    /// # Errors
    /// Another run works there; something that is not gearcut's has the hidden name; the place cannot be written to.
    pub(super) fn take(parent: &Path, name: &OsStr, steps: Box<dyn Steps>) -> Result<Self> {
        let folder = parent.join([OsStr::new("."), name, OsStr::new(".gearcut")].into_iter().collect::<OsString>());
        let lock = lock(&folder, &parent.join(name), steps.as_ref())?;
        let place = Self {
            folder,
            parent: parent.to_owned(),
            steps,
            is_left: false,
            is_forced: AtomicBool::new(false),
            lock: Some(lock),
        };
        place.clear().map_err(|source| Error::Io {
            action: "cannot put back or remove what an earlier run left in",
            path: place.folder.clone(),
            source,
        })?;
        let new = place.new_files();
        place.steps.create_folder(&new).map_err(Error::writing(&new))?;
        Ok(place)
    }

    /// No place at all, for a run that keeps no file.
    pub(super) fn nowhere() -> Self {
        Self {
            folder: PathBuf::new(),
            parent: PathBuf::new(),
            steps: Box::new(Disk),
            is_left: true,
            is_forced: AtomicBool::new(false),
            lock: None,
        }
    }

    /// Whether this is no place at all.
    pub(super) fn is_nowhere(&self) -> bool {
        self.lock.is_none()
    }

    /// The folder to fill.
    pub(super) fn new_files(&self) -> PathBuf {
        self.folder.join(NEW)
    }

    /// Gives `new/` the name `target`; what had that name before is in the workplace afterwards.
    ///
    /// Where names can be exchanged, `target` is there at every moment; elsewhere it is missing between two renames,
    /// and a run killed there leaves it to the next one to put the earlier result back.
    pub(super) fn publish(&self, target: &Path) -> io::Result<()> {
        let new = self.new_files();
        if self.is_forced.load(Ordering::SeqCst) {
            // Nothing but the record came after that.
            self.steps.sync_file(&new.join(RUN_RECORD))?;
            self.steps.sync_folder(&new)?;
        } else {
            self.force_to_disk()?;
        }
        if target.symlink_metadata().is_err() {
            return self.steps.rename(&new, target);
        }
        if self.steps.exchange(&new, target)? {
            return Ok(());
        }
        let shelf = self.folder.join(EARLIER);
        self.steps.create_folder(&shelf)?;
        let aside = shelf.join(target.file_name().unwrap_or_default());
        self.steps.rename(target, &aside)?;
        self.steps.rename(&new, target).map_err(|refused| match self.steps.rename(&aside, target) {
            Ok(()) => refused,
            Err(_) => io::Error::new(
                refused.kind(),
                format!("{refused}; the earlier results are in {}, and the next run puts them back", aside.display()),
            ),
        })
    }

    /// Forces the files and their names to the disk: a name that is changed before may outlive a power cut that the
    /// files do not. Once for all files at the end, because the system has written most of them by then, and in one
    /// call where there is one: 1000 files of 73 kB took 0.1 to 0.2 s by `syncfs` and 0.8 to 1.1 s file by file
    /// (ext4, a busy disk of a shared machine).
    pub(super) fn force_to_disk(&self) -> io::Result<()> {
        let new = self.new_files();
        if !self.steps.sync_all(&new)? {
            self.sync_below(&new)?;
        }
        self.is_forced.store(true, Ordering::SeqCst);
        Ok(())
    }

    fn sync_below(&self, folder: &Path) -> io::Result<()> {
        let entries = fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>()?;
        entries.par_iter().try_for_each(|entry| {
            if entry.file_type()?.is_dir() {
                self.sync_below(&entry.path())
            } else {
                self.steps.sync_file(&entry.path())
            }
        })?;
        self.steps.sync_folder(folder)
    }

    /// Forces to the disk that results have their name.
    pub(super) fn settle(&self) -> io::Result<()> {
        self.steps.sync_folder(&self.parent)
    }

    /// Takes a folder away from its name in one step, to be removed with the workplace.
    pub(super) fn discard(&self, folder: &Path) -> io::Result<()> {
        self.steps.rename(folder, &self.folder.join(DISCARDED))
    }

    /// Moves `new/` to the first free name of `NAME.new`, `NAME.new-2`, ...: results that cannot have their name are
    /// not lost for it.
    pub(super) fn keep(&self, name: &OsStr) -> io::Result<PathBuf> {
        let free = |path: &PathBuf| path.symlink_metadata().is_err_and(|e| e.kind() == ErrorKind::NotFound);
        let endings = std::iter::once(".new".to_owned()).chain((2..1000).map(|n| format!(".new-{n}")));
        let mut names = endings.map(|ending| self.parent.join(with_ending(name, &ending)));
        let kept = names.find(free).ok_or(ErrorKind::AlreadyExists)?;
        self.steps.rename(&self.new_files(), &kept)?;
        Ok(kept)
    }

    /// Leaves everything to the next run, as a killed process does.
    pub(super) fn leave(&mut self) {
        self.is_left = true;
    }

    /// Leaves only the lock: earlier results whose name is free get it back, everything else is removed.
    pub(super) fn clear(&self) -> io::Result<()> {
        let [new, shelf, discarded] = [NEW, EARLIER, DISCARDED].map(|name| self.folder.join(name));
        let is_there = |path: &Path| path.symlink_metadata().is_ok();
        if is_there(&shelf) {
            for entry in fs::read_dir(&shelf)? {
                let entry = entry?;
                let name = self.parent.join(entry.file_name());
                if !is_there(&name) {
                    self.steps.rename(&entry.path(), &name)?;
                }
            }
        }
        for rest in [&new, &discarded] {
            if is_there(rest) {
                self.steps.remove_folder(rest)?;
            }
        }
        // Half a removal under `earlier/` would look like a result to put back.
        if is_there(&shelf) {
            self.steps.rename(&shelf, &discarded)?;
            self.steps.remove_folder(&discarded)?;
        }
        Ok(())
    }
}

impl Drop for Workplace {
    fn drop(&mut self) {
        if self.is_left {
            return;
        }
        // What cannot be removed now is left to the next run, which needs the lock file to know it as gearcut's.
        if self.clear().is_ok() && self.steps.remove_file(&self.folder.join(LOCK)).is_ok() {
            let _another_run_came = fs::remove_dir(&self.folder);
        }
    }
}

/// Makes the hidden folder and locks the file in it; `result` is what the lock is for.
fn lock(folder: &Path, result: &Path, steps: &dyn Steps) -> Result<File> {
    let refuse = |reason: String| Error::Output { path: result.to_owned(), reason };
    let failed = |source| Error::Io { action: "cannot lock", path: folder.to_owned(), source };
    let in_the_way = || {
        refuse(format!(
            "{} is in the way and is not gearcut's; move it away or choose another folder with --out",
            folder.display()
        ))
    };
    let path = folder.join(LOCK);
    for _ in 0..ATTEMPTS {
        match steps.create_folder(folder) {
            Err(there) if there.kind() == ErrorKind::AlreadyExists && is_foreign(folder) => return Err(in_the_way()),
            Err(refused) if refused.kind() != ErrorKind::AlreadyExists => return Err(Error::writing(folder)(refused)),
            _ => {}
        }
        let file = match steps.open_lock(&path) {
            Ok(file) => file,
            // Another run has just removed the folder with its lock.
            Err(gone) if gone.kind() == ErrorKind::NotFound => continue,
            Err(refused) => return Err(failed(refused)),
        };
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(refuse(format!(
                    "another run of gearcut{} is writing to this folder; wait for its end or choose another one \
                     with --out",
                    owner(&path).map_or_else(String::new, |process| format!(" (process {process})"))
                )));
            }
            Err(TryLockError::Error(refused)) => return Err(failed(refused)),
        }
        // A run that ended between opening and locking has removed this very file.
        let held = file.try_clone().and_then(Handle::from_file).map_err(failed)?;
        if Handle::from_path(&path).is_ok_and(|named| named == held) {
            return if sign(&file).map_err(failed)? { Ok(file) } else { Err(in_the_way()) };
        }
    }
    Err(refuse("other runs of gearcut keep taking this folder; choose another one with --out".to_owned()))
}

/// Whether the hidden name belongs to something that no run of gearcut made: their folders hold the lock or nothing.
fn is_foreign(folder: &Path) -> bool {
    match fs::read_dir(folder) {
        Ok(entries) => {
            let names: Vec<OsString> = entries.flatten().map(|entry| entry.file_name()).collect();
            !names.is_empty() && !names.iter().any(|name| name == LOCK)
        }
        Err(unread) => unread.kind() == ErrorKind::NotADirectory,
    }
}

/// Writes whose lock it is, for people and for [`owner`]; false if the file is somebody else's.
fn sign(mut file: &File) -> io::Result<bool> {
    let mut text = Vec::new();
    file.read_to_end(&mut text)?;
    if !text.is_empty() && !text.starts_with(PROGRAM.as_bytes()) {
        return Ok(false);
    }
    file.set_len(0)?;
    file.rewind()?;
    writeln!(file, "{PROGRAM} {}", std::process::id())?;
    Ok(true)
}

/// Number of the process that signed a lock; nothing on Windows, where nobody may read a locked file.
fn owner(lock: &Path) -> Option<u32> {
    fs::read_to_string(lock).ok()?.trim().strip_prefix(PROGRAM)?.trim().parse().ok()
}

/// `name` with more behind it.
pub(super) fn with_ending(name: &OsStr, ending: &str) -> OsString {
    let mut longer = name.to_owned();
    longer.push(ending);
    longer
}
