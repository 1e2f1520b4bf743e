//! Hobbing with five and six axes.

pub mod actual;
pub mod axes_report;
pub mod blank;
pub mod check;
pub mod commanded;
pub mod cut_section;
pub mod cutter;
pub mod drawn_rack;
pub mod flank_patch;
pub mod foreseen;
pub mod foreseen_chips;
pub mod gcode;
pub mod gear;
pub mod hob;
pub mod job;
mod kept;
pub mod linkage;
pub mod measure;
pub(crate) mod notices;
pub mod quantities;
pub mod rack_corner;
pub mod rack_generation;
pub mod rack_root;
pub mod report;
pub mod run;
pub mod scene;
mod stage_costs;
mod surfaces;
pub mod warnings;

use super::{CutDone, Process, ProcessJob};
use crate::findings::Notice;
use crate::interrupt::Interrupt;
use crate::job::GearJob;
use crate::output::folder::OutputFolder;
use crate::output::text::Sheet;
use crate::scene::Scene;
use crate::steps::parts::Stages;
use crate::steps::{Tools, axes};
use axes_report::HobbingAxesReport;
use gearcut_core::error::Result;

pub use blank::HobbedBlank;
pub use cutter::{HobCutter, HobbedFlank};
pub use gear::HobbedGear;
#[cfg(feature = "testing")]
pub use gear::cut_gear;
pub use hob::Hob;
pub use job::HobbingJob;

/// The process.
pub static PROCESS: Process = Process {
    scene: &scene::SCENE,
    notices: notices::NOTICES,
    quantities: quantities::QUANTITIES,
    prepare: |scene| Ok(Box::new(HobbingJob::new(scene)?)),
    axis_peaks: |scene| Ok(axes::found(scene, &HobbingAxesReport::of_job(&HobbingJob::new(scene)?))),
};

impl ProcessJob for HobbingJob {
    fn cut(&self, tools: &Tools, frames: Option<u32>) -> Result<CutDone> {
        run::run(self, tools, frames)
    }

    fn check(&self, sheet: &mut Sheet) -> Result<Vec<Notice>> {
        check::print(sheet, self)
    }

    fn foreseen(&self) -> Result<Vec<Notice>> {
        let motion = HobbingAxesReport::of_job(self);
        Ok(foreseen::foresee(&HobCutter::new(self)?, &motion, Stages::ALL)?.warnings)
    }

    fn foreseen_of_shapes(&self) -> Result<Vec<Notice>> {
        self.foreseen()
    }

    fn axis_charts(&self) -> Result<Vec<(String, String)>> {
        axes::svg_charts(&HobbingAxesReport::of_job(self))
    }

    fn with_gear(&self, visit: &mut dyn FnMut(&dyn GearJob) -> Result<()>) -> Result<()> {
        visit(&HobCutter::new(self)?)
    }

    fn with_errors_of(&self, scene: &Scene) -> Result<Box<dyn ProcessJob>> {
        Ok(Box::new(self.sharing_targets(scene)?))
    }

    fn axes(&self, folder: &OutputFolder, interrupt: &Interrupt, sheet: &mut Sheet) -> Result<Vec<Notice>> {
        let motion = HobbingAxesReport::of_job(self);
        let foreseen = foreseen::foresee(&HobCutter::new(self)?, &motion, Stages::ALL)?;
        axes::command(&motion, foreseen.warnings, folder, interrupt, sheet)
    }
}
