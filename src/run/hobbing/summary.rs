//! What is printed when a hobbed gear is done.

use super::HobbedGear;
use super::results::headline;
use crate::job::HobbingJob;
use crate::output::text::{Sheet, significant};
use std::path::Path;

/// What is printed when a run is done.
pub fn summary(job: &HobbingJob, gear: &HobbedGear, out: &Path, backend: &str) -> String {
    let mut sheet = Sheet::default();
    let spec = &job.scene.gear;
    let work = &gear.work;
    let state = if work.interrupted { ", stopped before all flanks were done" } else { "" };
    sheet.heading(&format!(
        "{}: {} teeth, module {} mm, {} of {} flanks hobbed{state}",
        job.scene.name,
        spec.teeth,
        spec.module_mm,
        gear.flanks.len(),
        2 * spec.teeth,
    ));
    for (key, quantity) in headline(job, gear) {
        let label = key.replace('_', " ");
        let value = match (quantity.value(), quantity.place()) {
            (Some(value), place) => {
                let at = place.map_or_else(String::new, |p| format!(" (tooth {} {})", p.tooth, p.flank));
                format!("{} {}{at}", significant(value, 4), quantity.unit().unwrap_or(""))
            }
            (None, _) => format!("none ({})", quantity.why().unwrap_or("not defined")),
        };
        sheet.line(&label, value);
    }
    let seconds = work.elapsed.as_secs_f64();
    sheet.line(
        "work",
        format!(
            "{} dexels, {:.1} passes each, in {seconds:.1} s on {backend}",
            work.dexels,
            work.stats.dexel_passes as f64 / work.dexels.max(1) as f64
        ),
    );
    let untouched: u64 = gear.flanks.iter().map(|f| f.untouched).sum();
    if untouched > 0 {
        sheet.line(
            "warning",
            format!("{untouched} dexels were reached by no pass: the hob does not cover the whole face"),
        );
    }
    if work.stats.unconverged > 0 {
        let count = work.stats.unconverged;
        sheet.line(
            "warning",
            format!("{count} rays did not converge: their heights may be too large; please report the scene"),
        );
    }
    sheet.line("files", out.display().to_string());
    sheet.into_text()
}
