//! `gearcut diagnose`: which errors explain a measured gear.

use std::path::PathBuf;

use crate::influence::diagnose::{self, MeasuredCuts, Noise};
use crate::influence::measured;
use crate::number_text::plain;
use crate::output::text::Sheet;
use crate::process;
use gearcut_core::{Refusal, Result};
use serde_json::json;

use super::args::DiagnoseArguments;
use super::failure::Failure;
use super::{backend, folder, print};

/// Runs the command; what Ctrl-C ended early is a failure that tells where its results are.
pub fn run(arguments: &DiagnoseArguments) -> Result<(), Failure> {
    let noise_um = arguments.noise_um;
    if !(noise_um.is_finite() && noise_um > 0.0) {
        let problem = format!("{noise_um} um is no standard deviation");
        return Err(Refusal::new("--noise-um", problem, "give a number above 0").into());
    }
    let loaded = process::load(&arguments.scene.scene, &arguments.scene.settings)?;
    diagnose::tried(&loaded, &arguments.parameters)?;
    let points = measured::read(&arguments.measured)?;
    let name = &loaded.scene.name;
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(format!("{name}_diagnosis")));
    let (choice, progress) = backend::of_few_places(&arguments.run.compute, false, &loaded.scene)?;
    let names = &arguments.parameters;
    let filled = folder::fill_partly(&out, "diagnose", |folder, interrupt, known| {
        let cuts = MeasuredCuts::new(&loaded, &points, choice.backend.as_ref(), known)?;
        let measured_um: Vec<f64> = points.iter().map(|point| point.deviation_um).collect();
        let noise = Noise::of_values(noise_um).and_axes(&cuts, &progress, interrupt)?;
        let (model, found) = diagnose::diagnose(&cuts, &measured_um, &noise, names, &progress, interrupt)?;
        let tree = diagnose::findings(&loaded.scene, &model, &points, &noise, &found);
        diagnose::write(&loaded, &choice.backend.name_in_files(), (&model, &found), &tree, folder)?;
        let mut record = vec![
            ("measured", json!(arguments.measured)),
            ("noise_um", json!(noise_um)),
            ("parameters", json!(names)),
            ("scene", json!(loaded.resolved_toml())),
        ];
        record.extend(backend::record(&choice));
        let complete = model.complete;
        Ok((record, (model, found, tree), complete))
    });
    let (path, (model, found, tree), complete) = filled.map_err(|error| Failure::of_scene(&loaded, error))?;
    let gear = &loaded.scene.gear;
    let mut sheet = Sheet::default();
    let places = points.len();
    sheet.heading(&format!(
        "{name}: {} teeth, module {} mm, {places} measured places",
        gear.teeth,
        plain(gear.module_mm)
    ));
    diagnose::sheet(&model, &found, &tree, &mut sheet);
    print::sheet(&format!("{}\neverything is in {}\n", sheet.into_text(), path.display()))?;
    print::warnings(&tree.warnings);
    if !complete {
        return Err(Failure::ended_early(&path, &out));
    }
    Failure::verdict(&tree.warnings, &arguments.run.verdict.rules())
}
