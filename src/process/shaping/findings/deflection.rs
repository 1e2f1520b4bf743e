//! How far tool and work give way in an operation, and what that leaves on flanks.

use super::chips::stroke_place;
use crate::findings::{QuantityRow, Section};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::cut::chips::ChipLedger;
use crate::process::shaping::gear::measure::flank_deflection::at_pitch_point_mm;
use crate::process::shaping::quantities::strokes::{DEFLECTION, IDLE_STROKE};
use gearcut_core::units::UM_PER_MM;

/// urad in a rad.
const URAD_PER_RAD: f64 = 1e6;

/// The values of [`DEFLECTION`], in its order, in a stroke of a machine that yields.
pub fn of_stroke(job: &ShapingJob, operation: usize, stroke: usize) -> [f64; 6] {
    let of = job.operations[operation].deflections.get(stroke).copied().unwrap_or_default();
    let [left_mm, right_mm] = at_pitch_point_mm(job, operation, stroke);
    [
        of.radial_mm * UM_PER_MM,
        of.tangential_mm * UM_PER_MM,
        of.tool_rad * URAD_PER_RAD,
        of.work_rad * URAD_PER_RAD,
        left_mm * UM_PER_MM,
        right_mm * UM_PER_MM,
    ]
}

/// Largest and mean of each over the strokes that cut; nothing on a rigid machine.
pub fn section(job: &ShapingJob, ledger: &ChipLedger, operation: usize) -> Option<Section> {
    if job.operations[operation].deflections.is_empty() {
        return None;
    }
    let chips = &ledger.operations[operation];
    // A first stroke at full depth is left out, as where forces are compared.
    let compared = chips.strokes.iter().enumerate().skip(usize::from(chips.enters_at_depth));
    let strokes: Vec<(usize, [f64; 6])> = compared
        .filter(|(_, stroke)| !stroke.is_idle())
        .map(|(stroke, _)| (stroke, of_stroke(job, operation, stroke)))
        .collect();
    let of_kind = |(index, row): (usize, &&'static QuantityRow)| {
        let larger = |a: &(usize, [f64; 6]), b: &(usize, [f64; 6])| b.1[index].abs() > a.1[index].abs();
        let largest = strokes.iter().copied().reduce(|best, next| if larger(&best, &next) { next } else { best });
        let sum: f64 = strokes.iter().map(|(_, values)| values[index]).sum();
        let mean = (!strokes.is_empty()).then(|| sum / strokes.len() as f64);
        let named = |what: &str| format!("{what}_{}", row.key);
        [
            row.of_or(largest.map(|(_, values)| values[index]), IDLE_STROKE)
                .at(largest.map(|(stroke, _)| stroke_place(job, ledger, operation, stroke)))
                .titled(named("largest").replace('_', " "))
                .keyed(named("largest")),
            row.of_or(mean, IDLE_STROKE).titled(named("mean").replace('_', " ")).keyed(named("mean")),
        ]
    };
    Some(DEFLECTION.section(DEFLECTION.rows.iter().enumerate().flat_map(of_kind)))
}
