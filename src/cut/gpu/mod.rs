//! The GPU backend: f32 in local frames through wgpu, on any Vulkan, Metal or DirectX 12 adapter, without a window.
//!
//! In: field, edge, plan, layer, as every backend. Out: heights within a nanometre of the native ones wherever these
//! are stable, and the passes that left them. Everything far away is subtracted in f64 on the host ([`compose`]);
//! fields of any size go through in [`batches`]; the host composes one batch while the device works on the one before.
//! Nothing is written to the layer before all batches are back, so a device that fails loses nothing: the flank is cut
//! again natively, or the run stops, as the user chose.

pub mod adapter;
pub mod batches;
mod blank;
pub mod compose;
mod device;
pub mod pipeline;
mod problem;
mod readback;
pub mod records;

use super::cpu::Cpu;
use super::{Backend, CutStats, StageTime};
use crate::dexel::{Field, Layer};
use crate::error::Error;
use crate::passes::CutPlan;
use crate::tool::edge::Edge;
use adapter::{AdapterFacts, AdapterWish, FoundAdapter};
use batches::{Allowance, Batch, Round};
use compose::EdgeCells;
use device::Device;
use readback::{InFlight, Returned, Shipment};
use std::sync::{Mutex, MutexGuard, PoisonError};

pub use problem::GpuProblem;

/// Threads of a workgroup: at least one wave on every GPU, and small enough for any.
pub const WORKGROUP_THREADS: u32 = 64;
/// Rows that one thread cuts, as the lanes of its vectors.
pub const ROWS_PER_THREAD: u32 = 4;
/// Batches on the device at once: one in work, one on its way.
const IN_FLIGHT: usize = 2;

/// What to do when the device fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OnGpuFailure {
    /// Cut the flank again on the processor, and say so.
    #[default]
    RedoNatively,
    /// Stop the run with the problem.
    Stop,
}

/// How the backend works.
#[derive(Debug, Clone, Copy, Default)]
pub struct GpuOptions {
    /// What to do when the device fails.
    pub on_failure: OnGpuFailure,
    /// Bytes that one cut may hold on the device; `None`: what the adapter allows.
    pub memory_limit_bytes: Option<u64>,
    /// Fill outputs with impossible values before the work: for tests.
    pub poison_outputs: bool,
}

/// The GPU backend.
pub struct Gpu {
    device: Device,
    planar_flank: Vec<wgpu::ComputePipeline>,
    blank_rays: Vec<wgpu::ComputePipeline>,
    options: GpuOptions,
    native: Cpu,
    log: Mutex<Log>,
}

#[derive(Default)]
struct Log {
    incidents: Vec<String>,
    batches: u64,
    device_ns: f64,
}

impl Gpu {
    /// Backend on the best adapter of a kind.
    ///
    /// # Errors
    /// No such adapter, or it gives no device, or refuses the shaders.
    pub fn new(wish: AdapterWish, options: GpuOptions) -> Result<Self, GpuProblem> {
        Self::on(&adapter::choose(wish)?, options)
    }

    /// Backend on a given adapter.
    ///
    /// # Errors
    /// The adapter gives no device, or refuses the shaders.
    pub fn on(adapter: &FoundAdapter, options: GpuOptions) -> Result<Self, GpuProblem> {
        let device = Device::open(adapter)?;
        let planar_flank = pipeline::pipelines(&device, &pipeline::PLANAR_FLANK)?;
        let blank_rays = pipeline::pipelines(&device, &pipeline::BLANK_RAYS)?;
        Ok(Self { device, planar_flank, blank_rays, options, native: Cpu::default(), log: Mutex::default() })
    }

    /// The adapter in use.
    pub fn adapter(&self) -> &AdapterFacts {
        &self.device.facts
    }

    /// Gives the device up as a driver reset would: whatever is on it is lost, and so is all that follows.
    pub fn lose_device(&self) {
        self.device.handle.destroy();
    }

