//! Flanks cut by strokes: plans in turn over whole fields, or batches of columns where a field is too large for that.
//!
//! In: fields with their plans. Out: what each plan leaves, or figures of it. Dexels of a field are made on the device,
//! and all its plans run over them there ([`crate::in_flight`]).

use crate::batches::{self, Allowance, Batch, Round};
use crate::context::{Gpu, IN_FLIGHT};
use crate::in_flight::WholeField;
use crate::problem::GpuProblem;
use crate::readback::{
    Before, FigureInputs, InFlight, Input, ReadbackJob, ReadbackStep, Returned, StageLaunch, Wanted,
};
use crate::records::FigureColumn;
use crate::waiting::wait;
use crate::{compose, records};
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::cut::{CutLayers, CutStats, PlannedField, cut_in_turn};
use gearcut_core::dexel::figures::{FieldFigures, LinesAt};
use gearcut_core::dexel::{Field, Layer};
use gearcut_core::error::Error;
use gearcut_core::passes::CutPlan;
use gearcut_shaders::{QUAD_ROWS, Rows, WORKGROUP_THREADS, planar_flank};
use wgpu::BufferUsages as Use;

/// Bytes of a dexel: height and pass.
const DEXEL_BYTES: usize = 8;
/// Columns of a field that is made on the device at most: workgroups in one dimension.
const MOST_COLUMNS: usize = 65_535;

impl WholeField for PlannedField {
    type Inputs = FieldInputs;
    const STAGE: &'static str = planar_flank(Rows::Many).name;
    const RECORD_USAGE: Use = Use::UNIFORM;

    /// It fits if its dexels do through all plans, and every plan is one batch.
    fn compose(&self, gpu: &Gpu) -> Option<FieldInputs> {
        let Allowance { buffer_bytes, batch_bytes } = gpu.allowance();
        let bytes = held_bytes(self);
        let fits = self.field.columns.len() <= MOST_COLUMNS && bytes <= buffer_bytes && 2 * bytes <= batch_bytes;
        if fits { FieldInputs::compose(gpu, self, bytes) } else { None }
    }

    fn bytes(inputs: &FieldInputs) -> u64 {
        inputs.bytes
    }

    fn job<'a>(inputs: &'a FieldInputs, gpu: &'a Gpu) -> ReadbackJob<'a> {
        inputs.job(gpu)
    }

    fn layers(&self, _: FieldInputs, left: Returned) -> CutLayers {
        cut_layers(self, left)
    }

    fn cut_in_batches(&self, gpu: &Gpu) -> Result<CutLayers, Error> {
        cut_in_turn(gpu, self, |_, _| ())
    }

    fn cut_natively(&self, native: Cpu) -> Result<CutLayers, Error> {
        cut_in_turn(&native, self, |_, _| ())
    }
}

impl Gpu {
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
            let (jobs, device_ns) = wait(in_flight.collect(&self.device))?;
            let Returned { layers, unconverged: short, .. } = &jobs[0];
            let Layer { heights_mm, passes } = &layers[0];
            for (index, column) in batch.columns.enumerate() {
                let (dexels, there) = (column * rows..(column + 1) * rows, index * padded..index * padded + rows);
                result.heights_mm[dexels.clone()].copy_from_slice(&heights_mm[there.clone()]);
                result.passes[dexels].copy_from_slice(&passes[there]);
            }
            unconverged += u64::from(short[0]);
            self.log().count(PlannedField::STAGE, device_ns);
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
            let in_flight = self.send_jobs::<PlannedField>(&[ReadbackJob {
                before: Before::Layer(&heights_mm, &passes),
                rays: &[],
                steps: vec![composed.step(self)],
                wanted: Wanted::Dexels,
            }])?;
            waiting.push((batch, in_flight));
        }
        waiting.into_iter().try_for_each(collect)?;
        Ok((result, unconverged))
    }
}

/// Lines of a field of which figures come back, where these are fewer bytes than the dexels.
fn figures_at(planned: &PlannedField) -> Option<LinesAt> {
    planned.lines.filter(|_| DEXEL_BYTES * planned.field.rows() > size_of::<FigureColumn>())
}

/// Bytes of the dexels of a field that are kept on the device.
fn held_bytes(planned: &PlannedField) -> u64 {
    let PlannedField { field, plans, .. } = planned;
    let layers = if figures_at(planned).is_some() { plans.len() } else { plans.len() + 1 };
    (DEXEL_BYTES * batches::padded(field.rows()) * field.columns.len() * layers) as u64
}

