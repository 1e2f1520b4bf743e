//! What a backend needs of one pass in one tile: which segment, and how the tile's coordinates become the segment's.
//!
//! `p_segment = R(tau) p_tile + t(tau)`, all four entries cubics in the stroke's phase tau, composed in f64 from poses
//! far away (gear axis 60 mm, cutter axis 30 mm off) so that only millimetres are left: the tile's origin lies on the
//! flank, the segment's on the edge.

use super::strokes::{StrokeSet, cubic_through};
use crate::frame::Rigid2;
use crate::tool::edge::Segment;
use glam::DVec2;

/// One pass of one segment of a blade over one tile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassRecord {
    /// Pass id.
    pub pass: u32,
    /// Index of the segment in the plan's list.
    pub segment: u32,
    /// Where Newton's method starts: the height at which the tile's middle ray enters the segment or its continuation,
    /// mm; below all rays if it does not.
    pub start_mm: f64,
    /// Cosine of the rotation, coefficients of tau^0 to tau^3.
    pub cos: [f64; 4],
    /// Sine of the rotation.
    pub sin: [f64; 4],
    /// x of the translation, mm.
    pub x_mm: [f64; 4],
    /// y of the translation, mm.
    pub y_mm: [f64; 4],
}

impl PassRecord {
    /// Record for a tile whose origin stands at `tile_origin_mm` in the gear frame; `start_mm` is filled by the caller.
    pub fn new(
        set: &StrokeSet,
        stroke: usize,
        blade: u32,
        blade_from_tool: &Rigid2,
        segment_index: usize,
        segment: &Segment,
        tile_origin_mm: DVec2,
    ) -> Self {
        let segment_from_tool = segment.blade_from_segment.inverse().after(blade_from_tool);
        let work_from_tile = Rigid2 { rotation: DVec2::X, translation_mm: tile_origin_mm };
        let mut entries = [[0.0; 4]; 4];
        let poses = set.poses(stroke);
        for (node, work_from_tool) in poses.iter().enumerate() {
            let segment_from_tile = segment_from_tool.after(&work_from_tool.inverse()).after(&work_from_tile);
            let (r, t) = (segment_from_tile.rotation, segment_from_tile.translation_mm);
            for (entry, value) in entries.iter_mut().zip([r.x, r.y, t.x, t.y]) {
                entry[node] = value;
            }
        }
        let [cos, sin, x_mm, y_mm] = entries.map(|entry| cubic_through(&entry[..poses.len()]));
        Self { pass: set.pass_id(stroke, blade), segment: segment_index as u32, start_mm: 0.0, cos, sin, x_mm, y_mm }
    }

    /// Origin and direction of a ray (tile frame) in the segment's frame at phase `tau`.
    pub fn ray_in_segment(&self, origin_mm: DVec2, normal: DVec2, tau: f64) -> (DVec2, DVec2) {
        let at = |c: &[f64; 4]| c[0] + tau * (c[1] + tau * (c[2] + tau * c[3]));
        let rotation = DVec2::new(at(&self.cos), at(&self.sin));
        let translation = DVec2::new(at(&self.x_mm), at(&self.y_mm));
        (rotation.rotate(origin_mm) + translation, rotation.rotate(normal))
    }
}
