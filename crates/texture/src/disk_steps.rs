//! The steps on the disk by which results come to be, where tests may refuse them.
//!
//! In: each step just before it is done, with the path that it is about. Out: whether it may be done. A test asks for
//! the steps below a folder of its own with [`watch_below`] and refuses some: all from the n-th on, as if the process
//! had been killed there, or every write from the n-th on, as a full disk does. Nobody else asks, and a step then costs
//! the look at a flag.
//!
//! Roads not taken: a trait that every writer of a file takes along, which some sixty signatures would carry for the
//! tests alone; and libraries that step between program and system, which need `unsafe`.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, PoisonError, RwLock};

/// What is about to happen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DiskStep {
    /// A file or folder is made or opened.
    Create,
    /// Bytes are written.
    Write,
    /// What was written is forced to the disk.
    Sync,
    /// A file or folder gets its name.
    Rename,
    /// Two folders exchange their names.
    Exchange,
    /// A file or folder is removed.
    Remove,
}

/// Says whether a step may be done, or why not.
pub type Watch = dyn Fn(DiskStep, &Path) -> io::Result<()> + Send + Sync;

static WATCHES: RwLock<Vec<(PathBuf, Arc<Watch>)>> = RwLock::new(Vec::new());
/// How many there are, so that without any a step costs no lock.
static WATCH_COUNT: AtomicUsize = AtomicUsize::new(0);

/// Ends a watch when it is dropped.
#[must_use = "the watch ends when this is dropped"]
#[derive(Debug)]
pub struct Watching {
    folder: PathBuf,
}

/// Asks `watch` before every step below `folder`, which no other watch has, until the answer is dropped.
pub fn watch_below(folder: &Path, watch: Arc<Watch>) -> Watching {
    WATCHES.write().unwrap_or_else(PoisonError::into_inner).push((folder.to_owned(), watch));
    WATCH_COUNT.fetch_add(1, Ordering::SeqCst);
    Watching { folder: folder.to_owned() }
}

impl Drop for Watching {
    fn drop(&mut self) {
        WATCH_COUNT.fetch_sub(1, Ordering::SeqCst);
        WATCHES.write().unwrap_or_else(PoisonError::into_inner).retain(|(folder, _)| *folder != self.folder);
    }
}

/// Called just before a step.
///
/// # Errors
/// What the watch of the path says.
pub fn about_to(step: DiskStep, path: &Path) -> io::Result<()> {
    if WATCH_COUNT.load(Ordering::SeqCst) == 0 {
        return Ok(());
    }
    let watches = WATCHES.read().unwrap_or_else(PoisonError::into_inner);
    let found = watches.iter().find(|(folder, _)| path.starts_with(folder)).map(|(_, watch)| watch.clone());
    drop(watches);
    found.map_or(Ok(()), |watch| watch(step, path))
}
