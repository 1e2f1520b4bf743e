//! A bevel gear, cut and measured flank by flank.

use super::job::BevelJob;
use super::measure::{self, BevelReport, SlotRow};
use crate::interrupt::Interrupt;
use crate::output::progress::Progress;
use crate::steps::cut_flanks::{CutFlank, cut_flanks, dexels_of};
use crate::steps::gear_maps::GearMaps;
use crate::steps::pictures::flank::PicturedFlanks;
use crate::steps::{FlankFiles, Work};
use crate::surface::SurfaceGrid;
use gearcut_core::cut::Backend;
use gearcut_core::error::{Error, Result};
use gearcut_core::terms::Side;

/// A cut and measured gear.
#[derive(Debug)]
pub struct BevelGear {
    /// Finished flanks in order.
    pub flanks: Vec<BevelReport>,
    /// The slot behind tooth 1; empty where one of its flanks was not cut.
    pub slot: Vec<SlotRow>,
    /// Maps of all finished flanks at map spacing.
    pub maps: GearMaps,
    /// Their surfaces at mesh spacing; empty where nothing that is written needs them.
    pub surfaces: Vec<SurfaceGrid>,
    /// What pictures of single flanks show.
    pub pictured: PicturedFlanks,
    /// How much work it was.
    pub work: Work,
}

/// Cuts and measures all flanks; maps and meshes of flanks go to `folder` as soon as a flank is done.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error: what is finished is returned.
pub fn cut_gear(
    job: &BevelJob,
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
    folder: Option<FlankFiles<'_>>,
) -> Result<BevelGear> {
    let cut_one = |tooth, side| {
        let rays = job.rays(tooth, side)?;
        let (layers, stats) = job.cut_field(backend, job.space_of(tooth, side), &rays.field)?;
        let report = measure::measure(job, tooth, side, &rays, &layers)?;
        let evaluated_mm = vec![report.evaluated_mm; layers.len()];
        Ok(CutFlank { dexels: dexels_of(&layers), rays, layers, stats, evaluated_mm, report })
    };
    let cut = cut_flanks(job, progress, interrupt, folder, |flanks| flanks.each(cut_one), |_, _, _| Vec::new())?;
    if cut.reports.is_empty() {
        return Err(Error::Interrupted);
    }
    let flank = |tooth, side| cut.reports.iter().find(|flank| flank.tooth == tooth && flank.side == side);
    // The slot behind tooth 1 lies between its left flank and the next tooth's right one.
    let slot = match (flank(1, Side::Left), flank(2, Side::Right)) {
        (Some(before), Some(after)) => measure::slot(job, backend, [before, after])?,
        _ => Vec::new(),
    };
    Ok(BevelGear {
        slot,
        flanks: cut.reports,
        maps: cut.maps,
        surfaces: cut.surfaces,
        pictured: cut.pictured,
        work: cut.work,
    })
}
