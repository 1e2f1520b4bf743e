//! Chips and cutting forces of an operation, from the chip ledger.

use crate::findings::quantities::cutting::{IDLE, LARGEST_FORCE, REMOVAL_RATE, REMOVED_VOLUME, THICKEST_CHIP};
use crate::findings::{Place, QuantityRow, Section};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::cut::chips::{ChipLedger, StrokeChips};
use crate::process::shaping::quantities::{
    CHIPS, CUTTER_TORQUE, ENTRY_FORCE, ENTRY_SECTION, IDLE_STROKES, LARGEST_POWER, LARGEST_SECTION, MEDIAN_FORCE,
    MEDIAN_SECTION, NO_ENTRY, THREE_FLANK_CHIPS, TWO_FLANK_CHIPS, WORK_TORQUE,
};
use crate::steps::inspection::headline::Placed;
use gearcut_core::units::UM_PER_MM;

/// N mm in a N m.
const NMM_PER_NM: f64 = 1e3;

/// Chips and forces of one operation.
pub fn chips(job: &ShapingJob, ledger: &ChipLedger, operation: usize) -> Section {
    let chips = &ledger.operations[operation];
    let (schedule, count) = (&job.operations[operation].schedule, job.operations[operation].count());
    let largest = |row: &QuantityRow, value: &dyn Fn(&StrokeChips) -> f64| match peak(job, ledger, operation, value) {
        Ok((value, place)) => row.of(value).at(place),
        Err(why) => row.none(why),
    };
    let median = |row: &QuantityRow, value: &dyn Fn(&StrokeChips) -> f64| {
        let mut values: Vec<f64> = chips.strokes.iter().filter(|s| !s.is_idle()).map(value).collect();
        values.sort_unstable_by(f64::total_cmp);
        row.of_or(values.get(values.len() / 2).copied(), IDLE)
    };
    let volume_mm3 = ledger.area_mm2(operation) * job.scene.gear.face_width_mm;
    let minutes = schedule.time_s(count as f64) / 60.0;
    let largest_n = chips.largest(|s| s.cutting_n).map(|(_, stroke)| stroke.cutting_n);
    let power_w = largest_n.map(|force_n| force_n * job.ram_speed_mm_per_s(operation) / 1e3);
    let count_of = |pick: fn(&StrokeChips) -> u32| chips.strokes.iter().map(|s| u64::from(pick(s))).sum::<u64>();
    CHIPS.section([
        largest(&LARGEST_SECTION, &|s| s.area_mm2),
        largest(&THICKEST_CHIP, &|s| s.thickest_anywhere_mm() * UM_PER_MM),
        largest(&LARGEST_FORCE, &|s| s.cutting_n),
        ENTRY_SECTION.of_or(chips.entry().map(|s| s.area_mm2), NO_ENTRY),
        ENTRY_FORCE.of_or(chips.entry().map(|s| s.cutting_n), NO_ENTRY),
        largest(&WORK_TORQUE, &|s| s.work_torque_nmm.abs() / NMM_PER_NM),
        largest(&CUTTER_TORQUE, &|s| s.cutter_torque_nmm.abs() / NMM_PER_NM),
        median(&MEDIAN_SECTION, &|s| s.area_mm2),
        median(&MEDIAN_FORCE, &|s| s.cutting_n),
        LARGEST_POWER.of_or(power_w, IDLE),
        REMOVED_VOLUME.of(volume_mm3),
        REMOVAL_RATE.of(volume_mm3 / minutes / 1e3),
        IDLE_STROKES.of(chips.idle()),
        TWO_FLANK_CHIPS.of(count_of(|s| s.two_flank)),
        THREE_FLANK_CHIPS.of(count_of(|s| s.three_flank)),
    ])
}

/// The largest value of a stroke with its place: the stroke (counted from 0), time and work angle, the space of the
/// stroke's largest chip (space j lies after tooth j) and the cutter tooth that takes it (counted from 0).
pub fn peak(job: &ShapingJob, ledger: &ChipLedger, operation: usize, value: impl Fn(&StrokeChips) -> f64) -> Placed {
    let (stroke, chips) = ledger.operations[operation].largest(&value).ok_or(IDLE)?;
    Ok((value(chips), stroke_place(job, ledger, operation, stroke)))
}

/// Place of a stroke that cuts: [`peak`] says with what.
pub fn stroke_place(job: &ShapingJob, ledger: &ChipLedger, operation: usize, stroke: usize) -> Place {
    let prepared = &job.operations[operation];
    let chips = &ledger.operations[operation].strokes[stroke];
    Place::default()
        .and("stroke", stroke as u64)
        .and("time_s", prepared.schedule.time_s(stroke as f64))
        .and("work_angle_deg", prepared.work_angle_rad(stroke as f64).to_degrees())
        .and("space", chips.space)
        .and("cutter_tooth", chips.blade)
}
