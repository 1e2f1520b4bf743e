//! The blank field's part of a run: cut and report.

use crate::interrupt::Interrupt;
use crate::process::shaping::ShapingJob;
use crate::progress::Progress;
use crate::steps::planar::blank_report::{self, BlankReport};
use gearcut_core::cut::Backend;
use gearcut_core::cut::CutBlank;
use gearcut_core::cut::cpu::blank;
use gearcut_core::error::Result;

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
    // One section stands for all of a spur gear.
    let slices_z_mm: &[f64] = if job.helix.is_some() { &cut.field.grid.slices_z_mm } else { &[0.0] };
    let targets: Result<Vec<_>, _> =
        slices_z_mm.iter().map(|&z_mm| job.target_outline(z_mm, TARGET_SPACING_MM)).collect();
    let report = blank_report::measure(&job.planar(), &cut, &targets.unwrap_or_default());
    Ok(Some((cut, report)))
}
