//! Shaping with a pinion cutter.

pub mod actual;
pub mod axes_report;
pub mod blank;
pub mod check;
mod chip_charts;
pub mod chips;
pub mod cutter;
pub mod edge_polygon;
pub mod findings;
pub mod gcode;
pub mod gear;
pub mod generation;
pub mod job;
pub mod linkage;
pub mod measure;
pub mod programs;
mod report;
pub mod returns;
pub mod ring;
mod run;
pub mod scene;
pub mod section;
mod surfaces;
pub mod target;
pub mod tip_relief;
pub mod tooth_facts;
pub mod tooth_target;
pub mod warnings;

use super::{CutDone, Process};
use crate::findings::Warning;
use crate::interrupt::Interrupt;
use crate::job::GearJob;
use crate::output::folder::OutputFolder;
use crate::output::text::Sheet;
use crate::steps::{Tools, axes};
use axes_report::OperationAxes;
use gearcut_core::error::Result;

pub use cutter::ShaperCutter;
pub use gear::{CutGear, cut_gear};
pub use job::{PreparedOperation, ShapingJob};

/// The process.
pub static PROCESS: Process =
    Process { scene: &scene::SCENE, prepare: |scene| Ok(Box::new(ShapingJob::new(scene.clone())?)) };

impl super::ProcessJob for ShapingJob {
    fn cut(&self, tools: &Tools, frames: Option<u32>) -> Result<CutDone> {
        run::run(self, tools, frames)
    }

    fn check(&self, sheet: &mut Sheet) -> Result<Vec<Warning>> {
        check::print(sheet, self)
    }

    fn with_gear(&self, visit: &mut dyn FnMut(&dyn GearJob) -> Result<()>) -> Result<()> {
        visit(self)
    }

    fn axes(&self, folder: &OutputFolder, interrupt: &Interrupt, sheet: &mut Sheet) -> Result<Vec<Warning>> {
        let motion = OperationAxes::of_job(self);
        let warnings = warnings::before(self, &motion, findings::ring::of_job(self).as_ref())?;
        axes::command(&motion, warnings, folder, interrupt, sheet)
    }
}