    fn log(&self) -> MutexGuard<'_, Log> {
        self.log.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Heights and passes of the whole field, the layer untouched.
    fn cut_on_device(
        &self,
        field: &Field,
        edge: &Edge,
        plan: &CutPlan,
        layer: &Layer,
    ) -> Result<(Layer, u64), GpuProblem> {
        self.device.alive()?;
        let work = Work { gpu: self, field, edge, plan, layer, cells: EdgeCells::new(edge) };
        let row_phases: Vec<f32> = plan.row_phases.iter().map(|&tau| tau as f32).collect();
        let facts = &self.device.facts;
        let allowance = Allowance {
            buffer_bytes: facts.binding_bytes.min(facts.buffer_bytes),
            batch_bytes: self.options.memory_limit_bytes.map_or(facts.buffer_bytes, |all| all / IN_FLIGHT as u64),
        };
        let mut result = layer.clone();
        let mut unconverged = 0;
        let mut waiting: Vec<(Batch, InFlight)> = Vec::new();
        let mut collect = |(batch, in_flight): (Batch, InFlight)| -> Result<(), GpuProblem> {
            let Returned { heights_mm, passes, unconverged: short, device_ns } = in_flight.collect(&self.device)?;
            let dexels = batch.columns.start * field.rows()..batch.columns.end * field.rows();
            result.heights_mm[dexels.clone()].copy_from_slice(&heights_mm);
            result.passes[dexels].copy_from_slice(&passes);
            unconverged += u64::from(short);
            let mut log = self.log();
            log.batches += 1;
            log.device_ns += device_ns.unwrap_or(0.0);
            Ok(())
        };
        for batch in batches::batches(plan, allowance)? {
            if waiting.len() == IN_FLIGHT {
                collect(waiting.remove(0))?;
            }
            let in_flight = work.send(&batch, &row_phases)?;
            waiting.push((batch, in_flight));
        }
        waiting.into_iter().try_for_each(collect)?;
        Ok((result, unconverged))
    }
}

/// One cut's inputs.
struct Work<'a> {
    gpu: &'a Gpu,
    field: &'a Field,
    edge: &'a Edge,
    plan: &'a CutPlan,
    layer: &'a Layer,
    cells: EdgeCells,
}

impl Work<'_> {
    fn send(&self, batch: &Batch, row_phases: &[f32]) -> Result<InFlight, GpuProblem> {
        let Self { gpu, field, edge, plan, layer, cells } = self;
        let rows = field.rows();
        let rounds = batch.rounds.iter().map(|pieces| Round::new(pieces, batch, plan, field, edge, cells));
        // The first round has a piece for every column.
        let columns = batch.rounds[0].iter().flat_map(|piece| {
            let tile = &plan.tiles[piece.tile];
            let middle = compose::middle(&field.columns[tile.columns.clone()]);
            field.columns[piece.columns.clone()].iter().map(move |ray| compose::column(ray, tile.origin_mm, &middle))
        });
        let dexels = batch.columns.start * rows..batch.columns.end * rows;
        readback::send(
            &gpu.device,
            &gpu.planar_flank,
            &Shipment {
                rows,
                columns: columns.collect(),
                rounds: rounds.filter(|round| !round.records.is_empty()).collect(),
                cells: &cells.cells,
                row_phases,
                heights_mm: &layer.heights_mm[dexels.clone()],
                passes: &layer.passes[dexels],
                poison: gpu.options.poison_outputs,
            },
        )
    }
}

impl Backend for Gpu {
    fn name(&self) -> String {
        let AdapterFacts { name, interface, driver, .. } = self.adapter();
        format!("gpu ({name}, {interface}, {driver})")
    }

    fn cut(&self, field: &Field, edge: &Edge, plan: &CutPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        match self.cut_on_device(field, edge, plan, layer) {
            Ok((cut, unconverged)) => {
                *layer = cut;
                Ok(CutStats { dexels: field.len() as u64, dexel_passes: plan.dexel_passes(), unconverged })
            }
            Err(problem) if self.options.on_failure == OnGpuFailure::Stop => Err(problem.into()),
            Err(problem) => {
                self.log().incidents.push(format!("{problem}; cut again on {}", self.native.name()));
                self.native.cut(field, edge, plan, layer)
            }
        }
    }

    fn incidents(&self) -> Vec<String> {
        self.log().incidents.clone()
    }

    fn stage_times(&self) -> Vec<StageTime> {
        if !self.device.facts.timestamps {
            return Vec::new();
        }
        let log = self.log();
        let stage = pipeline::PLANAR_FLANK.name;
        vec![StageTime { stage, batches: log.batches, device_s: log.device_ns * 1e-9 }]
    }
}
