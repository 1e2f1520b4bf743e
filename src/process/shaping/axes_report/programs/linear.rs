//! A program in straight lines, with everything in its head that the operator must know.

use crate::findings::Notice;
use crate::gcode::{AxisColumn, Ram, Script, StraightLine};
use crate::machine::Axis;
use crate::number_text::plain;
use crate::process::shaping::helix::Helix;
use crate::process::shaping::job::{PreparedOperation, ShapingJob};
use crate::process::shaping::linkage::dynamics::AXES;
use crate::process::shaping::motion::gcode::{AxisProgram, Knot};
use gearcut_core::gear::GearKind;

/// Room between cutter and blank before and after a program, mm.
const CLEAR_MM: f64 = 2.0;

/// A program in straight lines, for an operation of a job, and its largest contour error (mm) with the stroke that has
/// it; `warnings` go into its head.
pub fn script(
    job: &ShapingJob,
    operation: &PreparedOperation,
    program: &AxisProgram,
    (error_mm, worst): (f64, f64),
    warnings: &[Notice],
) -> Script {
    let output = &job.scene.output;
    let tip_radius_mm = job.cutter.tip_radius_mm;
    let reach_mm = program.knots.iter().map(|k| k.center_distance_mm).fold(0.0, f64::max) + tip_radius_mm;
    let digits = output.post.digits(output.gcode_contour_error_mm, reach_mm);
    let feed = if operation.spec.feed_during_stroke {
        "CONTINUOUS: the feed runs on during the cutting stroke"
    } else {
        "INTERMITTENT: the axes rest while the cutter is in the work and move in the return stroke"
    };
    let head = [
        format!("gearcut {}: operation {} of {}", env!("CARGO_PKG_VERSION"), operation.spec.name, job.scene.name),
        "UNITS mm and deg; G90 absolute; G93 inverse time, F = 1 / minutes of the block".to_owned(),
        "AXES X centre distance, C work spindle, B cutter spindle; C and B counter-clockwise from above".to_owned(),
        "FRAME C0: polar angle 0 of the gear on the line of centres; B0: cutter tooth 0 points at the work".to_owned(),
        format!(
            "GEAR z {} m {} mm; CUTTER z0 {}, pitch radius {} mm",
            job.scene.gear.teeth,
            plain(job.scene.gear.module_mm),
            job.cutter.teeth,
            plain(job.cutter.pitch_radius_mm)
        ),
        format!("LINKAGE {}, offset {} mm", operation.linkage.words(), plain(operation.spec.offset_mm)),
        format!(
            "STROKES {} at {} per minute; S is double strokes per minute",
            program.count(),
            plain(program.double_strokes_per_minute)
        ),
        format!("FEED {feed}"),
        format!(
            "CONTOUR at most {} um on the flanks asked, {} um reached at stroke {worst}",
            plain(output.gcode_contour_error_mm * 1e3),
            plain(error_mm * 1e3)
        ),
    ];
    let retraction = &operation.retraction;
    let after = if retraction.is_in_axes() {
        vec![
            format!(
                "RETRACTION {} by {} mm, in X, C and B; the machine's own relief is to be switched off",
                retraction.asked().words(),
                plain(retraction.back_off_mm())
            ),
            "The ram passes the middle of the face, cutting stroke 0, when the first G93 block begins".to_owned(),
            "Approach and clamping are the operator's".to_owned(),
        ]
    } else {
        vec![
            "The ram is at the top of stroke 0 when the first G93 block begins".to_owned(),
            "Relief on the return stroke is the machine's own; approach and clamping are the operator's".to_owned(),
        ]
    };
    let told = warnings.iter().map(Notice::line);
    let [work, cutter, distance] = &AXES;
    // The work turns by -psi_c.
    let position = |knot: &Knot| {
        let axes = [(distance, knot.center_distance_mm), (work, -knot.psi_c_rad), (cutter, knot.psi_b_rad)];
        axes.map(|(axis, position)| axis.kind.shown(position)).to_vec()
    };
    let column = |axis: &Axis| AxisColumn { letter: axis.letter, kind: axis.kind, digits: digits.of(axis.kind) };
    let line = |pair: &[Knot]| StraightLine {
        to: position(&pair[1]),
        per_minute: program.double_strokes_per_minute / (pair[1].stroke - pair[0].stroke),
    };
    Script {
        name: operation.spec.name.clone(),
        number: job.operations.iter().take_while(|before| before.spec.name != operation.spec.name).count() as u32 + 1,
        head: head.into_iter().chain(job.helix.as_ref().map(guide_words)).chain(after).chain(told).collect(),
        columns: [distance, work, cutter].map(column).to_vec(),
        clear: (0, clear_mm(job)),
        ram: Some(Ram {
            per_minute: program.double_strokes_per_minute,
            shown: plain(program.double_strokes_per_minute),
            runs_on: program.runs_on,
        }),
        start: position(&program.knots[0]),
        lines: program.knots.windows(2).map(line).collect(),
        contour_error_mm: output.gcode_contour_error_mm,
    }
}

/// The helical guide, which turns the cutter beside what the program commands.
fn guide_words(helix: &Helix) -> String {
    format!(
        "GUIDE helical, {}-hand, lead {} mm, turning the cutter by nothing in the middle of the face; B is without it",
        helix.hand.name(),
        plain(helix.lead_mm)
    )
}

/// Centre distance at which the cutter is clear of the blank, however both are turned: beside it, or in the middle of a
/// ring.
fn clear_mm(job: &ShapingJob) -> f64 {
    match job.blank.kind() {
        GearKind::External => {
            let largest_mm = job.curve.facts().largest_radius_mm + job.blank.addendum_mm;
            (largest_mm + job.cutter.tip_radius_mm + CLEAR_MM).ceil()
        }
        GearKind::Internal => 0.0,
    }
}
