//! G-code for a three-axis CNC gear shaper: written from a stroke schedule, and read back into axis positions.
//!
//! The programs move three axes while the ram runs: `X` centre distance (mm), `C` work spindle and `B` cutter spindle
//! (deg). Signs are those of the machine: the work turns by -psi_c, so C = -psi_c, and B = psi_b, both
//! counter-clockwise seen from above, from where the ram comes. Blocks are straight lines in all axes at once and last
//! whole double strokes, in inverse time (`G93`: F = 1 / minutes), so that ram and feed stay in step whatever the axes
//! do.
//!
//! In: [`AxisProgram::fit`] takes a schedule and the **contour error**, the largest displacement that straight lines
//! may cause anywhere on the cutter's flanks. Out: the text ([`write::text`]), and from any such text the axis
//! positions at every stroke ([`read::program`]). A scene's operation can name a program; the gear is then cut as the
//! program says.
//!
//! The dialect that is read: `G0`, `G1`, `G4 P` (dwell, s), `G21`, `G90`, `G93`, `G94`, `M3`, `M5`, `M2`, `M30`, words
//! `N S F X B C`, comments in round brackets or after `;`, `%`. Everything else is refused by line and word: a word
//! that is passed over may be the one that matters.
//!
//! Road not taken: one point per stroke. It is exact, and at 4,200 strokes it starves the block buffer of older
//! controls; straight lines within a micrometre need a tenth.

pub mod paper;
pub mod program;
pub mod read;
pub mod write;

pub use program::{AxisProgram, Knot};

use crate::output::text::{plain, significant};
use crate::process::shaping::scene::model::{GcodeDialect, Linkage, NormalReading};
use crate::process::shaping::{PreparedOperation, ShapingJob};
use crate::units::UM_PER_MM;

/// The program of an operation; an error is the reason why there is none, `None`: none is wanted.
pub fn text(job: &ShapingJob, operation: &PreparedOperation) -> Option<Result<String, String>> {
    if job.gcode == GcodeDialect::None {
        return None;
    }
    if (operation.spec.linkage == Linkage::ShapingNormal { reading: NormalReading::AsPrinted }) {
        return Some(Err("Eq. 12 as printed turns the cutter wrongly; this reading is for comparison only".to_owned()));
    }
    Some(match job.gcode {
        GcodeDialect::PaperG84 => paper::text(job, operation),
        _ => linear(job, operation),
    })
}

/// The program in straight lines, or what keeps it from being written.
fn linear(job: &ShapingJob, operation: &PreparedOperation) -> Result<String, String> {
    let asked_mm = job.scene.output.gcode_contour_error_mm;
    let (schedule, tip_radius_mm) = (&operation.schedule, job.cutter.tip_radius_mm);
    let continuous = operation.spec.feed_during_stroke;
    let program = AxisProgram::fit(schedule, tip_radius_mm, asked_mm, continuous);
    let (reached_mm, stroke) = program.contour_error_mm(schedule, tip_radius_mm, continuous);
    if reached_mm > asked_mm {
        return Err(format!(
            "blocks of one double stroke leave a contour error of {} um at stroke {stroke}, {} um are asked; ask for \
            no less, or take more strokes per revolution",
            significant(reached_mm * UM_PER_MM, 3),
            plain(asked_mm * UM_PER_MM),
        ));
    }
    match program.exceeded(&job.machine.limits).first() {
        Some(first) => Err(format!("{first}; take more strokes per revolution or fewer double strokes per minute")),
        None => Ok(write::text(job, operation, &program)),
    }
}
