//! `gearcut devices`: what can compute here, and what `--backend auto` would take.

use gearcut::cut::choice;

use super::failure::Failure;
use super::print;

/// Runs the command.
pub fn run() -> Result<(), Failure> {
    Ok(print::to_stdout(&format!("{}\n", choice::devices()))?)
}
