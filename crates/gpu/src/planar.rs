//! Flanks cut by strokes: batches of columns, one in work while the next is composed.

use crate::batches::{self, Batch, Round};
use crate::context::{Gpu, IN_FLIGHT};
use crate::problem::GpuProblem;
use crate::readback::{self, InFlight, Input, Returned, Shipment, StageLaunch};
use crate::{compose, records};
use gearcut_core::dexel::{Field, Layer};
use gearcut_core::passes::CutPlan;
use gearcut_shaders::{QUAD_ROWS, Rows, WORKGROUP_THREADS, planar_flank};

/// Name of the stage.
const NAME: &str = planar_flank(Rows::Many).name;

impl Gpu {
    /// Heights and passes of the whole field, the layer untouched.
    pub(crate) fn cut_on_device(
        &self,
        field: &Field,
        plan: &CutPlan,
        layer: &Layer,
    ) -> Result<(Layer, u64), GpuProblem> {
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
            self.log().count(NAME, device_ns);
            Ok(())
        };
        for batch in batches::batches(plan, self.allowance(), self.rows)? {
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
        let columns: Vec<records::FlankColumn> = columns.collect();
        let rounds = Round::compose(batch, plan, field);
        let launch = records::Launch {
            rows: rows as u32,
            quads: (row_phases.len() / QUAD_ROWS) as u32,
            threads_per_column: gpu.rows.threads_per_column(rows) as u32,
        };
        let records: Vec<Vec<records::FlankPass>> = rounds.iter().map(Round::padded_records).collect();
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
                stage: NAME,
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
