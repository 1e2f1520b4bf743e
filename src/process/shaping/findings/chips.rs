//! Chips and cutting forces of an operation, from the chip ledger.

use crate::findings::{Place, Quantity, Section};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::chips::{ChipLedger, StrokeChips};
use gearcut_core::units::UM_PER_MM;
use std::f64::consts::PI;

const IDLE: &str = "all strokes are idle";
const ENTRY_SECTION: &str = "section of a first stroke at full depth without infeed: whole tooth spaces at once, as no \
    machine cuts; the largest values leave it out";
/// What the force of an entry is.
pub const ENTRY_FORCE: &str =
    "cutting force of a first stroke at full depth without infeed; the largest values leave it out";
const NO_ENTRY: &str = "the cutter is fed in, or its first stroke meets nothing";
/// N mm in a N m.
const NMM_PER_NM: f64 = 1e3;

/// Chips and forces of one operation.
pub fn chips(job: &ShapingJob, ledger: &ChipLedger, operation: usize) -> Section {
    let chips = &ledger.operations[operation];
    let (schedule, count) = (&job.operations[operation].schedule, job.operations[operation].count());
    let peak = |what: &'static str, unit: &'static str, value: &dyn Fn(&StrokeChips) -> f64| {
        peak(job, ledger, operation, what, unit, value)
    };
    let median = |unit: &'static str, definition: &'static str, value: &dyn Fn(&StrokeChips) -> f64| {
        let mut values: Vec<f64> = chips.strokes.iter().filter(|s| !s.is_idle()).map(value).collect();
        values.sort_unstable_by(f64::total_cmp);
        Quantity::number_or(values.get(values.len() / 2).copied(), unit, definition, IDLE)
    };
    let width_mm = job.scene.gear.face_width_mm;
    let volume_mm3 = ledger.area_mm2(operation) * width_mm;
    let minutes = schedule.time_s(count as f64) / 60.0;
    let largest_n = chips.largest(|s| s.cutting_n).map(|(_, stroke)| stroke.cutting_n);
    let power_w = largest_n.map(|force_n| force_n * ram_speed_mm_per_s(job, operation) / 1e3);
    let power = "largest cutting force times the ram's largest speed, pi times stroke length times double strokes per \
                 time";
    let chips_of = |definition: &'static str, pick: fn(&StrokeChips) -> u32| {
        Quantity::count(chips.strokes.iter().map(|s| u64::from(pick(s))).sum(), "chips", definition)
    };
    Section::new("chips", "Chips and cutting forces")
        .with(
            "largest_section",
            peak("section of all chips of a stroke, in the transverse plane", "mm^2", &|s| s.area_mm2),
        )
        .with(
            "largest_thickness",
            peak("uncut chip thickness, from the edge to the surface before", "um", &|s| {
                s.thickest_anywhere_mm() * UM_PER_MM
            }),
        )
        .with("largest_force", peak("cutting force along the stroke", "N", &|s| s.cutting_n))
        .with("entry_section", entry(chips.entry().map(|s| s.area_mm2), "mm^2", ENTRY_SECTION))
        .with("entry_force", entry(chips.entry().map(|s| s.cutting_n), "N", ENTRY_FORCE))
        .with(
            "largest_work_torque",
            peak("torque of the cut on the work spindle, without its sign", "N m", &|s| {
                s.work_torque_nmm.abs() / NMM_PER_NM
            }),
        )
        .with(
            "largest_cutter_torque",
            peak("torque of the cut on the cutter spindle, without its sign", "N m", &|s| {
                s.cutter_torque_nmm.abs() / NMM_PER_NM
            }),
        )
        .with(
            "median_section",
            median("mm^2", "section of all chips of a stroke: median over the strokes that cut", &|s| s.area_mm2),
        )
        .with(
            "median_force",
            median("N", "cutting force along the stroke: median over the strokes that cut", &|s| s.cutting_n),
        )
        .with("largest_power", Quantity::number_or(power_w, "W", power, IDLE))
        .with("removed_volume", Quantity::number(volume_mm3, "mm^3", "sections of all chips times the face width"))
        .with(
            "removal_rate",
            Quantity::number(
                volume_mm3 / minutes / 1e3,
                "cm^3/min",
                "volume taken away over the time of the operation's double strokes",
            ),
        )
        .with(
            "idle_strokes",
            Quantity::count(chips.idle() as u64, "strokes", "strokes in which no cutter tooth meets material"),
        )
        .with(
            "two_flank_chips",
            chips_of(
                "chips that form on two sides of a cutter tooth's edge at once (tip and flank, or both flanks)",
                |s| s.two_flank,
            ),
        )
        .with(
            "three_flank_chips",
            chips_of("chips that form on tip and both flanks of a cutter tooth at once", |s| s.three_flank),
        )
}

/// What is told of a first stroke at full depth.
pub fn entry(value: Option<f64>, unit: &'static str, definition: &'static str) -> Quantity {
    Quantity::number_or(value, unit, definition, NO_ENTRY)
}

/// Largest speed of the ram on its crank in an operation, mm/s.
pub fn ram_speed_mm_per_s(job: &ShapingJob, operation: usize) -> f64 {
    let machine = &job.machine;
    let stroke_mm = machine.approach_mm + job.scene.gear.face_width_mm + machine.overrun_mm;
    PI * stroke_mm * job.operations[operation].schedule.double_strokes_per_minute() / 60.0
}

/// Where `value` is largest: with its stroke (counted from 0), time and work angle, the space of the stroke's largest
/// chip (space j lies after tooth j) and the cutter tooth that takes it (counted from 0).
pub fn peak(
    job: &ShapingJob,
    ledger: &ChipLedger,
    operation: usize,
    what: &'static str,
    unit: &'static str,
    value: &dyn Fn(&StrokeChips) -> f64,
) -> Quantity {
    let definition = format!("largest {what}");
    let Some((stroke, chips)) = ledger.operations[operation].largest(value) else {
        return Quantity::undefined(unit, definition, IDLE);
    };
    Quantity::number(value(chips), unit, definition).at(stroke_place(job, ledger, operation, stroke))
}

/// Where a stroke that cuts stands: [`peak`] says with what.
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
