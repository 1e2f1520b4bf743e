//! `gearcut axes`: axis tables and charts of every operation, nothing cut.

use std::path::PathBuf;

use crate::findings::Notice;
use crate::interrupt::Interrupt;
use crate::output::folder::OutputFolder;
use crate::output::text::Sheet;
use crate::process;
use gearcut_core::Error;
use serde_json::json;

use super::args::AxesArguments;
use super::failure::Failure;
use super::folder::{self, Record};
use super::print;

/// Runs the command.
pub fn run(arguments: &AxesArguments) -> Result<(), Failure> {
    let scene = process::load(&arguments.scene.scene, &arguments.scene.settings)?;
    let default = || PathBuf::from("out").join(format!("{}_axes", scene.scene.name));
    let out = arguments.out.clone().unwrap_or_else(default);
    let mut sheet = Sheet::default();
    let write = |output: &OutputFolder, interrupt: &Interrupt| -> Result<(Record, Vec<Notice>), Error> {
        let mut axes = || process::prepare(&scene.scene)?.axes(output, interrupt, &mut sheet);
        let warnings = if arguments.quiet { axes() } else { print::waiting("axes", "scene", axes) }?;
        Ok((vec![("scene", json!(scene.resolved_toml()))], warnings))
    };
    let (path, warnings) = folder::fill(&out, "axes", write).map_err(|error| Failure::of_scene(&scene, error))?;
    let written = format!("\ntables, charts and programs are in {}\n", path.join("axes").display());
    if !arguments.quiet {
        print::sheet(&(sheet.into_text() + &written))?;
    }
    print::warnings(&warnings);
    Failure::verdict(&warnings, &arguments.verdict.rules())
}
