//! How far tool and work give way in an operation, and what that leaves on flanks.

use super::chips::stroke_place;
use crate::findings::{Quantity, Section};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::chips::ChipLedger;
use crate::process::shaping::measure::flank_deflection::at_pitch_point_mm;
use gearcut_core::units::UM_PER_MM;

const IDLE: &str = "all strokes are idle";
/// urad in a rad.
const URAD_PER_RAD: f64 = 1e6;

/// What is told of every stroke: key, name, unit, definition.
pub const KINDS: [(&str, &str, &str, &str); 6] = [
    ("radial_deflection", "radial", "um", "shift of the cutter along the line of centres, away from the work axis"),
    (
        "tangential_deflection",
        "tangential",
        "um",
        "shift of the cutter across the line of centres, towards larger work angles",
    ),
    ("cutter_turn", "cutter spindle", "urad", "turn of the cutter, counter-clockwise"),
    ("work_turn", "work spindle", "urad", "turn of the work, counter-clockwise"),
    (
        "left_flank_deflection",
        "left flanks",
        "um",
        "material left on left flanks at the stroke's pitch point, along their normal",
    ),
    ("right_flank_deflection", "right flanks", "um", "material left on right flanks there, along their normal"),
];

/// The values of [`KINDS`] in a stroke of a machine that yields.
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
    let mut section = Section::new("deflection", "Deflection of cutter and work");
    for (index, (key, _, unit, definition)) in KINDS.into_iter().enumerate() {
        let larger = |a: &(usize, [f64; 6]), b: &(usize, [f64; 6])| b.1[index].abs() > a.1[index].abs();
        let largest = strokes.iter().copied().reduce(|best, next| if larger(&best, &next) { next } else { best });
        let what = format!("{definition}: the largest without its sign, given with it");
        section = section.with(
            &format!("largest_{key}"),
            match largest {
                Some((stroke, values)) => {
                    Quantity::number(values[index], unit, what).at(stroke_place(job, ledger, operation, stroke))
                }
                None => Quantity::undefined(unit, what, IDLE),
            },
        );
        let sum: f64 = strokes.iter().map(|(_, values)| values[index]).sum();
        let mean = (!strokes.is_empty()).then(|| sum / strokes.len() as f64);
        let what = format!("{definition}: mean over the strokes that cut");
        section = section.with(&format!("mean_{key}"), Quantity::number_or(mean, unit, what, IDLE));
    }
    Some(section)
}
