//! From the plan's f64 records to f32 records that lose nothing.
//!
//! In: tiles, their rays, plan. Out: [`records::FlankPass`] and [`records::FlankColumn`].
//!
//! A record of the plan maps the tile's frame to the segment's: millimetres on both sides, where f32 resolves half a
//! nanometre and a Newton step on differences of such numbers loses several. So the last subtraction is done here, in
//! f64: the tile's middle ray is put at the record's start height, its place becomes the origin on the tile's side, and
//! a **base point** of the segment near it becomes the origin on the other. What is left for f32 is some tenths of a
//! millimetre, resolved to a hundredth of a nanometre. Start height and an arc's base point are rounded to f32 *before*
//! they are subtracted, so that the shader's own subtraction of the same numbers is exact.
//!
//! A record brings its piece of the edge along ([`near_edge`]); one whose rays graze becomes several, each for its own
//! part of the segment; one whose segment none of the tile's rays can meet goes.
//!
//! Road not taken: pairs of f32. They need a fused multiply-add that WGSL does not promise.

use super::{near_edge, records};
use gearcut_core::dexel::Column;
use gearcut_core::passes::PassRecord;
use gearcut_core::tool::edge::{Segment, SegmentShape};
use glam::DVec2;

/// Hits this far beyond a segment's end still count (half a nanometre): more than f32 errs near the base point, so that
/// no ray slips through between two segments, and less than the sideways shift of 2 nm under which a dexel must be
/// stable for its height to mean anything.
pub const END_OVERLAP_MM: f64 = 5e-7;

/// Largest distance between an edge's polynomial and its table: twice what the table itself may err.
const TOLERANCE_MM: f64 = 1e-7;

/// Records for the shader; `columns` are the tile's rays.
pub fn records(
    record: &PassRecord,
    segment: &Segment,
    columns: &[Column],
    tile_origin_mm: DVec2,
    out: &mut Vec<records::FlankPass>,
) {
    let start_mm = f64::from(record.start_mm as f32);
    let n = middle(columns).normal;
    let (mut x, mut y) = (record.x_mm, record.y_mm);
    for k in 0..4 {
        x[k] += start_mm * (record.cos[k] * n.x - record.sin[k] * n.y);
        y[k] += start_mm * (record.sin[k] * n.x + record.cos[k] * n.y);
    }
    let [from, to] = [segment.y_range_mm[0] - END_OVERLAP_MM, segment.y_range_mm[1] + END_OVERLAP_MM];
    let place = DVec2::new(x[0], y[0]);
    let counted_from = |base: DVec2, [from, to]: [f64; 2]| records::FlankPass {
        cos: record.cos.map(|c| c as f32),
        sin: record.sin.map(|c| c as f32),
        x_mm: [x[0] - base.x, x[1], x[2], x[3]].map(|c| c as f32),
        y_mm: [y[0] - base.y, y[1], y[2], y[3]].map(|c| c as f32),
        start_mm: start_mm as f32,
        y_from_mm: (from - base.y) as f32,
        y_to_mm: (to - base.y) as f32,
        pass_id: record.pass,
        ..bytemuck::Zeroable::zeroed()
    };
    match &segment.shape {
        SegmentShape::Table(table) => {
            let reach = near_edge::reach_mm(record, columns, tile_origin_mm);
            let range = [from.max(reach[0]), to.min(reach[1])];
            if range[0] >= range[1] {
                return;
            }
            let mut curves = Vec::new();
            near_edge::curves(table, range, place.y, TOLERANCE_MM, &mut curves);
            out.extend(curves.iter().map(|curve| {
                let [c1, c2, c3, c4, c5] = curve.coefficients.map(|c| c as f32);
                records::FlankPass {
                    curve: [c1, c2, c3, c4],
                    curve_5: c5,
                    ..counted_from(curve.base_mm, curve.range_mm.map(|t| curve.base_mm.y + t))
                }
            }));
        }
        SegmentShape::Arc { radius_mm } => {
            let base = ArcBase::new(*radius_mm, place);
            let [center_x, center_y] = base.from_center_mm;
            out.push(records::FlankPass {
                curve: [center_x, center_y, base.excess_mm2, 0.0],
                is_arc: 1,
                ..counted_from(base.point, [from, to])
            });
        }
    }
}

/// Base point of an arc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArcBase {
    /// The point, segment frame, mm.
    pub point: DVec2,
    /// The same against the arc's centre, mm.
    pub from_center_mm: [f32; 2],
    /// Square of its distance from the centre less that of the radius, mm^2.
    pub excess_mm2: f32,
}

impl ArcBase {
    /// The arc's point nearest to a place, both in the segment's frame, whose origin lies on the arc.
    pub fn new(radius_mm: f64, place: DVec2) -> Self {
        let center_to_origin = DVec2::new(radius_mm, 0.0);
        let from_center = (place + center_to_origin).normalize_or(DVec2::X) * radius_mm;
        let from_center_mm = [from_center.x as f32, from_center.y as f32];
        let rounded = DVec2::from(from_center_mm.map(f64::from));
        Self {
            point: rounded - center_to_origin,
            from_center_mm,
            excess_mm2: (rounded.length_squared() - radius_mm * radius_mm) as f32,
        }
    }
}

/// A column for the shader, in the frame of its tile.
pub fn column(ray: &Column, tile_origin_mm: DVec2, middle: &Column) -> records::FlankColumn {
    let pair = |v: DVec2| [v.x as f32, v.y as f32];
    records::FlankColumn {
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
