//! From the plan's f64 records to f32 records that lose nothing.
//!
//! In: field, edge, plan. Out: [`records::PassRecord`], [`records::Column`] and one table of all segments' cells.
//!
//! A record of the plan maps the tile's frame to the segment's: millimetres on both sides, where f32 resolves half a
//! nanometre and a Newton step on differences of such numbers loses several. So the last subtraction is done here, in
//! f64: the tile's middle ray is put at the record's start height, its place becomes the origin on the tile's side, and
//! a **base point** of the segment near it becomes the origin on the other: the start of the table cell that the ray
//! stands over, or the point of the arc. What is left for f32 is some tenths of a millimetre, resolved to a hundredth
//! of a nanometre. Start height, base x and base point are rounded to f32 *before* they are subtracted, so that the
//! shader's own subtraction of the same numbers is exact.
//!
//! Road not taken: pairs of f32. They need a fused multiply-add that WGSL does not promise.

use super::records;
use crate::dexel::Column;
use crate::passes::PassRecord;
use crate::tool::edge::{Edge, Segment, SegmentShape};
use glam::DVec2;

/// Hits this far beyond a segment's end still count (half a nanometre): more than f32 errs near the base point, so that
/// no ray slips through between two segments, and less than the sideways shift of 2 nm under which a dexel must be
/// stable for its height to mean anything.
pub const END_OVERLAP_MM: f64 = 5e-7;

/// The cells of an edge's tables after each other.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeCells {
    /// Coefficients of all cells; a single zero if no segment has a table, since no binding may be empty.
    pub cells: Vec<[f32; 4]>,
    /// First cell of every segment.
    first: Vec<u32>,
}

impl EdgeCells {
    /// Cells of an edge.
    pub fn new(edge: &Edge) -> Self {
        let (mut cells, mut first) = (Vec::new(), Vec::new());
        for segment in &edge.segments {
            first.push(cells.len() as u32);
            if let SegmentShape::Table(table) = &segment.shape {
                cells.extend(table.cells.iter().map(|cell| cell.map(|c| c as f32)));
            }
        }
        if cells.is_empty() {
            cells.push([0.0; 4]);
        }
        Self { cells, first }
    }

    /// A record for the shader; `middle` is the tile's middle ray, its origin the tile's.
    pub fn record(&self, record: &PassRecord, segment: &Segment, middle: &Column) -> records::PassRecord {
        let start_mm = f64::from(record.start_mm as f32);
        let n = middle.normal;
        let (mut x, mut y) = (record.x_mm, record.y_mm);
        for k in 0..4 {
            x[k] += start_mm * (record.cos[k] * n.x - record.sin[k] * n.y);
            y[k] += start_mm * (record.sin[k] * n.x + record.cos[k] * n.y);
        }
        let mut out = records::PassRecord {
            cos: record.cos.map(|c| c as f32),
            sin: record.sin.map(|c| c as f32),
            start_mm: start_mm as f32,
            pass_id: record.pass,
            ..bytemuck::Zeroable::zeroed()
        };
        let base = self.base(record.segment as usize, segment, DVec2::new(x[0], y[0]));
        x[0] -= base.point.x;
        y[0] -= base.point.y;
        out.x_mm = x.map(|c| c as f32);
        out.y_mm = y.map(|c| c as f32);
        [out.y_from_mm, out.y_to_mm] = base.y_range_mm;
        out.base_x_mm = base.x_mm;
        out.base_y_mm = base.y_mm;
        out.arc_excess_mm2 = base.arc_excess_mm2;
        out.cells_per_mm = base.cells_per_mm;
        out.cell_width_mm = base.cell_width_mm;
        out.first_cell = base.first_cell;
        out.last_cell = base.last_cell;
        out.base_cell = base.cell;
        out
    }

    /// Base point of a segment for what comes near `place` (segment frame).
    pub fn base(&self, index: usize, segment: &Segment, place: DVec2) -> Base {
        let mut base = match &segment.shape {
            SegmentShape::Table(table) => {
                let cells = table.cells.len();
                let at = (place.y.clamp(table.y_start_mm, table.y_end_mm()) - table.y_start_mm) * table.cells_per_mm;
                let before = (at as usize).min(cells - 1);
                let cell = self.first[index] + before as u32;
                let x_mm = self.cells[cell as usize][0];
                Base {
                    point: DVec2::new(f64::from(x_mm), table.y_start_mm + before as f64 / table.cells_per_mm),
                    x_mm,
                    cells_per_mm: table.cells_per_mm as f32,
                    cell_width_mm: (1.0 / table.cells_per_mm) as f32,
                    first_cell: -(before as f32),
                    last_cell: (cells - 1 - before) as f32,
                    cell,
                    ..Base::default()
                }
            }
            SegmentShape::Arc { radius_mm } => {
                let from_center = (place + DVec2::new(*radius_mm, 0.0)).normalize_or(DVec2::X) * *radius_mm;
                let (x_mm, y_mm) = (from_center.x as f32, from_center.y as f32);
                let rounded = DVec2::new(f64::from(x_mm), f64::from(y_mm));
                Base {
                    point: rounded - DVec2::new(*radius_mm, 0.0),
                    x_mm,
                    y_mm,
                    arc_excess_mm2: (rounded.length_squared() - radius_mm * radius_mm) as f32,
                    ..Base::default()
                }
            }
        };
        let [from, to] = segment.y_range_mm;
        base.y_range_mm = [from - END_OVERLAP_MM - base.point.y, to + END_OVERLAP_MM - base.point.y].map(|y| y as f32);
        base
    }
}

/// Where a segment's coordinates start for one record, and what the shader needs of the segment from there.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Base {
    /// The base point, segment frame, mm.
    pub point: DVec2,
    /// Ends of the segment against it, overlapping, mm.
    pub y_range_mm: [f32; 2],
    /// Table: x of the base cell. Arc: x of the base point against the centre, mm.
    pub x_mm: f32,
    /// Arc: y of the base point against the centre, mm.
    pub y_mm: f32,
    /// Arc: square of its distance from the centre less that of the radius, mm^2.
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
    pub cell: u32,
}

/// A column for the shader, in the frame of its tile.
pub fn column(ray: &Column, tile_origin_mm: DVec2, middle: &Column) -> records::Column {
    let pair = |v: DVec2| [v.x as f32, v.y as f32];
    records::Column {
        offset_mm: pair(ray.origin_mm - tile_origin_mm),
        normal: pair(ray.normal),
        normal_change: pair(ray.normal - middle.normal),
        low_mm: ray.low_mm as f32,
        padding: 0.0,
    }
}

/// The ray whose direction the tile's records are composed with.
pub fn middle(rays: &[Column]) -> Column {
    rays[rays.len() / 2]
}
