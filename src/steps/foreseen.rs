//! What is known of a gear before anything is cut, the same for `check`, `axes` and `cut`.
//!
//! In: a job, its texture windows, what its process warns about. Out: [`Foreseen`]: the windows as they will be cut,
//! and the list of warnings as far as it follows from the scene. A process makes it in one function of its own, which
//! also refuses what a run cannot begin with (windows that lie on no flank, too large a blank field), so that a scene
//! that `check` accepts is one that `cut` starts on.

use super::inspection;
use super::parts::{Stage, Stages};
use crate::findings::Notice;
use crate::findings::notice::ranked;
use crate::job::GearJob;
use crate::output::summary;
use crate::output::text::Sheet;
use crate::texture::{self, SampledWindow, Window};
use gearcut_core::error::Result;

/// What is known before the first cut.
#[derive(Debug)]
pub struct Foreseen {
    /// Where texture is looked at.
    pub windows: Vec<SampledWindow>,
    /// What must be known before cutting.
    pub warnings: Vec<Notice>,
}

impl Foreseen {
    /// With the warnings of the process. A job `as_cut` has its passes where they will cut; on a machine that yields
    /// that is known late, and what marks say of windows with it.
    ///
    /// # Errors
    /// Geometry that cannot be cut.
    pub fn new(job: &dyn GearJob, windows: &[Window], own: Vec<Notice>, as_cut: bool) -> Result<Self> {
        let windows = texture::sampled(job, windows)?;
        let mut warnings = own;
        if let Some(gear) = job.cylindrical() {
            warnings.extend(inspection::not_judged(gear)?);
        }
        if as_cut {
            warnings.extend(texture::foreseen(job, &windows));
        }
        Ok(Self { windows, warnings: ranked(warnings) })
    }
}

/// Texture windows of a job; none where nobody looks at them.
///
/// # Errors
/// A window that lies on no flank.
pub fn windows(job: &dyn GearJob, wanted: Stages) -> Result<Vec<Window>> {
    if wanted.has(Stage::Texture) { texture::windows(job) } else { Ok(Vec::new()) }
}

/// Says in `check` which kinds of warnings only a cut can find.
pub fn print_unknown(sheet: &mut Sheet, kinds: &[&str]) {
    sheet.details(|sheet| {
        sheet.heading("Warnings that only a cut can find");
        summary::line(sheet, "about", &kinds.join("; "));
    });
}

/// What no process knows of its windows before they are cut.
pub const OF_WINDOWS: &str = "holes of texture windows";
