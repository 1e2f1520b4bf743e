//! Files that are either complete or absent: the writers of [`gearcut_texture::atomic`] with this crate's errors.

use std::io;
use std::path::Path;

use gearcut_core::{Error, Result};

pub use gearcut_texture::atomic::{Sink, is_temporary};

/// Writes `path` completely or not at all.
///
/// The folder must exist. A file already there is replaced at the end.
///
/// # Errors
/// [`gearcut_core::Error::Io`] with the system's reason, or with the reason that `fill` gave through
/// [`io::Error::other`].
pub fn write_atomically(path: &Path, fill: impl FnOnce(&mut dyn Sink) -> io::Result<()>) -> Result<()> {
    gearcut_texture::atomic::write_atomically(path, fill).map_err(file_error)
}

/// Writes `path` with the given contents, completely or not at all.
///
/// # Errors
/// [`gearcut_core::Error::Io`] with the system's reason.
pub fn write_bytes_atomically(path: &Path, bytes: &[u8]) -> Result<()> {
    gearcut_texture::atomic::write_bytes_atomically(path, bytes).map_err(file_error)
}

/// A problem of a surface file or map in this crate's words.
pub fn file_error(error: gearcut_texture::Error) -> Error {
    use gearcut_texture::Error as Texture;
    match error {
        Texture::Io { action, path, source } => Error::Io { action, path, source },
        Texture::Unwritable { path, fault } => Error::Output { path, reason: fault.to_string() },
        Texture::Unreadable { path, fault, .. } => Error::Unreadable { path, reason: fault.to_string() },
    }
}
