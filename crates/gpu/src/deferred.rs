//! Flanks on a device for those who may not wait: the page in a browser.
//!
//! In: a job that cuts flanks on a [`Deferred`], twice. Out: the first time, every field goes to a list instead of the
//! device, and the cut ends with [`Error::Interrupted`]; [`Deferred::settle`], a future, sends the list and brings back
//! what is left; the second time the fields come again in their order and find it. What does not fit the device, and
//! what is no flank, is cut natively at once.
//!
//! Road not taken: a backend whose calls are futures. Every process, measure and map between a job and its backend
//! would be one, for the page alone; a flank is made ready twice instead, which takes a few milliseconds.

use crate::context::Gpu;
use crate::in_flight::WholeField;
use crate::problem::GpuProblem;
use crate::readback::{Returned, Shipment};
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::cut::sweep_chips::SweepsCut;
use gearcut_core::cut::{
    Backend, BlankCut, BlankOperation, CutStats, MakeField, MakeSwept, PlannedField, SweptField, TakeField, TakeSwept,
};
use gearcut_core::dexel::{BlankField, Field, Layer, SpatialField};
use gearcut_core::error::Error;
use gearcut_core::passes::sections::swept_sections::SweptSections;
use gearcut_core::passes::{CutPlan, SweepPlan};
use std::any::Any;
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What goes to the device, of a field of any kind.
type AnyInputs = Box<dyn Any + Send + Sync>;

/// A field that waits for the device.
struct Waiting {
    inputs: AnyInputs,
    shipment: for<'a> fn(&'a AnyInputs, &'a Gpu) -> Option<Shipment<'a>>,
}

impl Waiting {
    fn of<F: WholeField>(inputs: F::Inputs) -> Self {
        fn shipment<'a, F: WholeField>(inputs: &'a AnyInputs, gpu: &'a Gpu) -> Option<Shipment<'a>> {
            inputs.downcast_ref::<F::Inputs>().map(|inputs| F::shipment(&[inputs], gpu))
        }
        Self { inputs: Box::new(inputs), shipment: shipment::<F> }
    }
}

#[derive(Default)]
struct Lists {
    /// None for a field that the device does not take.
    waiting: Vec<Option<Waiting>>,
    settled: VecDeque<Option<(AnyInputs, Returned)>>,
}

/// A backend that is asked twice, for one cut: the next one has a `Deferred` of its own.
#[derive(Clone)]
pub struct Deferred {
    gpu: Arc<Gpu>,
    native: Cpu,
    lists: Arc<Mutex<Lists>>,
}

impl Deferred {
    /// On a device.
    pub fn new(gpu: Arc<Gpu>) -> Self {
        Self { gpu, native: Cpu::default(), lists: Arc::default() }
    }

    fn lists(&self) -> MutexGuard<'_, Lists> {
        self.lists.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Cuts what waits, field by field.
    ///
    /// # Errors
    /// The device is lost, or refuses memory or a call.
    pub async fn settle(&self) -> Result<(), GpuProblem> {
        let waiting = std::mem::take(&mut self.lists().waiting);
        let mut settled = VecDeque::new();
        for waiting in waiting {
            let Some(Waiting { inputs, shipment }) = waiting else {
                settled.push_back(None);
                continue;
            };
            let mut left = Vec::new();
            if let Some(shipment) = shipment(&inputs, &self.gpu) {
                left = self.gpu.collect(self.gpu.send(&shipment).await?).await?;
            }
            settled.push_back(left.into_iter().next().map(|left| (inputs, left)));
        }
        self.lists().settled = settled;
        Ok(())
    }

    fn cut_once_or_twice<F: WholeField>(
        &self,
        count: usize,
        make: &(dyn Fn(usize) -> Result<Option<F>, Error> + Sync + '_),
        take: &(dyn Fn(usize, F, gearcut_core::cut::CutLayers) -> Result<(), Error> + Sync + '_),
    ) -> Result<(), Error> {
        let mut deferred = false;
        for index in 0..count {
            let Some(field) = make(index)? else { continue };
            let settled = self.lists().settled.pop_front();
            let left = match settled {
                Some(Some((inputs, left))) => match inputs.downcast::<F::Inputs>() {
                    Ok(inputs) => field.layers(*inputs, left),
                    // Another job's field: cuts of two jobs are mixed up.
                    Err(_) => return Err(Error::Interrupted),
                },
                Some(None) => field.cut_natively(self.native)?,
                None => {
                    let waiting = field.compose(&self.gpu).map(Waiting::of::<F>);
                    self.lists().waiting.push(waiting);
                    deferred = true;
                    continue;
                }
            };
            take(index, field, left)?;
        }
        if deferred { Err(Error::Interrupted) } else { Ok(()) }
    }
}

impl Backend for Deferred {
    fn name(&self) -> String {
        self.gpu.name()
    }

    fn cut(&self, field: &Field, plan: &CutPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        self.native.cut(field, plan, layer)
    }

    fn cut_fields(&self, count: usize, make: &MakeField, take: &TakeField) -> Result<(), Error> {
        self.cut_once_or_twice::<PlannedField>(count, make, take)
    }

    fn cut_blank(
        &self,
        field: &mut BlankField,
        operation: &BlankOperation,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<BlankCut>, Error> {
        self.native.cut_blank(field, operation, advance)
    }

    fn cut_blank_sweeps(
        &self,
        field: &mut BlankField,
        sections: &SweptSections,
        passes: Range<u32>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<SweepsCut>, Error> {
        self.native.cut_blank_sweeps(field, sections, passes, advance)
    }

    fn cut_spatial(&self, field: &SpatialField, plan: &SweepPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        self.native.cut_spatial(field, plan, layer)
    }

    fn cut_swept<'p>(&self, count: usize, make: &MakeSwept<'_, 'p>, take: &TakeSwept<'_, 'p>) -> Result<(), Error> {
        self.cut_once_or_twice::<SweptField<'p>>(count, make, take)
    }
}
