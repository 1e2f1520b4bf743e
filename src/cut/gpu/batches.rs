//! Cuts a field of any size into batches that a device can hold.
//!
//! In: the plan, what the device allows. Out: batches of whole columns, each with rounds of records. Dexels of a batch
//! stay on the device through its rounds, which run in order, so that a tile with more records than one buffer holds is
//! cut like any other.

use super::problem::GpuProblem;
use super::{compose, records};
use crate::passes::CutPlan;
use std::ops::Range;

/// Dexels of a batch at most: 32 MB of heights and ids; the next batch is composed while one is cut.
const BATCH_DEXELS: usize = 4 << 20;
/// (Dexel, pass) pairs of a launch at most: a twentieth of a second on a GPU of 1e10 pairs a second. Display drivers
/// reset devices that do not answer for two seconds, so even one that is twenty times slower stays below that.
const LAUNCH_PAIRS: u64 = 1 << 29;
/// Workgroups in one dimension: what every WebGPU device has.
const WORKGROUPS: usize = 65535;

/// What a device and the memory limit allow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Allowance {
    /// Bytes that one buffer may have.
    pub buffer_bytes: u64,
    /// Bytes that all buffers of one batch may have together.
    pub batch_bytes: u64,
}

/// Columns of a tile that share records.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Tile of the plan.
    pub tile: usize,
    /// Columns of the field.
    pub columns: Range<usize>,
    /// Records of the plan.
    pub records: Range<usize>,
}

/// Columns that lie on the device together.
#[derive(Debug, Clone, PartialEq)]
pub struct Batch {
    /// Columns of the field.
    pub columns: Range<usize>,
    /// Launches, in order; all of them together visit every record of every column.
    pub rounds: Vec<Vec<Piece>>,
}

/// Bytes that a batch needs: dexels once on the device and once to come back, columns, records of its largest round.
pub fn batch_bytes(rows: usize, columns: usize, records: usize) -> u64 {
    let dexels = (rows * columns) as u64;
    dexels * 16 + (columns * size_of::<records::Column>() + records * size_of::<records::PassRecord>()) as u64
}

/// Batches of a plan, covering all columns once and every record of every tile.
///
/// # Errors
/// Not even a single column, or a single record with it, fits.
pub fn batches(plan: &CutPlan, allowance: Allowance) -> Result<Vec<Batch>, GpuProblem> {
    let rows = plan.row_phases.len();
    if rows == 0 {
        return Ok(Vec::new());
    }
    // Half of the batch's memory for dexels, half for records.
    let dexels = (allowance.buffer_bytes / 4).min(allowance.batch_bytes / 32).min(BATCH_DEXELS as u64);
    // Columns that fit the memory and, as one tile, one dispatch.
    let threads_per_column = super::pipeline::threads_per_column(rows);
    let dispatch_columns = WORKGROUPS * super::WORKGROUP_THREADS as usize / threads_per_column;
    // A column longer than the usual batch is a batch of its own as long as the memory allows it.
    let fits_alone = batch_bytes(rows, 1, 1) <= allowance.batch_bytes && rows as u64 * 4 <= allowance.buffer_bytes;
    let columns_at_most = (dexels as usize / rows).max(usize::from(fits_alone)).min(dispatch_columns);
    let record_bytes = size_of::<records::PassRecord>() as u64;
    let records_at_most = (allowance.buffer_bytes.min(allowance.batch_bytes / 2) / record_bytes).max(1) as usize;
    if columns_at_most == 0 {
        return Err(GpuProblem::OutOfMemory {
            reason: format!(
                "one column of {rows} rows needs {} bytes, {} are allowed",
                batch_bytes(rows, 1, 1),
                allowance.batch_bytes.min(4 * allowance.buffer_bytes)
            ),
        });
    }
    let mut batches: Vec<Batch> = Vec::new();
    for (index, tile) in plan.tiles.iter().enumerate() {
        for start in tile.columns.clone().step_by(columns_at_most) {
            let columns = start..(start + columns_at_most).min(tile.columns.end);
            let piece = Piece { tile: index, columns: columns.clone(), records: tile.records.clone() };
            let round_records = records_at_most.min((LAUNCH_PAIRS / (rows * columns.len()) as u64).max(1) as usize);
            if tile.records.len() > round_records {
                // Its own batch, with several rounds over the same columns.
                let rounds = tile
                    .records
                    .clone()
                    .step_by(round_records)
                    .map(|r| vec![Piece { records: r..(r + round_records).min(tile.records.end), ..piece.clone() }])
                    .collect();
                batches.push(Batch { columns, rounds });
                continue;
            }
            match batches.last_mut().filter(|batch| takes(batch, &piece, rows, columns_at_most, records_at_most)) {
                Some(batch) => {
                    batch.columns.end = columns.end;
                    batch.rounds[0].push(piece);
                }
                None => batches.push(Batch { columns, rounds: vec![vec![piece]] }),
            }
        }
    }
    Ok(batches)
}

/// Whether a batch of one round takes one more piece.
fn takes(batch: &Batch, piece: &Piece, rows: usize, columns_at_most: usize, records_at_most: usize) -> bool {
    let [round] = batch.rounds.as_slice() else { return false };
    let pairs = |p: &Piece| (p.columns.len() * p.records.len() * rows) as u64;
    batch.columns.end == piece.columns.start
        && piece.columns.end - batch.columns.start <= columns_at_most
        && round.iter().map(|p| p.records.len()).sum::<usize>() + piece.records.len() <= records_at_most
        && round.iter().map(pairs).sum::<u64>() + pairs(piece) <= LAUNCH_PAIRS
        && round.len() < WORKGROUPS
}

/// One round as the shader reads it.
#[derive(Debug, Default)]
pub struct Round {
    /// Tiles, one for each piece.
    pub tiles: Vec<records::Tile>,
    /// Records of all of them.
    pub records: Vec<records::PassRecord>,
    /// Columns of the widest tile.
    pub widest: usize,
}

impl Round {
    /// No pose changes during its stroke: one phase serves for all rows.
    pub fn is_frozen(&self) -> bool {
        let constant = |c: &[f32; 4]| c[1..] == [0.0; 3];
        self.records.iter().all(|r| [&r.cos, &r.sin, &r.x_mm, &r.y_mm].into_iter().all(constant))
    }

    /// Composes the pieces of a round of `batch`.
    pub fn new(
        pieces: &[Piece],
        batch: &Batch,
        plan: &CutPlan,
        field: &crate::dexel::Field,
        edge: &crate::tool::edge::Edge,
        cells: &compose::EdgeCells,
    ) -> Self {
        let mut round = Self::default();
        for piece in pieces {
            let middle = compose::middle(&field.columns[plan.tiles[piece.tile].columns.clone()]);
            round.tiles.push(records::Tile {
                first_column: (piece.columns.start - batch.columns.start) as u32,
                column_count: piece.columns.len() as u32,
                first_record: round.records.len() as u32,
                record_count: piece.records.len() as u32,
            });
            round.records.extend(
                plan.records[piece.records.clone()]
                    .iter()
                    .map(|record| cells.record(record, &edge.segments[record.segment as usize], &middle)),
            );
            round.widest = round.widest.max(piece.columns.len());
        }
        round
    }
}
