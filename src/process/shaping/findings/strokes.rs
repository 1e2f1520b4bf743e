//! The chips of every stroke: `tables/chips_<operation>.csv`, one row per stroke.
//!
//! An operation has thousands of strokes, so the rows stand in the file alone.

use super::deflection;
use crate::findings::Table;
use crate::findings::quantities::blank::{CUTTER_TOOTH, STROKE};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::cut::chips::{ChipLedger, StrokeChips};
use crate::process::shaping::quantities::strokes::{
    CONTACT_LEFT, CONTACT_RIGHT, CONTACT_TIP, CUTTER_TORQUE_OF_STROKE, CUTTING_TEETH, DEFLECTION, FORCE, LARGEST_CHIP,
    MEAN_THICKNESS, RADIAL_FORCE, RATE, SECTION, SPACE, TANGENTIAL_FORCE, THICKEST_LEFT, THICKEST_RIGHT, THICKEST_TIP,
    TIME, VIBRATION, VOLUME, WORK_ANGLE, WORK_TORQUE_OF_STROKE,
};
use crate::process::shaping::quantities::{THREE_FLANK_CHIPS, TWO_FLANK_CHIPS};
use gearcut_core::units::UM_PER_MM;

/// The table of one operation.
pub fn strokes(job: &ShapingJob, ledger: &ChipLedger, operation: usize) -> Table {
    let prepared = &job.operations[operation];
    let per_minute = prepared.schedule.double_strokes_per_minute();
    let width_mm = job.scene.gear.face_width_mm;
    let busy = |s: &StrokeChips, value: u32| (!s.is_idle()).then_some(value);
    let mean_um = |s: &StrokeChips| {
        let contact_mm = s.contact_length_mm();
        (contact_mm > 0.0).then(|| s.area_mm2 / contact_mm * UM_PER_MM)
    };
    let mut table =
        Table::over("strokes", "Chips of every stroke", ledger.operations[operation].strokes.iter().enumerate())
            .column(&STROKE, |&(stroke, _)| stroke)
            .column(&TIME, |&(stroke, _)| prepared.schedule.time_s(stroke as f64))
            .column(&WORK_ANGLE, |&(stroke, _)| prepared.work_angle_rad(stroke as f64).to_degrees())
            .column(&CUTTING_TEETH, |(_, s)| s.chips)
            .column(&TWO_FLANK_CHIPS, |(_, s)| s.two_flank)
            .column(&THREE_FLANK_CHIPS, |(_, s)| s.three_flank)
            .column(&SPACE, |(_, s)| busy(s, s.space))
            .column(&CUTTER_TOOTH, |(_, s)| busy(s, s.blade))
            .column(&SECTION, |(_, s)| s.area_mm2)
            .column(&VOLUME, |(_, s)| s.area_mm2 * width_mm)
            .column(&LARGEST_CHIP, |(_, s)| s.largest_mm2);
    for (index, row) in [&CONTACT_RIGHT, &CONTACT_TIP, &CONTACT_LEFT].into_iter().enumerate() {
        table = table.column(row, |(_, s)| s.contact_mm[index]);
    }
    table = table.column(&MEAN_THICKNESS, |(_, s)| mean_um(s));
    for (index, row) in [&THICKEST_RIGHT, &THICKEST_TIP, &THICKEST_LEFT].into_iter().enumerate() {
        table = table.column(row, |(_, s)| s.thickest_mm[index] * UM_PER_MM);
    }
    table = table
        .column(&FORCE, |(_, s)| s.cutting_n)
        .column(&RADIAL_FORCE, |(_, s)| s.radial_n)
        .column(&TANGENTIAL_FORCE, |(_, s)| s.tangential_n)
        .column(&WORK_TORQUE_OF_STROKE, |(_, s)| s.work_torque_nmm / 1e3)
        .column(&CUTTER_TORQUE_OF_STROKE, |(_, s)| s.cutter_torque_nmm / 1e3)
        .column(&RATE, |(_, s)| s.area_mm2 * width_mm * per_minute / 1e3);
    if !prepared.deflections.is_empty() {
        for (index, &row) in DEFLECTION.rows.iter().enumerate() {
            table = table.column(row, |&(stroke, _)| deflection::of_stroke(job, operation, stroke)[index]);
        }
    }
    if prepared.vibration.is_some() {
        for (index, &row) in VIBRATION.rows[..3].iter().enumerate() {
            table = table.column(row, |&(stroke, _)| deflection::vibration_of_stroke(job, operation, stroke)[index]);
        }
    }
    table.rows_in_file(&format!("chips_{}", prepared.spec.name))
}
