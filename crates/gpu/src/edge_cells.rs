//! The tables of a tool's edges as the spatial shader reads them, and the point from which a record counts.
//!
//! In: the segments of all edges of a tool, a place near which a tile's rays meet a segment. Out: one table of all
//! segments' cells; the **base point** of the segment near that place, the start of the table cell over which it stands
//! or the point of the arc, to which what f32 sees is referred. Base x and base point are rounded to f32 *before* they
//! are subtracted, so that the shader's own subtraction of the same numbers is exact.

use super::compose::{ArcBase, END_OVERLAP_MM};
use gearcut_core::tool::edge::{Segment, SegmentShape};
use glam::DVec2;

/// The cells of all segments' tables after each other.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeCells {
    /// Coefficients of all cells; a single zero if no segment has a table, since no binding may be empty.
    pub cells: Vec<[f32; 4]>,
    /// First cell of every segment.
    first: Vec<u32>,
}

impl EdgeCells {
    /// Cells of the segments that a plan's records name.
    pub fn new(segments: &[Segment]) -> Self {
        let (mut cells, mut first) = (Vec::new(), Vec::new());
        for segment in segments {
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
                let arc = ArcBase::new(*radius_mm, place);
                let [x_mm, y_mm] = arc.from_center_mm;
                Base { point: arc.point, x_mm, y_mm, arc_excess_mm2: arc.excess_mm2, ..Base::default() }
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
