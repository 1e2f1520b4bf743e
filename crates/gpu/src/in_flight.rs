//! Fields that the device takes whole: made ready some at a time, sent together, taken back while the next are made.
//!
//! In: fields by their index. Out: what is left on each. Dexels of a field stay on the device through all that is cut
//! from it, and several fields share a submission. Two submissions are on their way while the next is made ready. A
//! field that does not fit the device goes plan by plan in batches.

use crate::batches::Allowance;
use crate::context::{Gpu, IN_FLIGHT, OnGpuFailure};
use crate::problem::GpuProblem;
use crate::readback::{self, Arrived, InFlight, Returned, Shipment};
use crate::waiting::wait;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::cut::{Backend, CutLayers};
use gearcut_core::error::Error;
use rayon::prelude::*;
use std::collections::VecDeque;
use std::ops::Range;

/// Fields that are made ready together at first: enough that waiting for them costs little.
const FIELDS_AT_ONCE: usize = 12;
/// Twice as many next time where they take less than this together, bytes: the device is sent enough to work on, and
/// there is still a next time.
const FEW_BYTES: u64 = 24 << 20;
/// Bytes that a submission of some fields keeps on the device at most.
const SUBMISSION_BYTES: u64 = 256 << 20;

/// A field that may go to the device whole.
pub(crate) trait WholeField: Send + Sized {
    /// What goes there.
    type Inputs: Send + Sync + 'static;

    /// What goes to the device; nothing if it does not fit.
    fn compose(&self, gpu: &Gpu) -> Option<Self::Inputs>;

    /// Bytes on the device: of all buffers, and of the largest.
    fn bytes(inputs: &Self::Inputs) -> [u64; 2];

    /// Some fields together.
    fn shipment<'a>(fields: &[&'a Self::Inputs], gpu: &'a Gpu) -> Shipment<'a>;

    /// What is left of it.
    fn layers(&self, inputs: Self::Inputs, left: Returned) -> CutLayers;

    /// Cuts it plan by plan, in batches.
    fn cut_in_batches(&self, gpu: &Gpu) -> Result<CutLayers, Error>;

    /// Cuts it natively.
    fn cut_natively(&self, native: Cpu) -> Result<CutLayers, Error>;
}

/// Makes the field of an index; `None`: it is left out.
type Make<'a, F> = dyn Fn(usize) -> Result<Option<F>, Error> + Sync + 'a;
/// Takes the field of an index with what is left on it.
type Take<'a, F> = dyn Fn(usize, F, CutLayers) -> Result<(), Error> + Sync + 'a;

/// A field that is made ready, with its index.
struct Ready<F: WholeField> {
    index: usize,
    field: F,
    inputs: F::Inputs,
}

/// Fields that are on their way together.
struct Sent<F: WholeField> {
    fields: Vec<Ready<F>>,
    in_flight: Result<InFlight, GpuProblem>,
}

impl Gpu {
    /// Cuts fields as a backend does: while some are on the device, the next ones are made ready, and what is left of
    /// those before is taken.
    pub(crate) fn cut_in_flight<F: WholeField>(
        &self,
        count: usize,
        make: &Make<F>,
        take: &Take<F>,
    ) -> Result<(), Error> {
        let mut waiting: VecDeque<Sent<F>> = VecDeque::new();
        let (mut next, mut at_once) = (0, FIELDS_AT_ONCE);
        while next < count {
            let some = next..count.min(next + at_once);
            next = some.end;
            let oldest = if waiting.len() == IN_FLIGHT { waiting.pop_front() } else { None };
            let take_oldest = || oldest.map_or(Ok(()), |sent| self.take_fields(sent, take));
            let (made, taken) = rayon::join(|| self.make_some(some, make, take), take_oldest);
            taken?;
            let fields = made?;
            if fields.iter().map(|field| F::bytes(&field.inputs)[0]).sum::<u64>() < FEW_BYTES {
                at_once *= 2;
            }
            let Allowance { buffer_bytes, batch_bytes } = self.allowance();
            for fields in groups(fields, [SUBMISSION_BYTES.min(batch_bytes), buffer_bytes]) {
                if waiting.len() == IN_FLIGHT {
                    waiting.pop_front().map_or(Ok(()), |sent| self.take_fields(sent, take))?;
                }
                let in_flight = self.send_fields(&fields);
                waiting.push_back(Sent { fields, in_flight });
            }
        }
        waiting.into_iter().try_for_each(|sent| self.take_fields(sent, take))
    }

