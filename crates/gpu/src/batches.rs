//! Cuts a field of any size into batches that a device can hold.
//!
//! In: the plan, what the device allows. Out: batches of whole columns.

use super::launches::WORKGROUPS;
use super::problem::GpuProblem;
use super::records;
use gearcut_core::passes::CutPlan;
use gearcut_shaders::{QUAD_ROWS, Rows, WORKGROUP_THREADS};
use std::ops::Range;

/// Dexels of a batch at most: 32 MB of heights and ids; the next batch is composed while one is cut.
const BATCH_DEXELS: usize = 4 << 20;
/// Bytes of a record.
const RECORD_BYTES: u64 = size_of::<records::FlankPass>() as u64;

/// What a device and the memory limit allow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Allowance {
    /// Bytes that one buffer may have.
    pub buffer_bytes: u64,
    /// Bytes that all buffers of one batch may have together.
    pub batch_bytes: u64,
}

/// Columns of a tile, which share its records.
#[derive(Debug, Clone, PartialEq)]
pub struct TileColumns {
    /// Tile of the plan.
    pub tile: usize,
    /// Columns of the field.
    pub columns: Range<usize>,
}

/// Columns that lie on the device together.
#[derive(Debug, Clone, PartialEq)]
pub struct Batch {
    /// Columns of the field.
    pub columns: Range<usize>,
    /// The same tile by tile.
    pub pieces: Vec<TileColumns>,
}

/// Bytes that a batch needs: dexels once on the device and once to come back, columns, records.
pub fn batch_bytes(rows: usize, columns: usize, records: usize) -> u64 {
    let dexels = (padded(rows) * columns) as u64;
    dexels * 16 + (columns * size_of::<records::FlankColumn>()) as u64 + records as u64 * RECORD_BYTES
}

/// Rows of a column filled up to whole quads.
pub fn padded(rows: usize) -> usize {
    rows.next_multiple_of(QUAD_ROWS)
}

/// Batches of a plan, covering all columns once. Records of a batch keep to half of its memory, unless a single tile
/// has more.
///
/// # Errors
/// Not even a single column with a record fits.
pub fn batches(plan: &CutPlan, allowance: Allowance, rows_per_thread: Rows) -> Result<Vec<Batch>, GpuProblem> {
    let rows = plan.row_phases.len();
    if rows == 0 {
        return Ok(Vec::new());
    }
    let dexels = (allowance.buffer_bytes / 4).min(allowance.batch_bytes / 32).min(BATCH_DEXELS as u64);
    // Columns that fit the memory and, as one tile, one dispatch.
    let dispatch_columns = WORKGROUPS * WORKGROUP_THREADS as usize / rows_per_thread.threads_per_column(rows);
    // A column longer than the usual batch is a batch of its own as long as the memory allows it.
    let column_fits =
        batch_bytes(rows, 1, 1) <= allowance.batch_bytes && padded(rows) as u64 * 4 <= allowance.buffer_bytes;
    if !column_fits || dispatch_columns == 0 {
        return Err(GpuProblem::OutOfMemory {
            reason: format!(
                "one column of {rows} rows needs {} bytes, {} are allowed",
                batch_bytes(rows, 1, 1),
                allowance.batch_bytes.min(4 * allowance.buffer_bytes)
            ),
        });
    }
    let columns_at_most = (dexels as usize / padded(rows)).clamp(1, dispatch_columns);
    let records_at_most = (allowance.buffer_bytes.min(allowance.batch_bytes / 2) / RECORD_BYTES) as usize;
    let mut batches: Vec<Batch> = Vec::new();
    let mut in_records = 0;
    for (index, tile) in plan.tiles.iter().enumerate() {
        for start in tile.columns.clone().step_by(columns_at_most) {
            let columns = start..(start + columns_at_most).min(tile.columns.end);
            let piece = TileColumns { tile: index, columns: columns.clone() };
            let fits = |batch: &&mut Batch| {
                batch.columns.end == columns.start
                    && columns.end - batch.columns.start <= columns_at_most
                    && in_records + tile.records.len() <= records_at_most
            };
            match batches.last_mut().filter(fits) {
                Some(batch) => {
                    batch.columns.end = columns.end;
                    batch.pieces.push(piece);
                    in_records += tile.records.len();
                }
                None => {
                    batches.push(Batch { columns, pieces: vec![piece] });
                    in_records = tile.records.len();
                }
            }
        }
    }
    Ok(batches)
}
