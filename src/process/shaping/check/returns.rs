//! The return strokes on the terminal, before anything is cut: answers, and the chart along the curve.

use super::along::{self, bars, largest, values};
use crate::findings::Section;
use crate::output::summary;
use crate::output::text::Sheet;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::findings::{answers, program, returns};
use crate::process::shaping::quantities::returns::{
    ANGLE_AT, CLEARANCE_AT, CUTTER, DEPTH_AT, DIRECTION, PHI, RETURN_PLACES,
};
use gearcut_core::error::Refusal;

/// Adds the lines; none where the cutter is not drawn back.
///
/// # Errors
/// A back-off so large that the retraction leads to no pose.
pub fn print(sheet: &mut Sheet, job: &ShapingJob, motion: &[OperationAxes]) -> Result<(), Refusal> {
    for (index, (operation, motion)) in job.operations.iter().zip(motion).enumerate() {
        let other = program::not_of_the_operation(job, motion);
        let Some(section) = returns::section(job, index, other.as_deref())? else { return Ok(()) };
        let name = &operation.spec.name;
        sheet.details(|sheet| {
            sheet.heading(&format!("{} of {name}: {}", section.title, section.text(&DIRECTION)));
            if let Some(why) = &other {
                return summary::line(sheet, "not known", why);
            }
            answers::print(sheet, &section);
            along(sheet, &section);
        });
    }
    Ok(())
}

fn along(sheet: &mut Sheet, section: &Section) {
    let Some(table) = section.table_of(&RETURN_PLACES) else { return };
    let columns = [
        values(&PHI, "polar angle", 2),
        values(&ANGLE_AT, "retraction angle", 2),
        values(&CUTTER, "cutter", 0),
        bars(&CLEARANCE_AT, "clearance", 1, largest(table, &[&CLEARANCE_AT])),
        bars(&DEPTH_AT, "in stock", 1, largest(table, &[&DEPTH_AT])),
    ];
    along::print(sheet, table, &columns);
}
