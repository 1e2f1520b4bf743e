//! Steps of a run that all processes share: flanks in parallel, maps, meshes, pictures, sheets, the parts of the
//! report.
//!
//! In: a job ([`GearJob`]) and what it is run with ([`Tools`]). A process puts the steps in its own order and adds what
//! is its own.

pub mod attempts;
pub mod axes;
pub mod backend_trial;
pub mod check_curve;
pub mod conclusion;
pub mod cut_flanks;
pub mod forecast;
pub mod foreseen;
pub mod frames;
pub mod gear_maps;
pub mod gear_surfaces;
pub mod inspection;
pub mod machine_errors;
pub mod meshes;
pub mod parts;
pub mod pictures;
pub mod planar;
pub mod program_under_test;
pub mod record;
pub mod report;
pub mod sheets;
pub mod stages;
pub mod summary;
pub mod tool_wear;
pub mod view_mesh;
pub mod whole_blank;

use crate::findings::Notice;
use crate::findings::notices::{NoBody, Stopped, Unconverged, Untouched};
use crate::interrupt::Interrupt;
use crate::job::GearJob;
use crate::number_text::significant;
use crate::output::folder::OutputFolder;
use crate::progress::Progress;
use attempts::Attempts;
use gear_maps::GearMaps;
use gearcut_core::cut::{Backend, CutStats};
use gearcut_core::error::{Error, Result};
use gearcut_core::terms::Side;
use meshes::ClosedBodies;
use parts::{Part, Parts, Stages};
use pictures::flank::PicturedFlanks;
use std::time::Duration;

/// How much work a run was.
#[derive(Debug, Clone, Copy)]
pub struct Work {
    /// What the backend met.
    pub stats: CutStats,
    /// Dexels cut, all operations.
    pub dexels: u64,
    /// Wall time of cutting and measuring, files of flanks included.
    pub elapsed: Duration,
    /// Stopped by the user before all flanks were done.
    pub interrupted: bool,
}

impl Work {
    /// Passes that a dexel which was cut met, mean: of those that other rows stand for or tell of, none count.
    pub fn passes_per_dexel(&self) -> f64 {
        self.stats.dexel_passes as f64 / self.stats.dexels.max(1) as f64
    }

    /// Number of dexels and passes of each, as the terminal and the page say it.
    pub fn dexels_in_words(&self) -> String {
        let (millions, per_dexel) = (self.dexels as f64 / 1e6, significant(self.passes_per_dexel(), 3));
        let cut = self.stats.dexels as f64 / self.dexels.max(1) as f64;
        let few = if cut < 1.0 {
            format!("; {} % were cut, the others follow from them", significant(100.0 * cut, 2))
        } else {
            String::new()
        };
        format!("{millions:.1} million, {per_dexel} passes each{few}")
    }

    /// What a reader of the results must know of how flanks were cut.
    pub fn warnings(&self) -> Vec<Notice> {
        let mut warnings = Vec::new();
        let unconverged = self.stats.unconverged;
        if unconverged > 0 {
            warnings.push(Unconverged { rays: unconverged }.notice());
        }
        if self.interrupted {
            warnings.push(Stopped {}.notice());
        }
        warnings
    }
}

/// Dexels that no pass reached; `why` says so for the process.
pub fn untouched_dexels(dexels: u64, why: &str) -> Option<Notice> {
    (dexels > 0).then(|| Untouched { dexels, why }.notice())
}

/// What a run says where a gear has no closed body.
pub const NO_BODY: &str = "mesh/gear.* and pictures of the gear and its teeth are left out";

/// Where files of single flanks go, what stands in their heads, and which of them are written.
pub type FlankFiles<'a> = (&'a OutputFolder, &'a [(String, String)], Parts);

/// Everything that a run is done with.
pub struct Tools<'a> {
    /// The scene with every value written out.
    pub resolved: &'a str,
    /// What cuts.
    pub backend: &'a dyn Backend,
    /// Why it was taken.
    pub backend_why: &'a str,
    /// Where progress is shown.
    pub progress: &'a Progress,
    /// Ctrl-C.
    pub interrupt: &'a Interrupt,
    /// Where files go.
    pub folder: &'a OutputFolder,
    /// What is written beyond the numbers.
    pub parts: Parts,
    /// What is measured.
    pub stages: Stages,
    /// Scene and program, for the heads of files.
    pub notes: &'a [(String, String)],
}

/// Both flanks of every tooth, in order.
pub fn flanks_of(job: &dyn GearJob) -> Vec<(u32, Side)> {
    (1..=job.scene().gear.teeth).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]).collect()
}

/// Names of the operations, in order.
pub fn operation_names(job: &dyn GearJob) -> Vec<String> {
    job.operations().into_iter().map(|(name, _)| name.to_owned()).collect()
}

/// Whether anything that is written shows maps of flanks.
pub fn needs_maps(parts: Parts) -> bool {
    parts.has_any(&[Part::Maps, Part::Pictures, Part::Report])
}

/// Whether anything that is written shows the surfaces of flanks.
pub fn needs_surfaces(job: &dyn GearJob, parts: Parts) -> bool {
    parts.has(Part::Meshes) || parts.has(Part::Pictures) && !job.scene().pictures.is_empty()
}

/// Meshes of the whole gear and the scene's pictures; whether all pictures were drawn or failed. `bodies` makes the
/// gear's closed bodies, [`meshes::gear`] for a cylindrical one, where it has one; a note says why not. `maps` have
/// the colours of the stock before the last operation.
///
/// # Errors
/// Ctrl-C while the body is made.
pub fn write_meshes_and_pictures(
    job: &dyn GearJob,
    tools: &Tools,
    attempts: &mut Attempts,
    (flanks, maps): (&PicturedFlanks, &GearMaps),
    bodies: impl FnOnce() -> Result<Option<ClosedBodies>>,
) -> Result<bool> {
    let Tools { progress, folder, parts, notes, .. } = *tools;
    let asked = if parts.has(Part::Pictures) { job.scene().pictures.len() } else { 0 };
    if asked == 0 && !parts.has(Part::Meshes) {
        return Ok(true);
    }
    let bodies = match bodies() {
        Ok(bodies) => bodies,
        // A gear that has no closed body: flanks that do not meet.
        Err(Error::Refused(refusal)) => {
            let why = refusal.problem;
            attempts.tell(NoBody { left_out: NO_BODY, why }.notice());
            None
        }
        Err(other) => attempts.of("the gear's closed body", Err(other))?.flatten(),
    };
    if let Some(ClosedBodies { whole, .. }) = bodies.as_ref().filter(|_| parts.has(Part::Meshes)) {
        attempts.of("meshes of the gear", meshes::write_gear(job, whole, folder, notes, progress))?;
    }
    if asked == 0 {
        return Ok(true);
    }
    let solid = bodies.as_ref().map(|bodies| bodies.pictured.as_ref().unwrap_or(&bodies.whole));
    let drawn = pictures::draw(job, solid, (flanks, maps.stock_scales.last().copied()), tools, attempts)?;
    if drawn < asked {
        progress.note(&format!("stopped: {drawn} of {asked} pictures are drawn"));
    }
    Ok(drawn == asked)
}
