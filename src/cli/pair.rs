//! `gearcut pair`: two gears rolled on each other.

use std::path::PathBuf;

use crate::findings::Findings;
use crate::number_text::plain;
use crate::output::summary;
use crate::output::text::Sheet;
use crate::pair_job::flanks::FlankSource;
use crate::pair_job::options::PairOptions;
use crate::pair_job::page::PairRecord;
use crate::pair_job::quantities::{DISTANCE, PAIR};
use crate::pair_job::watch::Watch;
use crate::pair_job::{findings, member, rolled, spline, write};
use crate::scene::{LoadedScene, Mate};
use gearcut_core::Error;
use gearcut_core::gear::GearKind;
use serde_json::json;

use super::args::{FlankChoice, PairArguments};
use super::failure::Failure;
use super::{backend, folder, print};

/// Runs the command.
pub fn run(arguments: &PairArguments) -> Result<(), Failure> {
    let [a, b] = gears(arguments)?;
    let scenes = [&a.scene, &b.scene];
    let options = options(arguments)?;
    let name = format!("{}_with_{}", a.scene.name, b.scene.name);
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&name));
    let words = std::env::args().skip(1).collect::<Vec<_>>();
    let (choice, progress) = backend::of_few_places(&arguments.run.compute, arguments.json, scenes[0])?;
    let (path, found) = folder::fill(&out, "pair", |folder, interrupt| {
        let watch = Watch::new(&progress, interrupt);
        let [scene_a, scene_b] = [&a, &b].map(LoadedScene::resolved_toml);
        let run = PairRecord { backend: choice.backend.name_in_files(), scenes: [scene_a.clone(), scene_b.clone()] };
        let mut record =
            [("arguments", json!(words)), ("scene_A", json!(scene_a)), ("scene_B", json!(scene_b))].to_vec();
        record.extend(backend::record(&choice));
        if spline::is_spline(scenes) {
            let fit = spline::fit(scenes, &options, choice.backend.as_ref(), &watch)?;
            let found = spline::report::findings(&name, scenes, &fit);
            spline::report::write(scenes, &fit, &found, folder, &run)?;
            return Ok((record, found));
        }
        let rolled = rolled::roll_pair(scenes, &options, choice.backend.as_ref(), &watch)?;
        let found = findings::findings(&name, scenes, &options, &rolled);
        write::write(scenes, &options, &rolled, &found, folder, &run, &watch)?;
        Ok((record, found))
    })
    .map_err(|error| in_place(&a, error))?;
    if arguments.json {
        let text = serde_json::to_string_pretty(&found.to_json())
            .map_err(|reason| Error::Output { path: path.clone(), reason: reason.to_string() })?;
        print::to_stdout(&format!("{text}\n"))?;
    } else {
        let mut sheet = Sheet::default();
        heading(&found, scenes.map(|scene| scene.gear.teeth), a.scene.gear.module_mm, &mut sheet);
        summary::print(&found, &mut sheet);
        print::sheet(&format!("{}\neverything is in {}\n", sheet.into_text(), path.display()))?;
    }
    // Everything is written all the same.
    Failure::verdict(&found.warnings, &arguments.run.verdict.rules())
}

fn heading(found: &Findings, teeth: [u32; 2], module_mm: f64, sheet: &mut Sheet) {
    let [a, b] = teeth;
    let module = plain(module_mm);
    let axes = match found.group(&PAIR).and_then(|pair| pair.value(&DISTANCE)) {
        Some(apart_mm) => format!("axes {} mm apart", plain(apart_mm)),
        None => "a splined shaft in its hub".to_owned(),
    };
    sheet.heading(&format!("{}: {a} and {b} teeth, module {module} mm, {axes}", found.scene));
}

/// Both gears.
fn gears(arguments: &PairArguments) -> Result<[LoadedScene; 2], Failure> {
    let a = member::read(&arguments.a, &arguments.set_a)?;
    let b = match (&arguments.b, arguments.mate) {
        (Some(path), _) => member::read(path, &arguments.set_b)?,
        (None, teeth) => {
            let teeth = teeth.expect("the command line asks for gear B or --mate");
            let kind = if arguments.internal { GearKind::Internal } else { GearKind::External };
            member::mate(&a, Mate { teeth, kind }, &arguments.set_b).map_err(|error| match error {
                Error::Refused(refusal) => {
                    Failure::without_place(&format!("no {} mate with {teeth} teeth", kind.name()), &refusal)
                }
                other => other.into(),
            })?
        }
    };
    Ok([a, b])
}

/// What geometry refuses of a pair lies in both scenes, or in the options: it has no line in one file.
fn in_place(a: &LoadedScene, error: Error) -> Failure {
    match error {
        Error::Refused(refusal) => Failure::without_place(&format!("{} in a pair", a.scene.name), &refusal),
        other => other.into(),
    }
}

fn options(arguments: &PairArguments) -> Result<PairOptions, Failure> {
    let finite = [
        ("--center-distance-mm", arguments.center_distance_mm.unwrap_or(1.0), f64::MIN_POSITIVE),
        ("--center-distance-error-um", arguments.center_distance_error_um, f64::NEG_INFINITY),
        ("--eccentricity-a-um", arguments.eccentricity_a_um, 0.0),
        ("--eccentricity-a-at-deg", arguments.eccentricity_a_at_deg, f64::NEG_INFINITY),
        ("--eccentricity-b-um", arguments.eccentricity_b_um, 0.0),
        ("--eccentricity-b-at-deg", arguments.eccentricity_b_at_deg, f64::NEG_INFINITY),
        ("--parallelism-in-plane-um", arguments.parallelism_in_plane_um, f64::NEG_INFINITY),
        ("--parallelism-out-of-plane-um", arguments.parallelism_out_of_plane_um, f64::NEG_INFINITY),
        ("--marking-um", arguments.marking_um, f64::MIN_POSITIVE),
    ];
    if let Some((name, value, least)) =
        finite.into_iter().find(|(_, value, least)| !(value.is_finite() && value >= least))
    {
        let allowed = if least > 0.0 {
            "a number above 0"
        } else if least == 0.0 {
            "0 or more"
        } else {
            "a finite number"
        };
        return Err(
            gearcut_core::Refusal::new(name, format!("{value} is not {allowed}"), format!("give {allowed}")).into()
        );
    }
    Ok(PairOptions {
        source: match arguments.flanks {
            FlankChoice::Cut => FlankSource::Cut,
            FlankChoice::Nominal => FlankSource::Nominal,
        },
        positions: arguments.positions.map(|count| count as usize),
        sections: arguments.sections.map(|count| count as usize),
        center_distance_mm: arguments.center_distance_mm,
        center_distance_error_um: arguments.center_distance_error_um,
        eccentricity_um_deg: [
            [arguments.eccentricity_a_um, arguments.eccentricity_a_at_deg],
            [arguments.eccentricity_b_um, arguments.eccentricity_b_at_deg],
        ],
        phase_teeth: arguments.phase_teeth,
        parallelism_um: [arguments.parallelism_in_plane_um, arguments.parallelism_out_of_plane_um],
        marking_um: arguments.marking_um,
    })
}
