//! How far tool and work give way in an operation and how they vibrate, and what that leaves on flanks.

use super::chips::stroke_place;
use crate::findings::{Entry, Notice, QuantityRow, Section};
use crate::number_text::significant;
use crate::process::shaping::cut::chips::ChipLedger;
use crate::process::shaping::gear::measure::flank_deflection::{at_pitch_point_mm, moved_mm};
use crate::process::shaping::notices::Chatter;
use crate::process::shaping::quantities::strokes::{
    DEFLECTION, IDLE_STROKE, STABLE_WIDTH, TURNS, UNSTABLE_STROKES, VIBRATION, WAVE_LENGTH,
};
use crate::process::shaping::scene::model::MachineVibration;
use crate::process::shaping::{PreparedOperation, ShapingJob};
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

/// The first values of [`VIBRATION`], in its order, in a stroke of a machine that vibrates.
pub fn vibration_of_stroke(job: &ShapingJob, operation: usize, stroke: usize) -> [f64; 3] {
    let Some(vibration) = &job.operations[operation].vibration else { return [0.0; 3] };
    let of = vibration.strokes[stroke];
    let [left_mm, right_mm] = moved_mm(job, operation, stroke, of.rms * vibration.unit());
    [of.share_of_limit, left_mm.abs() * UM_PER_MM, right_mm.abs() * UM_PER_MM]
}

/// Deflection in an operation; nothing on a rigid machine.
pub fn section(job: &ShapingJob, ledger: &ChipLedger, operation: usize) -> Option<Section> {
    if job.operations[operation].deflections.is_empty() {
        return None;
    }
    let of = |stroke| of_stroke(job, operation, stroke);
    Some(DEFLECTION.section(largest_and_mean(job, ledger, operation, (DEFLECTION.rows, &of))))
}

/// Vibration in an operation; nothing where nothing vibrates.
pub fn vibration(job: &ShapingJob, ledger: &ChipLedger, operation: usize) -> Option<Section> {
    let machine = job.machine.vibration.filter(|_| job.operations[operation].vibration.is_some())?;
    let of = |stroke| vibration_of_stroke(job, operation, stroke);
    let strokes = 0..job.operations[operation].count();
    let unstable = strokes.filter(|&stroke| of(stroke)[0] > 1.0).count();
    let is_shift = machine.axis < 2;
    let limit = machine.mass(&job.machine.compliance).least_limit();
    let width_mm = is_shift.then(|| limit / job.material.normal_n_per_mm2);
    let own = [
        UNSTABLE_STROKES.of(unstable),
        STABLE_WIDTH.of_or(width_mm, TURNS),
        WAVE_LENGTH.of(wave_length_mm(job, operation, &machine)),
    ];
    let of_strokes = largest_and_mean(job, ledger, operation, (&VIBRATION.rows[..3], &of));
    Some(VIBRATION.section(of_strokes.into_iter().chain(own)))
}

/// Operations with strokes beyond the limit, where a wave finds room on the face.
pub fn chatter(job: &ShapingJob) -> Vec<Notice> {
    let Some(machine) = job.machine.vibration else { return Vec::new() };
    let width_mm = job.scene.gear.face_width_mm;
    let of_operation = |(index, operation): (usize, &PreparedOperation)| {
        let has_room = wave_length_mm(job, index, &machine) < width_mm;
        let unstable = operation.vibration.as_ref().filter(|_| has_room)?.strokes.iter().enumerate();
        let unstable = unstable.filter(|(_, of)| of.share_of_limit > 1.0);
        let values: Vec<[f64; 3]> = unstable.map(|(stroke, _)| vibration_of_stroke(job, index, stroke)).collect();
        let largest = |place: usize| significant(values.iter().map(|of| of[place]).fold(0.0, f64::max), 3);
        let strokes = format!("{} of {} strokes", values.len(), operation.count());
        let [times, left_um, right_um] = [0, 1, 2].map(largest);
        let chatter = Chatter { operation: &operation.spec.name, strokes, times, left_um, right_um };
        (!values.is_empty()).then(|| chatter.notice())
    };
    job.operations.iter().enumerate().filter_map(of_operation).collect()
}

/// Length along the tooth of a wave of the natural frequency, in the middle of the face.
fn wave_length_mm(job: &ShapingJob, operation: usize, machine: &MachineVibration) -> f64 {
    let middle = job.machine.speed_share(job.scene.gear.face_width_mm, 0.0);
    job.ram_speed_mm_per_s(operation) * middle / machine.natural_frequency_hz
}

/// Largest and mean of each value of a stroke over the strokes that cut.
fn largest_and_mean<const N: usize>(
    job: &ShapingJob,
    ledger: &ChipLedger,
    operation: usize,
    (rows, of_stroke): (&[&'static QuantityRow], &dyn Fn(usize) -> [f64; N]),
) -> Vec<Entry> {
    let chips = &ledger.operations[operation];
    // A first stroke at full depth is left out, as where forces are compared.
    let compared = chips.strokes.iter().enumerate().skip(usize::from(chips.enters_at_depth));
    let strokes: Vec<(usize, [f64; N])> =
        compared.filter(|(_, stroke)| !stroke.is_idle()).map(|(stroke, _)| (stroke, of_stroke(stroke))).collect();
    let of_kind = |(index, row): (usize, &&'static QuantityRow)| {
        let larger = |a: &(usize, [f64; N]), b: &(usize, [f64; N])| b.1[index].abs() > a.1[index].abs();
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
    rows.iter().enumerate().flat_map(of_kind).collect()
}
