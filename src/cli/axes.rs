//! `gearcut axes`: axis tables and charts of every operation, nothing cut.

use std::path::PathBuf;

use gearcut::axes_report::{self, OperationAxes};
use gearcut::gcode;
use gearcut::job::Job;
use gearcut::output::text::Sheet;
use gearcut::scene;
use serde_json::json;

use super::args::AxesArguments;
use super::failure::Failure;
use super::{folder, print};

/// Runs the command.
pub fn run(arguments: &AxesArguments) -> Result<(), Failure> {
    let scene = scene::load(&arguments.scene.scene, &arguments.scene.settings)?;
    let default = || PathBuf::from("out").join(format!("{}_axes", scene.scene.name));
    let out = arguments.out.clone().unwrap_or_else(default);
    let output = folder::open(&out, "axes")?;
    let job = Job::new(scene.scene.clone()).map_err(|error| Failure::of_scene(&scene, error))?;
    axes_report::write(&job, &output)?;
    let left_out = gcode::write_all(&job, &output)?;
    let path = folder::finish(output, "axes", [("scene", json!(scene.resolved_toml()))])?;

    let operations = OperationAxes::of_job(&job);
    let mut sheet = Sheet::default();
    for operation in &operations {
        operation.print(&mut sheet);
    }
    let written = format!("\ntables, charts and programs are in {}\n", path.join("axes").display());
    print::to_stdout(&(sheet.into_text() + &written))?;
    print::warnings(&operations.iter().flat_map(OperationAxes::warnings).chain(left_out).collect::<Vec<_>>());
    Ok(())
}
