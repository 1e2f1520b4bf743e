//! `gearcut devices`: what can compute here, and what `--backend auto` would take.

use gearcut::backend;

use super::failure::Failure;
use super::{drivers, print};

/// Runs the command.
pub fn run() -> Result<(), Failure> {
    drivers::without_window_system();
    Ok(print::sheet(&format!("{}\n", backend::devices()))?)
}
