//! The return strokes on the terminal, before anything is cut: answers, and the chart along the curve.

use super::along::{self, bars, largest, values};
use crate::findings::Section;
use crate::output::text::Sheet;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::findings::{answers, returns};
use gearcut_core::error::Refusal;

/// Adds the lines; gives the warnings.
///
/// # Errors
/// A back-off so large that the retraction leads to no pose.
pub fn print(sheet: &mut Sheet, job: &ShapingJob) -> Result<Vec<String>, Refusal> {
    let mut warnings = Vec::new();
    for (index, operation) in job.operations.iter().enumerate() {
        let Some(section) = returns::section(job, index)? else {
            return Ok(vec![
                "machine.back_off_mm = 0: the cutter returns along the surfaces that it has cut".to_owned(),
            ]);
        };
        let name = &operation.spec.name;
        sheet.heading(&format!("{} of {name}: {}", section.title, section.words("direction")));
        answers::print(sheet, &section);
        along(sheet, &section);
        warnings.extend(returns::warning(name, &section));
    }
    Ok(warnings)
}

fn along(sheet: &mut Sheet, section: &Section) {
    let Some(table) = section.table_of("places") else { return };
    let columns = [
        values("phi", "polar angle", 2),
        values("retraction_angle", "retraction angle", 2),
        values("cutter", "cutter", 0),
        bars("clearance", "clearance", 1, largest(table, &["clearance"])),
        bars("depth_in_stock", "in stock", 1, largest(table, &["depth_in_stock"])),
    ];
    along::print(sheet, table, &columns);
}
