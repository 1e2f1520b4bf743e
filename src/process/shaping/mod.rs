//! Shaping with a pinion cutter.

pub mod axes_report;
pub mod blank;
pub mod check;
pub mod chips;
pub mod cutter;
pub mod findings;
pub mod gcode;
pub mod generation;
pub mod job;
pub mod linkage;
pub mod measure;
mod report;
pub mod run;
pub mod scene;
pub mod section;
mod surfaces;
pub mod target;

use super::{CutDone, Process};
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::output::folder::OutputFolder;
use crate::output::text::Sheet;
use crate::steps::Tools;
use axes_report::OperationAxes;

pub use cutter::ShaperCutter;
pub use job::{CutFlank, Job, PreparedOperation};
pub use run::{CutGear, cut_gear};

/// The process.
pub static PROCESS: Process = Process { scene: &scene::SCENE, prepare: |scene| Ok(Box::new(Job::new(scene.clone())?)) };

impl super::Job for Job {
    fn cut(&self, tools: &Tools, frames: Option<u32>) -> Result<CutDone> {
        run::run(self, tools, frames)
    }

    fn check(&self, sheet: &mut Sheet) -> Result<Vec<String>> {
        check::print(sheet, self)
    }

    fn axes(&self, folder: &OutputFolder, interrupt: &Interrupt, sheet: &mut Sheet) -> Result<Vec<String>> {
        axes_report::write(self, folder)?;
        let operations = OperationAxes::of_job(self);
        for operation in &operations {
            operation.print(sheet);
        }
        interrupt.check()?;
        let left_out = gcode::write_all(self, folder)?;
        Ok(operations.iter().flat_map(OperationAxes::warnings).chain(left_out).collect())
    }
}
