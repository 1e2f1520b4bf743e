//! What a pair writes: results and tables.

use super::options::PairOptions;
use super::rolled::RolledPair;
use crate::findings::{Findings, RESULTS_FILE};
use crate::output::folder::OutputFolder;
use crate::output::table::write_tables;
use crate::scene::Scene;
use gearcut_core::error::Result;

/// Writes everything but the run record.
///
/// # Errors
/// Files that cannot be written.
pub fn write(
    _scenes: [&Scene; 2],
    _options: &PairOptions,
    _rolled: &RolledPair,
    found: &Findings,
    folder: &OutputFolder,
) -> Result<()> {
    write_tables(found, folder)?;
    folder.write_json(RESULTS_FILE, &found.to_json())
}
