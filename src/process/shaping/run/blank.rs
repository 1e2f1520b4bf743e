//! The blank field's part of a run: cut and report.

use crate::interrupt::Interrupt;
use crate::output::progress::Progress;
use crate::output::text::significant;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::scene::model::Retraction;
use crate::steps::planar::blank_report::{self, BlankReport};
use gearcut_core::cut::Backend;
use gearcut_core::cut::CutBlank;
use gearcut_core::cut::cpu::blank;
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;

/// Distance of the target outline's points: chords of a fillet then miss about 60 nm, a fifteenth of the least depth
/// that is reported.
const TARGET_SPACING_MM: f64 = 0.02;

/// The cut blank and what it says; nothing after Ctrl-C.
///
/// # Errors
/// A field that does not fit in memory; the backend's.
pub(super) fn cut(
    job: &ShapingJob,
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
) -> Result<Option<(CutBlank, BlankReport)>> {
    let field = job.planar().blank_field()?;
    let step = progress.step("cut the whole blank", blank::steps(&field) * job.operations.len() as u64, "tiles");
    let advance = || {
        step.advance(1);
        !interrupt.is_raised()
    };
    let Some(cut) = job.cut_blank(backend, field, &advance)? else { return Ok(None) };
    step.finish();
    let target = job.target_outline(TARGET_SPACING_MM).ok();
    let report = blank_report::measure(&job.planar(), &cut, target.as_ref());
    Ok(Some((cut, report)))
}

/// What must be known of return strokes that enter surfaces that stay.
pub(super) fn rubbing_warning(job: &ShapingJob, report: &BlankReport) -> Option<String> {
    let on_gear = || report.rubbing.iter().filter(|rubbing| rubbing.stays).map(|rubbing| &rubbing.damage);
    let deepest = on_gear().max_by(|a, b| a.depth_mm.total_cmp(&b.depth_mm))?;
    let volume_mm3 = on_gear().fold(0.0, |sum, damage| sum + damage.volume_mm3);
    let way_out = match job.machine.retraction {
        Retraction::CenterLine => "set machine.retraction = \"auto\"",
        _ => "set another machine.retraction or machine.back_off_mm",
    };
    Some(format!(
        "operation {}: after stroke {} the returning cutter stands {} um deep in tooth {} {}, and in {} mm3 of the gear in \
         all: {way_out}; gearcut check says where it clears",
        job.operations[deepest.operation].spec.name,
        deepest.stroke,
        significant(UM_PER_MM * deepest.depth_mm, 3),
        deepest.place.tooth,
        deepest.place.side.name(),
        significant(volume_mm3, 3),
    ))
}
