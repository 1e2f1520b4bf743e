//! Jobs on their way: sent to the device, cut there, brought back.
//!
//! In: dexels, uncut or with a layer's part, and the steps over them with composed rounds. Out: after every step
//! heights, passes, the number of iterations that stopped short; the device's own time. All jobs of a submission go
//! together and come back together. Sending returns at once; the next submission is composed and sent while the device
//! works on this one.

use super::device::Device;
use super::problem::GpuProblem;
use std::sync::mpsc;
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

/// Launches of a stage over the dexels of a job, in order; what they leave comes back.
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

/// Dexels that stay on the device through some steps.
pub struct ReadbackJob<'a> {
    /// What they are before.
    pub before: Before<'a>,
    /// Steps in order.
    pub steps: Vec<ReadbackStep<'a>>,
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
    mapped: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
    /// Bytes of heights and number of steps of every job.
    jobs: Vec<(usize, usize)>,
    timed: usize,
}

/// What a step left.
#[derive(Debug, Clone, PartialEq)]
pub struct Returned {
    /// Heights, mm.
    pub heights_mm: Vec<f32>,
    /// Passes.
    pub passes: Vec<u32>,
    /// Iterations that stopped short below the height that was there.
    pub unconverged: u32,
}

/// Bytes at the end of what a step brings back: its count of iterations, and nothing, so that stamps are aligned.
const COUNT_BYTES: usize = 8;

/// Sends jobs.
///
/// # Errors
/// The device is lost, or refuses memory or a call.
pub fn send(device: &Device, shipment: &Shipment) -> Result<InFlight, GpuProblem> {
    device.checked(|| {
        let buffer = |label: &str, bytes: &[u8], usage: Use| {
            let buffer = empty(device, label, bytes.len() as u64, usage | Use::COPY_DST);
            device.queue.write_buffer(&buffer, 0, bytes);
            buffer
        };
        let shared = |inputs: &[Input]| -> Vec<Option<wgpu::Buffer>> {
            let own = inputs.iter().map(|input| match *input {
                Input::Shared { label, bytes, usage } => Some(buffer(label, bytes, usage)),
                Input::Tiles | Input::Records => None,
            });
            own.collect()
        };
        let launches = shipment.jobs.iter().flat_map(|job| &job.steps).map(|step| step.launches.len()).sum::<usize>();
        let timed = if device.facts.timestamps { launches.min(TIMED_ROUNDS) } else { 0 };
        let stamps = (timed > 0).then(|| Stamps::new(device, timed));
        let jobs: Vec<(usize, usize)> = shipment.jobs.iter().map(|job| (job.before.bytes(), job.steps.len())).collect();
        let dexel_bytes: usize = jobs.iter().map(|(bytes, steps)| steps * (2 * bytes + COUNT_BYTES)).sum();
        let back_bytes = dexel_bytes + STAMP_BYTES * timed;
        let back = empty(device, "back", back_bytes as u64, Use::MAP_READ | Use::COPY_DST);
        if shipment.poison {
            device.queue.write_buffer(&back, 0, &vec![0xFF; back_bytes]);
        }

        let mut encoder = device.handle.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut index = 0;
        let mut run = |encoder: &mut wgpu::CommandEncoder,
                       pipeline: &wgpu::ComputePipeline,
                       buffers: &[&wgpu::Buffer],
                       [x, y]: [u32; 2],
                       is_timed: bool| {
            let entries: Vec<wgpu::BindGroupEntry> = (0..)
                .zip(buffers)
                .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
                .collect();
            let group = device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
            let timestamp_writes = stamps.as_ref().filter(|_| is_timed && index < timed).map(|s| s.writes(index));
            index += usize::from(is_timed);
            let mut pass = encoder
                .begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(shipment.stage), timestamp_writes });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(x, y, 1);
        };
        let mut place = 0;
        for job in shipment.jobs {
            let bytes = job.before.bytes();
            let both = Use::STORAGE | Use::COPY_SRC | Use::COPY_DST;
            let [heights, passes] = ["heights", "passes"].map(|label| empty(device, label, bytes as u64, both));
            match &job.before {
                Before::Layer(heights_mm, ids) => {
                    device.queue.write_buffer(&heights, 0, bytemuck::cast_slice(heights_mm));
                    device.queue.write_buffer(&passes, 0, bytemuck::cast_slice(ids));
                }
                Before::Uncut { pipeline, inputs, workgroups, .. } => {
                    if shipment.poison {
                        for buffer in [&heights, &passes] {
                            device.queue.write_buffer(buffer, 0, &vec![0xFF; bytes]);
                        }
                    }
                    let own = shared(inputs);
                    let buffers: Vec<&wgpu::Buffer> = own.iter().flatten().chain([&heights, &passes]).collect();
                    run(&mut encoder, pipeline, &buffers, *workgroups, false);
                }
            }
            for step in &job.steps {
                let own = shared(&step.inputs);
                let unconverged = buffer("unconverged", bytemuck::bytes_of(&0_u32), Use::STORAGE | Use::COPY_SRC);
                for launch in &step.launches {
                    let tiles = buffer("tiles", launch.tiles, Use::STORAGE);
                    let records = buffer("records", launch.records, shipment.record_usage);
                    let inputs = step.inputs.iter().zip(&own).map(|(input, own)| match (input, own) {
                        (Input::Records, _) => &records,
                        (_, Some(own)) => own,
                        (_, None) => &tiles,
                    });
                    let buffers: Vec<&wgpu::Buffer> = inputs.chain([&heights, &passes, &unconverged]).collect();
                    run(&mut encoder, launch.pipeline, &buffers, launch.workgroups, true);
                }
                for (from, size) in [(&heights, bytes), (&passes, bytes), (&unconverged, 4)] {
                    encoder.copy_buffer_to_buffer(from, 0, &back, place as u64, size as u64);
                    place += size;
                }
                place += COUNT_BYTES - 4;
            }
        }
        if let Some(stamps) = &stamps {
            stamps.bring_back(&mut encoder, &back, dexel_bytes as u64, timed);
        }
        let submission = device.queue.submit([encoder.finish()]);
        let (sender, mapped) = mpsc::channel();
        back.map_async(wgpu::MapMode::Read, .., move |result| {
            // Nobody listens any more when the batch was given up.
            let _ = sender.send(result);
        });
        InFlight { back, submission, mapped, jobs, timed }
    })
}

