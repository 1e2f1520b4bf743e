//! `gearcut budget`: which error of the machine costs what on the gear.

use std::path::PathBuf;

use crate::influence::budget::{self, BudgetOptions};
use crate::number_text::plain;
use crate::output::text::Sheet;
use crate::process;
use gearcut_core::terms::Side;
use gearcut_core::{Refusal, Result};
use serde_json::json;

use super::args::BudgetArguments;
use super::failure::Failure;
use super::{backend, folder, print};

/// Runs the command; what Ctrl-C ended early is a failure that tells where its results are.
pub fn run(arguments: &BudgetArguments) -> Result<(), Failure> {
    let loaded = process::load(&arguments.scene.scene, &arguments.scene.settings)?;
    let name = &loaded.scene.name;
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(format!("{name}_budget")));
    let flanks = arguments.flanks.iter().map(|text| flank(text)).collect::<Result<_, _>>()?;
    let options = BudgetOptions { parameters: arguments.parameters.clone(), flanks, numbers: arguments.numbers };
    let (choice, progress) = backend::of_few_places(&arguments.run.compute, false, &loaded.scene)?;
    let filled = folder::fill_partly(&out, "budget", |folder, interrupt, known| {
        let found = budget::budget(&loaded, &options, &choice, &progress, interrupt, known)?;
        let tree = budget::findings(&loaded.scene, &found);
        budget::write(&loaded, &choice.backend.name_in_files(), &found, &tree, folder)?;
        let mut record = vec![("parameters", json!(options.parameters)), ("scene", json!(loaded.resolved_toml()))];
        record.extend(backend::record(&choice));
        Ok((record, (budget::printed(&found), tree.warnings), found.complete))
    });
    let (path, (rows, warnings), complete) = filled.map_err(|error| Failure::of_scene(&loaded, error))?;
    let gear = &loaded.scene.gear;
    let mut sheet = Sheet::default();
    sheet.heading(&format!("{name}: {} teeth, module {} mm", gear.teeth, plain(gear.module_mm)));
    sheet.words("predicted: um that a natural step of each error alone makes of an ideal gear");
    sheet.table(&rows);
    print::sheet(&format!("{}\nper unit, and with maps, in {}\n", sheet.into_text(), path.display()))?;
    print::warnings(&warnings);
    if !complete {
        return Err(Failure::ended_early(&path, &out));
    }
    Failure::verdict(&warnings, &arguments.run.verdict.rules())
}

/// `7-left` as a flank.
pub fn flank(text: &str) -> Result<(u32, Side), Refusal> {
    let read = || {
        let (tooth, side) = text.split_once('-')?;
        let side = [Side::Left, Side::Right].into_iter().find(|known| known.name() == side)?;
        Some((tooth.parse().ok()?, side))
    };
    let problem = || Refusal::new("--flanks", format!("`{text}` is no flank"), "write a tooth and a side: 7-left");
    read().ok_or_else(problem)
}
