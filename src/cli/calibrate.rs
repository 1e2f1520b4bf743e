//! `gearcut calibrate`: errors of a scene fitted to measured numbers.

use std::path::PathBuf;

use gearcut::backend::{BackendWish, OnFailure, choose};
use gearcut::influence::budget::chosen;
use gearcut::influence::calibrate::{self, Calibration};
use gearcut::output::progress::{Progress, ProgressMode};
use gearcut::output::summary;
use gearcut::output::text::{Sheet, plain};
use gearcut::{Result, process};
use serde_json::json;

use super::args::CalibrateArguments;
use super::failure::Failure;
use super::{folder, print};

/// Runs the command.
pub fn run(arguments: &CalibrateArguments) -> Result<(), Failure> {
    let loaded = process::load(&arguments.scene.scene, &arguments.scene.settings)?;
    let parameters = chosen(&loaded, &arguments.fit)?;
    let measured = calibrate::read_numbers(&arguments.measured)?;
    let name = &loaded.scene.name;
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(format!("{name}_calibration")));
    let progress = Progress::new(ProgressMode::choose(false, false));
    let choice = choose(BackendWish::Cpu, OnFailure::default())?;
    let filled = folder::fill(&out, "calibrate", |folder, interrupt| {
        let found = Calibration::new(&loaded, &parameters, &measured, &choice, &progress, interrupt)?;
        let tree = calibrate::findings(&loaded.scene, &found);
        calibrate::write(&loaded.scene, &found, &tree, folder)?;
        let record = vec![
            ("measured", json!(arguments.measured)),
            ("fit", json!(arguments.fit)),
            ("settings", json!(found.settings)),
            ("scene", json!(loaded.resolved_toml())),
        ];
        Ok((record, (found, tree)))
    });
    let (path, (found, tree)) = filled.map_err(|error| Failure::of_scene(&loaded, error))?;
    let gear = &loaded.scene.gear;
    let mut sheet = Sheet::default();
    sheet.heading(&format!("{name}: {} teeth, module {} mm; fitted", gear.teeth, plain(gear.module_mm)));
    for (parameter, fitted) in &found.fitted {
        let value = fitted.map_or_else(
            || "cannot be identified".to_owned(),
            |[shift, half]| format!("{shift:.3} +- {half:.3} {} beyond the scene", parameter.unit),
        );
        summary::line(&mut sheet, &parameter.title, &value);
    }
    if !found.settings.is_empty() {
        sheet.heading("The fitted scene");
        found.settings.iter().for_each(|setting| sheet.words(&format!("--set '{setting}'")));
    }
    print::sheet(&format!("{}\neverything is in {}\n", sheet.into_text(), path.display()))?;
    print::warnings(&tree.warnings);
    Ok(())
}
