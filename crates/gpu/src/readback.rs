//! A batch on its way: sent to the device, cut there, brought back.
//!
//! In: a batch with its composed rounds and the layer's part. Out: heights, passes, the number of iterations that
//! stopped short, the device's own time. Sending returns at once; the next batch is composed and sent while the device
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

/// What goes to the device.
pub struct Shipment<'a> {
    /// Name of the stage.
    pub stage: &'static str,
    /// Bindings in order; heights, passes and the count of iterations that stopped short follow them.
    pub inputs: &'a [Input<'a>],
    /// `UNIFORM` or `STORAGE`, whichever the stage reads records from.
    pub record_usage: Use,
    /// Launches in order.
    pub launches: &'a [StageLaunch<'a>],
    /// Heights before.
    pub heights_mm: &'a [f32],
    /// Passes before.
    pub passes: &'a [u32],
    /// Fill the outputs with ones (a NaN, an impossible id) before the work, so that nothing stale passes for a result.
    pub poison: bool,
}

/// A batch that the device works on.
pub struct InFlight {
    back: wgpu::Buffer,
    submission: wgpu::SubmissionIndex,
    mapped: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
    dexel_bytes: usize,
    timed: usize,
}

/// What came back.
#[derive(Debug, Clone, PartialEq)]
pub struct Returned {
    /// Heights, mm.
    pub heights_mm: Vec<f32>,
    /// Passes.
    pub passes: Vec<u32>,
    /// Iterations that stopped short below the height that was there.
    pub unconverged: u32,
    /// The device's own time for the launches, ns, if it can tell.
    pub device_ns: Option<f64>,
}

/// Sends a batch.
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
        let shared: Vec<Option<wgpu::Buffer>> = shipment
            .inputs
            .iter()
            .map(|input| match *input {
                Input::Shared { label, bytes, usage } => Some(buffer(label, bytes, usage)),
                Input::Tiles | Input::Records => None,
            })
            .collect();
        let heights = buffer("heights", bytemuck::cast_slice(shipment.heights_mm), Use::STORAGE | Use::COPY_SRC);
        let passes = buffer("passes", bytemuck::cast_slice(shipment.passes), Use::STORAGE | Use::COPY_SRC);
        let unconverged = buffer("unconverged", bytemuck::bytes_of(&0_u32), Use::STORAGE | Use::COPY_SRC);

        let timed = if device.facts.timestamps { shipment.launches.len().min(TIMED_ROUNDS) } else { 0 };
        let stamps = (timed > 0).then(|| Stamps::new(device, timed));
        let dexel_bytes = size_of_val(shipment.heights_mm);
        let back_bytes = 2 * dexel_bytes + 8 + STAMP_BYTES * timed;
        let back = empty(device, "back", back_bytes as u64, Use::MAP_READ | Use::COPY_DST);
        if shipment.poison {
            device.queue.write_buffer(&back, 0, &vec![0xFF; back_bytes]);
        }

        let mut encoder = device.handle.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for (index, launch) in shipment.launches.iter().enumerate() {
            let tiles = buffer("tiles", launch.tiles, Use::STORAGE);
            let records = buffer("records", launch.records, shipment.record_usage);
            let inputs = shipment.inputs.iter().zip(&shared).map(|(input, shared)| match (input, shared) {
                (Input::Records, _) => &records,
                (_, Some(shared)) => shared,
                (_, None) => &tiles,
            });
            let entries: Vec<wgpu::BindGroupEntry> = (0..)
                .zip(inputs.chain([&heights, &passes, &unconverged]))
                .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
                .collect();
            let pipeline = launch.pipeline;
            let group = device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
            let timestamp_writes = stamps.as_ref().filter(|_| index < timed).map(|s| s.writes(index));
            let mut pass = encoder
                .begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(shipment.stage), timestamp_writes });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            let [x, y] = launch.workgroups;
            pass.dispatch_workgroups(x, y, 1);
        }
        encoder.copy_buffer_to_buffer(&heights, 0, &back, 0, dexel_bytes as u64);
        encoder.copy_buffer_to_buffer(&passes, 0, &back, dexel_bytes as u64, dexel_bytes as u64);
        encoder.copy_buffer_to_buffer(&unconverged, 0, &back, 2 * dexel_bytes as u64, 4);
        if let Some(stamps) = &stamps {
            stamps.bring_back(&mut encoder, &back, 2 * dexel_bytes as u64 + 8, timed);
        }
        let submission = device.queue.submit([encoder.finish()]);
        let (sender, mapped) = mpsc::channel();
        back.map_async(wgpu::MapMode::Read, .., move |result| {
            // Nobody listens any more when the batch was given up.
            let _ = sender.send(result);
        });
        InFlight { back, submission, mapped, dexel_bytes, timed }
    })
}

/// A buffer that holds nothing yet.
pub fn empty(device: &Device, label: &str, size: u64, usage: Use) -> wgpu::Buffer {
    device.handle.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
}

impl InFlight {
    /// Waits for the batch.
    ///
    /// # Errors
    /// The device is lost or silent, or refuses to give the result.
    pub fn collect(self, device: &Device) -> Result<Returned, GpuProblem> {
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
        let (dexels, rest) = view.split_at(2 * self.dexel_bytes);
        let (heights, passes) = dexels.split_at(self.dexel_bytes);
        Ok(Returned {
            heights_mm: bytemuck::pod_collect_to_vec(heights),
            passes: bytemuck::pod_collect_to_vec(passes),
            unconverged: bytemuck::pod_read_unaligned(&rest[..4]),
            device_ns: (self.timed > 0).then(|| device_ns(device, &rest[8..])),
        })
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
