//! `gearcut devices`: what can compute here.

use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::output::text::Sheet;

use super::failure::Failure;
use super::print;

/// Runs the command.
pub fn run() -> Result<(), Failure> {
    let mut sheet = Sheet::default();
    sheet.line("--backend cpu", Cpu::default().name());
    Ok(print::to_stdout(&sheet.into_text())?)
}
