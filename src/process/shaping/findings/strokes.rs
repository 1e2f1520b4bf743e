//! The chips of every stroke: `tables/chips_<operation>.csv`, one row per stroke.
//!
//! An operation has thousands of strokes, so the rows stand in the file alone.

use super::deflection;
use crate::findings::{Datum, Table, TableColumn};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::chips::{ChipLedger, StrokeChips};
use gearcut_core::units::UM_PER_MM;

const IDLE: &str = "the stroke is idle";

/// The table of one operation.
pub fn strokes(job: &ShapingJob, ledger: &ChipLedger, operation: usize) -> Table {
    let prepared = &job.operations[operation];
    let rows = ledger.operations[operation].strokes.iter().enumerate().map(|(stroke, s)| {
        let coordinate = stroke as f64;
        let angle_deg = prepared.work_angle_rad(coordinate).to_degrees();
        let mut row: Vec<Datum> =
            vec![(stroke as u64).into(), prepared.schedule.time_s(coordinate).into(), angle_deg.into()];
        row.extend(cells(job, s, prepared.schedule.double_strokes_per_minute()));
        if !prepared.deflections.is_empty() {
            row.extend(deflection::of_stroke(job, operation, stroke).map(Datum::from));
        }
        row
    });
    let mut columns = columns();
    if !prepared.deflections.is_empty() {
        columns.extend(deflection::KINDS.map(|(key, _, unit, definition)| TableColumn::new(key, unit, definition)));
    }
    Table::new("strokes", "Chips of every stroke", columns)
        .with_rows(rows)
        .rows_in_file(&format!("chips_{}", prepared.spec.name))
}

fn columns() -> Vec<TableColumn> {
    let new = |key, unit, definition| TableColumn::new(key, unit, definition);
    vec![
        new("stroke", "1", "stroke, from 0"),
        new("time", "s", "time from the operation's first stroke"),
        new("work_angle", "deg", "work angle psi_c"),
        new("chips", "chips", "cutter teeth that cut"),
        new("two_flank_chips", "chips", "chips on two sides of the edge: tip and flank, or both flanks"),
        new("three_flank_chips", "chips", "chips on tip and both flanks"),
        new("space", "1", "space of the largest chip; space j lies after tooth j").or(IDLE),
        new("cutter_tooth", "1", "cutter tooth that takes the largest chip, from 0").or(IDLE),
        new("section", "mm^2", "section of all chips, in the transverse plane"),
        new("volume", "mm^3", "section of all chips times the face width"),
        new("largest_chip_section", "mm^2", "section of the largest chip"),
        new("contact_right", "mm", "length of right flank in contact"),
        new("contact_tip", "mm", "length of tip in contact"),
        new("contact_left", "mm", "length of left flank in contact"),
        new("mean_thickness", "um", "section of all chips over the length of edge in contact").or(IDLE),
        new("largest_thickness_right", "um", "largest uncut chip thickness on right flanks"),
        new("largest_thickness_tip", "um", "largest uncut chip thickness on tips"),
        new("largest_thickness_left", "um", "largest uncut chip thickness on left flanks"),
        new("cutting_force", "N", "cutting force along the stroke"),
        new("radial_force", "N", "force on the tool along the line of centres, away from the work axis"),
        new("tangential_force", "N", "force on the tool across the line of centres, towards larger work angles"),
        new("work_torque", "N m", "torque on the work spindle, counter-clockwise"),
        new("cutter_torque", "N m", "torque on the cutter spindle, counter-clockwise"),
        new("removal_rate", "cm^3/min", "volume taken by double strokes like this one over their time"),
    ]
}

/// What follows stroke, time and angle, at so many double strokes per minute.
fn cells(job: &ShapingJob, s: &StrokeChips, per_minute: f64) -> Vec<Datum> {
    let width_mm = job.scene.gear.face_width_mm;
    let of_busy = |value: u32| if s.is_idle() { Datum::Undefined } else { value.into() };
    let contact_mm = s.contact_length_mm();
    let mut row = vec![
        s.chips.into(),
        s.two_flank.into(),
        s.three_flank.into(),
        of_busy(s.space),
        of_busy(s.blade),
        s.area_mm2.into(),
        (s.area_mm2 * width_mm).into(),
        s.largest_mm2.into(),
    ];
    row.extend(s.contact_mm.map(Datum::from));
    row.push((contact_mm > 0.0).then(|| s.area_mm2 / contact_mm * UM_PER_MM).into());
    row.extend(s.thickest_mm.map(|h| Datum::from(h * UM_PER_MM)));
    row.extend(
        [s.cutting_n, s.radial_n, s.tangential_n, s.work_torque_nmm / 1e3, s.cutter_torque_nmm / 1e3].map(Datum::from),
    );
    row.push((s.area_mm2 * width_mm * per_minute / 1e3).into());
    row
}
