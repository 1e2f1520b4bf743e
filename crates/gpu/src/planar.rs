//! Flanks cut by strokes: plans in turn over whole fields, or batches of columns where a field is too large for that.
//!
//! In: fields with their plans. Out: what each plan leaves. Dexels of a job are made on the device, all its plans run
//! over them there, and small jobs share a submission. The next submission is composed while the device works on the
//! one before.

use crate::batches::{self, Batch, Round};
use crate::context::{Gpu, IN_FLIGHT};
use crate::problem::GpuProblem;
use crate::readback::{self, Before, InFlight, Input, ReadbackJob, ReadbackStep, Returned, Shipment, StageLaunch};
use crate::{compose, records};
use gearcut_core::cut::{CutJob, CutLayers, CutStats};
use gearcut_core::dexel::{Field, Layer};
use gearcut_core::passes::CutPlan;
use gearcut_shaders::{QUAD_ROWS, Rows, WORKGROUP_THREADS, planar_flank};
use std::ops::Range;
use wgpu::BufferUsages as Use;

/// Name of the stage.
const NAME: &str = planar_flank(Rows::Many).name;
/// Bytes that a submission of some jobs brings back at most: enough that waiting for it costs little.
const SUBMISSION_BYTES: u64 = 32 << 20;
/// Columns of an uncut field on the device at most: workgroups in one dimension.
const UNCUT_COLUMNS: usize = 65_535;

impl Gpu {
    /// Whether the dexels of a job fit the device together through all its plans, with what comes back.
    pub(crate) fn takes_whole(&self, job: &CutJob) -> Result<bool, GpuProblem> {
        let allowance = self.allowance();
        let bytes = back_bytes(job);
        let one_batch = |plan| Ok(batches::batches(plan, allowance, self.rows)?.len() == 1);
        let fits = job.start.is_none()
            && job.field.columns.len() <= UNCUT_COLUMNS
            && bytes <= allowance.buffer_bytes
            && 2 * bytes <= allowance.batch_bytes;
        Ok(fits && job.plans.iter().map(one_batch).collect::<Result<Vec<bool>, GpuProblem>>()?.iter().all(|one| *one))
    }

    /// What the plans of jobs leave that the device [takes whole](Self::takes_whole).
    pub(crate) fn cut_jobs_on_device(&self, jobs: &[CutJob]) -> Result<Vec<CutLayers>, GpuProblem> {
        self.device.alive()?;
        let mut cut = Vec::with_capacity(jobs.len());
        let mut waiting: Vec<(&[CutJob], InFlight)> = Vec::new();
        let mut collect = |(jobs, in_flight): (&[CutJob], InFlight)| -> Result<(), GpuProblem> {
            let (left, device_ns) = in_flight.collect(&self.device)?;
            self.log().count(NAME, device_ns);
            cut.extend(jobs.iter().zip(left).map(|(job, left)| {
                let of_plan = |(plan, left): (&CutPlan, Returned)| {
                    let stats = CutStats {
                        dexels: job.field.len() as u64,
                        dexel_passes: plan.dexel_passes(),
                        unconverged: u64::from(left.unconverged),
                    };
                    (unpadded(left, job.field.rows()), stats)
                };
                job.plans.iter().zip(left).map(of_plan).collect()
            }));
            Ok(())
        };
        for some in submissions(jobs) {
            if waiting.len() == IN_FLIGHT {
                collect(waiting.remove(0))?;
            }
            waiting.push((some, self.send_jobs(some)?));
        }
        waiting.into_iter().try_for_each(collect)?;
        Ok(cut)
    }

