//! From the plan's f64 sweeps to f32 records that lose nothing.
//!
//! In: a record of the plan, the direction of its tile's middle ray. Out: [`SpatialPass`]. As in [`super::compose`],
//! everything large is subtracted here in f64: a record counts from the tile's middle ray at its start height on one
//! side, from a base point of the segment near it on the other.

use super::edge_cells::EdgeCells;
use super::sweep_records::SpatialPass;
use gearcut_core::passes::spatial::sweep;
use gearcut_core::tool::edge::{Segment, SegmentShape};
use glam::{DVec2, DVec3};

/// A record for the shader; `middle` is the direction of the tile's middle ray as the shader has it.
pub fn compose(cells: &EdgeCells, record: &sweep::SweepRecord, segment: &Segment, middle: DVec3) -> SpatialPass {
    let start_mm = f64::from(record.start.height_mm[0] as f32);
    let (mut place, axes) = (record.place_mm, segment.blade_from_segment.rotation);
    for (place, turn) in place.iter_mut().zip(&record.turn) {
        for (value, row) in place.iter_mut().zip(turn) {
            *value += start_mm * DVec3::from_array(*row).dot(middle);
        }
    }
    let in_segment = DVec2::new(axes.x, -axes.y).rotate(DVec2::new(place[0][0], place[0][2]));
    let base = cells.base(record.segment as usize, segment, in_segment);
    let base_in_blade = axes.rotate(base.point);
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
        place_3: [place[3][0], place[3][1], place[3][2], start_mm].map(|c| c as f32),
        radius_mm: radius_mm as f32,
        twist_rad_per_mm: record.twist_rad_per_mm as f32,
        cos: axes.x as f32,
        sin: axes.y as f32,
        y_from_mm: base.y_range_mm[0],
        y_to_mm: base.y_range_mm[1],
        base_x_mm: base.x_mm,
        base_y_mm: base.y_mm,
        arc_excess_mm2: base.arc_excess_mm2,
        arc_half_curvature: match &segment.shape {
            SegmentShape::Table(_) => 0.0,
            SegmentShape::Arc { radius_mm } => (0.5 / radius_mm) as f32,
        },
        cells_per_mm: base.cells_per_mm,
        cell_width_mm: base.cell_width_mm,
        first_cell: base.first_cell,
        last_cell: base.last_cell,
        base_cell: base.cell,
        pass_id: record.pass,
        t_from: record.t_range[0] as f32,
        t_to: record.t_range[1] as f32,
        unused: [0; 2],
    }
}
