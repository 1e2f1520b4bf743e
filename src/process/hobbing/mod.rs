//! Hobbing with five and six axes.

pub mod axes_report;
pub mod blank;
pub mod check;
pub mod cutter;
pub mod flank_patch;
pub mod gcode;
pub mod hob;
pub mod job;
pub mod linkage;
pub mod measure;
pub mod rack_generation;
pub mod rack_root;
mod report;
pub mod run;
pub mod scene;
mod surfaces;

use super::{CutDone, Process};
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::output::folder::OutputFolder;
use crate::output::text::Sheet;
use crate::steps::Tools;
use axes_report::HobbingAxesReport;

pub use blank::HobbedBlank;
pub use cutter::{HobCutter, HobbedFlank};
pub use hob::Hob;
pub use job::HobbingJob;

/// The process.
pub static PROCESS: Process = Process { scene: &scene::SCENE, prepare: |scene| Ok(Box::new(HobbingJob::new(scene)?)) };

impl super::Job for HobbingJob {
    fn cut(&self, tools: &Tools, frames: Option<u32>) -> Result<CutDone> {
        if frames.is_some() {
            tools.progress.note("no frames are drawn: pictures of the cut as it happens exist for shaping only");
        }
        run::run(self, tools)
    }

    fn check(&self, sheet: &mut Sheet) -> Result<Vec<String>> {
        check::print(sheet, self)
    }

    fn axes(&self, folder: &OutputFolder, interrupt: &Interrupt, sheet: &mut Sheet) -> Result<Vec<String>> {
        let operations = HobbingAxesReport::of_job(self);
        for operation in &operations {
            interrupt.check()?;
            operation.write(self, folder)?;
            operation.write_work_of_teeth(self, folder)?;
            operation.print(sheet);
        }
        interrupt.check()?;
        let left_out = gcode::write_all(self, folder)?;
        Ok(operations.iter().flat_map(HobbingAxesReport::warnings).chain(left_out).collect())
    }
}
