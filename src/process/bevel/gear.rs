//! A bevel gear, cut and measured flank by flank.

use super::job::BevelJob;
use super::measure::{self, BevelReport, SlotRow};
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use crate::steps::cut_flanks::{CutFlank, FlankQueue, cut_flanks, dexels_of};
use crate::steps::gear_maps::GearMaps;
use crate::steps::pictures::flank::PicturedFlanks;
use crate::steps::{FlankFiles, Work};
use gearcut_core::cut::{Backend, CutLayers, SweptField};
use gearcut_core::dexel::FreeRays;
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
    let cut_all = |flanks: &FlankQueue<FreeRays, BevelReport>| {
        let make = |index: usize| {
            let Some((tooth, side)) = flanks.next(index) else { return Ok(None) };
            Ok(Some(job.swept(job.space_of(tooth, side), job.rays(tooth, side)?.field)))
        };
        let take = |index: usize, swept: SweptField, left: CutLayers| {
            let (tooth, side) = flanks.list[index];
            let [arcs_mm, rows_mm] = job.places_mm(side);
            let rays = FreeRays { field: swept.field, arcs_mm, rows_mm };
            let CutLayers { layers, stats, .. } = left;
            let report = measure::measure(job, tooth, side, &rays, &layers)?;
            let evaluated_mm = vec![report.evaluated_mm; layers.len()];
            flanks.take(index, CutFlank { dexels: dexels_of(&layers), rays, layers, stats, evaluated_mm, report })
        };
        backend.cut_swept(flanks.list.len(), &make, &take)
    };
    let cut = cut_flanks(job, progress, interrupt, folder, cut_all, |_, _, _| Vec::new())?;
    if cut.reports.is_empty() {
        return Err(Error::Interrupted);
    }
    let flank = |tooth, side| cut.reports.iter().find(|flank| flank.tooth == tooth && flank.side == side);
    // The slot behind tooth 1 lies between its left flank and the next tooth's right one.
    let slot = match (flank(1, Side::Left), flank(2, Side::Right)) {
        (Some(before), Some(after)) => measure::slot(job, backend, [before, after])?,
        _ => Vec::new(),
    };
    Ok(BevelGear { slot, flanks: cut.reports, maps: cut.maps, pictured: cut.pictured, work: cut.work })
}
