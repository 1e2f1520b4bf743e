//! G-code for the six-axis machine: written from the motion of an operation over all slots, and read back.
//!
//! In: a prepared operation and the **contour error**, the largest displacement of the blades' tips in the work that
//! straight lines may cause. Out: a text, and from any such text the axes at every moment
//! ([`super::axis_program::read`]).
//!
//! | word | axis | unit |
//! | --- | --- | --- |
//! | X, Y, Z | middle of the head against the machine centre, Eq. 14 of the five-linkage paper | mm |
//! | A | work spindle | deg |
//! | B | swing of the work | deg |
//!
//! Every block is a straight line in all axes in inverse time (`G93`). Between slots the head withdraws along Z, the
//! axes go back and the work is indexed in one block, and the head comes in again; together they take the
//! operation's idle time. The head itself turns at the speed that the program's head says.

mod judge;
mod program;

pub use super::axis_program::{BevelKnot, BevelProgram};
pub use judge::judged;

use super::job::BevelJob;
use super::motion::{AXES, SlotMotion, limits};
use super::operation::PreparedBevel;
use crate::findings::Notice;
use crate::gcode::{AxisColumn, Script, StraightLine};
use crate::machine::Axis;
use crate::number_text::{plain, significant};
use gearcut_core::units::{TURN_RAD, UM_PER_MM};

/// The program of an operation, `warnings` in its head; an error is the reason why there is none, `None`: none is
/// wanted.
pub fn text(job: &BevelJob, operation: &PreparedBevel, warnings: &[Notice]) -> Option<Result<String, String>> {
    job.spec.programs.then(|| linear(job, operation, warnings))
}

fn linear(job: &BevelJob, operation: &PreparedBevel, warnings: &[Notice]) -> Result<String, String> {
    let motion = SlotMotion { job, operation };
    let asked_mm = job.scene.output.gcode_contour_error_mm;
    let program = BevelProgram::fit(&motion, asked_mm);
    let (reached_mm, time_s) = program.contour_error_mm(&motion);
    if reached_mm > asked_mm {
        return Err(format!(
            "the shortest blocks leave a contour error of {} um at {time_s:.3} s, {} um are asked; ask for no less, or \
             lower {}",
            significant(reached_mm * UM_PER_MM, 3),
            plain(asked_mm * UM_PER_MM),
            operation.spec.feed.key()
        ));
    }
    if let Some(first) = crate::machine::peaks(&motion, &limits(job)).iter().find(|peak| peak.exceeds_its_limit()) {
        return Err(format!(
            "the {} reaches {} {unit}, the machine allows {} {unit}; lower {}",
            first.name(),
            significant(first.shown(), 4),
            significant(first.shown_limit().unwrap_or_default(), 4),
            operation.spec.feed.key(),
            unit = first.unit()
        ));
    }
    let digits = program::digits(job, asked_mm);
    let head = [
        format!("gearcut {}: operation {} of {}", env!("CARGO_PKG_VERSION"), operation.spec.name, job.scene.name),
        "UNITS mm and deg; G90 absolute; G93 inverse time, F = 1 / minutes of the block".to_owned(),
        "AXES X Y Z middle of the plane of the tips, A work spindle, B swing".to_owned(),
        "SIGNS Z along the axis of the head to the work; X in the plane of the axes of head and work, away from the \
        apex; Y completes them to a right-hand frame; A about the axis of the work from the back to the apex; B from \
        the axis of the work at right angles to that of the head"
            .to_owned(),
        format!(
            "ZERO X0 Y0 Z0: the swing axis; the apex of the work is {} mm from it along the axis of the work, \
             towards the head",
            plain(job.machine.mounting_mm)
        ),
        format!(
            "SET UP head of {} blades, mean radius {:.6} mm, point width {} mm, {:.4} 1/min against the cradle angle",
            job.head.blades(),
            job.head.radius_mm,
            plain(job.head.point_width_mm),
            operation.spec.head_speed_rad_per_s / TURN_RAD * 60.0
        ),
        format!("GEAR z {}, {} slots one after the other", job.blank.teeth, job.blank.teeth),
        format!(
            "CONTOUR at most {} um at the tips of the blades asked, {} um reached at {time_s:.3} s",
            plain(asked_mm * UM_PER_MM),
            significant(reached_mm * UM_PER_MM, 6)
        ),
    ];
    let told = warnings.iter().map(Notice::line);
    let column = |axis: &Axis| AxisColumn { letter: axis.letter, kind: axis.kind, digits: digits.of(axis.kind) };
    let position = |knot: &BevelKnot| AXES.iter().zip(&knot.axes).map(|(axis, &at)| axis.kind.shown(at)).collect();
    let line = |pair: &[BevelKnot]| StraightLine {
        to: position(&pair[1]),
        per_minute: 60.0 / (pair[1].time_s - pair[0].time_s),
    };
    let script = Script {
        name: operation.spec.name.clone(),
        number: program_number(job, operation),
        head: head.into_iter().chain(told).collect(),
        columns: AXES.iter().map(column).collect(),
        // The head stands back along its axis as between slots.
        clear: (2, program::clear_mm(job, &program)),
        ram: None,
        start: position(&program.knots[0]),
        lines: program.knots.windows(2).map(line).collect(),
        contour_error_mm: asked_mm,
    };
    script.text(job.scene.output.post)
}

/// Number of an operation's program among those of its scene, from 1.
pub fn program_number(job: &BevelJob, operation: &PreparedBevel) -> u32 {
    job.operations.iter().take_while(|before| before.spec.name != operation.spec.name).count() as u32 + 1
}
