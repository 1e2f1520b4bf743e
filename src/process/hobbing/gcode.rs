//! G-code for a five- or six-axis CNC hobbing machine: written from a linkage, and read back into axis positions.
//!
//! In: a prepared operation and the **contour error**, the largest displacement of the hob in the work that straight
//! lines may cause where both meet. Out: two texts, and from any such text the axes at every moment
//! ([`crate::process::hobbing::commanded::read`]).
//!
//! | word | axis | unit |
//! | --- | --- | --- |
//! | X | tangential: pitch point against the work's axis, along the rack | mm |
//! | Y | radial: pitch plane of the hob against the work's axis, infeed included | mm |
//! | Z | slide along the work's axis, 0 in the middle of the face | mm |
//! | W | shift along the hob's axis, 0 with its middle at the pitch point; diagonal hobbing only | mm |
//! | B | hob spindle in the cutting direction | deg |
//! | C | work spindle, counter-clockwise seen against Z | deg |
//!
//! **Fully interpolated**: every block is a straight line in all axes, in inverse time (`G93`). **With an electronic
//! gearbox**: the control itself couples the work to hob, slide and shift as it does for a round gear,
//! `C = k_B B + k_Z Z + k_W W`, the rolling of a circle as long as the pitch curve; the word C then commands what is
//! added to it, the variation of a gear that is not round. Its digits stay few and the synchronism of hob and work no
//! longer hangs on the interpolation.
//!
//! Road not taken: cycles of single controls. Their names and parameters differ from maker to maker; the coupling's
//! three numbers stand in the head of the program instead.

mod judge;
mod program;
mod text;

pub use crate::process::hobbing::commanded::HobbingProgram;
pub use judge::judged;
pub use program::Gearbox;
pub use text::program_numbers;

use crate::findings::Notice;
use crate::number_text::{plain, significant};
use crate::process::hobbing::HobbingJob;
use crate::process::hobbing::job::PreparedHobbing;
use gearcut_core::units::UM_PER_MM;

/// Both programs of an operation, fully interpolated and with a gearbox, `warnings` in their heads; an error is the
/// reason why there are none, `None`: none are wanted.
pub fn texts(
    job: &HobbingJob,
    operation: &PreparedHobbing,
    warnings: &[Notice],
) -> Option<Result<[String; 2], String>> {
    job.programs.then(|| linear(job, operation, warnings))
}

fn linear(job: &HobbingJob, operation: &PreparedHobbing, warnings: &[Notice]) -> Result<[String; 2], String> {
    let linkage = &operation.linkage;
    if linkage.law().is_as_printed() {
        return Err(
            "the linkage as printed parts work and carriage on a curve that is no circle; it is for comparison only"
                .to_owned(),
        );
    }
    let asked_mm = job.scene.output.gcode_contour_error_mm;
    let program = HobbingProgram::fit(job, operation, asked_mm);
    let (reached_mm, time_s) = program.contour_error_mm(job, operation);
    if reached_mm > asked_mm {
        return Err(format!(
            "blocks of {} ms leave a contour error of {} um at {time_s:.3} s, {} um are asked; ask for no less, or \
            lower hob_speed_per_minute",
            significant(1e3 * program::shortest_block_s(job, linkage), 3),
            significant(reached_mm * UM_PER_MM, 3),
            plain(asked_mm * UM_PER_MM),
        ));
    }
    if let Some(first) = program.exceeded(&job.limits, &linkage.corners_s()).first() {
        return Err(format!("{first}; lower hob_speed_per_minute, or take another even_motion"));
    }
    let gearbox = Gearbox::new(linkage);
    let geared = program.geared(&gearbox, -1.0);
    let written = |program, gearbox| {
        text::script(job, operation, program, gearbox, (reached_mm, time_s), warnings).text(job.scene.output.post)
    };
    Ok([written(&program, None)?, written(&geared, Some(&gearbox))?])
}
