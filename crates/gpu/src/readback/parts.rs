//! What comes back of a submission, part after part.
//!
//! In: the fields of a submission. Out: parts in the order in which they are copied, and what they hold once they are
//! here.

use super::{Returned, Shipment, Wanted};
use crate::records::FigureColumn;
use gearcut_core::dexel::Layer;
use std::ops::Range;

/// Bytes of a height and of a pass.
pub const VALUE_BYTES: usize = 4;
/// Bytes of the counts of a field: iterations that stopped short, pairs that the device has counted.
pub const COUNT_BYTES: usize = 8;

/// What a part is copied from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum OutputBuffer {
    /// Heights of all fields.
    Heights,
    /// Passes of all fields.
    Passes,
    /// Figures of all fields that want them.
    Figures,
    /// Counts of every field.
    Counts,
}

/// Bytes of a field in a buffer that fields share.
pub struct ReturnedPart {
    field: usize,
    /// The buffer.
    pub source: OutputBuffer,
    /// Its bytes there.
    pub bytes: Range<usize>,
}

/// All parts of a submission; those of one source follow each other.
pub struct ReturnedParts {
    /// Dexels after every step.
    pub of_steps: Vec<Vec<ReturnedPart>>,
    /// Figures of every step.
    pub of_figures: Vec<Vec<ReturnedPart>>,
    /// What follows.
    pub at_the_end: Vec<ReturnedPart>,
}

/// Heights and passes of some dexels.
fn dexels(field: usize, dexels: Range<usize>) -> impl Iterator<Item = ReturnedPart> {
    let bytes = VALUE_BYTES * dexels.start..VALUE_BYTES * dexels.end;
    [OutputBuffer::Heights, OutputBuffer::Passes].into_iter().map(move |source| ReturnedPart {
        field,
        source,
        bytes: bytes.clone(),
    })
}

impl ReturnedParts {
    /// Those of a submission.
    pub fn of(shipment: &Shipment) -> Self {
        let steps = || shipment.steps.iter().map(|_| Vec::new()).collect();
        let mut parts = Self { of_steps: steps(), of_figures: steps(), at_the_end: Vec::new() };
        let (mut first_dexel, mut first_figure) = (0, 0);
        for (field, share) in shipment.fields.iter().enumerate() {
            match &share.wanted {
                Wanted::Dexels => {
                    let own = first_dexel..first_dexel + share.dexels;
                    parts.of_steps[..share.steps].iter_mut().for_each(|of| of.extend(dexels(field, own.clone())));
                }
                Wanted::Figures { columns, along } => {
                    let bytes = first_figure..first_figure + columns * size_of::<FigureColumn>();
                    first_figure = bytes.end;
                    for of_step in &mut parts.of_figures[..share.steps] {
                        of_step.push(ReturnedPart { field, source: OutputBuffer::Figures, bytes: bytes.clone() });
                    }
                    parts.at_the_end.extend(dexels(field, first_dexel + along.start..first_dexel + along.end));
                }
            }
            let bytes = COUNT_BYTES * field..COUNT_BYTES * (field + 1);
            parts.at_the_end.push(ReturnedPart { field, source: OutputBuffer::Counts, bytes });
            first_dexel += share.dexels;
        }
        let Self { of_steps, of_figures, at_the_end } = &mut parts;
        for together in of_steps.iter_mut().chain(of_figures).chain([at_the_end]) {
            together.sort_by_key(|part| part.source);
        }
        parts
    }

    fn in_order(&self) -> impl Iterator<Item = &ReturnedPart> {
        self.of_steps.iter().chain(&self.of_figures).flatten().chain(&self.at_the_end)
    }

    /// Bytes of all of them.
    pub fn bytes(&self) -> usize {
        self.in_order().map(|part| part.bytes.len()).sum()
    }

    /// What is left of so many fields.
    pub fn read(&self, mut rest: &[u8], fields: usize) -> Vec<Returned> {
        let mut returned = vec![Returned::default(); fields];
        for part in self.in_order() {
            let (bytes, others) = rest.split_at(part.bytes.len());
            rest = others;
            let of_field = &mut returned[part.field];
            match part.source {
                OutputBuffer::Heights => {
                    let heights_mm = bytemuck::pod_collect_to_vec(bytes);
                    of_field.layers.push(Layer { heights_mm, passes: Vec::new() });
                }
                OutputBuffer::Passes => {
                    if let Some(layer) = of_field.layers.last_mut() {
                        layer.passes = bytemuck::pod_collect_to_vec(bytes);
                    }
                }
                OutputBuffer::Figures => of_field.figures.push(bytemuck::pod_collect_to_vec(bytes)),
                OutputBuffer::Counts => [of_field.unconverged, of_field.visited] = bytemuck::pod_read_unaligned(bytes),
            }
        }
        returned
    }
}