    /// Makes the fields of some indices ready; those that do not fit the device are cut and taken.
    fn make_some<F: WholeField>(
        &self,
        some: Range<usize>,
        make: &Make<F>,
        take: &Take<F>,
    ) -> Result<Vec<Ready<F>>, Error> {
        let ready = |index: usize| -> Result<Option<Ready<F>>, Error> {
            let Some(field) = make(index)? else { return Ok(None) };
            if let Some(inputs) = field.compose(self) {
                return Ok(Some(Ready { index, field, inputs }));
            }
            let left = field.cut_in_batches(self)?;
            take(index, field, left).map(|()| None)
        };
        let made: Vec<Option<Ready<F>>> = some.into_par_iter().map(ready).collect::<Result<_, Error>>()?;
        Ok(made.into_iter().flatten().collect())
    }

    fn send_fields<F: WholeField>(&self, fields: &[Ready<F>]) -> Result<InFlight, GpuProblem> {
        let inputs: Vec<&F::Inputs> = fields.iter().map(|field| &field.inputs).collect();
        wait(self.send(&F::shipment(&inputs, self)))
    }

    /// Sends a submission.
    pub(crate) async fn send(&self, shipment: &Shipment<'_>) -> Result<InFlight, GpuProblem> {
        self.device.alive()?;
        readback::send(&self.device, shipment, self.options.poison_outputs).await
    }

    /// Waits for a submission: what is left of its fields.
    pub(crate) async fn collect(&self, in_flight: InFlight) -> Result<Vec<Returned>, GpuProblem> {
        let Arrived { stage, fields, device_ns } = in_flight.collect(&self.device).await?;
        self.log().count(stage, device_ns);
        Ok(fields)
    }

    /// Waits for fields; cuts them natively if that is what a failure asks for.
    fn take_fields<F: WholeField>(&self, sent: Sent<F>, take: &Take<F>) -> Result<(), Error> {
        let Sent { fields, in_flight } = sent;
        match in_flight.and_then(|in_flight| wait(self.collect(in_flight))) {
            Ok(left) => {
                let fields = fields.into_par_iter().zip(left);
                fields.try_for_each(|(Ready { index, field, inputs }, left)| {
                    let left = field.layers(inputs, left);
                    take(index, field, left)
                })
            }
            Err(problem) if self.options.on_failure == OnGpuFailure::Stop => Err(problem.into()),
            Err(problem) => {
                self.log().incidents.push(format!("{problem}; cut again on {}", self.native.name()));
                fields.into_par_iter().try_for_each(|Ready { index, field, .. }| {
                    let left = field.cut_natively(self.native)?;
                    take(index, field, left)
                })
            }
        }
    }
}

/// Fields in runs that share a submission of at most so many bytes, in all buffers and in the largest, or of one field.
fn groups<F: WholeField>(fields: Vec<Ready<F>>, most: [u64; 2]) -> Vec<Vec<Ready<F>>> {
    let (mut groups, mut all, mut largest): (Vec<Vec<Ready<F>>>, u64, u64) = (Vec::new(), 0, 0);
    for field in fields {
        let own = F::bytes(&field.inputs);
        [all, largest] = [all + own[0], largest + own[1]];
        match groups.last_mut().filter(|_| all <= most[0] && largest <= most[1]) {
            Some(group) => group.push(field),
            None => {
                groups.push(vec![field]);
                [all, largest] = own;
            }
        }
    }
    groups
}
