//! From the plan's f64 sweeps to f32 records that lose nothing.
//!
//! In: a record of the plan, the polynomials of its segment, the direction of its tile's middle ray. Out:
//! [`SpatialPass`]es, one for each piece of the edge. As in [`super::compose`], everything large is subtracted here in
//! f64: a record counts from the tile's middle ray at its start height on one side, from a base point of the segment
//! near it on the other.

use super::compose::{ArcBase, END_OVERLAP_MM};
use super::near_edge::{EdgePolynomial, curves};
use super::sweep_records::SpatialPass;
use gearcut_core::passes::spatial::sweep;
use gearcut_core::tool::edge::{Segment, SegmentShape};
use glam::{DVec2, DVec3};

/// Largest distance between an edge's polynomial and its table: a tenth of what the kernel may add to a height. A flank
/// of a hob of module 9 mm, 21 mm long, is one polynomial within 0.113 nm.
const TOLERANCE_MM: f64 = 2e-7;

/// Pieces of a segment of which each is one polynomial; none for an arc.
pub fn pieces(segment: &Segment) -> Vec<EdgePolynomial> {
    let mut pieces = Vec::new();
    if let SegmentShape::Table(table) = &segment.shape {
        curves(table, segment.y_range_mm, 0.0, TOLERANCE_MM, &mut pieces);
    }
    pieces
}

/// Records for the shader; `middle` is the direction of the tile's middle ray as the shader has it.
pub fn compose(
    record: &sweep::SweepRecord,
    segment: &Segment,
    pieces: &[EdgePolynomial],
    middle: DVec3,
    out: &mut Vec<SpatialPass>,
) {
    let start_mm = f64::from(record.start.height_mm[0] as f32);
    let (mut place, axes) = (record.place_mm, segment.blade_from_segment.rotation);
    for (place, turn) in place.iter_mut().zip(&record.turn) {
        for (value, row) in place.iter_mut().zip(turn) {
            *value += start_mm * DVec3::from_array(*row).dot(middle);
        }
    }
    let in_segment = DVec2::new(axes.x, -axes.y).rotate(DVec2::new(place[0][0], place[0][2]));
    match &segment.shape {
        SegmentShape::Table(_) => out.extend(pieces.iter().map(|piece| {
            let curve = piece.seen_from(in_segment.y);
            let [c1, c2, c3, c4, c5] = curve.coefficients.map(|c| c as f32);
            SpatialPass {
                curve: [c1, c2, c3, c4],
                curve_5: c5,
                ..counted_from(curve.base_mm, curve.range_mm, record, segment, place)
            }
        })),
        SegmentShape::Arc { radius_mm } => {
            let ArcBase { point, from_center_mm: [x_mm, y_mm], excess_mm2 } = ArcBase::new(*radius_mm, in_segment);
            out.push(SpatialPass {
                curve: [x_mm, y_mm, excess_mm2, (0.5 / radius_mm) as f32],
                is_arc: 1,
                ..counted_from(point, segment.y_range_mm.map(|y| y - point.y), record, segment, place)
            });
        }
    }
}

/// A record from a base point of the segment, without the edge; `place` is that of the tile's middle ray at the start
/// height.
fn counted_from(
    base: DVec2,
    [from_mm, to_mm]: [f64; 2],
    record: &sweep::SweepRecord,
    segment: &Segment,
    mut place: [[f64; 3]; 4],
) -> SpatialPass {
    let start_mm = record.start.height_mm[0] as f32;
    let axes = segment.blade_from_segment.rotation;
    let base_in_blade = axes.rotate(base);
    place[0][0] -= base_in_blade.x;
    place[0][2] -= base_in_blade.y;
    let radius_mm = record.radius_mm + base_in_blade.x;
    let mut turn = record.turn;
    if record.twist_rad_per_mm != 0.0 {
        // A helical rake face is turned back by its angle at the base point's y, to which the angle now refers.
        let (sin, cos) = (record.twist_rad_per_mm * base_in_blade.y).sin_cos();
        let turned_back = |v: [f64; 3]| [cos * v[0] + sin * v[1], cos * v[1] - sin * v[0], v[2]];
        turn = turn.map(|rows| {
            let columns = [0, 1, 2].map(|column| turned_back([rows[0][column], rows[1][column], rows[2][column]]));
            [0, 1, 2].map(|row| columns.map(|column: [f64; 3]| column[row]))
        });
        place[0][0] += radius_mm;
        place = place.map(turned_back);
        place[0][0] -= radius_mm;
    }
    let row = |k: usize, r: usize| {
        let [x, y, z] = turn[k][r];
        [x, y, z, place[k][r]].map(|c| c as f32)
    };
    SpatialPass {
        turn: std::array::from_fn(|i| row(i / 3, i % 3)),
        place_3: [place[3][0] as f32, place[3][1] as f32, place[3][2] as f32, start_mm],
        radius_mm: radius_mm as f32,
        twist_rad_per_mm: record.twist_rad_per_mm as f32,
        cos: axes.x as f32,
        sin: axes.y as f32,
        y_from_mm: (from_mm - END_OVERLAP_MM) as f32,
        y_to_mm: (to_mm + END_OVERLAP_MM) as f32,
        pass_id: record.pass,
        t_from: record.t_range[0] as f32,
        t_to: record.t_range[1] as f32,
        ..bytemuck::Zeroable::zeroed()
    }
}
