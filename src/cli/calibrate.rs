//! `gearcut calibrate`: errors of a scene fitted to what was measured of its gear.

use std::path::PathBuf;

use crate::influence::budget::chosen;
use crate::influence::calibrate::{self, Calibrated, Calibration, MeasuredGear, MeasuredNumber, MeasuredWish};
use crate::number_text::{plain, significant};
use crate::output::summary;
use crate::output::text::Sheet;
use crate::process;
use crate::scene::LoadedScene;
use gearcut_core::{Refusal, Result};
use serde_json::json;

use super::args::CalibrateArguments;
use super::failure::Failure;
use super::{backend, folder, print};

/// Runs the command; what Ctrl-C ended early is a failure that tells where its results are.
pub fn run(arguments: &CalibrateArguments) -> Result<(), Failure> {
    let loaded = process::load(&arguments.scene.scene, &arguments.scene.settings)?;
    let of_fit = |refusal: Refusal| Refusal { key: "--fit".to_owned(), ..refusal };
    let parameters = chosen(&loaded, &arguments.fit).map_err(of_fit)?;
    let measured = read(&loaded, arguments).map_err(|error| Failure::of_scene(&loaded, error))?;
    let name = &loaded.scene.name;
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(format!("{name}_calibration")));
    let (choice, progress) = backend::of_few_places(&arguments.run.compute, false, &loaded.scene)?;
    let filled = folder::fill_partly(&out, "calibrate", |folder, interrupt, known| {
        let found = Calibration::new(&loaded, &parameters, &measured, &choice, &progress, interrupt, known)?;
        let tree = calibrate::findings(&loaded.scene, &measured, &found);
        calibrate::write(&loaded, &choice.backend.name_in_files(), &measured, &found, &tree, folder)?;
        let mut record = vec![
            ("measured", json!(arguments.measured)),
            ("noise_um", json!(arguments.noise_um)),
            ("surface_percent", json!(arguments.surface_percent)),
            ("surface_numbers", json!(arguments.surface_numbers)),
            ("fit", json!(arguments.fit)),
            ("settings", json!(found.settings)),
            ("scene", json!(loaded.resolved_toml())),
        ];
        record.extend(backend::record(&choice));
        let complete = found.complete;
        Ok((record, (found, tree), complete))
    });
    let (path, (found, tree), complete) = filled.map_err(|error| Failure::of_scene(&loaded, error))?;
    let gear = &loaded.scene.gear;
    let mut sheet = Sheet::default();
    sheet.heading(&format!("{name}: {} teeth, module {} mm; fitted", gear.teeth, plain(gear.module_mm)));
    sheet.words("fitted: shifts beyond the scene, with 95 % intervals");
    for [title, value, unit] in found.printed() {
        let is_number = value.ends_with(|last: char| last.is_ascii_digit());
        let unit = if is_number && unit != "1" { unit } else { String::new() };
        summary::line(&mut sheet, &title, format!("{value} {unit}").trim_end());
    }
    if !measured.numbers.is_empty() {
        sheet.heading("Numbers");
        let shown = |value: f64| significant(value, 4);
        let heads = ["quantity", "measured", "predicted", "fitted"].map(str::to_owned);
        let row = |(number, of): (&MeasuredNumber, &Calibrated)| {
            vec![number.quantity.clone(), shown(of.measured), shown(of.predicted), shown(of.fitted)]
        };
        let rows = measured.numbers.iter().zip(&found.values).map(row);
        sheet.table(&std::iter::once(heads.to_vec()).chain(rows).collect::<Vec<_>>());
    }
    if !found.settings.is_empty() {
        sheet.heading("The fitted scene; fitted: these arguments make it");
        found.settings.iter().for_each(|setting| sheet.words(&format!("--set '{setting}'")));
    }
    print::sheet(&format!("{}\neverything is in {}\n", sheet.into_text(), path.display()))?;
    print::warnings(&tree.warnings);
    if !complete {
        return Err(Failure::ended_early(&path, &out));
    }
    Failure::verdict(&tree.warnings, &arguments.run.verdict.rules())
}

/// What was measured, laid on the scene's gear.
fn read(loaded: &LoadedScene, arguments: &CalibrateArguments) -> Result<MeasuredGear> {
    for (option, value) in [("--noise-um", arguments.noise_um), ("--surface-percent", arguments.surface_percent)] {
        if let Some(value) = value.filter(|value| !(value.is_finite() && *value > 0.0)) {
            let problem = format!("{value} is no standard uncertainty");
            return Err(Refusal::new(option, problem, "give a number above 0").into());
        }
    }
    let wish = MeasuredWish {
        noise_um: arguments.noise_um,
        surface_percent: arguments.surface_percent,
        symbols: arguments.surface_numbers.clone(),
    };
    let mut measured = MeasuredGear::default();
    process::prepare(&loaded.scene)?.with_gear(&mut |gear| {
        measured = calibrate::read(gear, &arguments.measured, &wish)?;
        Ok(())
    })?;
    Ok(measured)
}