    fn send_jobs(&self, jobs: &[CutJob]) -> Result<InFlight, GpuProblem> {
        let uncut: Vec<UncutInputs> = jobs.iter().map(|job| UncutInputs::new(self, job.field)).collect();
        let mut composed = Vec::new();
        for job in jobs {
            let of_job: Result<Vec<StepInputs>, GpuProblem> = job
                .plans
                .iter()
                .map(|plan| {
                    let whole = batches::batches(plan, self.allowance(), self.rows)?;
                    Ok(StepInputs::compose(self, job.field, plan, &whole[0]))
                })
                .collect();
            composed.push(of_job?);
        }
        let jobs: Vec<ReadbackJob> = uncut
            .iter()
            .zip(&composed)
            .map(|(uncut, steps)| ReadbackJob {
                before: uncut.before(self),
                steps: steps.iter().map(|step| step.step(self)).collect(),
            })
            .collect();
        self.send_planar(&jobs)
    }

    fn send_planar(&self, jobs: &[ReadbackJob]) -> Result<InFlight, GpuProblem> {
        readback::send(
            &self.device,
            &Shipment { stage: NAME, record_usage: Use::UNIFORM, jobs, poison: self.options.poison_outputs },
        )
    }

    /// Heights and passes of a field of any size, the layer untouched.
    pub(crate) fn cut_on_device(
        &self,
        field: &Field,
        plan: &CutPlan,
        layer: &Layer,
    ) -> Result<(Layer, u64), GpuProblem> {
        self.device.alive()?;
        let (rows, padded) = (field.rows(), batches::padded(field.rows()));
        let mut result = layer.clone();
        let mut unconverged = 0;
        let mut waiting: Vec<(Batch, InFlight)> = Vec::new();
        let mut collect = |(batch, in_flight): (Batch, InFlight)| -> Result<(), GpuProblem> {
            let (jobs, device_ns) = in_flight.collect(&self.device)?;
            let Returned { heights_mm, passes, unconverged: short } = &jobs[0][0];
            for (index, column) in batch.columns.enumerate() {
                let (dexels, there) = (column * rows..(column + 1) * rows, index * padded..index * padded + rows);
                result.heights_mm[dexels.clone()].copy_from_slice(&heights_mm[there.clone()]);
                result.passes[dexels].copy_from_slice(&passes[there]);
            }
            unconverged += u64::from(*short);
            self.log().count(NAME, device_ns);
            Ok(())
        };
        for batch in batches::batches(plan, self.allowance(), self.rows)? {
            if waiting.len() == IN_FLIGHT {
                collect(waiting.remove(0))?;
            }
            let composed = StepInputs::compose(self, field, plan, &batch);
            let dexels = batch.columns.start * rows..batch.columns.end * rows;
            let heights_mm = padded_columns(&layer.heights_mm[dexels.clone()], rows);
            let passes = padded_columns(&layer.passes[dexels], rows);
            let job = ReadbackJob { before: Before::Layer(&heights_mm, &passes), steps: vec![composed.step(self)] };
            let in_flight = self.send_planar(&[job])?;
            waiting.push((batch, in_flight));
        }
        waiting.into_iter().try_for_each(collect)?;
        Ok((result, unconverged))
    }
}

/// Bytes that a job brings back: heights and passes after every plan.
fn back_bytes(job: &CutJob) -> u64 {
    (8 * batches::padded(job.field.rows()) * job.field.columns.len() * job.plans.len()) as u64
}

/// Jobs in runs that share a submission.
fn submissions<'a, 'b>(jobs: &'a [CutJob<'b>]) -> Vec<&'a [CutJob<'b>]> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    let mut bytes = 0;
    for (index, job) in jobs.iter().enumerate() {
        bytes += back_bytes(job);
        match runs.last_mut().filter(|_| bytes <= SUBMISSION_BYTES) {
            Some(run) => run.end = index + 1,
            None => {
                runs.push(index..index + 1);
                bytes = back_bytes(job);
            }
        }
    }
    runs.into_iter().map(|run| &jobs[run]).collect()
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

