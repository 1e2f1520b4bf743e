//! What the shaders read, byte for byte: the only place where Rust and WGSL share a layout.
//!
//! Members stand in the order of `shaders/shared/*records.wgsl` and are f32 and u32 alone; a test asks naga for names,
//! offsets and sizes and compares.

use bytemuck::{Pod, Zeroable};
use gearcut_core::dexel::figures::{ColumnHeights, ColumnStock, NO_HEIGHTS, RowHeight};

/// A field among those of a submission.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FlankField {
    /// Its first column.
    pub first_column: u32,
    /// Number of columns.
    pub column_count: u32,
    /// Its first quad of rows.
    pub first_quad: u32,
    /// Quads of rows in a column, the last one filled up.
    pub quads: u32,
    /// Rows, along the tooth.
    pub rows: u32,
    /// Row whose dexels come back.
    pub profile_row: u32,
}

/// Columns that visit the same passes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FlankTile {
    /// First column of the step.
    pub first_column: u32,
    /// Number of columns.
    pub column_count: u32,
    /// First record of the step.
    pub first_record: u32,
    /// Number of records.
    pub record_count: u32,
    /// First quad of rows of its first column.
    pub first_quad: u32,
    /// Quads of rows in a column, the last one filled up.
    pub quads: u32,
    /// Rows of its field, along the tooth.
    pub rows: u32,
    /// Threads that share the rows of one column.
    pub threads_per_column: u32,
    /// First quad of its field's row phases.
    pub first_phase: u32,
    /// Its field among those of the submission.
    pub field: u32,
}

/// One ray of the transverse plane, in the frame of its tile.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FlankColumn {
    /// Origin against the tile's origin, mm.
    pub offset_mm: [f32; 2],
    /// Unit direction.
    pub normal: [f32; 2],
    /// Direction less that of the tile's middle ray.
    pub normal_change: [f32; 2],
    /// Lowest height that the ray records, mm.
    pub low_mm: f32,
    /// Nothing.
    pub padding: f32,
}

/// One pass of one segment over one tile; coefficients belong to tau^0 to tau^3.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FlankPass {
    /// Cosine of the rotation from the tile's frame into the segment's.
    pub cos: [f32; 4],
    /// Sine of it.
    pub sin: [f32; 4],
    /// x of the tile's middle ray at the start height, against the segment's base point, mm.
    pub x_mm: [f32; 4],
    /// y of it.
    pub y_mm: [f32; 4],
    /// Height where the iteration starts, mm.
    pub start_mm: f32,
    /// First y that belongs to the segment, against the base point, mm.
    pub y_from_mm: f32,
    /// Last y that belongs to it.
    pub y_to_mm: f32,
    /// Id of the pass.
    pub pass_id: u32,
    /// Table: coefficients of t to t^4, t = y against the base point. Arc: base point against the centre, mm; square of
    /// its distance from the centre less that of the radius, mm^2; nothing.
    pub curve: [f32; 4],
    /// Table: coefficient of t^5.
    pub curve_5: f32,
    /// 1 for an arc, 0 for a table.
    pub is_arc: u32,
    /// Nothing.
    pub padding_1: u32,
    /// Nothing.
    pub padding_2: u32,
}

/// Figures of one column after an operation; rows count from its first one.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FigureColumn {
    /// Lowest height, mm.
    pub lowest_mm: f32,
    /// Its row.
    pub lowest_row: u32,
    /// Lowest height of the dexels that a pass has reached, mm.
    pub reached_low_mm: f32,
    /// Its row; the number of rows if there is none.
    pub reached_low_row: u32,
    /// Highest of them, mm.
    pub reached_high_mm: f32,
    /// Its row.
    pub reached_high_row: u32,
    /// Dexels that no pass has reached.
    pub untouched: u32,
    /// Dexels as low as their rays record.
    pub at_bottom: u32,
    /// Smallest stock over the last operation, mm.
    pub stock_low_mm: f32,
    /// Its row.
    pub stock_low_row: u32,
    /// Largest, mm.
    pub stock_high_mm: f32,
    /// Its row.
    pub stock_high_row: u32,
    /// Sum, mm.
    pub stock_sum_mm: f32,
    /// Height of the profile's dexel, mm.
    pub profile_mm: f32,
    /// Its pass.
    pub profile_pass: u32,
}

impl FigureColumn {
    /// Heights of a column of so many rows.
    pub fn heights(&self, rows: usize) -> ColumnHeights {
        let reached = [(self.reached_low_mm, self.reached_low_row), (self.reached_high_mm, self.reached_high_row)]
            .map(row_height);
        ColumnHeights {
            lowest: row_height((self.lowest_mm, self.lowest_row)),
            reached: if self.untouched as usize == rows { NO_HEIGHTS } else { reached },
            untouched: self.untouched,
            at_bottom: self.at_bottom,
        }
    }

    /// Its stock.
    pub fn stock(&self, rows: usize) -> ColumnStock {
        let range =
            [(self.stock_low_mm, self.stock_low_row), (self.stock_high_mm, self.stock_high_row)].map(row_height);
        ColumnStock {
            range: if self.untouched as usize == rows { NO_HEIGHTS } else { range },
            sum_mm: f64::from(self.stock_sum_mm),
            untouched: self.untouched,
        }
    }
}

fn row_height((height_mm, row): (f32, u32)) -> RowHeight {
    RowHeight { height_mm, row }
}
