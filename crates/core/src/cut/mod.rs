//! Backends: subtract the passes of a plan from a field of dexels.
//!
//! One law, several machines: [`cpu::Cpu`] (f64, vectorised at run time) always works, the GPU backend (f32 in local
//! frames, within nanometres) runs on any Vulkan, Metal or DirectX 12 adapter; the program takes one of them. A backend
//! reads a plan's records with the edge tables that they name and lowers the heights of a [`Layer`]; among passes that
//! leave the same height the lowest id wins, so the result does not depend on any order of work.

pub mod blank;
mod by_stage;
pub mod cpu;
pub mod sweep_chips;
pub mod swept;

use crate::dexel::figures::{FieldFigures, LinesAt};
use crate::dexel::{BlankField, Field, Layer, SpatialField};
use crate::error::Error;
use crate::passes::sections::swept_sections::SweptSections;
use crate::passes::{CutPlan, SweepPlan};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::OnceLock;
use sweep_chips::SweepsCut;

pub use blank::{BlankCut, BlankOperation, BlankStats, CutBlank, Rub, WatchCuts};
pub use by_stage::ByStage;
pub use swept::{MakeSwept, SweptBy, SweptField, TakeSwept};

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

/// A field with the plans that run over it in turn, from the uncut blank on.
#[derive(Debug, Clone)]
pub struct PlannedField {
    /// Rays.
    pub field: Field,
    /// Plans in order, one for each operation.
    pub plans: Vec<CutPlan>,
    /// Lines whose dexels are wanted beside figures of the columns; `None`: all dexels are wanted.
    pub lines: Option<LinesAt>,
}

/// What is left on a field.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CutLayers {
    /// What each plan left, in order; empty where figures are given instead.
    pub layers: Vec<Layer>,
    /// Figures of the columns, if these are enough and the dexels stay where they are.
    pub figures: Option<FieldFigures>,
    /// What was met.
    pub stats: CutStats,
}

/// Makes the field of an index when its turn comes; `None`: it is left out.
pub type MakeField<'a> = dyn Fn(usize) -> Result<Option<PlannedField>, Error> + Sync + 'a;

/// Takes the field of an index with what is left on it.
pub type TakeField<'a> = dyn Fn(usize, PlannedField, CutLayers) -> Result<(), Error> + Sync + 'a;

/// Runs the plans of a field one by one; `and_then` changes what each of them leaves before the next one.
///
/// # Errors
/// The backend's.
pub fn cut_in_turn(
    backend: &(impl Backend + ?Sized),
    planned: &PlannedField,
    and_then: impl Fn(usize, &mut Layer),
) -> Result<CutLayers, Error> {
    let PlannedField { field, plans, .. } = planned;
    let mut layers: Vec<Layer> = Vec::with_capacity(plans.len());
    let mut stats = CutStats::default();
    for plan in plans {
        let mut layer = layers.last().cloned().unwrap_or_else(|| field.blank_layer());
        stats += backend.cut(field, plan, &mut layer)?;
        and_then(layers.len(), &mut layer);
        layers.push(layer);
    }
    Ok(CutLayers { layers, figures: None, stats })
}

/// Cuts one field.
///
/// # Errors
/// The backend's.
pub fn cut_alone(backend: &dyn Backend, planned: &PlannedField) -> Result<CutLayers, Error> {
    let done = OnceLock::new();
    let take = |_, _, left| {
        let _is_first = done.set(left);
        Ok(())
    };
    backend.cut_fields(1, &|_| Ok(Some(planned.clone())), &take)?;
    Ok(done.into_inner().unwrap_or_default())
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

    /// Runs the plans of so many fields, each from its uncut blank. Several fields are on their way at once: `make` and
    /// `take` are called from several threads, each once for every field. The first failure ends it.
    ///
    /// # Errors
    /// As [`Self::cut`]; those of `make` and `take`.
    fn cut_fields(&self, count: usize, make: &MakeField, take: &TakeField) -> Result<(), Error> {
        (0..count).into_par_iter().try_for_each(|index| match make(index)? {
            Some(planned) => {
                let left = cut_in_turn(self, &planned, |_, _| ())?;
                take(index, planned, left)
            }
            None => Ok(()),
        })
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

    /// Cuts so many fields of rays in space, as [`Self::cut_fields`] does.
    ///
    /// # Errors
    /// As [`Self::cut`]; those of `make` and `take`.
    fn cut_swept<'p>(&self, count: usize, make: &MakeSwept<'_, 'p>, take: &TakeSwept<'_, 'p>) -> Result<(), Error> {
        (0..count).into_par_iter().try_for_each(|index| match make(index)? {
            Some(swept) => {
                let left = swept.cut_in_turn(self, |set| swept.by.plans(&swept.field, set))?;
                take(index, swept, left)
            }
            None => Ok(()),
        })
    }

    /// What went wrong so far and was made good: one line each, for the run record.
    fn incidents(&self) -> Vec<String> {
        Vec::new()
    }

    /// The device's own time, stage by stage, where it can tell.
    fn stage_times(&self) -> Vec<StageTime> {
        Vec::new()
    }
}