/// A buffer that holds nothing yet.
pub fn empty(device: &Device, label: &str, size: u64, usage: Use) -> wgpu::Buffer {
    device.handle.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
}

impl InFlight {
    /// Waits for the submission: what every step of every job left, and the device's own time for all launches, ns, if
    /// it can tell.
    ///
    /// # Errors
    /// The device is lost or silent, or refuses to give the result.
    pub fn collect(self, device: &Device) -> Result<(Vec<Vec<Returned>>, Option<f64>), GpuProblem> {
        let wait = wgpu::PollType::Wait { submission_index: Some(self.submission), timeout: Some(PATIENCE) };
        if device.checked(|| device.handle.poll(wait))?.is_err() {
            return Err(GpuProblem::Silent { seconds: PATIENCE.as_secs() });
        }
        let lost = |reason: String| GpuProblem::Lost { reason };
        match self.mapped.recv_timeout(PATIENCE) {
            Ok(Ok(())) => {}
            Ok(Err(error)) => return Err(lost(error.to_string())),
            Err(_) => return Err(GpuProblem::Silent { seconds: PATIENCE.as_secs() }),
        }
        let view = device.checked(|| self.back.get_mapped_range(..))?.map_err(|error| lost(error.to_string()))?;
        let mut rest = &view[..];
        let mut jobs = Vec::with_capacity(self.jobs.len());
        for &(bytes, steps) in &self.jobs {
            let mut left = Vec::with_capacity(steps);
            for _ in 0..steps {
                let (heights, others) = rest.split_at(bytes);
                let (passes, others) = others.split_at(bytes);
                left.push(Returned {
                    heights_mm: bytemuck::pod_collect_to_vec(heights),
                    passes: bytemuck::pod_collect_to_vec(passes),
                    unconverged: bytemuck::pod_read_unaligned(&others[..4]),
                });
                rest = &others[COUNT_BYTES..];
            }
            jobs.push(left);
        }
        let device_ns = (self.timed > 0).then(|| device_ns(device, rest));
        Ok((jobs, device_ns))
    }
}

/// Bytes of the stamps of one launch.
pub const STAMP_BYTES: usize = 16;

/// Time between the stamps of launches as they come back, ns.
pub fn device_ns(device: &Device, stamps: &[u8]) -> f64 {
    let stamps: Vec<u64> = stamps.chunks_exact(8).map(bytemuck::pod_read_unaligned).collect();
    let ticks: u64 = stamps.chunks_exact(2).map(|s| s[1].saturating_sub(s[0])).sum();
    ticks as f64 * f64::from(device.queue.get_timestamp_period())
}

/// Times at which launches begin and end.
pub struct Stamps {
    queries: wgpu::QuerySet,
    /// Where [`Self::resolve`] puts them.
    pub resolved: wgpu::Buffer,
}

impl Stamps {
    /// Stamps of so many launches.
    pub fn new(device: &Device, rounds: usize) -> Self {
        let queries = device.handle.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("stamps"),
            ty: wgpu::QueryType::Timestamp,
            count: 2 * rounds as u32,
        });
        let resolved = empty(device, "stamps", (STAMP_BYTES * rounds) as u64, Use::QUERY_RESOLVE | Use::COPY_SRC);
        Self { queries, resolved }
    }

    /// What a launch writes.
    pub fn writes(&self, round: usize) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(2 * round as u32),
            end_of_pass_write_index: Some(2 * round as u32 + 1),
        }
    }

    /// Makes the stamps readable.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder, rounds: usize) {
        encoder.resolve_query_set(&self.queries, 0..2 * rounds as u32, &self.resolved, 0);
    }

    fn bring_back(&self, encoder: &mut wgpu::CommandEncoder, back: &wgpu::Buffer, offset: u64, rounds: usize) {
        self.resolve(encoder, rounds);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, back, offset, (STAMP_BYTES * rounds) as u64);
    }
}
