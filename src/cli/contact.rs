//! `gearcut contact`: a bevel gear and its pinion in contact.

use std::path::PathBuf;

use crate::findings::RESULTS_FILE;
use crate::output::atomic::write_bytes_atomically;
use crate::output::report::REPORT_FILE;
use crate::output::summary;
use crate::output::table::write_tables;
use crate::output::text::Sheet;
use crate::process::bevel::BevelJob;
use crate::process::bevel::pair::{MountingErrors, bearing, charts, findings, page, roll};
use crate::process::load;
use crate::progress::{Progress, ProgressMode};
use crate::scene::LoadedScene;
use gearcut_core::units::UM_PER_MM;
use gearcut_core::{Error, Refusal};
use serde_json::json;

use super::args::ContactArguments;
use super::failure::Failure;
use super::{folder, print};

/// Errors of the mounting above this are another pair, mm and deg.
const LARGEST_MM: f64 = 2.0;
const LARGEST_DEG: f64 = 2.0;
/// Marking compound of more than this is no marking, mm.
const THICKEST_MM: f64 = 0.1;

/// Runs the command.
pub fn run(arguments: &ContactArguments) -> Result<(), Failure> {
    let errors = errors(arguments)?;
    let marking_mm = within("--marking-um", arguments.marking_um / UM_PER_MM, THICKEST_MM, 0.0, UM_PER_MM)?;
    // The gear, its pinion, and the pinion's concave side where that has a scene of its own.
    let mut scenes = vec![load(&arguments.gear, &arguments.set_gear)?];
    for pinion in std::iter::once(&arguments.pinion).chain(&arguments.pinion_concave) {
        scenes.push(load(pinion, &arguments.set_pinion)?);
    }
    let name = format!("{}_with_{}", scenes[0].scene.name, scenes[1].scene.name);
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&name));
    let words = std::env::args().skip(1).collect::<Vec<_>>();
    let jobs: Vec<BevelJob> = scenes.iter().map(job).collect::<Result<_, _>>()?;
    let progress = Progress::new(ProgressMode::choose(false, arguments.json));
    let filled = folder::fill(&out, "contact", |folder, interrupt| {
        let rolled = roll(&jobs[0], [&jobs[1], &jobs[jobs.len() - 1]], &errors, marking_mm, (&progress, interrupt))?;
        interrupt.check()?;
        let found = findings::findings(&name, &jobs, &rolled);
        let motion_error = charts::motion_error(&rolled);
        motion_error.write_svg(&folder.path("pictures/motion_error.svg")?)?;
        for side in &rolled.sides {
            let path = folder.path(format!("pictures/bearing_{}.svg", findings::words(side)))?;
            write_bytes_atomically(&path, bearing::svg(side, rolled.marking_mm).as_bytes())?;
        }
        write_tables(&found, folder)?;
        let scenes: Vec<String> = scenes.iter().map(LoadedScene::resolved_toml).collect();
        let end = page::ending(folder, &scenes)?;
        page::page(&jobs, &rolled, &found, motion_error, end).write(&folder.path(REPORT_FILE)?)?;
        folder.write_json(RESULTS_FILE, &found.to_json())?;
        let keys = ["scene_gear", "scene_pinion", "scene_pinion_concave"].into_iter();
        let record = std::iter::once(("arguments", json!(words)));
        Ok((record.chain(keys.zip(scenes.iter().map(|scene| json!(scene)))).collect(), found))
    });
    let (path, found) = filled.map_err(|error| match error {
        // What geometry refuses of a pair lies in both scenes.
        Error::Refused(refusal) => Failure::without_place("no pair", &refusal),
        other => other.into(),
    })?;
    if arguments.json {
        let text = serde_json::to_string_pretty(&found.to_json())
            .map_err(|reason| Error::Output { path: path.clone(), reason: reason.to_string() })?;
        print::to_stdout(&format!("{text}\n"))?;
    } else {
        let mut sheet = Sheet::default();
        sheet.heading(&found.scene);
        summary::print(&found, &mut sheet);
        print::sheet(&format!("{}\neverything is in {}\n", sheet.into_text(), path.display()))?;
    }
    Failure::verdict(&found.warnings, &arguments.verdict.rules())
}

fn job(loaded: &LoadedScene) -> Result<BevelJob, Failure> {
    BevelJob::new(&loaded.scene).map_err(|error| match error {
        Error::Refused(refusal) => Failure::without_place(&loaded.scene.name, &refusal),
        other => other.into(),
    })
}

fn errors(arguments: &ContactArguments) -> Result<MountingErrors, Failure> {
    let mm = |name, um: f64| within(name, um / UM_PER_MM, LARGEST_MM, -LARGEST_MM, UM_PER_MM);
    Ok(MountingErrors {
        offset_mm: mm("--e-um", arguments.e_um)?,
        pinion_axial_mm: mm("--p-um", arguments.p_um)?,
        gear_axial_mm: mm("--g-um", arguments.g_um)?,
        shaft_angle_rad: within("--sigma-deg", arguments.sigma_deg, LARGEST_DEG, -LARGEST_DEG, 1.0)?.to_radians(),
    })
}

/// A value within its range; `shown` is what a value is multiplied by to be as it was written.
fn within(name: &'static str, value: f64, most: f64, least: f64, shown: f64) -> Result<f64, Failure> {
    if value.is_finite() && value >= least && value <= most && (least < 0.0 || value > 0.0) {
        return Ok(value);
    }
    let above = if least < 0.0 { format!("{}", least * shown) } else { "above 0".to_owned() };
    let problem = format!("{} is not {above} to {}", value * shown, most * shown);
    Err(Refusal::new(name, problem, "give a value in this range").into())
}
