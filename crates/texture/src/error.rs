//! Errors as values: which file, and why. What a surface does not allow is a sentence, ready to print.

use std::path::PathBuf;

/// What can go wrong with a file.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file could not be opened, read or written.
    #[error("{action} {}: {source}", path.display())]
    Io {
        /// What was being done: "cannot read", "cannot write".
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A file that was read is not what it should be.
    #[error("cannot use {}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// The format cannot hold what should be written.
    #[error("cannot write {}: {reason}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// The writer's reason.
        reason: String,
    },
}

impl Error {
    /// Adapter for `map_err`: a read that failed.
    pub(crate) fn reading(path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| Self::Io { action: "cannot read", path, source }
    }
}

/// Result of everything that reads or writes files.
pub type Result<T, E = Error> = std::result::Result<T, E>;
