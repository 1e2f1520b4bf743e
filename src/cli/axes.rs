//! `gearcut axes`: axis tables and charts of every operation, nothing cut.

use std::path::PathBuf;

use gearcut::axes_report::{self, HobbingAxesReport, OperationAxes};
use gearcut::gcode;
use gearcut::job::Prepared;
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
    let prepared = Prepared::new(&scene.scene).map_err(|error| Failure::of_scene(&scene, error))?;
    let mut sheet = Sheet::default();
    let warnings: Vec<String> = match &prepared {
        Prepared::Shaping(job) => {
            axes_report::write(job, &output)?;
            let operations = OperationAxes::of_job(job);
            for operation in &operations {
                operation.print(&mut sheet);
            }
            let left_out = gcode::write_all(job, &output)?;
            operations.iter().flat_map(OperationAxes::warnings).chain(left_out).collect()
        }
        Prepared::Hobbing(job) => {
            let operations = HobbingAxesReport::of_job(job);
            for operation in &operations {
                operation.write(job, &output)?;
                operation.print(&mut sheet);
            }
            let left_out = gcode::hobbing::write_all(job, &output)?;
            operations.iter().flat_map(HobbingAxesReport::warnings).chain(left_out).collect()
        }
    };
    let path = folder::finish(output, "axes", [("scene", json!(scene.resolved_toml()))])?;
    let written = format!("\ntables, charts and programs are in {}\n", path.join("axes").display());
    print::to_stdout(&(sheet.into_text() + &written))?;
    print::warnings(&warnings);
    Ok(())
}
