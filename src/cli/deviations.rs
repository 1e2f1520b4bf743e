//! `gearcut deviations`: measured points of a gear as normal deviations from its target.

use std::path::PathBuf;

use crate::deviations::probed::{self, DrawnSection};
use crate::deviations::{self, FitFreedom};
use crate::output::summary;
use crate::output::text::Sheet;
use crate::pair_job::watch::Watch;
use crate::process;
use crate::progress::{Progress, ProgressMode};
use gearcut_core::{Error, Refusal, Result};
use serde_json::json;

use super::args::{DeviationsArguments, FitChoice};
use super::failure::Failure;
use super::{folder, print};

/// Runs the command.
pub fn run(arguments: &DeviationsArguments) -> Result<(), Failure> {
    let radius_mm = arguments.probe_radius_mm;
    if !(0.0..=50.0).contains(&radius_mm) {
        let problem = format!("{radius_mm} mm is no radius of a probe");
        return Err(Refusal::new("--probe-radius-mm", problem, "give 0 to 50").into());
    }
    let loaded = process::load(&arguments.scene.scene, &arguments.scene.settings)?;
    let half_mm = 0.5 * loaded.scene.gear.face_width_mm;
    if arguments.section_mm.is_nan() || arguments.section_mm.abs() > half_mm {
        let problem =
            format!("{} mm is off the face, which goes from {:.3} to {half_mm:.3} mm", arguments.section_mm, -half_mm);
        return Err(Refusal::new("--section-mm", problem, "it counts from the middle of the face").into());
    }
    let freedom = match arguments.fit {
        FitChoice::None => FitFreedom::Fixed,
        FitChoice::Turn => FitFreedom::Turn,
        FitChoice::Centre => FitFreedom::Centre,
        FitChoice::Axis => FitFreedom::Axis,
        FitChoice::Body => FitFreedom::Body,
    };
    let section = DrawnSection { layer: arguments.layer.as_deref(), z_mm: arguments.section_mm };
    let points = probed::read(&arguments.measured, section)?;
    let name = &loaded.scene.name;
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(format!("{name}_deviations")));
    let progress = Progress::new(ProgressMode::choose(arguments.quiet, false));
    let filled = folder::fill(&out, "deviations", |folder, interrupt| {
        let watch = Watch::new(&progress, interrupt);
        let mut laid = None;
        process::prepare(&loaded.scene)?.with_gear(&mut |gear| {
            laid = Some(deviations::lay(gear, &points, freedom, radius_mm, &watch)?);
            Ok(())
        })?;
        let laid = laid.ok_or(Error::Interrupted)?;
        let tree = deviations::findings(&loaded.scene, &points, freedom, &laid);
        deviations::write(&loaded, freedom, &laid, &tree, folder)?;
        let record = vec![
            ("measured", json!(arguments.measured)),
            ("free_to_move", json!(freedom.words())),
            ("probe_radius_mm", json!(radius_mm)),
            ("section_mm", json!(section.z_mm)),
            ("scene", json!(loaded.resolved_toml())),
        ];
        Ok((record, tree))
    });
    let (path, tree) = filled.map_err(|error| Failure::of_scene(&loaded, error))?;
    let mut sheet = Sheet::default();
    let measured = points.len();
    sheet.heading(&format!("{name}: {measured} measured points"));
    let entries = tree.headline.iter().chain(tree.sections.iter().flat_map(|section| &section.entries));
    for entry in entries {
        summary::line(&mut sheet, &entry.title, &summary::shown(&entry.quantity));
    }
    let written = format!("\neverything is in {}; which errors explain it:\n  ", path.display());
    let next = format!(
        "gearcut diagnose {} --measured {} --noise-um 0.5\n",
        arguments.scene.scene.display(),
        path.join("tables/deviations.csv").display()
    );
    print::sheet(&(sheet.into_text() + &written + &next))?;
    print::warnings(&tree.warnings);
    Failure::verdict(&tree.warnings, &arguments.verdict.rules())
}
