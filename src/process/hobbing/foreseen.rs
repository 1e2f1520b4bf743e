//! What is known of a hobbed gear before anything is cut; what a run cannot begin with is refused.

use super::HobCutter;
use super::axes_report::HobbingAxesReport;
use super::warnings;
use crate::output::text::Sheet;
use crate::steps::foreseen::{Foreseen, OF_WINDOWS, print_unknown, windows};
use crate::steps::parts::Stages;
use gearcut_core::error::Result;

/// Windows and warnings of a gear with its passes.
///
/// # Errors
/// A window that lies on no flank, too large a blank field, a flank that the hob does not generate.
pub fn foresee(cutter: &HobCutter, motion: &[HobbingAxesReport], wanted: Stages) -> Result<Foreseen> {
    cutter.job.blank_grid()?;
    let windows = windows(cutter, wanted)?;
    Foreseen::new(cutter, &windows, warnings::before(cutter, motion)?, true)
}

/// Which kinds of warnings only a cut can find.
pub fn print(sheet: &mut Sheet) {
    let kinds = [
        "deviations beyond limits and gouges as cut",
        "chips thicker than usual beside the middle of the face",
        "parts of the face that the hob does not cover",
        OF_WINDOWS,
    ];
    print_unknown(sheet, &kinds);
}
