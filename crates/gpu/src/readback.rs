//! Fields on their way: sent to the device together, cut there, brought back.
//!
//! In: dexels of some fields, uncut or with what they had, and the steps over them. They follow each other in buffers
//! that all fields share, so that a launch goes over tiles of all of them. Out: of every field, after each of its
//! steps, heights and passes, or figures of their columns, and the number of iterations that stopped short; the
//! device's own time. Sending returns at once; the next submission is composed and sent while the device works on this
//! one.

mod arrival;
mod parts;
mod sending;

use super::device::Device;
use super::problem::GpuProblem;
use super::records::FigureColumn;
use super::stamps::{STAMP_BYTES, Stamps, device_ns};
use arrival::Arrival;
use gearcut_core::dexel::Layer;
use parts::ReturnedParts;
use sending::Sending;
use std::ops::Range;
use std::time::Duration;
use wgpu::BufferUsages as Use;

/// How long a batch may take: a launch is a second's work on the slowest GPU, minutes on a software adapter that shares
/// two busy cores.
const PATIENCE: Duration = Duration::from_secs(600);
/// Launches of a submission that are timed; later ones, if a tile has that many records, are not.
const TIMED_LAUNCHES: usize = 256;

/// What a binding before heights and passes holds.
pub enum Input<'a> {
    /// Parts one after the other, the same in all launches of a step.
    Shared(&'static str, Vec<&'a [u8]>),
    /// The submission's rays.
    Rays,
    /// The launch's tiles.
    Tiles,
}

/// One launch of a stage.
pub struct StageLaunch<'a> {
    /// The stage's pipeline in the variant that serves.
    pub pipeline: &'a wgpu::ComputePipeline,
    /// Tiles, or whole fields, as bytes.
    pub tiles: Vec<u8>,
    /// Workgroups in both dimensions.
    pub workgroups: [u32; 2],
}

/// Launches over the dexels of all fields, in order.
pub struct ReadbackStep<'a> {
    /// Bindings in order; what the device writes follows them.
    pub inputs: Vec<Input<'a>>,
    /// Launches in order.
    pub launches: Vec<StageLaunch<'a>>,
}

/// Dexels before the first step.
pub enum Before<'a> {
    /// As they are here: heights and passes, field by field.
    Layers(Vec<(&'a [f32], &'a [u32])>),
    /// Uncut: the step that says so.
    Uncut(ReadbackStep<'a>),
}

/// What comes back of a field.
pub enum Wanted {
    /// All dexels after every step.
    Dexels,
    /// Figures of its columns after every step, and one column after the last.
    Figures {
        /// Columns.
        columns: usize,
        /// Dexels of the column that comes back.
        along: Range<usize>,
    },
}

/// A field among those of a submission.
pub struct FieldShare {
    /// Dexels.
    pub dexels: usize,
    /// Steps that run over it.
    pub steps: usize,
    /// What comes back.
    pub wanted: Wanted,
}

/// What goes to the device in one submission.
pub struct Shipment<'a> {
    /// Name of the stage.
    pub stage: &'static str,
    /// Fields in order.
    pub fields: Vec<FieldShare>,
    /// What their dexels are before the first step.
    pub before: Before<'a>,
    /// Rays as bytes, field by field; nothing where every step has its own.
    pub rays: Vec<&'a [u8]>,
    /// Steps in order.
    pub steps: Vec<ReadbackStep<'a>>,
    /// Makes the figures of a step from its dexels and the last ones.
    pub figures: Option<ReadbackStep<'a>>,
}

/// A submission that the device works on.
pub struct InFlight {
    stage: &'static str,
    back: wgpu::Buffer,
    submission: wgpu::SubmissionIndex,
    mapped: Arrival<Result<(), wgpu::BufferAsyncError>>,
    fields: usize,
    parts: ReturnedParts,
    timed: usize,
}

/// What is left of a field.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Returned {
    /// Iterations that stopped short below the height that was there.
    pub unconverged: u32,
    /// (Dexel, record) pairs that the device has found worth a visit, if it was to search them.
    pub visited: u32,
    /// Dexels after every step, or those of one column after the last.
    pub layers: Vec<Layer>,
    /// Figures of the columns after every step, if they are wanted.
    pub figures: Vec<Vec<FigureColumn>>,
}

/// What a submission brings.
pub struct Arrived {
    /// Name of the stage.
    pub stage: &'static str,
    /// What is left of every field.
    pub fields: Vec<Returned>,
    /// The device's own time for all launches, ns, if it can tell.
    pub device_ns: Option<f64>,
}

/// Sends fields. With `poison`, outputs are filled with ones (a NaN, an impossible id) before the work, so that nothing
/// stale passes for a result.
///
/// # Errors
/// The device is lost, or refuses memory or a call.
pub async fn send(device: &Device, shipment: &Shipment<'_>, poison: bool) -> Result<InFlight, GpuProblem> {
    let sent = || {
        let launches = shipment.steps.iter().map(|step| step.launches.len()).sum::<usize>();
        let timed = if device.facts.timestamps { launches.min(TIMED_LAUNCHES) } else { 0 };
        let parts = ReturnedParts::of(shipment);
        // Stamps are aligned.
        let stamps_at = parts.bytes().next_multiple_of(8);
        let back_bytes = stamps_at + STAMP_BYTES * timed;
        let back = device.empty("back", back_bytes as u64, Use::MAP_READ | Use::COPY_DST);
        if poison {
            device.queue.write_buffer(&back, 0, &vec![0xFF; back_bytes]);
        }
        let mut sending = Sending {
            device,
            stage: shipment.stage,
            poison,
            encoder: device.handle.create_command_encoder(&wgpu::CommandEncoderDescriptor::default()),
            stamps: (timed > 0).then(|| Stamps::new(device, timed)),
            timed,
            launched: 0,
            back,
            place: 0,
        };
        sending.ship(shipment, &parts);
        let Sending { mut encoder, stamps, back, .. } = sending;
        if let Some(stamps) = &stamps {
            stamps.bring_back(&mut encoder, &back, stamps_at as u64, timed);
        }
        let submission = device.queue.submit([encoder.finish()]);
        let mapped = Arrival::default();
        let arrives = mapped.clone();
        back.map_async(wgpu::MapMode::Read, .., move |result| arrives.with(result));
        let (stage, fields) = (shipment.stage, shipment.fields.len());
        InFlight { stage, back, submission, mapped, fields, parts, timed }
    };
    device.tried(sent).await
}

impl InFlight {
    /// Waits for the submission.
    ///
    /// # Errors
    /// The device is lost or silent, or refuses to give the result.
    pub async fn collect(self, device: &Device) -> Result<Arrived, GpuProblem> {
        // A browser polls by itself, and this returns at once there.
        let done = wgpu::PollType::Wait { submission_index: Some(self.submission), timeout: Some(PATIENCE) };
        if device.tried(|| device.handle.poll(done)).await?.is_err() {
            return Err(GpuProblem::Silent { seconds: PATIENCE.as_secs() });
        }
        let lost = |reason: String| GpuProblem::Lost { reason };
        self.mapped.await.map_err(|error| lost(error.to_string()))?;
        let view = device.tried(|| self.back.get_mapped_range(..)).await?.map_err(|error| lost(error.to_string()))?;
        let fields = self.parts.read(&view, self.fields);
        let stamps = &view[view.len() - STAMP_BYTES * self.timed..];
        let device_ns = (self.timed > 0).then(|| device_ns(device, stamps));
        Ok(Arrived { stage: self.stage, fields, device_ns })
    }
}
