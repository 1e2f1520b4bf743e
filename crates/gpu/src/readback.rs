//! Jobs on their way: sent to the device, cut there, brought back.
//!
//! In: dexels, uncut or with a layer's part, and the steps over them with composed rounds. Out: after every step
//! heights and passes, or figures of their columns, and the number of iterations that stopped short; the device's own
//! time. All jobs of a submission go together and come back together. Sending returns at once; the next submission is
//! composed and sent while the device works on this one.

mod arrival;
mod sending;

use super::device::Device;
use super::problem::GpuProblem;
use super::records::FigureColumn;
use super::stamps::{STAMP_BYTES, Stamps, device_ns};
use arrival::Arrival;
use gearcut_core::dexel::Layer;
use sending::Sending;
use std::ops::Range;
use std::time::Duration;
use wgpu::BufferUsages as Use;

/// How long a batch may take: a launch is a second's work on the slowest GPU, minutes on a software adapter that shares
/// two busy cores.
const PATIENCE: Duration = Duration::from_secs(600);
/// Rounds of a batch that are timed; later ones, if a tile has that many records, are not.
const TIMED_ROUNDS: usize = 256;

/// What a binding before heights and passes holds.
pub enum Input<'a> {
    /// The same bytes in all launches of the batch.
    Shared {
        /// Name of the binding.
        label: &'static str,
        /// Its bytes.
        bytes: &'a [u8],
        /// `UNIFORM` or `STORAGE`.
        usage: Use,
    },
    /// The job's rays.
    Rays,
    /// The launch's tiles.
    Tiles,
    /// The launch's records.
    Records,
}

/// One launch of a stage.
pub struct StageLaunch<'a> {
    /// The stage's pipeline in the variant that serves.
    pub pipeline: &'a wgpu::ComputePipeline,
    /// Tiles as bytes.
    pub tiles: &'a [u8],
    /// Records as bytes.
    pub records: &'a [u8],
    /// Workgroups in both dimensions.
    pub workgroups: [u32; 2],
}

/// Launches of a stage over the dexels of a job, in order.
pub struct ReadbackStep<'a> {
    /// Bindings in order; heights, passes and the count of iterations that stopped short follow them.
    pub inputs: Vec<Input<'a>>,
    /// Launches in order.
    pub launches: Vec<StageLaunch<'a>>,
}

/// Dexels before the first step.
pub enum Before<'a> {
    /// As they are here: heights and passes.
    Layer(&'a [f32], &'a [u32]),
    /// Uncut: the launch that says so, over so many bytes of heights.
    Uncut {
        /// Its pipeline.
        pipeline: &'a wgpu::ComputePipeline,
        /// Bindings before heights and passes.
        inputs: [Input<'a>; 2],
        /// Workgroups in both dimensions.
        workgroups: [u32; 2],
        /// Bytes of all heights.
        bytes: usize,
    },
}

impl Before<'_> {
    fn bytes(&self) -> usize {
        match self {
            Self::Layer(heights_mm, _) => size_of_val(*heights_mm),
            Self::Uncut { bytes, .. } => *bytes,
        }
    }
}

/// What comes back of a job.
pub enum Wanted<'a> {
    /// All dexels after every step.
    Dexels,
    /// Figures of their columns after every step, and one column after the last.
    Figures(FigureInputs<'a>),
}

/// How figures are made.
pub struct FigureInputs<'a> {
    /// Makes the figures of a step and of what follows.
    pub pipeline: &'a wgpu::ComputePipeline,
    /// Bindings before the dexels.
    pub inputs: [Input<'a>; 2],
    /// Columns of the job.
    pub columns: u32,
    /// Bytes of the column that comes back among those of all heights.
    pub along: Range<usize>,
}

impl FigureInputs<'_> {
    /// Bytes of the figures of a step.
    fn bytes(&self) -> usize {
        self.columns as usize * size_of::<FigureColumn>()
    }
}

/// Dexels that stay on the device through some steps.
pub struct ReadbackJob<'a> {
    /// What they are before.
    pub before: Before<'a>,
    /// Rays as bytes; nothing where every step has its own.
    pub rays: &'a [u8],
    /// Steps in order.
    pub steps: Vec<ReadbackStep<'a>>,
    /// What comes back.
    pub wanted: Wanted<'a>,
}

/// What goes to the device in one submission.
pub struct Shipment<'a> {
    /// Name of the stage.
    pub stage: &'static str,
    /// `UNIFORM` or `STORAGE`, whichever the stage reads records from.
    pub record_usage: Use,
    /// Jobs in order.
    pub jobs: &'a [ReadbackJob<'a>],
    /// Fill the outputs with ones (a NaN, an impossible id) before the work, so that nothing stale passes for a result.
    pub poison: bool,
}

/// A submission that the device works on.
pub struct InFlight {
    back: wgpu::Buffer,
    submission: wgpu::SubmissionIndex,
    mapped: Arrival<Result<(), wgpu::BufferAsyncError>>,
    jobs: Vec<JobBytes>,
    timed: usize,
}

/// Bytes that a job brings back, one after the other.
struct JobBytes {
    /// Steps.
    steps: usize,
    /// Heights of a step, as many as those of passes; 0 if figures are wanted.
    heights: usize,
    /// Figures of a step; 0 if dexels are wanted.
    figures: usize,
    /// Heights of the column, as many as those of passes; 0 if dexels are wanted.
    along: usize,
}

