//! `gearcut scatter`: how gears of one scene scatter, and which layer of errors makes how much.
//!
//! The folder grows while the command runs: every finished seed is a row that a kill does not take. So its record is
//! written first, and the same command goes on with what is missing.

use std::path::PathBuf;

use crate::interrupt::Interrupt;
use crate::output::growing_folder::GrowingFolder;
use crate::process;
use crate::process::ProcessJob;
use crate::progress::Progress;
use crate::scatter::layers::{cases, measure_cases};
use crate::scatter::rows::{self, Rows};
use crate::scatter::seeds::measure_seeds;
use crate::scatter::tolerance::{self, Tolerance};
use crate::scatter::{FlankWish, Scatter, findings, page, printed};
use crate::scene::LoadedScene;
use gearcut_core::cut::Backend;
use gearcut_core::terms::Side;
use gearcut_core::{Error, Refusal};
use serde_json::{Map, Value, json};

use super::args::{FlankSide, ScatterArguments};
use super::failure::Failure;
use super::folder::listening;
use super::{backend, print};

/// Runs the command.
pub fn run(arguments: &ScatterArguments) -> Result<(), Failure> {
    let loaded = process::load(&arguments.scene.scene, &arguments.scene.settings)?;
    let scene = &loaded.scene;
    let layers = scene.process.error_layers();
    let tolerances = checked(arguments)?;
    if layers.is_empty() && tolerances.is_empty() {
        let problem = "the scene has no errors: all its gears are alike";
        let way_out = "write [machine.errors...], [mounting] or errors of the tool, or give a --tolerance; see \
            docs/errors.md";
        return Err(Failure::without_place(&scene.name, &Refusal::new("machine.errors", problem, way_out)));
    }
    let side = match arguments.side {
        FlankSide::Left => Side::Left,
        FlankSide::Right => Side::Right,
    };
    let flank = FlankWish { tooth: arguments.tooth, side };
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(format!("{}_scatter", scene.name)));
    let interrupt = Interrupt::listen().map_err(listening(&out))?;
    let (choice, progress) = backend::of_few_places(&arguments.run.compute, false, scene)?;
    let cutter = choice.backend.as_ref();
    let folder = GrowingFolder::open(&out, record(&loaded, flank, tolerances, &cutter.name_in_files()))?;
    let watch = (&progress, &interrupt);
    let of_scene = |error| Failure::of_scene(&loaded, error);
    let job = process::prepare(scene).map_err(of_scene)?;
    let cases = measure_cases((scene, job.as_ref()), cases(&layers), flank, cutter, watch).map_err(of_scene)?;
    let differs = !tolerances.is_empty() || layers.iter().any(|layer| layer.is_random());
    let gears = Some(arguments.seeds).filter(|&gears| gears > 0 && differs);
    let rows = match gears {
        Some(gears) => {
            seeds(arguments, gears, (&loaded, job.as_ref()), (flank, cutter), &folder, watch).map_err(of_scene)?
        }
        None => Rows::new(),
    };
    let done = rows.range(..=gears.unwrap_or(0)).count();
    if let Some(gears) = gears.filter(|&gears| done < gears as usize) {
        rows::write(folder.path(), &rows)?;
        return Err(Failure::to_go_on(&out, [done as u64, gears.into()], "gears"));
    }
    let mut unfollowed = Vec::new();
    job.with_gear(&mut |gear| {
        unfollowed = gear.unfollowed_errors();
        Ok(())
    })
    .map_err(of_scene)?;
    let found = Scatter { flank, cases, gears, tolerances: tolerances.to_vec(), unfollowed, rows };
    let tree = findings(scene, &found);
    let path = folder.finish(|folder| page::write(scene, &found, &tree, folder))?;
    print::sheet(&format!("{}\neverything is in {}\n", printed(scene, &found), path.display()))?;
    print::warnings(&tree.warnings);
    Failure::verdict(&tree.warnings, &arguments.run.verdict.rules())
}

/// Rows of the gears that the folder has and of those that are cut now, until Ctrl-C.
fn seeds(
    arguments: &ScatterArguments,
    gears: u32,
    (base, job): (&LoadedScene, &dyn ProcessJob),
    of: (FlankWish, &dyn Backend),
    folder: &GrowingFolder,
    watch: (&Progress, &Interrupt),
) -> Result<Rows, Error> {
    let (file, known) = rows::open(folder.path())?;
    let with_seed = |seed: u32| {
        let mut settings = vec![format!("machine.errors.seed={seed}")];
        settings.extend(tolerance::settings(&arguments.tolerances, seed));
        Ok(base.with_settings(&settings, process::table()).map_err(|errors| Error::Scene(Box::new(errors)))?.scene)
    };
    measure_seeds((known, &file), gears, with_seed, job, of, watch)
}

/// The tolerances, each of which makes a gear at both of its limits.
fn checked(arguments: &ScatterArguments) -> Result<&[Tolerance], Failure> {
    let tolerances = &arguments.tolerances;
    for (place, tolerance) in tolerances.iter().enumerate() {
        let Tolerance { key, limits } = tolerance;
        if tolerances[..place].iter().any(|other| other.key == *key) {
            let refusal = Refusal::new(key, format!("`{key}` has two tolerances"), "leave one of them");
            return Err(Failure::without_place("--tolerance", &refusal));
        }
        for limit in limits {
            let settings = [&arguments.scene.settings[..], &[tolerance.setting(*limit)]].concat();
            process::load(&arguments.scene.scene, &settings)?;
        }
    }
    Ok(tolerances)
}

/// What the rows of a folder belong to.
fn record(scene: &LoadedScene, flank: FlankWish, tolerances: &[Tolerance], backend: &str) -> Map<String, Value> {
    let limits: Map<String, Value> = tolerances.iter().map(|of| (of.key.clone(), json!(of.limits))).collect();
    let entries = [
        ("program", json!("gearcut")),
        ("program_version", json!(env!("CARGO_PKG_VERSION"))),
        ("command", json!("scatter")),
        ("tooth", json!(flank.tooth)),
        ("side", json!(flank.side.name())),
        ("tolerances", json!(limits)),
        ("backend", json!(backend)),
        ("scene", json!(scene.resolved_toml())),
    ];
    entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}