/// A layer without the rows that fill up quads.
fn unpadded(left: Returned, rows: usize) -> Layer {
    let padded = batches::padded(rows);
    if padded == rows {
        return Layer { heights_mm: left.heights_mm, passes: left.passes };
    }
    Layer {
        heights_mm: left.heights_mm.chunks_exact(padded).flat_map(|column| &column[..rows]).copied().collect(),
        passes: left.passes.chunks_exact(padded).flat_map(|column| &column[..rows]).copied().collect(),
    }
}

fn launch(gpu: &Gpu, rows: usize) -> records::Launch {
    records::Launch {
        rows: rows as u32,
        quads: rows.div_ceil(QUAD_ROWS) as u32,
        threads_per_column: gpu.rows.threads_per_column(rows) as u32,
    }
}

/// What says how a field is uncut.
struct UncutInputs {
    launch: records::Launch,
    /// Height of every column.
    blank_mm: Vec<f32>,
}

impl UncutInputs {
    fn new(gpu: &Gpu, field: &Field) -> Self {
        let blank_mm = field.columns.iter().map(|column| column.blank_mm as f32).collect();
        Self { launch: launch(gpu, field.rows()), blank_mm }
    }

    fn before<'a>(&'a self, gpu: &'a Gpu) -> Before<'a> {
        let quads = self.launch.quads;
        Before::Uncut {
            pipeline: &gpu.planar_uncut[0],
            inputs: [
                Input::Shared { label: "launch", bytes: bytemuck::bytes_of(&self.launch), usage: Use::UNIFORM },
                Input::Shared { label: "blank", bytes: bytemuck::cast_slice(&self.blank_mm), usage: Use::STORAGE },
            ],
            workgroups: [quads.div_ceil(WORKGROUP_THREADS), self.blank_mm.len() as u32],
            bytes: self.blank_mm.len() * quads as usize * QUAD_ROWS * size_of::<f32>(),
        }
    }
}

/// What a plan needs over a batch, composed.
struct StepInputs {
    launch: records::Launch,
    columns: Vec<records::FlankColumn>,
    row_phases: Vec<f32>,
    rounds: Vec<Round>,
    records: Vec<Vec<records::FlankPass>>,
}

impl StepInputs {
    fn compose(gpu: &Gpu, field: &Field, plan: &CutPlan, batch: &Batch) -> Self {
        let columns = batch.pieces.iter().flat_map(|piece| {
            let tile = &plan.tiles[piece.tile];
            let middle = compose::middle(&field.columns[tile.columns.clone()]);
            field.columns[piece.columns.clone()].iter().map(move |ray| compose::column(ray, tile.origin_mm, &middle))
        });
        let rounds = Round::compose(batch, plan, field);
        Self {
            launch: launch(gpu, field.rows()),
            columns: columns.collect(),
            row_phases: padded_phases(&plan.row_phases),
            records: rounds.iter().map(Round::padded_records).collect(),
            rounds,
        }
    }

    fn step<'a>(&'a self, gpu: &'a Gpu) -> ReadbackStep<'a> {
        let launches = self.rounds.iter().zip(&self.records).map(|(round, records)| StageLaunch {
            pipeline: &gpu.planar_flank[round.variant()],
            tiles: bytemuck::cast_slice(&round.tiles),
            records: bytemuck::cast_slice(records),
            workgroups: [
                (round.widest as u32 * self.launch.threads_per_column).div_ceil(WORKGROUP_THREADS),
                round.tiles.len() as u32,
            ],
        });
        let shared = |label, bytes| Input::Shared { label, bytes, usage: Use::STORAGE };
        ReadbackStep {
            launches: launches.collect(),
            inputs: vec![
                Input::Shared { label: "launch", bytes: bytemuck::bytes_of(&self.launch), usage: Use::UNIFORM },
                Input::Tiles,
                shared("columns", bytemuck::cast_slice(&self.columns)),
                Input::Records,
                shared("row phases", bytemuck::cast_slice(&self.row_phases)),
            ],
        }
    }
}
