//! A batch on its way: sent to the device, cut there, brought back.
//!
//! In: a batch with its composed rounds and the layer's part. Out: heights, passes, the number of iterations that
//! stopped short, the device's own time. Sending returns at once; the next batch is composed and sent while the device
//! works on this one.

use super::batches::Round;
use super::device::Device;
use super::pipeline::threads_per_column;
use super::problem::GpuProblem;
use super::records::{Column, Launch};
use std::sync::mpsc;
use std::time::Duration;
use wgpu::BufferUsages as Use;

/// How long a batch may take: a launch is a second's work on the slowest GPU, minutes on a software adapter that shares
/// two busy cores.
const PATIENCE: Duration = Duration::from_secs(600);
/// Rounds of a batch that are timed; later ones, if a tile has that many records, are not.
const TIMED_ROUNDS: usize = 256;

/// What goes to the device.
pub struct Shipment<'a> {
    /// Rows of the field.
    pub rows: usize,
    /// Columns of the batch.
    pub columns: Vec<Column>,
    /// Launches in order.
    pub rounds: Vec<Round>,
    /// Cells of all segments.
    pub cells: &'a [[f32; 4]],
    /// Phase of every row.
    pub row_phases: &'a [f32],
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
pub fn send(device: &Device, pipelines: &[wgpu::ComputePipeline], shipment: &Shipment) -> Result<InFlight, GpuProblem> {
    device.checked(|| {
        let buffer = |label: &str, bytes: &[u8], usage: Use| {
            let buffer = empty(device, label, bytes.len() as u64, usage | Use::COPY_DST);
            device.queue.write_buffer(&buffer, 0, bytes);
            buffer
        };
        let launch =
            Launch { rows: shipment.rows as u32, threads_per_column: threads_per_column(shipment.rows) as u32 };
        let launch_buffer = buffer("launch", bytemuck::bytes_of(&launch), Use::UNIFORM);
        let columns = buffer("columns", bytemuck::cast_slice(&shipment.columns), Use::STORAGE);
        let cells = buffer("cells", bytemuck::cast_slice(shipment.cells), Use::STORAGE);
        let row_phases = buffer("row phases", bytemuck::cast_slice(shipment.row_phases), Use::STORAGE);
        let heights = buffer("heights", bytemuck::cast_slice(shipment.heights_mm), Use::STORAGE | Use::COPY_SRC);
        let passes = buffer("passes", bytemuck::cast_slice(shipment.passes), Use::STORAGE | Use::COPY_SRC);
        let unconverged = buffer("unconverged", bytemuck::bytes_of(&0_u32), Use::STORAGE | Use::COPY_SRC);

        let timed = if device.facts.timestamps { shipment.rounds.len().min(TIMED_ROUNDS) } else { 0 };
        let stamps = (timed > 0).then(|| Stamps::new(device, timed));
        let dexel_bytes = size_of_val(shipment.heights_mm);
        let back_bytes = 2 * dexel_bytes + 8 + 16 * timed;
        let back = empty(device, "back", back_bytes as u64, Use::MAP_READ | Use::COPY_DST);
        if shipment.poison {
            device.queue.write_buffer(&back, 0, &vec![0xFF; back_bytes]);
        }

        let mut encoder = device.handle.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for (index, round) in shipment.rounds.iter().enumerate() {
            let pipeline = &pipelines[usize::from(round.is_frozen())];
            let tiles = buffer("tiles", bytemuck::cast_slice(&round.tiles), Use::STORAGE);
            let records = buffer("records", bytemuck::cast_slice(&round.records), Use::STORAGE);
            let bindings =
                [&launch_buffer, &tiles, &columns, &records, &cells, &row_phases, &heights, &passes, &unconverged];
            let entries: Vec<wgpu::BindGroupEntry> = (0..)
                .zip(bindings)
                .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
                .collect();
            let group = device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
            let timestamp_writes = stamps.as_ref().filter(|_| index < timed).map(|s| s.writes(index));
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(super::pipeline::PLANAR_FLANK.name),
                timestamp_writes,
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            let threads = round.widest as u32 * launch.threads_per_column;
            pass.dispatch_workgroups(threads.div_ceil(super::WORKGROUP_THREADS), round.tiles.len() as u32, 1);
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

fn empty(device: &Device, label: &str, size: u64, usage: Use) -> wgpu::Buffer {
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
        let stamps: Vec<u64> = rest[8..].chunks_exact(8).map(bytemuck::pod_read_unaligned).collect();
        let period_ns = f64::from(device.queue.get_timestamp_period());
        let ticks: u64 = stamps.chunks_exact(2).map(|s| s[1].saturating_sub(s[0])).sum();
        Ok(Returned {
            heights_mm: bytemuck::pod_collect_to_vec(heights),
            passes: bytemuck::pod_collect_to_vec(passes),
            unconverged: bytemuck::pod_read_unaligned(&rest[..4]),
            device_ns: (self.timed > 0).then_some(ticks as f64 * period_ns),
        })
    }
}

/// Times at which launches begin and end.
struct Stamps {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
}

impl Stamps {
    fn new(device: &Device, rounds: usize) -> Self {
        let queries = device.handle.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("stamps"),
            ty: wgpu::QueryType::Timestamp,
            count: 2 * rounds as u32,
        });
        let resolved = empty(device, "stamps", 16 * rounds as u64, Use::QUERY_RESOLVE | Use::COPY_SRC);
        Self { queries, resolved }
    }

    fn writes(&self, round: usize) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(2 * round as u32),
            end_of_pass_write_index: Some(2 * round as u32 + 1),
        }
    }

    fn bring_back(&self, encoder: &mut wgpu::CommandEncoder, back: &wgpu::Buffer, offset: u64, rounds: usize) {
        encoder.resolve_query_set(&self.queries, 0..2 * rounds as u32, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, back, offset, 16 * rounds as u64);
    }
}
