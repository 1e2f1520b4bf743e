//! What is printed when a run is done: which gear, what was found, how much work it was.

use super::Work;
use crate::findings::Findings;
use crate::findings::notice::count_words;
use crate::number_text::{plain, significant};
use crate::output::summary;
use crate::output::text::Sheet;
use crate::scene::model::Gear;
use std::path::Path;

/// Most lines of a brief summary.
const BRIEF_LINES: usize = 40;

/// What is printed of a run, briefly and as a whole.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Summary {
    /// On one screen: headline, deviations, what must be known.
    pub brief: String,
    /// Every section.
    pub whole: String,
}

/// The summary of a run that has finished `flanks` flanks, of which `lost` are cut away, on `backend` and has written
/// to `out`.
pub fn text(
    gear: &Gear,
    findings: &Findings,
    [flanks, lost]: [usize; 2],
    work: &Work,
    out: &Path,
    backend: &str,
) -> Summary {
    let state = if findings.complete { "" } else { ", stopped before all were done" };
    let away = if lost > 0 { format!(", {lost} of them away") } else { String::new() };
    let title = format!(
        "{}: {} teeth, module {} mm, {flanks} of {} flanks cut{away}{state}",
        findings.scene,
        gear.teeth,
        plain(gear.module_mm),
        2 * gear.teeth,
    );
    let run = |sheet: &mut Sheet| {
        sheet.heading("Run");
        summary::line(sheet, "backend", backend);
        sheet.details(|sheet| summary::line(sheet, "dexels", &work.dexels_in_words()));
        let seconds = significant(work.elapsed.as_secs_f64(), 3);
        summary::line(sheet, "cut, measured and mapped in", &format!("{seconds} s"));
        sheet.line("written to", out.display().to_string());
        sheet.line("shown above", count_words(&findings.warnings));
        if sheet.is_brief() {
            sheet.line("more", "with --verbose, in results.json and report.html");
        }
    };
    let mut whole = Sheet::default();
    whole.heading(&title);
    summary::print(findings, &mut whole);
    run(&mut whole);
    let [mut brief, mut end] = [Sheet::brief(), Sheet::brief()];
    brief.heading(&title);
    // A first heading is written at once.
    end.words("");
    run(&mut end);
    summary::print_brief(findings, &mut brief, BRIEF_LINES - end.count_lines());
    run(&mut brief);
    Summary { brief: brief.into_text(), whole: whole.into_text() }
}
