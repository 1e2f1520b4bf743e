//! The steps on the disk that change which folder has which name.
//!
//! In: paths. Out: the system's answer. Each step is done or not done, whenever the process is killed; only the
//! removal of a folder may end halfway, so nothing is removed under a name that anybody reads.
//!
//! They are behind a trait because the tests of [`OutputFolder`](super::OutputFolder) let a run die at each of them.

use std::fmt::Debug;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::Path;

/// What is asked of the file system.
pub(super) trait Steps: Debug + Send + Sync {
    /// Makes a folder, with the rights that the user's umask gives.
    fn create_folder(&self, path: &Path) -> io::Result<()>;

    /// Opens the file that the lock is on, and makes it if it is missing.
    fn open_lock(&self, path: &Path) -> io::Result<File>;

    /// Gives a folder a name that nothing else has.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;

    /// Two folders exchange their names in one step; false if this system or file system cannot do that.
    fn exchange(&self, one: &Path, other: &Path) -> io::Result<bool>;

    /// Removes a folder with all that is in it.
    fn remove_folder(&self, path: &Path) -> io::Result<()>;

    /// Removes a file.
    fn remove_file(&self, path: &Path) -> io::Result<()>;
}

/// The system's own file system.
#[derive(Debug)]
pub(super) struct Disk;

impl Steps for Disk {
    fn create_folder(&self, path: &Path) -> io::Result<()> {
        fs::create_dir(path)
    }

    fn open_lock(&self, path: &Path) -> io::Result<File> {
        OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)
    }

    fn exchange(&self, one: &Path, other: &Path) -> io::Result<bool> {
        exchange(one, other)
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        fs::remove_dir_all(path)
    }

    fn remove_file(&self, path: &Path) -> io::Result<()> {
        fs::remove_file(path)
    }
}

/// `renameat2` with `RENAME_EXCHANGE` (Linux 3.15), `renameatx_np` with `RENAME_SWAP` (macOS 10.12).
#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn exchange(one: &Path, other: &Path) -> io::Result<bool> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    use rustix::io::Errno;
    match renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE) {
        Ok(()) => Ok(true),
        // An old kernel; a file system that does not know the flag.
        Err(Errno::NOSYS | Errno::INVAL | Errno::NOTSUP) => Ok(false),
        Err(refused) => Err(refused.into()),
    }
}

/// Other systems have no such call.
#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
fn exchange(_one: &Path, _other: &Path) -> io::Result<bool> {
    Ok(false)
}
