//! What the host hands to `spatial_flank`, member by member.
//!
//! Members stand in the order of `shaders/shared/sweep_records.wgsl`; a test asks naga for names, offsets and sizes and
//! compares.

use bytemuck::{Pod, Zeroable};

/// Dexels of a part of a tile, column by column in groups of rows.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SpatialTile {
    /// Direction of the tile's middle ray, and the lowest height that rays record, mm.
    pub middle: [f32; 4],
    /// First group of the submission.
    pub first_group: u32,
    /// Number of groups.
    pub group_count: u32,
    /// First visit of the step.
    pub first_visit: u32,
    /// Number of visits.
    pub visit_count: u32,
    /// First record of the tile; visits count from there.
    pub first_record: u32,
    /// Its field among those of the submission.
    pub field: u32,
    /// Groups of a column.
    pub rows: u32,
    /// Structures end at multiples of sixteen bytes.
    pub unused: u32,
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
    /// Table: coefficients of t to t^4, t = y against the base point. Arc: base point against the centre, mm; square of
    /// its distance from the centre less that of the radius, mm^2; half of 1 / radius, 1/mm.
    pub curve: [f32; 4],
    /// Distance of the base point from the tool's axis, mm.
    pub radius_mm: f32,
    /// Turn of the rake face per mm of y.
    pub twist_rad_per_mm: f32,
    /// Direction of the segment's x: its part along r.
    pub cos: f32,
    /// Its part along y.
    pub sin: f32,
    /// First y that belongs to the piece of the segment, against the base point, mm.
    pub y_from_mm: f32,
    /// Last y that belongs to it.
    pub y_to_mm: f32,
    /// Table: coefficient of t^5.
    pub curve_5: f32,
    /// 1 for an arc, 0 for a table.
    pub is_arc: u32,
    /// Id of the pass.
    pub pass_id: u32,
    /// First moment at which the sweep is good.
    pub t_from: f32,
    /// Last moment.
    pub t_to: f32,
    /// Structures end at multiples of sixteen bytes.
    pub unused: u32,
}
