//! What is known of a shaped gear before anything is cut; what a run cannot begin with is refused.
//!
//! In: the job with the motion of its axes, what is known of a ring. Out: [`Foreseen`]. A machine that yields displaces
//! its strokes by forces that only the cut finds: `check` and `axes`, which know its rigid twin, leave to the cut what
//! follows from them.

use crate::findings::Section;
use crate::output::text::Sheet;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::findings::warnings;
use crate::steps::foreseen::{Foreseen, OF_WINDOWS, print_unknown, windows};
use crate::steps::parts::Stages;
use gearcut_core::error::Result;

/// Windows and warnings of a job.
///
/// # Errors
/// A window that lies on no flank, too large a blank field, a back-off so large that the retraction leads to no pose.
pub fn foresee(job: &ShapingJob, motion: &[OperationAxes], ring: Option<&Section>, wanted: Stages) -> Result<Foreseen> {
    let windows = windows(job, wanted)?;
    job.planar().blank_grid()?;
    let own = warnings::before(job, motion, ring)?;
    Foreseen::new(job, &windows, own, job.is_as_cut())
}

/// Which kinds of warnings only a cut can find.
pub fn print(sheet: &mut Sheet, job: &ShapingJob) {
    let mut kinds = vec![
        "deviations beyond limits, gouges and rubbing as cut",
        "the largest force after the first stroke",
        "flanks that no stroke reaches",
        OF_WINDOWS,
    ];
    if !job.is_as_cut() {
        kinds.push("the first stroke's force and the marks in windows, as the machine yields");
    }
    print_unknown(sheet, &kinds);
}
