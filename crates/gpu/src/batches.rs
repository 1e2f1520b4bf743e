//! Cuts a field of any size into batches that a device can hold, and a batch's work into rounds that one launch can do.
//!
//! In: the plan, what the device allows. Out: batches of whole columns; rounds of tiles with their composed records.
//! Dexels of a batch stay on the device through its rounds, which run in order, so that a tile with more records than
//! one launch may have is cut like any other.

use super::problem::GpuProblem;
use super::{compose, records};
use gearcut_core::dexel::Field;
use gearcut_core::passes::CutPlan;
use gearcut_shaders::{QUAD_ROWS, Rows, WORKGROUP_THREADS, planar_variant};
use std::ops::Range;

/// Dexels of a batch at most: 32 MB of heights and ids; the next batch is composed while one is cut.
const BATCH_DEXELS: usize = 4 << 20;
/// (Dexel, pass) pairs of a launch at most: a twentieth of a second on a GPU of 1e10 pairs a second. Display drivers
/// reset devices that do not answer for two seconds, so even one that is twenty times slower stays below that.
const LAUNCH_PAIRS: u64 = 1 << 29;
/// Workgroups in one dimension: what every WebGPU device has.
const WORKGROUPS: usize = 65535;
/// Records of a launch.
const ROUND_RECORDS: usize = gearcut_shaders::ROUND_RECORDS as usize;
/// Bytes of their buffer.
const ROUND_BYTES: u64 = (ROUND_RECORDS * size_of::<records::FlankPass>()) as u64;

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

/// Bytes that a batch needs: dexels once on the device and once to come back, columns, rounds of records.
pub fn batch_bytes(rows: usize, columns: usize, records: usize) -> u64 {
    let dexels = (padded(rows) * columns) as u64;
    dexels * 16
        + (columns * size_of::<records::FlankColumn>()) as u64
        + records.div_ceil(ROUND_RECORDS) as u64 * ROUND_BYTES
}

/// Rows of a column filled up to whole quads.
pub fn padded(rows: usize) -> usize {
    rows.next_multiple_of(QUAD_ROWS)
}

/// Batches of a plan, covering all columns once. Records of a batch keep to half of its memory, unless a single tile
/// has more.
///
/// # Errors
/// Not even a single column with a round of records fits.
pub fn batches(plan: &CutPlan, allowance: Allowance, rows_per_thread: Rows) -> Result<Vec<Batch>, GpuProblem> {
    let rows = plan.row_phases.len();
    if rows == 0 {
        return Ok(Vec::new());
    }
    let dexels = (allowance.buffer_bytes / 4).min(allowance.batch_bytes / 32).min(BATCH_DEXELS as u64);
    // Columns that fit the memory and, as one tile, one dispatch.
    let dispatch_columns = WORKGROUPS * WORKGROUP_THREADS as usize / rows_per_thread.threads_per_column(rows);
    // A column longer than the usual batch is a batch of its own as long as the memory allows it.
    let column_fits = batch_bytes(rows, 1, 1) <= allowance.batch_bytes
        && padded(rows) as u64 * 4 <= allowance.buffer_bytes
        && ROUND_BYTES <= allowance.buffer_bytes;
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
    let records_at_most = (allowance.batch_bytes / 2 / ROUND_BYTES).max(1) as usize * ROUND_RECORDS;
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

/// One launch as the shader reads it.
#[derive(Debug, Default)]
pub struct Round {
    /// Tiles, one for each piece.
    pub tiles: Vec<records::FlankTile>,
    /// Records of all of them.
    pub records: Vec<records::FlankPass>,
    /// Columns of the widest tile.
    pub widest: usize,
    /// (Dexel, pass) pairs.
    pairs: u64,
}

impl Round {
    /// Composes the rounds of `batch`; tiles that meet arcs go into rounds of their own, because a shader that knows no
    /// arcs is quicker.
    pub fn compose(batch: &Batch, plan: &CutPlan, field: &Field) -> Vec<Self> {
        let rows = field.rows();
        let mut of_kind = [Self::default(), Self::default()].map(|round| vec![round]);
        let mut composed = Vec::new();
        for piece in &batch.pieces {
            let tile = &plan.tiles[piece.tile];
            let columns = &field.columns[tile.columns.clone()];
            composed.clear();
            for record in &plan.records[tile.records.clone()] {
                let segment = &plan.segments[record.segment as usize];
                compose::records(record, segment, columns, tile.origin_mm, &mut composed);
            }
            let dexels = (piece.columns.len() * rows) as u64;
            let rounds = &mut of_kind[usize::from(composed.iter().any(|record| record.is_arc == 1))];
            let mut rest = composed.as_slice();
            while !rest.is_empty() {
                let last = rounds.len() - 1;
                let taken = rounds[last].room(dexels).min(rest.len());
                if taken == 0 {
                    rounds.push(Self::default());
                    continue;
                }
                rounds[last].take(piece, batch, dexels, &rest[..taken]);
                rest = &rest[taken..];
            }
        }
        of_kind.into_iter().flatten().filter(|round| !round.records.is_empty()).collect()
    }

    /// Variant of the shader that serves.
    pub fn variant(&self) -> usize {
        planar_variant(self.is_frozen(), self.records.iter().any(|record| record.is_arc == 1))
    }

    /// Records of a tile of so many dexels that the launch still takes; one at least if it is empty.
    fn room(&self, dexels: u64) -> usize {
        let by_pairs = (LAUNCH_PAIRS.saturating_sub(self.pairs) / dexels) as usize;
        if self.records.is_empty() {
            return by_pairs.clamp(1, ROUND_RECORDS);
        }
        if self.tiles.len() == WORKGROUPS {
            return 0;
        }
        by_pairs.min(ROUND_RECORDS - self.records.len())
    }

    fn take(&mut self, piece: &TileColumns, batch: &Batch, dexels: u64, records: &[records::FlankPass]) {
        self.tiles.push(records::FlankTile {
            first_column: (piece.columns.start - batch.columns.start) as u32,
            column_count: piece.columns.len() as u32,
            first_record: self.records.len() as u32,
            record_count: records.len() as u32,
        });
        self.records.extend(records);
        self.widest = self.widest.max(piece.columns.len());
        self.pairs += dexels * records.len() as u64;
    }

    /// No pose changes during its stroke: one phase serves for all rows.
    fn is_frozen(&self) -> bool {
        let constant = |c: &[f32; 4]| c[1..] == [0.0; 3];
        self.records.iter().all(|r| [&r.cos, &r.sin, &r.x_mm, &r.y_mm].into_iter().all(constant))
    }

    /// The records, filled up to what the shader declares.
    pub fn padded_records(&self) -> Vec<records::FlankPass> {
        let mut records = self.records.clone();
        records.resize(ROUND_RECORDS, bytemuck::Zeroable::zeroed());
        records
    }
}