impl JobBytes {
    fn of(job: &ReadbackJob) -> Self {
        let steps = job.steps.len();
        match &job.wanted {
            Wanted::Dexels => Self { steps, heights: job.before.bytes(), figures: 0, along: 0 },
            Wanted::Figures(inputs) => Self { steps, heights: 0, figures: inputs.bytes(), along: inputs.along.len() },
        }
    }

    /// All of them; stamps after them are aligned.
    fn all(&self) -> usize {
        (self.steps * (2 * self.heights + self.figures + size_of::<u32>()) + 2 * self.along).next_multiple_of(8)
    }
}

/// What is left of a job.
#[derive(Debug, Clone, PartialEq)]
pub struct Returned {
    /// Iterations of every step that stopped short below the height that was there.
    pub unconverged: Vec<u32>,
    /// Dexels after every step, if they are wanted.
    pub layers: Vec<Layer>,
    /// Figures of the columns after every step, if they are wanted.
    pub figures: Vec<Vec<FigureColumn>>,
    /// The column that comes with them.
    pub along: Layer,
}

/// Sends jobs.
///
/// # Errors
/// The device is lost, or refuses memory or a call.
pub async fn send(device: &Device, shipment: &Shipment<'_>) -> Result<InFlight, GpuProblem> {
    let sent = || {
        let launches = shipment.jobs.iter().flat_map(|job| &job.steps).map(|step| step.launches.len()).sum::<usize>();
        let timed = if device.facts.timestamps { launches.min(TIMED_ROUNDS) } else { 0 };
        let jobs: Vec<JobBytes> = shipment.jobs.iter().map(JobBytes::of).collect();
        let back_bytes = jobs.iter().map(JobBytes::all).sum::<usize>() + STAMP_BYTES * timed;
        let back = device.empty("back", back_bytes as u64, Use::MAP_READ | Use::COPY_DST);
        if shipment.poison {
            device.queue.write_buffer(&back, 0, &vec![0xFF; back_bytes]);
        }
        let mut sending = Sending {
            device,
            shipment,
            encoder: device.handle.create_command_encoder(&wgpu::CommandEncoderDescriptor::default()),
            stamps: (timed > 0).then(|| Stamps::new(device, timed)),
            timed,
            launched: 0,
            back,
            place: 0,
        };
        shipment.jobs.iter().for_each(|job| sending.job(job));
        let Sending { mut encoder, stamps, back, place, .. } = sending;
        if let Some(stamps) = &stamps {
            stamps.bring_back(&mut encoder, &back, place, timed);
        }
        let submission = device.queue.submit([encoder.finish()]);
        let mapped = Arrival::default();
        let arrives = mapped.clone();
        back.map_async(wgpu::MapMode::Read, .., move |result| arrives.with(result));
        InFlight { back, submission, mapped, jobs, timed }
    };
    device.tried(sent).await
}

impl InFlight {
    /// Waits for the submission: what is left of every job, and the device's own time for all launches, ns, if it can
    /// tell.
    ///
    /// # Errors
    /// The device is lost or silent, or refuses to give the result.
    pub async fn collect(self, device: &Device) -> Result<(Vec<Returned>, Option<f64>), GpuProblem> {
        // A browser polls by itself, and this returns at once there.
        let done = wgpu::PollType::Wait { submission_index: Some(self.submission), timeout: Some(PATIENCE) };
        if device.tried(|| device.handle.poll(done)).await?.is_err() {
            return Err(GpuProblem::Silent { seconds: PATIENCE.as_secs() });
        }
        let lost = |reason: String| GpuProblem::Lost { reason };
        self.mapped.await.map_err(|error| lost(error.to_string()))?;
        let view = device.tried(|| self.back.get_mapped_range(..)).await?.map_err(|error| lost(error.to_string()))?;
        let mut rest = &view[..];
        let mut jobs = Vec::with_capacity(self.jobs.len());
        for bytes in &self.jobs {
            let (own, others) = rest.split_at(bytes.all());
            jobs.push(Returned::read(bytes, own));
            rest = others;
        }
        let device_ns = (self.timed > 0).then(|| device_ns(device, rest));
        Ok((jobs, device_ns))
    }
}

/// Takes so many bytes from the front.
fn front<'a>(rest: &mut &'a [u8], size: usize) -> &'a [u8] {
    let (own, others) = rest.split_at(size);
    *rest = others;
    own
}

impl Returned {
    fn read(bytes: &JobBytes, mut rest: &[u8]) -> Self {
        let layer = |rest: &mut &[u8], size: usize| Layer {
            heights_mm: bytemuck::pod_collect_to_vec(front(rest, size)),
            passes: bytemuck::pod_collect_to_vec(front(rest, size)),
        };
        let (mut layers, mut unconverged) = (Vec::new(), Vec::new());
        for _ in 0..bytes.steps {
            if bytes.heights > 0 {
                layers.push(layer(&mut rest, bytes.heights));
            }
            unconverged.push(bytemuck::pod_read_unaligned(front(&mut rest, size_of::<u32>())));
        }
        let of_step = |_| bytemuck::pod_collect_to_vec(front(&mut rest, bytes.figures));
        let figures = if bytes.figures > 0 { (0..bytes.steps).map(of_step).collect() } else { Vec::new() };
        Self { unconverged, layers, figures, along: layer(&mut rest, bytes.along) }
    }
}
