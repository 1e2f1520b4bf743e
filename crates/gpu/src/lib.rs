//! The GPU backend: f32 in local frames through wgpu, on any Vulkan, Metal or DirectX 12 adapter, without a window.
//!
//! In: field, plan, layer, as every backend. Out: heights within a nanometre of the native ones wherever these
//! are stable, and the passes that left them. Everything far away is subtracted in f64 on the host ([`compose`]);
//! fields of any size go through in [`batches`]; the host composes one batch while the device works on the one before.
//! Nothing is written to the layer before all batches are back, so a device that fails loses nothing: the flank is cut
//! again natively, or the run stops, as the user chose.
//!
//! The modules, from the ground up; each uses only those above it in this list, and the backend at their head:
//!
//! - `problem`: what can go wrong on a device, as values
//! - [`adapter`]: which adapters are there, and which one serves
//! - `device`: a device that reports its problems
//! - [`pipeline`]: shaders as text and as pipelines
//! - `readback`: a batch sent, cut and brought back
//! - [`records`]: what the shaders of shaping read, byte for byte
//! - [`sweep_records`]: what the shader of hobbed flanks reads
//! - [`near_edge`]: the piece of an edge that a tile can meet, as one polynomial
//! - [`compose`]: from the plan's f64 records to f32 records
//! - [`batches`]: fields of any size in batches and rounds
//! - [`edge_cells`]: tables of an edge for the spatial shader
//! - `spatial`: flanks cut by sweeps
//! - `blank_rays`: launches of the kernel that cuts rays of the blank
//! - `blank`: the blank of shaping
//! - `blank_sweeps`: the blank of hobbing

pub mod adapter;
pub mod batches;
mod blank;
mod blank_rays;
mod blank_sweeps;
pub mod compose;
mod device;
pub mod edge_cells;
pub mod near_edge;
pub mod pipeline;
mod problem;
mod readback;
pub mod records;
mod spatial;
pub mod sweep_records;

use adapter::{AdapterFacts, AdapterWish, FoundAdapter};
use batches::{Allowance, Batch, Round};
use device::Device;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::cut::sweep_chips::SweepsCut;
use gearcut_core::cut::{Backend, CutStats, StageTime};
use gearcut_core::cut::{BlankCut, BlankOperation};
use gearcut_core::dexel::{BlankField, Field, Layer, SpatialField};
use gearcut_core::error::Error;
use gearcut_core::passes::sections::swept_sections::SweptSections;
use gearcut_core::passes::{CutPlan, SweepPlan};
use readback::{InFlight, Input, Returned, Shipment, StageLaunch};
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

pub use problem::GpuProblem;

/// Threads of a workgroup: at least one wave on every GPU, and small enough for any.
pub const WORKGROUP_THREADS: u32 = 64;
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
    spatial_flank: Vec<wgpu::ComputePipeline>,
    options: GpuOptions,
    native: Cpu,
    log: Mutex<Log>,
}

#[derive(Default)]
struct Log {
    incidents: Vec<String>,
    stages: Vec<StageTime>,
}

