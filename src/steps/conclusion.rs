//! The end of a run: programs, page and `results.json`, in this order.
//!
//! In: what was found, the motion of the axes, what the parts before had to tell. Out: the files. Each shows the list
//! of warnings as far as it is known then: a program that cannot be written is told on the page, and a page that fails
//! in `results.json`, which closes the run.

use super::Tools;
use super::attempts::Attempts;
use super::axes::{self, AxesOfOperation};
use super::parts::Part;
use crate::findings::notice::ranked;
use crate::findings::notices::Draft;
use crate::findings::{Findings, RESULTS_FILE};
use crate::output::report::{PAPER_FILE, Page, REPORT_FILE};
use crate::output::vector_page::VectorPage;
use crate::scene::Scene;
use crate::steps::report::paper;
use gearcut_core::error::Result;

/// Writes them; afterwards `found` has the whole list. `page` makes the report, on paper with the inspector's `sheet`.
///
/// # Errors
/// `results.json` cannot be written; Ctrl-C.
pub fn write<O: AxesOfOperation>(
    found: &mut Findings,
    motion: &[O],
    tools: &Tools,
    attempts: &mut Attempts,
    scene: &Scene,
    page: impl FnOnce(&Findings) -> Result<Page>,
    sheet: Option<VectorPage>,
) -> Result<()> {
    let Tools { progress, folder, parts, .. } = *tools;
    let mut known = std::mem::take(&mut found.warnings);
    if scene.is_draft {
        known.push(Draft { also: scene.process.process().draft }.notice());
    }
    let list = |attempts: &Attempts| ranked(known.iter().cloned().chain(attempts.told()));
    if parts.has(Part::Axes) {
        let step = progress.step("axis programs", 1, "part");
        let written = axes::write_programs(motion, &list(attempts), folder);
        attempts.of("axis programs", written)?;
        step.advance(1);
        step.finish();
    }
    found.warnings = list(attempts);
    if parts.has(Part::Report) {
        let step = progress.step("report", 1, "page");
        let write = || {
            let page = page(found)?;
            page.write(&folder.path(REPORT_FILE)?)?;
            Ok(page)
        };
        if let Some(page) = attempts.of(REPORT_FILE, write())? {
            attempts.of(PAPER_FILE, paper::write(&page, scene, sheet, tools))?;
        }
        step.advance(1);
        step.finish();
    }
    found.warnings = list(attempts);
    found.complete &= !attempts.lost_files();
    if folder.is_nowhere() {
        return Ok(());
    }
    folder.write_json(RESULTS_FILE, &found.to_json())
}
