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

use gearcut_texture::disk_steps::{DiskStep, about_to};

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

    /// Forces a file to the disk.
    fn sync_file(&self, path: &Path) -> io::Result<()>;

    /// Forces everything on the file system of a folder to the disk, in one go; false if this system cannot do that.
    fn sync_all(&self, folder: &Path) -> io::Result<bool>;

    /// Forces the names in a folder to the disk.
    fn sync_folder(&self, path: &Path) -> io::Result<()>;

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
        about_to(DiskStep::Create, path)?;
        fs::create_dir(path)
    }

    fn open_lock(&self, path: &Path) -> io::Result<File> {
        about_to(DiskStep::Create, path)?;
        OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        about_to(DiskStep::Rename, to)?;
        fs::rename(from, to)
    }

    fn exchange(&self, one: &Path, other: &Path) -> io::Result<bool> {
        about_to(DiskStep::Exchange, other)?;
        exchange(one, other)
    }

    fn sync_file(&self, path: &Path) -> io::Result<()> {
        about_to(DiskStep::Sync, path)?;
        // Windows syncs only what may be written to.
        OpenOptions::new().write(true).open(path)?.sync_all()
    }

    fn sync_all(&self, folder: &Path) -> io::Result<bool> {
        about_to(DiskStep::Sync, folder)?;
        sync_all(folder)
    }

    fn sync_folder(&self, path: &Path) -> io::Result<()> {
        about_to(DiskStep::Sync, path)?;
        sync_folder(path)
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        about_to(DiskStep::Remove, path)?;
        fs::remove_dir_all(path)
    }

    fn remove_file(&self, path: &Path) -> io::Result<()> {
        about_to(DiskStep::Remove, path)?;
        fs::remove_file(path)
    }
}

/// `fsync` of a folder, where the file system knows it.
#[cfg(unix)]
fn sync_folder(path: &Path) -> io::Result<()> {
    match File::open(path)?.sync_all() {
        Err(unknown) if matches!(unknown.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported) => Ok(()),
        done => done,
    }
}

/// Other systems force names to the disk by themselves.
#[cfg(not(unix))]
#[expect(clippy::unnecessary_wraps, reason = "as where the system has the call")]
fn sync_folder(_path: &Path) -> io::Result<()> {
    Ok(())
}

/// `syncfs` (Linux 2.6.39; since 5.8 it tells what could not be written).
#[cfg(target_os = "linux")]
fn sync_all(folder: &Path) -> io::Result<bool> {
    use rustix::io::Errno;
    match rustix::fs::syncfs(File::open(folder)?) {
        Ok(()) => Ok(true),
        Err(Errno::NOSYS | Errno::INVAL | Errno::NOTSUP) => Ok(false),
        Err(refused) => Err(refused.into()),
    }
}

/// Other systems have no such call.
#[cfg(not(target_os = "linux"))]
#[expect(clippy::unnecessary_wraps, reason = "as where the system has the call")]
fn sync_all(_folder: &Path) -> io::Result<bool> {
    Ok(false)
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
#[expect(clippy::unnecessary_wraps, reason = "as where the system has the call")]
fn exchange(_one: &Path, _other: &Path) -> io::Result<bool> {
    Ok(false)
}
