//! From the chip ledger to `results.json`.

use crate::job::Job;
use crate::measure::chips::{ChipLedger, StrokeChips};
use crate::output::quantity::Quantity;
use crate::output::results::{ChipPeak, ChipResults};
use crate::units::UM_PER_MM;
use std::f64::consts::PI;

const IDLE: &str = "all strokes are idle";
const ENTRY_SECTION: &str = "section of a first stroke at full depth without infeed: whole tooth spaces at once, as no machine cuts; the largest values leave it out";
/// What the force of an entry is.
pub const ENTRY_FORCE: &str =
    "cutting force of a first stroke at full depth without infeed; the largest values leave it out";
const NO_ENTRY: &str = "the cutter is fed in, or its first stroke meets nothing";
/// N mm in a N m.
const NMM_PER_NM: f64 = 1e3;

/// Results of one operation.
pub fn chip_results(job: &Job, ledger: &ChipLedger, operation: usize) -> ChipResults {
    let chips = &ledger.operations[operation];
    let schedule = &job.operations[operation].schedule;
    let peak = |what: &'static str, unit: &'static str, value: &dyn Fn(&StrokeChips) -> f64| {
        peak(job, ledger, operation, what, unit, value)
    };
    let median = |value: &dyn Fn(&StrokeChips) -> f64| {
        let mut values: Vec<f64> = chips.strokes.iter().filter(|s| !s.is_idle()).map(value).collect();
        values.sort_unstable_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    };
    let width_mm = job.scene.gear.face_width_mm;
    let volume_mm3 = ledger.area_mm2(operation) * width_mm;
    let minutes = schedule.time_s(schedule.count() as f64) / 60.0;
    let largest_n = chips.largest(|s| s.cutting_n).map(|(_, stroke)| stroke.cutting_n);
    let power_w = largest_n.map(|force_n| force_n * ram_speed_mm_per_s(job) / 1e3);
    let count = |pick: fn(&StrokeChips) -> u32| chips.strokes.iter().map(|s| u64::from(pick(s))).sum();
    ChipResults {
        largest_section: peak("section of all chips of a stroke, in the transverse plane", "mm^2", &|s| s.area_mm2),
        largest_thickness: peak("uncut chip thickness, from the edge to the surface before", "um", &|s| {
            s.thickest_anywhere_mm() * UM_PER_MM
        }),
        largest_force: peak("cutting force along the stroke", "N", &|s| s.cutting_n),
        entry_section: entry(chips.entry().map(|s| s.area_mm2), "mm^2", ENTRY_SECTION),
        entry_force: entry(chips.entry().map(|s| s.cutting_n), "N", ENTRY_FORCE),
        largest_work_torque: peak("torque of the cut on the work spindle, without its sign", "N m", &|s| {
            s.work_torque_nmm.abs() / NMM_PER_NM
        }),
        largest_cutter_torque: peak("torque of the cut on the cutter spindle, without its sign", "N m", &|s| {
            s.cutter_torque_nmm.abs() / NMM_PER_NM
        }),
        median_section: Quantity::number_or(
            median(&|s| s.area_mm2),
            "mm^2",
            "section of all chips of a stroke: median over the strokes that cut",
            IDLE,
        ),
        median_force: Quantity::number_or(
            median(&|s| s.cutting_n),
            "N",
            "cutting force along the stroke: median over the strokes that cut",
            IDLE,
        ),
        largest_power: Quantity::number_or(
            power_w,
            "W",
            "largest cutting force times the ram's largest speed, pi times stroke length times double strokes per time",
            IDLE,
        ),
        removed_volume: Quantity::number(volume_mm3, "mm^3", "sections of all chips times the face width"),
        removal_rate: Quantity::number(
            volume_mm3 / minutes / 1e3,
            "cm^3/min",
            "volume taken away over the time of the operation's double strokes",
        ),
        idle_strokes: Quantity::count(
            chips.idle() as u64,
            "strokes",
            "strokes in which no cutter tooth meets material",
        ),
        two_flank_chips: Quantity::count(
            count(|s| s.two_flank),
            "chips",
            "chips that form on two sides of a cutter tooth's edge at once (tip and flank, or both flanks)",
        ),
        three_flank_chips: Quantity::count(
            count(|s| s.three_flank),
            "chips",
            "chips that form on tip and both flanks of a cutter tooth at once",
        ),
    }
}

/// What is told of a first stroke at full depth.
pub fn entry(value: Option<f64>, unit: &'static str, definition: &'static str) -> Quantity {
    Quantity::number_or(value, unit, definition, NO_ENTRY)
}

/// Largest speed of the ram on its crank, mm/s.
pub fn ram_speed_mm_per_s(job: &Job) -> f64 {
    let machine = &job.machine;
    let stroke_mm = machine.approach_mm + job.scene.gear.face_width_mm + machine.overrun_mm;
    PI * stroke_mm * machine.double_strokes_per_minute / 60.0
}

/// The stroke at which `value` is largest.
pub fn peak(
    job: &Job,
    ledger: &ChipLedger,
    operation: usize,
    what: &'static str,
    unit: &'static str,
    value: &dyn Fn(&StrokeChips) -> f64,
) -> ChipPeak {
    let schedule = &job.operations[operation].schedule;
    let found = ledger.operations[operation].largest(value);
    let number = |number: &dyn Fn(usize, &StrokeChips) -> f64, unit: &'static str, definition: String| {
        Quantity::number_or(found.map(|(stroke, chips)| number(stroke, chips)), unit, definition, IDLE)
    };
    let count = |number: &dyn Fn(usize, &StrokeChips) -> u64, unit: &'static str, definition: &'static str| match found
    {
        Some((stroke, chips)) => Quantity::count(number(stroke, chips), unit, definition),
        None => Quantity::undefined(unit, definition, IDLE),
    };
    ChipPeak {
        value: number(&|_, chips| value(chips), unit, format!("largest {what}")),
        stroke: count(&|stroke, _| stroke as u64, "strokes", "strokes of the operation before it"),
        time: number(
            &|stroke, _| schedule.time_s(stroke as f64),
            "s",
            "time from the operation's first stroke".to_owned(),
        ),
        work_angle: number(
            &|stroke, _| schedule.state(stroke as f64).psi_c_rad.to_degrees(),
            "deg",
            "work angle psi_c of that stroke".to_owned(),
        ),
        space: count(
            &|_, chips| u64::from(chips.space),
            "1",
            "tooth space of that stroke's largest chip; space j lies after tooth j",
        ),
        cutter_tooth: count(&|_, chips| u64::from(chips.blade), "1", "cutter tooth of that chip, counted from 0"),
    }
}
