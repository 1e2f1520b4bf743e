//! `gearcut check`: what a scene means, before anything is cut.
//!
//! One part per question: is this the pitch curve I meant, what does the cutter do to the teeth, can the machine follow, what
//! will the cut cost.

mod cost;
mod curve;
mod facts;
mod hobbing;
mod teeth;

use gearcut::axes_report::OperationAxes;
use gearcut::job::{Job, Prepared};
use gearcut::output::text::{Sheet, plain};
use gearcut::scene::{self, LoadedScene, model::Gear};

use facts::ToothFacts;

use super::args::SceneArguments;
use super::failure::Failure;
use super::print;

/// Runs the command.
pub fn run(arguments: &SceneArguments) -> Result<(), Failure> {
    let scene = scene::load(&arguments.scene, &arguments.settings)?;
    match Prepared::new(&scene.scene).map_err(|error| Failure::of_scene(&scene, error))? {
        Prepared::Shaping(job) => shaping(&scene, &job),
        Prepared::Hobbing(job) => hobbing::run(&scene, &job),
    }
}

fn shaping(scene: &LoadedScene, job: &Job) -> Result<(), Failure> {
    let facts = ToothFacts::of_job(job).map_err(|refusal| Failure::of_scene(scene, refusal.into()))?;
    let operations = OperationAxes::of_job(job);

    let mut sheet = Sheet::default();
    sheet.heading(&format!("{}: {}", job.scene.name, gear_words(&job.scene.gear)));
    curve::print(&mut sheet, &job.curve, &job.scene.gear, Some(job.cutter.pitch_radius_mm));
    teeth::print(&mut sheet, job, &facts);
    for operation in &operations {
        operation.print(&mut sheet);
    }
    cost::shaping::print(&mut sheet, job, &facts).map_err(|refusal| Failure::of_scene(scene, refusal.into()))?;
    let mut warnings = curve::warnings(&job.curve, &job.scene.gear);
    warnings.extend(teeth::warnings(job, &facts));
    warnings.extend(operations.iter().flat_map(OperationAxes::warnings));
    print::to_stdout(&sheet.into_text())?;
    print::warnings(&warnings);
    Ok(())
}

fn gear_words(gear: &Gear) -> String {
    let helix = match gear.helix_angle_rad {
        0.0 => String::new(),
        angle => format!(", helix angle {} deg {}-hand", plain(angle.to_degrees()), gear.hand.name()),
    };
    format!(
        "{} teeth, module {} mm, pressure angle {} deg{helix}, face width {} mm",
        gear.teeth,
        plain(gear.module_mm),
        plain(gear.pressure_angle_rad.to_degrees()),
        plain(gear.face_width_mm)
    )
}