impl Log {
    fn count(&mut self, stage: &'static str, device_ns: Option<f64>) {
        let device_s = device_ns.unwrap_or(0.0) * 1e-9;
        match self.stages.iter_mut().find(|time| time.stage == stage) {
            Some(time) => {
                time.batches += 1;
                time.device_s += device_s;
            }
            None => self.stages.push(StageTime { stage, batches: 1, device_s }),
        }
    }
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
        let spatial_flank = pipeline::pipelines(&device, &pipeline::SPATIAL_FLANK)?;
        let native = Cpu::default();
        Ok(Self { device, planar_flank, blank_rays, spatial_flank, options, native, log: Mutex::default() })
    }

    /// The adapter in use.
    pub fn adapter(&self) -> &AdapterFacts {
        &self.device.facts
    }

    /// Gives the device up as a driver reset would: whatever is on it is lost, and so is all that follows.
    pub fn lose_device(&self) {
        self.device.handle.destroy();
    }

    fn allowance(&self) -> Allowance {
        let facts = &self.device.facts;
        Allowance {
            buffer_bytes: facts.binding_bytes.min(facts.buffer_bytes),
            batch_bytes: self.options.memory_limit_bytes.map_or(facts.buffer_bytes, |all| all / IN_FLIGHT as u64),
        }
    }

    /// Cuts on the device, or natively if that is what a failure asks for.
    fn cut_or_redo(
        &self,
        layer: &mut Layer,
        [dexels, dexel_passes]: [u64; 2],
        on_device: impl FnOnce(&Layer) -> Result<(Layer, u64), GpuProblem>,
        natively: impl FnOnce(&mut Layer) -> Result<CutStats, Error>,
    ) -> Result<CutStats, Error> {
        match on_device(layer) {
            Ok((cut, unconverged)) => {
                *layer = cut;
                Ok(CutStats { dexels, dexel_passes, unconverged })
            }
            Err(problem) if self.options.on_failure == OnGpuFailure::Stop => Err(problem.into()),
            Err(problem) => {
                self.log().incidents.push(format!("{problem}; cut again on {}", self.native.name()));
                natively(layer)
            }
        }
    }

    /// What the device made of the blank, or what is made of it natively if that is what a failure asks for.
    fn blank_or_redo<T>(
        &self,
        on_device: Result<T, GpuProblem>,
        natively: impl FnOnce(&Cpu) -> Result<T, Error>,
    ) -> Result<T, Error> {
        match on_device {
            Ok(cut) => Ok(cut),
            Err(problem) if self.options.on_failure == OnGpuFailure::Stop => Err(problem.into()),
            Err(problem) => {
                self.log().incidents.push(format!("{problem}; the blank is cut again on {}", self.native.name()));
                natively(&self.native)
            }
        }
    }

    fn log(&self) -> MutexGuard<'_, Log> {
        self.log.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Heights and passes of the whole field, the layer untouched.
    fn cut_on_device(&self, field: &Field, plan: &CutPlan, layer: &Layer) -> Result<(Layer, u64), GpuProblem> {
        self.device.alive()?;
        let work = CutInputs { gpu: self, field, plan, layer, row_phases: padded_phases(&plan.row_phases) };
        let (rows, padded) = (field.rows(), batches::padded(field.rows()));
        let mut result = layer.clone();
        let mut unconverged = 0;
        let mut waiting: Vec<(Batch, InFlight)> = Vec::new();
        let mut collect = |(batch, in_flight): (Batch, InFlight)| -> Result<(), GpuProblem> {
            let Returned { heights_mm, passes, unconverged: short, device_ns } = in_flight.collect(&self.device)?;
            for (index, column) in batch.columns.enumerate() {
                let (dexels, there) = (column * rows..(column + 1) * rows, index * padded..index * padded + rows);
                result.heights_mm[dexels.clone()].copy_from_slice(&heights_mm[there.clone()]);
                result.passes[dexels].copy_from_slice(&passes[there]);
            }
            unconverged += u64::from(short);
            self.log().count(pipeline::PLANAR_FLANK.name, device_ns);
            Ok(())
        };
        for batch in batches::batches(plan, self.allowance())? {
            if waiting.len() == IN_FLIGHT {
                collect(waiting.remove(0))?;
            }
            let in_flight = work.send(&batch)?;
            waiting.push((batch, in_flight));
        }
        waiting.into_iter().try_for_each(collect)?;
        Ok((result, unconverged))
    }
}

/// Phases of a column's rows as the shader reads them, in quads, the last one filled up with the last phase.
fn padded_phases(row_phases: &[f64]) -> Vec<f32> {
    let mut phases: Vec<f32> = row_phases.iter().map(|&tau| tau as f32).collect();
    phases.resize(batches::padded(row_phases.len()), phases.last().copied().unwrap_or_default());
    phases
}

/// Columns one after the other, each filled up to whole quads with its last value.
fn padded_columns<T: Copy>(values: &[T], rows: usize) -> Vec<T> {
    let mut columns = Vec::with_capacity(values.len() / rows * batches::padded(rows));
    for column in values.chunks_exact(rows) {
        columns.extend_from_slice(column);
        columns.extend(std::iter::repeat_n(column[rows - 1], batches::padded(rows) - rows));
    }
    columns
}

