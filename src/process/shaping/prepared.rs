//! A shaping scene as the commands know it: checked and moved as commanded, cut as the machine yields.
//!
//! In: the job of a rigid machine. Out: what commands ask of a process. Where the machine has compliance, the first
//! command that cuts finds the deflections of all strokes, and how they vibrate; the gear that follows from them is
//! kept.

use super::axes_report::OperationAxes;
use crate::findings::Notice;
use crate::interrupt::Interrupt;
use crate::job::GearJob;
use crate::output::folder::OutputFolder;
use crate::output::text::Sheet;
use crate::process::shaping::cut::chips::as_cut;
use crate::process::shaping::cut::section::CutSection;
use crate::process::shaping::findings::foreseen::foresee;
use crate::process::shaping::findings::{ring, warnings};
use crate::process::shaping::{ShapingJob, check, run};
use crate::process::{CutDone, ProcessJob};
use crate::scene::Scene;
use crate::steps::parts::Stages;
use crate::steps::{Tools, axes};
use gearcut_core::error::{Error, Result};
use std::sync::OnceLock;

/// The job of a scene, and the same with its strokes displaced.
pub(super) struct PreparedShaping {
    rigid: ShapingJob,
    /// Boxed: a job is large, and most scenes have no second one.
    yielding: OnceLock<Box<ShapingJob>>,
}

impl PreparedShaping {
    pub(super) fn new(rigid: ShapingJob) -> Self {
        Self { rigid, yielding: OnceLock::new() }
    }

    /// The gear as it is cut; `advance` is called after every stroke and says whether to go on.
    fn cut_gear(&self, advance: &(dyn Fn() -> bool + Sync)) -> Result<&ShapingJob> {
        if self.rigid.machine.compliance.is_none() {
            return Ok(&self.rigid);
        }
        if let Some(job) = self.yielding.get() {
            return Ok(job);
        }
        let found = as_cut(&self.rigid, advance)?.ok_or(Error::Interrupted)?;
        Ok(self.yielding.get_or_init(|| Box::new(found)))
    }
}

impl ProcessJob for PreparedShaping {
    fn cut(&self, tools: &Tools, frames: Option<u32>) -> Result<CutDone> {
        let machine = &self.rigid.machine;
        let times = if machine.compliance.is_none() { 0 } else { 1 + usize::from(machine.vibration.is_some()) };
        let count = times * CutSection::strokes(&self.rigid);
        let step = (count > 0).then(|| tools.progress.step("deflection", count as u64, "strokes"));
        let job = self.cut_gear(&|| {
            if let Some(step) = &step {
                step.advance(1);
            }
            !tools.interrupt.is_raised()
        })?;
        if let Some(step) = step {
            step.finish();
        }
        run::run(job, tools, frames)
    }

    fn check(&self, sheet: &mut Sheet) -> Result<Vec<Notice>> {
        check::print(sheet, &self.rigid)
    }

    fn foreseen(&self) -> Result<Vec<Notice>> {
        let motion = OperationAxes::of_job(&self.rigid);
        let ring = ring::of_job(&self.rigid, &motion);
        Ok(foresee(&self.rigid, &motion, ring.as_ref(), Stages::ALL)?.warnings)
    }

    fn foreseen_of_shapes(&self) -> Result<Vec<Notice>> {
        Ok(warnings::of_shapes(&self.rigid, &OperationAxes::of_job(&self.rigid)))
    }

    fn axis_charts(&self) -> Result<Vec<(String, String)>> {
        axes::svg_charts(&OperationAxes::of_job(&self.rigid))
    }

    fn with_gear(&self, visit: &mut dyn FnMut(&dyn GearJob) -> Result<()>) -> Result<()> {
        visit(self.cut_gear(&|| true)?)
    }

    fn with_errors_of(&self, scene: &Scene) -> Result<Box<dyn ProcessJob>> {
        Ok(Box::new(Self::new(self.rigid.sharing_targets(scene.clone())?)))
    }

    fn axes(&self, folder: &OutputFolder, interrupt: &Interrupt, sheet: &mut Sheet) -> Result<Vec<Notice>> {
        let motion = OperationAxes::of_job(&self.rigid);
        let ring = ring::of_job(&self.rigid, &motion);
        let foreseen = foresee(&self.rigid, &motion, ring.as_ref(), Stages::ALL)?;
        axes::command(&motion, foreseen.warnings, folder, interrupt, sheet)
    }
}
