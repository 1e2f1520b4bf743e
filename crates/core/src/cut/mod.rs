//! Backends: subtract the passes of a plan from a field of dexels.
//!
//! One law, several machines: [`cpu::Cpu`] (f64, vectorised at run time) always works, the GPU backend (f32 in local
//! frames, within nanometres) runs on any Vulkan, Metal or DirectX 12 adapter; the program takes one of them. A backend
//! reads a plan's records with the edge tables that they name and lowers the heights of a [`Layer`]; among passes that
//! leave the same height the lowest id wins, so the result does not depend on any order of work.

pub mod blank;
pub mod cpu;
pub mod sweep_chips;

use crate::dexel::{BlankField, Field, Layer, SpatialField};
use crate::error::Error;
use crate::passes::sections::swept_sections::SweptSections;
use crate::passes::{CutPlan, SweepPlan};
use rayon::prelude::*;
use std::ops::Range;
use sweep_chips::SweepsCut;

pub use blank::{BlankCut, BlankOperation, BlankStats, CutBlank, Rub};

/// Heights below this are the kernels' own error and shown as zero, µm.
pub const KERNEL_UM: f64 = 1e-4;

/// Thinner than this an edge rubs and takes no chip, mm: it counts neither as engaged nor for forces. A tenth of a
/// micrometre is far below the radius of any cutting edge.
pub const LEAST_CHIP_MM: f64 = 1e-4;

/// What a backend met besides heights.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct CutStats {
    /// Dexels that were cut; fewer than there are where rows are alike and one of them was cut for all.
    pub dexels: u64,
    /// (Dexel, pass) pairs evaluated.
    pub dexel_passes: u64,
    /// Pairs whose ray meets the segment but whose root was not reached to a picometre; any at all makes the result
    /// untrustworthy.
    pub unconverged: u64,
}

impl std::ops::AddAssign for CutStats {
    fn add_assign(&mut self, other: Self) {
        self.dexels += other.dexels;
        self.dexel_passes += other.dexel_passes;
        self.unconverged += other.unconverged;
    }
}

/// Time that a device spent on one stage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageTime {
    /// Name of the stage: the shader's.
    pub stage: &'static str,
    /// Batches sent.
    pub batches: u64,
    /// Time between the first and the last of its threads, summed over launches, s.
    pub device_s: f64,
}

/// A field with the plans that run over it in turn.
#[derive(Debug, Clone, Copy)]
pub struct CutJob<'a> {
    /// Rays.
    pub field: &'a Field,
    /// What is left on them before; `None`: they are uncut.
    pub start: Option<&'a Layer>,
    /// Plans in order.
    pub plans: &'a [CutPlan],
}

/// What each plan of a job leaves, with what was met.
pub type CutLayers = Vec<(Layer, CutStats)>;

/// Runs the plans of every job one by one.
///
/// # Errors
/// The backend's.
pub fn cut_in_turn(backend: &(impl Backend + ?Sized), jobs: &[CutJob]) -> Result<Vec<CutLayers>, Error> {
    let in_turn = |job: &CutJob| {
        let mut layer = job.start.cloned().unwrap_or_else(|| job.field.blank_layer());
        let each = |plan| backend.cut(job.field, plan, &mut layer).map(|stats| (layer.clone(), stats));
        job.plans.iter().map(each).collect()
    };
    jobs.par_iter().map(in_turn).collect()
}

/// A machine that cuts.
pub trait Backend: Send + Sync {
    /// Name for the run record, with the instruction set or adapter.
    fn name(&self) -> String;

    /// Name for the heads of files: the same wherever the bytes are the same.
    fn name_in_files(&self) -> String {
        self.name()
    }

    /// Runs all records of `plan` over `field`, lowering `layer`.
    ///
    /// # Errors
    /// Whatever keeps the backend from finishing; the layer is then unusable.
    fn cut(&self, field: &Field, plan: &CutPlan, layer: &mut Layer) -> Result<CutStats, Error>;

    /// Runs the plans of every job in turn, each from what the one before has left.
    ///
    /// # Errors
    /// As [`Self::cut`].
    fn cut_jobs(&self, jobs: &[CutJob]) -> Result<Vec<CutLayers>, Error> {
        cut_in_turn(self, jobs)
    }

    /// Takes all strokes of an operation from the blank and checks its return strokes; `advance` is called after every
    /// tile and says whether to go on. `None`: stopped, the field is then as it was or partly cut.
    ///
    /// # Errors
    /// As [`Self::cut`].
    fn cut_blank(
        &self,
        field: &mut BlankField,
        operation: &BlankOperation,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<BlankCut>, Error>;

    /// Takes all sweeps of an operation with a turning tool, whose passes have the ids `passes`, from the blank;
    /// `advance` is called as often as the field has slices and says whether to go on. `None`: stopped, the field is
    /// then as it was or partly cut.
    ///
    /// # Errors
    /// As [`Self::cut`].
    fn cut_blank_sweeps(
        &self,
        field: &mut BlankField,
        sections: &SweptSections,
        passes: Range<u32>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<SweepsCut>, Error>;

    /// Runs all records of a plan of sweeps over a field of rays in space, lowering `layer`.
    ///
    /// # Errors
    /// As [`Self::cut`].
    fn cut_spatial(&self, field: &SpatialField, plan: &SweepPlan, layer: &mut Layer) -> Result<CutStats, Error>;

    /// What went wrong so far and was made good: one line each, for the run record.
    fn incidents(&self) -> Vec<String> {
        Vec::new()
    }

    /// The device's own time, stage by stage, where it can tell.
    fn stage_times(&self) -> Vec<StageTime> {
        Vec::new()
    }
}
