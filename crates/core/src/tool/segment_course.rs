//! A segment's course without its roughness, with what bounds of passes ask of it: how far it bends, the box that
//! holds it.
//!
//! In: a segment of an edge. Out: a [`SegmentCourse`]. It follows from the segment alone: [`super::blade_edges`] keeps
//! those of a tool for all fields that are cut with it.

use super::edge::{Segment, SegmentShape};

/// Safety on how far a segment leaves its chord between two nodes of its table, of curvatures taken in the middles of
/// its cells.
const BULGE_SAFETY: f64 = 1.5;

/// A segment as bounds see it.
#[derive(Debug, Clone, PartialEq)]
pub struct SegmentCourse {
    /// Without its roughness.
    pub segment: Segment,
    /// How far the segment stays within that course along x, mm.
    pub depth_mm: f64,
    /// Smallest and largest dx/dy, roughness included.
    pub slope_range: [f64; 2],
    /// Largest curvature, 1/mm.
    pub curvature_per_mm: f64,
    /// x range in its own frame, mm.
    pub x_range_mm: [f64; 2],
}

impl SegmentCourse {
    /// Of a segment.
    pub fn new(of: &Segment) -> Self {
        let segment = of.smoothed();
        let curvature_per_mm = match &segment.shape {
            SegmentShape::Arc { radius_mm } => 1.0 / radius_mm,
            SegmentShape::Table(table) => (0..table.cells.len())
                .map(|i| table.curvature(table.y_start_mm + (i as f64 + 0.5) / table.cells_per_mm).abs())
                .fold(0.0, f64::max),
        };
        let x_range_mm = match &segment.shape {
            SegmentShape::Arc { radius_mm } => {
                let half = segment.y_range_mm[1];
                [(radius_mm * radius_mm - half * half).max(0.0).sqrt() - radius_mm, 0.0]
            }
            SegmentShape::Table(table) => {
                let nodes = table.cells.iter().map(|cell| cell[0]).chain([table.x_and_slope(table.y_end_mm())[0]]);
                let [low, high] = nodes.fold([0.0, 0.0], |[low, high]: [f64; 2], x| [low.min(x), high.max(x)]);
                // Between two nodes the segment leaves their chord by this at most: the extreme lies inside a cell.
                let bulge_mm = BULGE_SAFETY * curvature_per_mm / (8.0 * table.cells_per_mm * table.cells_per_mm);
                [low - bulge_mm, high + bulge_mm]
            }
        };
        Self { depth_mm: of.depth_mm(), slope_range: of.slope_range, segment, curvature_per_mm, x_range_mm }
    }
}
