//! `gearcut scatter`: how gears of one scene scatter, and which layer of errors makes how much.
//!
//! The folder grows while the command runs: every finished seed is a row that a kill does not take. So its record is
//! written first, and the same command goes on with what is missing.

use std::fs;
use std::path::{Path, PathBuf};

use gearcut::cut::cpu::Cpu;
use gearcut::interrupt::Interrupt;
use gearcut::machine_errors::ErrorLayer;
use gearcut::output::atomic::write_bytes_atomically;
use gearcut::output::folder::RUN_RECORD;
use gearcut::output::progress::{Progress, ProgressMode};
use gearcut::scatter::layers::{cases, measure_cases};
use gearcut::scatter::numbers::NUMBERS;
use gearcut::scatter::rows::{self, RowFile, Rows};
use gearcut::scatter::seeds::measure_seeds;
use gearcut::scatter::statistics::Spread;
use gearcut::scatter::{FlankWish, tables};
use gearcut::scene::LoadedScene;
use gearcut::{Error, Refusal, Side, process};
use serde_json::{Value, json};

use super::args::{FlankSide, ScatterArguments};
use super::failure::Failure;
use super::folder::listening;
use super::print;

/// Runs the command.
pub fn run(arguments: &ScatterArguments) -> Result<(), Failure> {
    let scene = process::load(&arguments.scene.scene, &arguments.scene.settings)?;
    let layers = scene.scene.process.error_layers();
    if layers.is_empty() {
        let problem = "the scene has no errors: all its gears are alike";
        let way_out = "write [machine.errors...], [mounting] or errors of the tool; see docs/errors.md";
        return Err(Failure::without_place(&scene.scene.name, &Refusal::new("machine.errors", problem, way_out)));
    }
    let side = match arguments.side {
        FlankSide::Left => Side::Left,
        FlankSide::Right => Side::Right,
    };
    let flank = FlankWish { tooth: arguments.tooth, side };
    let out =
        arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(format!("{}_scatter", scene.scene.name)));
    let interrupt = Interrupt::listen().map_err(listening(&out))?;
    let progress = Progress::new(ProgressMode::choose(arguments.quiet, false));
    open(&out, &scene, flank)?;
    let watch = (&progress, &interrupt);
    let of_scene = |error| Failure::of_scene(&scene, error);
    let cases = cases(&layers);
    let by_layer = measure_cases(&scene.scene, &cases, flank, &Cpu::default(), watch).map_err(of_scene)?;
    let names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    write(&out.join("layers.csv"), &tables::layers_csv(&names, &by_layer))?;
    let mut text =
        tables::sheet(&format!("{}: tooth {} {}", scene.scene.name, flank.tooth, side.name()), &names, &by_layer);
    let random = layers.iter().any(|layer| matches!(layer, ErrorLayer::Noise | ErrorLayer::Stock));
    if random && arguments.seeds > 0 {
        let path = out.join("seeds.csv");
        let (file, known) = RowFile::open(&path)?;
        let with_seed = |seed: u32| {
            let mut settings = arguments.scene.settings.clone();
            settings.push(format!("machine.errors.seed={seed}"));
            Ok(process::load(&arguments.scene.scene, &settings).map_err(|errors| Error::Scene(Box::new(errors)))?.scene)
        };
        let found = measure_seeds((known, &file), arguments.seeds, with_seed, flank, &Cpu::default(), watch)
            .map_err(of_scene)?;
        let done = (1..=arguments.seeds).filter(|seed| found.contains_key(seed)).count();
        rows::write(&path, &found)?;
        if done < arguments.seeds as usize {
            return Err(Failure::to_go_on(&out, done, arguments.seeds as usize));
        }
        let spreads = spreads(&found, arguments.seeds);
        write(&out.join("scatter.csv"), &tables::scatter_csv(&spreads))?;
        text += &tables::spread_sheet(arguments.seeds, &spreads);
    } else if arguments.seeds > 0 {
        text += "\nnothing in the scene is random: every seed makes the same gear\n";
    }
    Ok(print::sheet(&format!("{text}\neverything is in {}\n", out.display()))?)
}

/// Median and interval of every number over the seeds up to `seeds`.
fn spreads(rows: &Rows, seeds: u32) -> Vec<Option<Spread>> {
    let of = |number: usize| Spread::of(rows.range(1..=seeds).filter_map(|(_, values)| values[number]));
    (0..NUMBERS.len()).map(of).collect()
}

fn write(path: &Path, text: &str) -> Result<(), Error> {
    write_bytes_atomically(path, text.as_bytes())
}

/// Makes the folder, or finds it as this command left it for the same scene and flank.
fn open(out: &Path, scene: &LoadedScene, flank: FlankWish) -> Result<(), Error> {
    let record = json!({
        "program": "gearcut",
        "program_version": env!("CARGO_PKG_VERSION"),
        "command": "scatter",
        "tooth": flank.tooth,
        "side": flank.side.name(),
        "scene": scene.resolved_toml(),
    });
    let path = out.join(RUN_RECORD);
    let refuse = |reason: &str| Err(Error::Output { path: out.to_owned(), reason: reason.to_owned() });
    match fs::read(&path) {
        Ok(text) => match serde_json::from_slice::<Value>(&text) {
            Ok(there) if there == record => Ok(()),
            Ok(there) if there.get("command") == record.get("command") => {
                refuse("the folder holds gears of another scene, flank or version; choose another one with --out")
            }
            _ => refuse("the folder holds what another command of gearcut wrote; choose another one with --out"),
        },
        Err(_) if out.exists() => refuse("gearcut scatter did not make this folder; choose another one with --out"),
        Err(_) => {
            fs::create_dir_all(out).map_err(Error::writing(out))?;
            write(&path, &format!("{record:#}\n"))
        }
    }
}
