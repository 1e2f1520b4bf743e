//! The programs of an operation, in the dialect that the scene asks for.
//!
//! In: a job and one of its operations. Out: the text, or the reason why there is none.

mod linear;
mod paper;

use crate::findings::Notice;
use crate::number_text::{plain, significant};
use crate::process::shaping::job::{PreparedOperation, ShapingJob};
use crate::process::shaping::motion::gcode::AxisProgram;
use crate::process::shaping::scene::model::{GcodeDialect, Linkage, NormalReading};
use gearcut_core::units::UM_PER_MM;

/// The program of an operation, `warnings` in its head; an error is the reason why there is none, `None`: none is
/// wanted.
pub fn text(job: &ShapingJob, operation: &PreparedOperation, warnings: &[Notice]) -> Option<Result<String, String>> {
    if job.gcode == GcodeDialect::None {
        return None;
    }
    if (operation.spec.linkage == Linkage::ShapingNormal { reading: NormalReading::AsPrinted }) {
        return Some(Err("Eq. 12 as printed turns the cutter wrongly; this reading is for comparison only".to_owned()));
    }
    Some(match job.gcode {
        GcodeDialect::PaperG84 => paper::text(job, operation, warnings),
        _ => straight_lines(job, operation, warnings),
    })
}

/// The program in straight lines, or what keeps it from being written.
fn straight_lines(job: &ShapingJob, operation: &PreparedOperation, warnings: &[Notice]) -> Result<String, String> {
    let (asked_mm, post) = (job.scene.output.gcode_contour_error_mm, job.scene.output.post);
    let (schedule, tip_radius_mm) = (&operation.schedule, job.cutter.tip_radius_mm);
    let continuous = operation.spec.feed_during_stroke;
    let (program, (reached_mm, stroke)) = if operation.retraction.is_in_axes() {
        let ram = job.ram_times();
        if ram.shortest_stay() <= 0.0 {
            return Err("the ram does not leave the face at both ends, and the axes have no time to draw the cutter \
                        back; give machine.approach_mm and machine.overrun_mm above zero"
                .to_owned());
        }
        let program =
            AxisProgram::retracting(schedule, &operation.retraction, &ram, tip_radius_mm, asked_mm, continuous, post);
        let error = program.cut_error_mm(schedule, tip_radius_mm, &ram, continuous);
        (program, error)
    } else {
        let program = AxisProgram::fit(schedule, tip_radius_mm, asked_mm, continuous, post);
        let error = program.contour_error_mm(schedule, tip_radius_mm, continuous);
        (program, error)
    };
    if reached_mm > asked_mm {
        return Err(format!(
            "the shortest blocks leave a contour error of {} um at stroke {stroke}, {} um are asked; ask for no less, \
            or take more strokes per revolution",
            significant(reached_mm * UM_PER_MM, 3),
            plain(asked_mm * UM_PER_MM),
        ));
    }
    match program.exceeded(schedule, &job.machine.limits).first() {
        Some(first) => Err(format!("{first}; take more strokes per revolution or fewer double strokes per minute")),
        None => linear::script(job, operation, &program, (reached_mm, stroke), warnings).text(post),
    }
}