/// What is left of a field.
fn cut_layers(planned: &PlannedField, left: Returned) -> CutLayers {
    let PlannedField { field, plans, .. } = planned;
    let stats = CutStats {
        dexels: (field.len() * plans.len()) as u64,
        dexel_passes: plans.iter().map(CutPlan::dexel_passes).sum(),
        unconverged: left.unconverged.iter().map(|&of_step| u64::from(of_step)).sum(),
    };
    let rows = field.rows();
    if left.figures.is_empty() {
        let layers = left.layers.into_iter().map(|layer| unpadded(layer, rows)).collect();
        return CutLayers { layers, figures: None, stats };
    }
    let last = left.figures.len() - 1;
    let profile = Layer {
        heights_mm: left.figures[last].iter().map(|column| column.profile_mm).collect(),
        passes: left.figures[last].iter().map(|column| column.profile_pass).collect(),
    };
    let figures = FieldFigures {
        heights: left.figures.iter().map(|columns| columns.iter().map(|of| of.heights(rows)).collect()).collect(),
        stock: left.figures[..last].iter().map(|columns| columns.iter().map(|of| of.stock(rows)).collect()).collect(),
        profile,
        along: unpadded(left.along, rows),
    };
    CutLayers { layers: Vec::new(), figures: Some(figures), stats }
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
fn unpadded(left: Layer, rows: usize) -> Layer {
    let padded = batches::padded(rows);
    if padded == rows {
        return left;
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

/// What a field needs that the device takes whole, composed.
pub(crate) struct FieldInputs {
    /// Bytes of its dexels through all plans.
    bytes: u64,
    launch: records::Launch,
    /// Height of every column before the first plan.
    blank_mm: Vec<f32>,
    /// Lowest height that every column records.
    low_mm: Vec<f32>,
    steps: Vec<StepInputs>,
    /// Lines of which figures come back; nothing: all dexels do.
    figures: Option<(records::FigureLaunch, LinesAt)>,
}

impl FieldInputs {
    fn compose(gpu: &Gpu, planned: &PlannedField, bytes: u64) -> Option<Self> {
        let PlannedField { field, plans, .. } = planned;
        let launch = launch(gpu, field.rows());
        let whole = |plan| batches::batches(plan, gpu.allowance(), gpu.rows).ok().filter(|all| all.len() == 1);
        let whole: Vec<Vec<Batch>> = plans.iter().map(whole).collect::<Option<_>>()?;
        let steps = plans.iter().zip(&whole).map(|(plan, whole)| StepInputs::compose(gpu, field, plan, &whole[0]));
        let figures = figures_at(planned).map(|lines| {
            let records::Launch { rows, quads, .. } = launch;
            (records::FigureLaunch { rows, quads, profile_row: lines.row as u32 }, lines)
        });
        Some(Self {
            bytes,
            launch,
            blank_mm: field.columns.iter().map(|column| column.blank_mm as f32).collect(),
            low_mm: field.columns.iter().map(|column| column.low_mm as f32).collect(),
            steps: steps.collect(),
            figures,
        })
    }

    fn job<'a>(&'a self, gpu: &'a Gpu) -> ReadbackJob<'a> {
        let columns = self.blank_mm.len() as u32;
        let column_bytes = self.launch.quads as usize * QUAD_ROWS * size_of::<f32>();
        let workgroups = [self.launch.quads.div_ceil(WORKGROUP_THREADS), columns];
        let launch = || Input::Shared { label: "launch", bytes: bytemuck::bytes_of(&self.launch), usage: Use::UNIFORM };
        let of_columns =
            |label, mm: &'a [f32]| Input::Shared { label, bytes: bytemuck::cast_slice(mm), usage: Use::STORAGE };
        ReadbackJob {
            before: Before::Uncut {
                pipeline: &gpu.planar_uncut[0],
                inputs: [launch(), of_columns("blank", &self.blank_mm)],
                workgroups,
                bytes: column_bytes * self.blank_mm.len(),
            },
            rays: &[],
            steps: self.steps.iter().map(|step| step.step(gpu)).collect(),
            wanted: self.figures.as_ref().map_or(Wanted::Dexels, |(figure_launch, lines)| {
                let bytes = bytemuck::bytes_of(figure_launch);
                Wanted::Figures(FigureInputs {
                    pipeline: &gpu.flank_figures[0],
                    inputs: [
                        Input::Shared { label: "figure launch", bytes, usage: Use::UNIFORM },
                        of_columns("low", &self.low_mm),
                    ],
                    columns,
                    along: lines.column * column_bytes..(lines.column + 1) * column_bytes,
                })
            }),
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
