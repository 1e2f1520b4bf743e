//! The folder of gears or scenes that are made one after the other: it goes on where the last run ended.
//!
//! In: its name and the record of what it holds. Out: a place for rows, and at the end everything else.
//!
//! The law: rows stand under the final name as soon as they are found, beside a record that says what they are; a kill
//! takes none of them. Everything else is written under the hidden name ([`OutputFolder`]) and takes the final one in
//! one step, rows included. The lock of that hidden name is held from the first look at the folder to the last: a
//! second run to the same name is refused.
//!
//! Road not taken: rows under the hidden name. The next run removes what a killed one left there.

use super::folder::{FILES, OutputFolder, RUN_RECORD};
use super::growing::begin;
use gearcut_core::error::{Error, Result};
use serde_json::{Map, Value};
use std::fs;
use std::path::{Path, PathBuf};

/// A folder that grows.
#[derive(Debug)]
pub struct GrowingFolder {
    path: PathBuf,
    record: Map<String, Value>,
    hidden: OutputFolder,
}

impl GrowingFolder {
    /// Makes the folder, or takes it as an earlier run with the same record left it. The record tells program, version
    /// and command, and what the rows belong to.
    ///
    /// # Errors
    /// Another run writes there; the folder holds something else; it cannot be made.
    pub fn open(path: &Path, record: Map<String, Value>) -> Result<Self> {
        let hidden = OutputFolder::create(path)?;
        let refuse = |reason: &str| Err(Error::Output { path: path.to_owned(), reason: reason.to_owned() });
        // What is no record of gearcut's has been refused above; what is left is an empty folder, or none.
        let there = fs::read(path.join(RUN_RECORD)).ok();
        match there.and_then(|text| serde_json::from_slice::<Map<String, Value>>(&text).ok()) {
            Some(mut there) => {
                there.remove("complete");
                there.remove(FILES);
                if there.get("command") != record.get("command") {
                    return refuse(
                        "the folder holds what another command of gearcut wrote; choose another one with --out",
                    );
                }
                if there != record {
                    return refuse(
                        "the folder holds rows of another scene, flank or version, or of other options; choose \
                         another one with --out",
                    );
                }
            }
            None => begin(path, &record)?,
        }
        Ok(Self { path: path.to_owned(), record, hidden })
    }

    /// Where files grow.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Lets `write` write everything, rows included, and puts it in the place of what was there.
    ///
    /// # Errors
    /// Files that cannot be written: what was there stays.
    pub fn finish(self, write: impl FnOnce(&OutputFolder) -> Result<()>) -> Result<PathBuf> {
        let written = write(&self.hidden);
        let written = written.and_then(|()| self.hidden.write_record(self.record));
        written.map_err(|error| self.hidden.explain(error))?;
        self.hidden.finish()
    }
}
