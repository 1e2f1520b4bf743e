//! The text of a program, with everything in its head that the operator must know.

use crate::findings::Warning;
use crate::gcode::{Digits, ProgramText, axis_word};
use crate::machine::Axis;
use crate::output::text::plain;
use crate::process::shaping::gcode::{AxisProgram, Knot};
use crate::process::shaping::job::{PreparedOperation, ShapingJob};
use crate::process::shaping::linkage::dynamics::AXES;

/// A program in the linear dialect, for an operation of a job, and its largest contour error (mm) with the stroke that
/// has it; `warnings` go into its head.
pub fn text(
    job: &ShapingJob,
    operation: &PreparedOperation,
    program: &AxisProgram,
    (error_mm, worst): (f64, f64),
    warnings: &[Warning],
) -> String {
    let output = &job.scene.output;
    let tip_radius_mm = job.cutter.tip_radius_mm;
    let reach_mm = program.knots.iter().map(|k| k.center_distance_mm).fold(0.0, f64::max) + tip_radius_mm;
    let digits = Digits::new(output.gcode_contour_error_mm, reach_mm);
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
    let head: Vec<String> = head.into_iter().chain(after).collect();
    let position = |knot: &Knot| {
        let [work, cutter, distance] = &AXES;
        let word = |axis: &Axis, position: f64| axis_word(axis, position, digits.of(axis.kind));
        // The work turns by -psi_c.
        [word(distance, knot.center_distance_mm), word(work, -knot.psi_c_rad), word(cutter, knot.psi_b_rad)].join(" ")
    };
    let mut text = ProgramText::new(&head, warnings.iter().map(Warning::line));
    text.block("G21 G90 G94");
    text.block(&format!("G0 {}", position(&program.knots[0])));
    text.block(&format!("S{} M3", plain(program.double_strokes_per_minute)));
    for pair in program.knots.windows(2) {
        let per_minute = program.double_strokes_per_minute / (pair[1].stroke - pair[0].stroke);
        text.block(&format!("G93 G1 {} F{per_minute:.9}", position(&pair[1])));
    }
    // The last stroke is made where the last block ends.
    text.block(&format!("G4 P{:.9}", 60.0 / program.double_strokes_per_minute));
    text.block("M5");
    text.block("M30");
    text.finish()
}
