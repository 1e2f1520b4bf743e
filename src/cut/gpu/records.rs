//! What the shaders read, byte for byte: the only place where Rust and WGSL share a layout.
//!
//! Members stand in the order of `shaders/shared/records.wgsl` and are f32 and u32 alone; a test asks naga for names,
//! offsets and sizes and compares.

use bytemuck::{Pod, Zeroable};

/// Rows of one launch.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Launch {
    /// Rows of the field, along the tooth.
    pub rows: u32,
    /// Threads that share the rows of one column.
    pub threads_per_column: u32,
}

/// Columns that visit the same passes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Tile {
    /// First column of the batch.
    pub first_column: u32,
    /// Number of columns.
    pub column_count: u32,
    /// First record of the batch.
    pub first_record: u32,
    /// Number of records.
    pub record_count: u32,
}

/// One ray of the transverse plane, in the frame of its tile.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Column {
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
pub struct PassRecord {
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
    /// Table: x of the base cell. Arc: x of the base point against the centre, mm.
    pub base_x_mm: f32,
    /// Arc: y of the base point against the centre, mm.
    pub base_y_mm: f32,
    /// Arc: square of the base point's distance from the centre less that of the radius, mm^2.
    pub arc_excess_mm2: f32,
    /// Table: cells in a millimetre; 0 for an arc.
    pub cells_per_mm: f32,
    /// Table: width of a cell, mm.
    pub cell_width_mm: f32,
    /// Table: first cell against the base cell.
    pub first_cell: f32,
    /// Table: last cell against the base cell.
    pub last_cell: f32,
    /// Table: base cell among the cells of all segments.
    pub base_cell: u32,
    /// Id of the pass.
    pub pass_id: u32,
}
