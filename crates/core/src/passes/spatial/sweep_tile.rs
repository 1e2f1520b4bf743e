//! Tiles of a spatial field and their cells: the dexels that visit the same sweeps.

use glam::DVec3;
use std::ops::Range;

/// Columns of a tile at most.
pub const TILE_COLUMNS: usize = 16;
/// Rows of a tile at most, a power of two: whole chunks of every backend.
pub const TILE_ROWS: usize = 32;
/// Cells of a tile along each side: a record says in which it can be lowest.
pub const CELLS: usize = 4;
/// Columns and rows of a cell.
pub const CELL: [usize; 2] = [TILE_COLUMNS / CELLS, TILE_ROWS / CELLS];
/// Columns and rows of a cell of a patch, whose cells a device searches: two or four waves of it. Cells of 16 by 32
/// visit twice as many records, and those of 4 by 8 take as long to search as to cut.
pub const PATCH_CELL: [usize; 2] = [8, 16];

/// Some dexels and the sweeps that they visit.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepTile {
    /// Columns of the field.
    pub columns: Range<usize>,
    /// Rows of the field.
    pub rows: Range<usize>,
    /// Columns and rows of its cells; the last ones may have fewer.
    pub cell: [usize; 2],
    /// Origin of the tile's frame, gear frame, mm; axes are parallel to the gear's.
    pub origin_mm: DVec3,
    /// Records in [`super::sweep_plan::SweepPlan::records`], in order of pass id.
    pub records: Range<usize>,
}

impl SweepTile {
    /// Cell of a dexel: bit of [`super::sweep::SweepRecord::cells`].
    pub fn cell(&self, column: usize, row: usize) -> usize {
        cell_of([self.columns.start, self.rows.start], self.cell, [column, row])
    }

    /// Columns and rows of its cells, in the order of their bits.
    pub fn cells(&self) -> impl Iterator<Item = [Range<usize>; 2]> + use<> {
        let parts = |lines: &Range<usize>, of: usize| {
            let end = lines.end;
            lines.clone().step_by(of).map(move |first| first..end.min(first + of))
        };
        let rows = parts(&self.rows, self.cell[1]);
        parts(&self.columns, self.cell[0])
            .flat_map(move |columns| rows.clone().map(move |rows| [columns.clone(), rows]))
    }

    /// Column and row of the middle ray.
    pub fn middle(&self) -> [usize; 2] {
        [&self.columns, &self.rows].map(|lines| usize::midpoint(lines.start, lines.end - 1))
    }
}

fn cell_of(from: [usize; 2], [columns, rows]: [usize; 2], [column, row]: [usize; 2]) -> usize {
    CELLS * ((column - from[0]) / columns) + (row - from[1]) / rows
}

/// Cells, as bits, of some columns and rows of a tile that begins at this column and row.
pub(super) fn cells_between(from: [usize; 2], [columns, rows]: [Range<usize>; 2]) -> u16 {
    columns
        .flat_map(|column| rows.clone().map(move |row| cell_of(from, CELL, [column, row])))
        .fold(0, |cells, cell| cells | 1 << cell)
}
