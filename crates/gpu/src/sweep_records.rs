//! What the host hands to `spatial_flank`, member by member.
//!
//! Members stand in the order of `shaders/shared/sweep_records.wgsl`; a test asks naga for names, offsets and sizes and
//! compares.

use bytemuck::{Pod, Zeroable};

/// Dexels that visit the same passes, in groups of rows.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SpatialTile {
    /// Direction of the tile's middle ray, and the lowest height that rays record, mm.
    pub middle: [f32; 4],
    /// First group of the submission.
    pub first_group: u32,
    /// Number of groups.
    pub group_count: u32,
    /// First record of the step.
    pub first_record: u32,
    /// Number of records.
    pub record_count: u32,
    /// First cell of its field's tables.
    pub first_cell: u32,
    /// Its field among those of the submission.
    pub field: u32,
    /// Structures end at multiples of sixteen bytes.
    pub unused: [u32; 2],
}

/// One sweep of one segment over one tile.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SpatialPass {
    /// Rows r, q, y of the rotation, three for each of u^0, u^1, u^2; last the same coefficient of the place of the
    /// tile's middle ray at the start height, mm.
    pub turn: [[f32; 4]; 9],
    /// Coefficients of u^3 of the place, and the height where the iteration starts, mm.
    pub place_3: [f32; 4],
    /// Distance of the base point from the tool's axis, mm.
    pub radius_mm: f32,
    /// Turn of the rake face per mm of y.
    pub twist_rad_per_mm: f32,
    /// Direction of the segment's x: its part along r.
    pub cos: f32,
    /// Its part along y.
    pub sin: f32,
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
    /// Arc: half of 1 / radius, 1/mm.
    pub arc_half_curvature: f32,
    /// Table: cells in a millimetre; 0 for an arc.
    pub cells_per_mm: f32,
    /// Table: width of a cell, mm.
    pub cell_width_mm: f32,
    /// Table: first cell against the base cell.
    pub first_cell: f32,
    /// Table: last cell against the base cell.
    pub last_cell: f32,
    /// Table: base cell in its field's tables.
    pub base_cell: u32,
    /// Id of the pass.
    pub pass_id: u32,
    /// First moment at which the sweep is good.
    pub t_from: f32,
    /// Last moment.
    pub t_to: f32,
    /// Structures end at multiples of sixteen bytes.
    pub unused: [u32; 2],
}
