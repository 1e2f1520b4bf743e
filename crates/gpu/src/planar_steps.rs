//! What plans need over the columns of fields, composed and put together for a device.
//!
//! In: plans with their fields, or parts of these. Out: steps of a submission, each over the columns of all its fields.
//! Every tile says where its columns, dexels, records and phases lie among those of all.

use crate::batches::{self, Batch};
use crate::context::Gpu;
use crate::launches::{TileVisit, launches};
use crate::readback::{Input, ReadbackStep};
use crate::{compose, records};
use gearcut_core::dexel::Field;
use gearcut_core::passes::CutPlan;
use gearcut_shaders::{QUAD_ROWS, ROUND_RECORDS, WORKGROUP_THREADS, planar_variant};

/// (Dexel, pass) pairs of a launch at most: a twentieth of a second on a GPU of 1e10 pairs a second. Display drivers
/// reset devices that do not answer for two seconds, so even one that is twenty times slower stays below that.
const LAUNCH_PAIRS: u64 = 1 << 29;

/// What a plan needs over a batch, composed; places count from the batch's first.
pub struct PlanarStep {
    columns: Vec<records::FlankColumn>,
    /// Phases of a column's rows, in quads, the last one filled up with the last phase.
    row_phases: Vec<f32>,
    records: Vec<records::FlankPass>,
    visits: Vec<TileVisit<records::FlankTile>>,
}

impl PlanarStep {
    /// Composed.
    pub fn compose(gpu: &Gpu, field: &Field, plan: &CutPlan, batch: &Batch) -> Self {
        let rows = field.rows();
        let columns = batch.pieces.iter().flat_map(|piece| {
            let tile = &plan.tiles[piece.tile];
            let middle = compose::middle(&field.columns[tile.columns.clone()]);
            field.columns[piece.columns.clone()].iter().map(move |ray| compose::column(ray, tile.origin_mm, &middle))
        });
        let mut row_phases: Vec<f32> = plan.row_phases.iter().map(|&tau| tau as f32).collect();
        row_phases.resize(batches::padded(rows), row_phases.last().copied().unwrap_or_default());
        let mut step = Self { columns: columns.collect(), row_phases, records: Vec::new(), visits: Vec::new() };
        let [quads, threads_per_column] =
            [rows.div_ceil(QUAD_ROWS), gpu.rows.threads_per_column(rows)].map(|n| n as u32);
        for piece in &batch.pieces {
            let tile = &plan.tiles[piece.tile];
            let rays = &field.columns[tile.columns.clone()];
            let first = step.records.len();
            for record in &plan.records[tile.records.clone()] {
                let segment = &plan.segments[record.segment as usize];
                compose::records(record, segment, rays, tile.origin_mm, &mut step.records);
            }
            let own = &step.records[first..];
            let first_column = (piece.columns.start - batch.columns.start) as u32;
            let column_count = piece.columns.len() as u32;
            let dexels = (piece.columns.len() * rows) as u64;
            // A shader that knows no arcs is quicker, and so is one whose poses rest.
            let arcs = own.iter().any(|record| record.is_arc == 1);
            let at_once = ((LAUNCH_PAIRS / dexels) as usize).clamp(1, ROUND_RECORDS as usize);
            for (round, some) in own.chunks(at_once).enumerate() {
                step.visits.push(TileVisit {
                    tile: records::FlankTile {
                        first_column,
                        column_count,
                        first_record: (first + round * at_once) as u32,
                        record_count: some.len() as u32,
                        first_quad: first_column * quads,
                        quads,
                        rows: rows as u32,
                        threads_per_column,
                        first_phase: 0,
                        field: 0,
                    },
                    round,
                    variant: planar_variant(some.iter().all(is_frozen), arcs),
                    workgroups: (column_count * threads_per_column).div_ceil(WORKGROUP_THREADS),
                    pairs: dexels * some.len() as u64,
                });
            }
        }
        step
    }

    /// Bytes of the records.
    pub fn record_bytes(&self) -> usize {
        size_of_val(self.records.as_slice())
    }
}

/// Whether the pose does not change during the stroke: one phase serves for all rows.
fn is_frozen(record: &records::FlankPass) -> bool {
    [&record.cos, &record.sin, &record.x_mm, &record.y_mm].into_iter().all(|c| c[1..] == [0.0; 3])
}

/// Steps of some fields, each with its first quad among those of all.
pub fn steps<'a>(gpu: &'a Gpu, fields: &[(u32, &'a [PlanarStep])]) -> Vec<ReadbackStep<'a>> {
    let most = fields.iter().map(|(_, own)| own.len()).max().unwrap_or(0);
    (0..most).map(|index| step(gpu, fields, index)).collect()
}

fn step<'a>(gpu: &'a Gpu, fields: &[(u32, &'a [PlanarStep])], index: usize) -> ReadbackStep<'a> {
    let (mut columns, mut records, mut row_phases) = (Vec::new(), Vec::new(), Vec::new());
    let [mut first_column, mut first_record, mut first_phase] = [0; 3];
    let mut visits = Vec::new();
    for (field, (first_quad, own)) in fields.iter().enumerate() {
        let Some(own) = own.get(index) else { continue };
        visits.extend(own.visits.iter().map(|visit| {
            let mut visit = *visit;
            let tile = &mut visit.tile;
            tile.first_column += first_column;
            tile.first_record += first_record;
            tile.first_quad += first_quad;
            tile.first_phase = first_phase;
            tile.field = field as u32;
            visit
        }));
        first_column += own.columns.len() as u32;
        first_record += own.records.len() as u32;
        first_phase += (own.row_phases.len() / QUAD_ROWS) as u32;
        columns.push(bytemuck::cast_slice(&own.columns));
        records.push(bytemuck::cast_slice(&own.records));
        row_phases.push(bytemuck::cast_slice(&own.row_phases));
    }
    ReadbackStep {
        inputs: vec![
            Input::Tiles,
            Input::Shared("columns", columns),
            Input::Shared("records", records),
            Input::Shared("row phases", row_phases),
        ],
        launches: launches(&gpu.planar_flank, visits, LAUNCH_PAIRS),
    }
}
