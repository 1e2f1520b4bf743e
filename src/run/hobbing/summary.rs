//! What is printed when a hobbed gear is done.

use super::results::headline;
use super::{HobbedGear, marks, points};
use crate::axes_report::HobbingAxesReport;
use crate::cut::KERNEL_UM;
use crate::job::HobbingJob;
use crate::job::shaping::RAY_DEPTH_MODULES;
use crate::measure::marks::MarkLattice;
use crate::output::text::{Sheet, significant};
use std::path::Path;

/// What is printed when a run is done.
pub fn summary(job: &HobbingJob, gear: &HobbedGear, lattices: &[MarkLattice], out: &Path, backend: &str) -> String {
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
                let unit = quantity.unit().unwrap_or("");
                let value = if unit == "um" && value.abs() < KERNEL_UM { 0.0 } else { value };
                format!("{} {unit}{at}", significant(value, 4))
            }
            (None, _) => format!("none ({})", quantity.why().unwrap_or("not defined")),
        };
        sheet.line(&label, value);
    }
    for errors in points::errors(gear) {
        if let Some(spread) = errors.spread {
            let [mean, sigma] = [spread.mean_um, spread.sigma_um].map(|um| significant(um, 3));
            sheet.line(
                &errors.key.replace('_', " "),
                format!("{mean} um, sigma {sigma} um over {} points", spread.count),
            );
        }
    }
    for lattice in lattices {
        sheet.line(&format!("marks, tooth {} {}", lattice.tooth, lattice.side.name()), marks::words(lattice));
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
    let of_axes = HobbingAxesReport::of_job(job);
    for warning in warnings(job, gear).into_iter().chain(of_axes.iter().flat_map(HobbingAxesReport::warnings)) {
        sheet.line("warning", warning);
    }
    sheet.line("files", out.display().to_string());
    sheet.into_text()
}

/// What a reader must know before trusting the numbers.
pub(in crate::run) fn warnings(job: &HobbingJob, gear: &HobbedGear) -> Vec<String> {
    let mut warnings = Vec::new();
    if job.scene.hobbing().is_some_and(|hobbing| hobbing.tool.protuberance.is_some()) {
        warnings.push(
            "the target knows no protuberance: the relief that it leaves at the roots stands as a cut below the target and as gouges".to_owned(),
        );
    }
    let reach_mm = RAY_DEPTH_MODULES * job.scene.gear.module_mm;
    let lowest_mm = gear.flanks.iter().filter_map(|f| f.finished).map(|h| h.lowest_mm).fold(0.0, f64::min);
    if lowest_mm < -0.999 * reach_mm {
        warnings
            .push(format!("cuts go deeper than rays record: {reach_mm} mm under the target stands for that and more"));
    }
    let untouched: u64 = gear.flanks.iter().map(|f| f.untouched).sum();
    if untouched > 0 {
        warnings.push(format!("{untouched} dexels were reached by no pass: the hob does not cover the whole face"));
    }
    let unconverged = gear.work.stats.unconverged;
    if unconverged > 0 {
        warnings.push(format!(
            "{unconverged} rays did not converge: their heights may be too large; please report the scene"
        ));
    }
    if gear.work.interrupted {
        warnings.push("stopped by Ctrl-C: figures cover the finished flanks only".to_owned());
    }
    warnings
}
