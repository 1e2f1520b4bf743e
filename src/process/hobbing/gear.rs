//! A hobbed gear, cut and measured flank by flank.

use crate::interrupt::Interrupt;
use crate::measure::crossing::Crossing;
use crate::measure::inspection::GearInspection;
use crate::process::hobbing::HobCutter;
use crate::process::hobbing::cutter::HobbedFlank;
use crate::process::hobbing::measure::flank_report::{self, HobbedReport};
use crate::process::hobbing::measure::offset_curves::{self, CurvePoint};
use crate::progress::Progress;
use crate::steps::cut_flanks::{CutFlank, FlankQueue, cut_flanks, dexels_of};
use crate::steps::gear_maps::GearMaps;
use crate::steps::pictures::flank::PicturedFlanks;
use crate::steps::{FlankFiles, Work};
use crate::surface::SurfaceGrid;
use gearcut_core::cut::{Backend, CutLayers, SweptField};
use gearcut_core::dexel::PlacedRays;
use gearcut_core::error::{Error, Result};
use gearcut_core::terms::Side;

/// A hobbed and measured gear.
#[derive(Debug)]
pub struct HobbedGear {
    /// Finished flanks in order.
    pub flanks: Vec<HobbedReport>,
    /// Where five curves beside the pitch curve cross them.
    pub points: Vec<Vec<CurvePoint>>,
    /// Pitch, runout and thickness in the middle of the face.
    pub inspection: GearInspection,
    /// Maps of all finished flanks at map spacing.
    pub maps: GearMaps,
    /// Their surfaces at mesh spacing; empty where nothing that is written needs them.
    pub surfaces: Vec<SurfaceGrid>,
    /// What pictures of single flanks show.
    pub pictured: PicturedFlanks,
    /// Passes of every operation.
    pub passes: Vec<u32>,
    /// How much work it was.
    pub work: Work,
}

/// Cuts and measures all flanks; maps and meshes of flanks go to `folder` as soon as a flank is done, if they are among
/// the parts that it shall hold.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error: what is finished is returned.
pub fn cut_gear(
    cutter: &HobCutter,
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
    folder: Option<FlankFiles<'_>>,
) -> Result<HobbedGear> {
    let cut_all = |flanks: &FlankQueue<PlacedRays, HobbedReport>| {
        let make = |index: usize| {
            let Some((tooth, side)) = flanks.next(index) else { return Ok(None) };
            Ok(Some(cutter.swept(cutter.rays(tooth, side)?.1.field)))
        };
        let take = |index: usize, swept: SweptField, left: CutLayers| {
            let (tooth, side) = flanks.list[index];
            let flank = cutter.flank(tooth, side, swept.field, left)?;
            let report = flank_report::measure(tooth, side, &flank);
            let HobbedFlank { rays, layers, stats, .. } = flank;
            let evaluated_mm = vec![report.evaluated_mm; layers.len()];
            flanks.take(index, CutFlank { dexels: dexels_of(&layers), rays, layers, stats, evaluated_mm, report })
        };
        backend.cut_swept(flanks.list.len(), &make, &take)
    };
    let cut = cut_flanks(cutter, progress, interrupt, folder, cut_all, |_, _, _| Vec::new())?;
    if cut.reports.is_empty() {
        return Err(Error::Interrupted);
    }
    let flanks = cut.reports;
    let finished: Vec<(u32, Side)> = flanks.iter().map(|flank| (flank.tooth, flank.side)).collect();
    let points = offset_curves::measure(cutter, backend, &finished)?;
    Ok(HobbedGear {
        inspection: inspection(cutter, &flanks, &points),
        flanks,
        points,
        maps: cut.maps,
        surfaces: cut.surfaces,
        pictured: cut.pictured,
        passes: cutter.operations.iter().map(gearcut_core::passes::TurningPasses::count).collect(),
        work: cut.work,
    })
}

/// Pitch, runout and thickness from where the flanks cross the pitch curve in the middle of the face.
fn inspection(cutter: &HobCutter, flanks: &[HobbedReport], points: &[Vec<CurvePoint>]) -> GearInspection {
    let spec = &cutter.job.scene.gear;
    let crossings = |side: Side| -> Vec<Option<Crossing>> {
        (1..=spec.teeth)
            .map(|tooth| {
                let at = flanks.iter().position(|flank| flank.tooth == tooth && flank.side == side)?;
                offset_curves::pitch_crossing(&points[at], cutter)
            })
            .collect()
    };
    let [left, right] = [Side::Left, Side::Right].map(crossings);
    let pressure_angle_rad = spec.transverse_pressure_angle_rad();
    GearInspection::of_crossings(&cutter.job.blank, [&left, &right], pressure_angle_rad)
}
