//! The axis table: one row per stroke, for controllers, spreadsheets and scripts.

use std::path::Path;

use super::StrokeRow;
use crate::Result;
use crate::output::table::{Cell, write_table};

/// Columns with their units. `stroke` counts from 0, as pass ids do; angles run on beyond a turn.
const COLUMNS: [&str; 15] = [
    "stroke",
    "time_s",
    "psi_c_deg",
    "psi_b_deg",
    "center_distance_mm",
    "offset_mm",
    "phi_deg",
    "work_speed_deg_per_s",
    "cutter_speed_deg_per_s",
    "center_distance_speed_mm_per_s",
    "work_acceleration_deg_per_s2",
    "cutter_acceleration_deg_per_s2",
    "center_distance_acceleration_mm_per_s2",
    "left_relief_share_of_circular",
    "right_relief_share_of_circular",
];

pub(super) fn write(path: &Path, rows: &[StrokeRow]) -> Result<()> {
    write_table(path, &COLUMNS, rows.iter().map(cells))
}

fn cells(row: &StrokeRow) -> Vec<Cell> {
    let StrokeRow { stroke, motion, phi_rad, offset_mm, relief } = row;
    let (work, cutter, distance) = (motion.work, motion.cutter, motion.center_distance);
    let numbers = [
        motion.time_s,
        work.position.to_degrees(),
        cutter.position.to_degrees(),
        distance.position,
        *offset_mm,
        phi_rad.to_degrees(),
        work.velocity.to_degrees(),
        cutter.velocity.to_degrees(),
        distance.velocity,
        work.acceleration.to_degrees(),
        cutter.acceleration.to_degrees(),
        distance.acceleration,
        relief.left,
        relief.right,
    ];
    let index = Cell::Whole(i64::try_from(*stroke).unwrap_or(i64::MAX));
    [index].into_iter().chain(numbers.map(Cell::Number)).collect()
}
