//! What all parts of the backend share: the device with its pipelines, how it works, and what it has met.
//!
//! A device that fails loses nothing: what it was to cut is cut again natively, or the run stops, as the user chose.

use crate::adapter::{self, AdapterFacts, AdapterKind, AdapterWish, FoundAdapter};
use crate::batches::Allowance;
use crate::device::Device;
use crate::pipeline;
use crate::problem::GpuProblem;
use crate::waiting::wait;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::cut::{Backend, CutStats, StageTime};
use gearcut_core::dexel::Layer;
use gearcut_core::error::Error;
use gearcut_shaders::{BLANK_LISTS, BLANK_RAYS, FLANK_FIGURES, PLANAR_UNCUT, Rows, planar_flank, spatial_flank};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Batches on the device at once: one in work, one on its way.
pub(crate) const IN_FLIGHT: usize = 2;

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
    /// Rows that a thread cuts; `None`: what suits the adapter's kind.
    pub rows: Option<Rows>,
    /// Fill outputs with impossible values before the work: for tests.
    pub poison_outputs: bool,
}

/// The GPU backend.
pub struct Gpu {
    pub(crate) device: Device,
    pub(crate) planar_flank: Vec<wgpu::ComputePipeline>,
    pub(crate) planar_uncut: Vec<wgpu::ComputePipeline>,
    pub(crate) flank_figures: Vec<wgpu::ComputePipeline>,
    pub(crate) blank_rays: Vec<wgpu::ComputePipeline>,
    pub(crate) blank_lists: Vec<wgpu::ComputePipeline>,
    pub(crate) spatial_flank: Vec<wgpu::ComputePipeline>,
    pub(crate) options: GpuOptions,
    /// Rows that a thread cuts.
    pub(crate) rows: Rows,
    pub(crate) native: Cpu,
    log: Mutex<Log>,
}

#[derive(Default)]
pub(crate) struct Log {
    pub(crate) incidents: Vec<String>,
    pub(crate) stages: Vec<StageTime>,
}

impl Log {
    pub(crate) fn count(&mut self, stage: &'static str, device_ns: Option<f64>) {
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
        wait(Self::open(wish, options))
    }

    /// The same for those who may not wait.
    ///
    /// # Errors
    /// As there.
    pub async fn open(wish: AdapterWish, options: GpuOptions) -> Result<Self, GpuProblem> {
        Self::opened_on(&adapter::chosen(wish).await?, options).await
    }

    /// Backend on a given adapter.
    ///
    /// # Errors
    /// The adapter gives no device, or refuses the shaders.
    pub fn on(adapter: &FoundAdapter, options: GpuOptions) -> Result<Self, GpuProblem> {
        wait(Self::opened_on(adapter, options))
    }

    async fn opened_on(adapter: &FoundAdapter, options: GpuOptions) -> Result<Self, GpuProblem> {
        let device = Device::open(adapter).await?;
        let by_kind = if adapter.facts.kind == AdapterKind::Software { Rows::Many } else { Rows::Few };
        let rows = options.rows.unwrap_or(by_kind);
        let planar_flank = pipeline::pipelines(&device, &planar_flank(rows)).await?;
        let planar_uncut = pipeline::pipelines(&device, &PLANAR_UNCUT).await?;
        let flank_figures = pipeline::pipelines(&device, &FLANK_FIGURES).await?;
        let blank_rays = pipeline::pipelines(&device, &BLANK_RAYS).await?;
        let blank_lists = pipeline::pipelines(&device, &BLANK_LISTS).await?;
        let spatial_flank = pipeline::pipelines(&device, &spatial_flank(rows)).await?;
        let native = Cpu::default();
        Ok(Self {
            device,
            planar_flank,
            planar_uncut,
            flank_figures,
            blank_rays,
            blank_lists,
            spatial_flank,
            options,
            rows,
            native,
            log: Mutex::default(),
        })
    }

    /// The adapter in use.
    pub fn adapter(&self) -> &AdapterFacts {
        &self.device.facts
    }

    /// Gives the device up as a driver reset would: whatever is on it is lost, and so is all that follows.
    pub fn lose_device(&self) {
        self.device.handle.destroy();
    }

    pub(crate) fn allowance(&self) -> Allowance {
        let facts = &self.device.facts;
        Allowance {
            buffer_bytes: facts.binding_bytes.min(facts.buffer_bytes),
            batch_bytes: self.options.memory_limit_bytes.map_or(facts.buffer_bytes, |all| all / IN_FLIGHT as u64),
        }
    }

    /// Cuts on the device, or natively if that is what a failure asks for.
    pub(crate) fn cut_or_redo(
        &self,
        layer: &mut Layer,
        on_device: impl FnOnce(&Layer) -> Result<(Layer, CutStats), GpuProblem>,
        natively: impl FnOnce(&mut Layer) -> Result<CutStats, Error>,
    ) -> Result<CutStats, Error> {
        match on_device(layer) {
            Ok((cut, stats)) => {
                *layer = cut;
                Ok(stats)
            }
            Err(problem) if self.options.on_failure == OnGpuFailure::Stop => Err(problem.into()),
            Err(problem) => {
                self.log().incidents.push(format!("{problem}; cut again on {}", self.native.name()));
                natively(layer)
            }
        }
    }

    /// What the device made of the blank, or what is made of it natively if that is what a failure asks for.
    pub(crate) fn blank_or_redo<T>(
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

    pub(crate) fn log(&self) -> MutexGuard<'_, Log> {
        self.log.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
