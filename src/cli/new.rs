//! `gearcut new`: a commented scene to start from.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::Path;

use crate::process;
use crate::scene;
use gearcut_core::Error;

use super::args::NewArguments;
use super::failure::Failure;
use super::print;

/// Runs the command.
pub fn run(arguments: &NewArguments) -> Result<(), Failure> {
    // The argument parser has refused every other process.
    let text = scene::template(process::table(), &arguments.process).unwrap_or_default();
    let Some(path) = &arguments.out else { return Ok(print::to_stdout(&text)?) };
    write_new(path, &text)?;
    let next = format!("wrote {}; `gearcut check {}` says what it means\n", path.display(), path.display());
    Ok(print::sheet(&next)?)
}

/// Writes a scene to a file that does not exist yet.
pub fn write_new(path: &Path, text: &str) -> Result<(), Error> {
    let mut file = OpenOptions::new().write(true).create_new(true).open(path).map_err(|failed| {
        if failed.kind() == ErrorKind::AlreadyExists {
            let reason = "the file exists, and a scene is never replaced; choose another name with --out".to_owned();
            return Error::Output { path: path.to_owned(), reason };
        }
        Error::writing(path)(failed)
    })?;
    file.write_all(text.as_bytes()).map_err(Error::writing(path))
}
