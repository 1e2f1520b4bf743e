//! Rays in space with all that is cut from them: a job for a backend.
//!
//! In: fields, the passes of a turning tool that run over each, operation by operation. Out: what every operation
//! leaves. A backend plans the passes as its kernels want them, so that a device may keep the dexels from the first
//! operation to the last, and take many fields at a time.

use super::{Backend, CutLayers, CutStats};
use crate::dexel::{Layer, SpatialField};
use crate::error::Error;
use crate::passes::{SweepPlan, TurningPasses};
use std::sync::{Mutex, PoisonError};

/// Which passes are looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SweptBy {
    /// Those that may leave the lowest surface ([`SweepPlan::new`]).
    Candidates,
    /// Natively all that come near, column by column ([`SweepPlan::of_passes_near_column`]): for columns so far apart
    /// that a search over them all finds little. A device takes candidates here as well: composing a record costs more
    /// than finding out that it is none.
    NearPasses,
}

/// Rays in space with the passes that run over them in turn, from the uncut blank on.
#[derive(Debug, Clone)]
pub struct SweptField<'a> {
    /// Rays.
    pub field: SpatialField,
    /// Passes of every operation, set after set.
    pub operations: Vec<Vec<&'a TurningPasses>>,
    /// Which of them are looked at.
    pub by: SweptBy,
}

/// Makes the field of an index when its turn comes; `None`: it is left out.
pub type MakeSwept<'a, 'p> = dyn Fn(usize) -> Result<Option<SweptField<'p>>, Error> + Sync + 'a;

/// Takes the field of an index with what is left on it.
pub type TakeSwept<'a, 'p> = dyn Fn(usize, SweptField<'p>, CutLayers) -> Result<(), Error> + Sync + 'a;

impl SweptBy {
    /// Plans of the native kernel, one after the other.
    pub fn plans<'a>(
        self,
        field: &'a SpatialField,
        set: &'a TurningPasses,
    ) -> Box<dyn Iterator<Item = SweepPlan> + 'a> {
        match self {
            Self::Candidates => Box::new(std::iter::once_with(|| SweepPlan::new(field, set))),
            Self::NearPasses => {
                let columns = 0..field.columns();
                Box::new(columns.map(|column| SweepPlan::of_passes_near_column(field, column, set)))
            }
        }
    }
}

impl<'p> SweptField<'p> {
    /// Runs the passes of all operations, set by set and plan by plan, as `plans` plans them.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_in_turn<P: IntoIterator<Item = SweepPlan>>(
        &self,
        backend: &(impl Backend + ?Sized),
        plans: impl Fn(&'p TurningPasses) -> P,
    ) -> Result<CutLayers, Error> {
        let field = &self.field;
        let mut layers: Vec<Layer> = Vec::with_capacity(self.operations.len());
        let mut stats = CutStats::default();
        for sets in &self.operations {
            let mut layer = layers.last().cloned().unwrap_or_else(|| field.blank_layer());
            for set in sets {
                for plan in plans(set) {
                    stats += backend.cut_spatial(field, &plan, &mut layer)?;
                }
            }
            layers.push(layer);
        }
        // Plans may be those of parts.
        stats.dexels = (field.len() * self.operations.iter().map(Vec::len).sum::<usize>()) as u64;
        Ok(CutLayers { layers, figures: None, stats })
    }

    /// Cuts this field alone.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut(self, backend: &dyn Backend) -> Result<CutLayers, Error> {
        let (given, done) = (Mutex::new(Some(self)), Mutex::new(CutLayers::default()));
        let make = |_| Ok(given.lock().unwrap_or_else(PoisonError::into_inner).take());
        let take = |_, _, left| {
            *done.lock().unwrap_or_else(PoisonError::into_inner) = left;
            Ok(())
        };
        backend.cut_swept(1, &make, &take)?;
        Ok(done.into_inner().unwrap_or_else(PoisonError::into_inner))
    }
}