/// One cut's inputs.
struct CutInputs<'a> {
    gpu: &'a Gpu,
    field: &'a Field,
    plan: &'a CutPlan,
    layer: &'a Layer,
    row_phases: Vec<f32>,
}

impl CutInputs<'_> {
    fn send(&self, batch: &Batch) -> Result<InFlight, GpuProblem> {
        let Self { gpu, field, plan, layer, row_phases } = self;
        let rows = field.rows();
        let columns = batch.pieces.iter().flat_map(|piece| {
            let tile = &plan.tiles[piece.tile];
            let middle = compose::middle(&field.columns[tile.columns.clone()]);
            field.columns[piece.columns.clone()].iter().map(move |ray| compose::column(ray, tile.origin_mm, &middle))
        });
        let dexels = batch.columns.start * rows..batch.columns.end * rows;
        let columns: Vec<records::Column> = columns.collect();
        let rounds = Round::compose(batch, plan, field);
        let launch = records::Launch {
            rows: rows as u32,
            quads: (row_phases.len() / pipeline::QUAD_ROWS) as u32,
            threads_per_column: pipeline::threads_per_column(rows) as u32,
        };
        let records: Vec<Vec<records::PassRecord>> = rounds.iter().map(Round::padded_records).collect();
        let shared = |label, bytes| Input::Shared { label, bytes, usage: wgpu::BufferUsages::STORAGE };
        let launches: Vec<StageLaunch> = rounds
            .iter()
            .zip(&records)
            .map(|(round, records)| StageLaunch {
                pipeline: &gpu.planar_flank[round.variant()],
                tiles: bytemuck::cast_slice(&round.tiles),
                records: bytemuck::cast_slice(records),
                workgroups: [
                    (round.widest as u32 * launch.threads_per_column).div_ceil(WORKGROUP_THREADS),
                    round.tiles.len() as u32,
                ],
            })
            .collect();
        readback::send(
            &gpu.device,
            &Shipment {
                stage: pipeline::PLANAR_FLANK.name,
                inputs: &[
                    Input::Shared {
                        label: "launch",
                        bytes: bytemuck::bytes_of(&launch),
                        usage: wgpu::BufferUsages::UNIFORM,
                    },
                    Input::Tiles,
                    shared("columns", bytemuck::cast_slice(&columns)),
                    Input::Records,
                    shared("row phases", bytemuck::cast_slice(row_phases)),
                ],
                record_usage: wgpu::BufferUsages::UNIFORM,
                launches: &launches,
                heights_mm: &padded_columns(&layer.heights_mm[dexels.clone()], rows),
                passes: &padded_columns(&layer.passes[dexels], rows),
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

    fn cut(&self, field: &Field, plan: &CutPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        self.cut_or_redo(
            layer,
            [field.len() as u64, plan.dexel_passes()],
            |layer| self.cut_on_device(field, plan, layer),
            |layer| self.native.cut(field, plan, layer),
        )
    }

    fn cut_blank(
        &self,
        field: &mut BlankField,
        operation: &BlankOperation,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<BlankCut>, Error> {
        let cut = self.cut_blank_on_device(field, operation, None, advance);
        self.blank_or_redo(cut, |native| native.cut_blank(field, operation, advance))
    }

    fn cut_blank_sweeps(
        &self,
        field: &mut BlankField,
        sections: &SweptSections,
        passes: Range<u32>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<SweepsCut>, Error> {
        let cut = self.cut_blank_sweeps_on_device(field, sections, passes.clone(), None, advance);
        self.blank_or_redo(cut, |native| native.cut_blank_sweeps(field, sections, passes, advance))
    }

    fn cut_spatial(&self, field: &SpatialField, plan: &SweepPlan, layer: &mut Layer) -> Result<CutStats, Error> {
        self.cut_or_redo(
            layer,
            [field.len() as u64, plan.tile_passes()],
            |layer| spatial::cut_on_device(self, field, plan, layer),
            |layer| self.native.cut_spatial(field, plan, layer),
        )
    }

    fn incidents(&self) -> Vec<String> {
        self.log().incidents.clone()
    }

    fn stage_times(&self) -> Vec<StageTime> {
        if !self.device.facts.timestamps {
            return Vec::new();
        }
        self.log().stages.clone()
    }
}
