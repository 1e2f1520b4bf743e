//! Spiral bevel gears cut with a face-mill head on a machine that generates them, or plunges the head into each slot.
//!
//! The physics is that of [`gearcut_core::bevel`]: blank, head, machines, the flank that they generate. Here are
//! scenes, the passes of the head's blades over all slots, flank fields, measures, files and the page.

mod actual;
pub mod axes_report;
pub mod axis_program;
pub mod blank;
pub mod body;
mod check;
pub mod chips;
pub mod course;
pub mod drawing;
mod entry;
mod faults;
pub mod findings;
pub mod gcode;
pub mod gear;
pub mod hits;
pub mod job;
pub mod measure;
pub mod motion;
pub mod net;
pub(crate) mod notices;
pub mod operation;
pub mod pair;
pub mod quantities;
mod report;
mod run;
pub mod scene;
mod settings;
pub mod slot_frames;
pub mod slots;
mod stage_costs;
mod surfaces;

use super::{CutDone, Process};
use crate::findings::Notice;
use crate::interrupt::Interrupt;
use crate::job::GearJob;
use crate::output::folder::OutputFolder;
use crate::output::text::Sheet;
use crate::steps::parts::Stages;
use crate::steps::{Tools, axes};
use axes_report::BevelAxesReport;
use gearcut_core::error::Result;

pub use job::BevelJob;

/// The process.
pub static PROCESS: Process = Process {
    scene: &scene::SCENE,
    notices: notices::NOTICES,
    quantities: quantities::QUANTITIES,
    prepare: |scene| Ok(Box::new(BevelJob::new(scene)?)),
    axis_peaks: |scene| Ok(axes::found(scene, &BevelAxesReport::of_job(&BevelJob::new(scene)?))),
};

impl super::ProcessJob for BevelJob {
    fn cut(&self, tools: &Tools, frames: Option<u32>) -> Result<CutDone> {
        run::run(self, tools, frames)
    }

    fn check(&self, sheet: &mut Sheet) -> Result<Vec<Notice>> {
        check::print(sheet, self)
    }

    fn foreseen(&self) -> Result<Vec<Notice>> {
        Ok(findings::foresee(self, &BevelAxesReport::of_job(self), Stages::ALL)?.warnings)
    }

    fn foreseen_of_shapes(&self) -> Result<Vec<Notice>> {
        self.foreseen()
    }

    fn axis_charts(&self) -> Result<Vec<(String, String)>> {
        axes::svg_charts(&BevelAxesReport::of_job(self))
    }

    fn with_gear(&self, visit: &mut dyn FnMut(&dyn GearJob) -> Result<()>) -> Result<()> {
        visit(self)
    }

    fn axes(&self, folder: &OutputFolder, interrupt: &Interrupt, sheet: &mut Sheet) -> Result<Vec<Notice>> {
        let motion = BevelAxesReport::of_job(self);
        axes::command(&motion, findings::foresee(self, &motion, Stages::ALL)?.warnings, folder, interrupt, sheet)
    }
}
