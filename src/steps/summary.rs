//! What is printed when a run is done: which gear, what was found, how much work it was.

use super::Work;
use crate::findings::Findings;
use crate::findings::warning::count_words;
use crate::output::summary;
use crate::output::text::{Sheet, plain, significant};
use crate::scene::model::Gear;
use std::path::Path;

/// The summary of a run that has finished `flanks` flanks, of which `lost` are cut away, on `backend` and has written
/// to `out`.
pub fn text(
    gear: &Gear,
    findings: &Findings,
    [flanks, lost]: [usize; 2],
    work: &Work,
    out: &Path,
    backend: &str,
) -> String {
    let mut sheet = Sheet::default();
    let state = if findings.complete { "" } else { ", stopped before all were done" };
    let away = if lost > 0 { format!(", {lost} of them away") } else { String::new() };
    sheet.heading(&format!(
        "{}: {} teeth, module {} mm, {flanks} of {} flanks cut{away}{state}",
        findings.scene,
        gear.teeth,
        plain(gear.module_mm),
        2 * gear.teeth,
    ));
    summary::print(findings, &mut sheet);
    sheet.heading("Run");
    summary::line(&mut sheet, "backend", backend);
    summary::line(&mut sheet, "dexels", &work.dexels_in_words());
    let seconds = significant(work.elapsed.as_secs_f64(), 3);
    summary::line(&mut sheet, "cut, measured and mapped in", &format!("{seconds} s"));
    sheet.line("written to", out.display().to_string());
    sheet.line("told above", count_words(&findings.warnings));
    sheet.into_text()
}
