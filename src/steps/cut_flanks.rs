//! All flanks of a gear, cut and measured in parallel, each written and thinned out as soon as it is done.
//!
//! In: the job; how the process cuts and measures one flank. Out: [`CutFlanks`]: reports, maps and surfaces at
//! their own spacings, and what pictures show. The dexels themselves are dropped flank by flank: of a gear they would
//! fill the memory.

use super::gear_maps::GearMaps;
use super::parts::{Part, Parts};
use super::pictures::flank::PicturedFlanks;
use super::{FlankFiles, Work, all_flanks, flanks_of, map_operations, meshes, needs_maps, needs_surfaces, pictures};
use crate::interrupt::Interrupt;
use crate::job::GearJob;
use crate::measure::last_chips::LastChips;
use crate::output::flank_maps::FlankMaps;
use crate::output::progress::Progress;
use crate::surface::SurfaceGrid;
use gearcut_core::cut::CutStats;
use gearcut_core::dexel::{Layer, RayGrid};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use std::time::Instant;

/// One flank after all operations.
#[derive(Debug)]
pub struct CutFlank<G, R> {
    /// Rays: all of them where maps, meshes or pictures show the flank.
    pub rays: G,
    /// What each operation left, in order.
    pub layers: Vec<Layer>,
    /// Dexels of all operations.
    pub dexels: u64,
    /// What the backend met.
    pub stats: CutStats,
    /// Arcs along the profile between which what each operation left is flank and no fillet, mm.
    pub evaluated_mm: Vec<[f64; 2]>,
    /// What the process measured on it.
    pub report: R,
}

/// Dexels of some layers.
pub fn dexels_of(layers: &[Layer]) -> u64 {
    layers.iter().map(|layer| layer.heights_mm.len() as u64).sum()
}

/// All flanks that were finished, in order of teeth, left before right.
#[derive(Debug)]
pub struct CutFlanks<R> {
    /// What was measured.
    pub reports: Vec<R>,
    /// Their maps at map spacing.
    pub maps: GearMaps,
    /// Their surfaces at mesh spacing; empty where nothing that is written needs them.
    pub surfaces: Vec<SurfaceGrid>,
    /// What pictures of single flanks show.
    pub pictured: PicturedFlanks,
    /// How much work it was.
    pub work: Work,
}

/// What is left of a flank when its dexels are dropped.
struct KeptFlank<R> {
    report: R,
    maps: Option<FlankMaps>,
    surface: Option<SurfaceGrid>,
    pictured: PicturedFlanks,
    stats: CutStats,
    dexels: u64,
}

/// Cuts all flanks; `cut_one` cuts and measures one, `chips` says what chips left the cells of its maps (nothing where
/// a process does not follow them). Maps and meshes go to `folder` as soon as a flank is done, if they are among the
/// parts that it shall hold.
///
/// # Errors
/// Those of `cut_one`; files. Ctrl-C is no error: what is finished is returned.
pub fn cut_flanks<G: RayGrid, R: Send>(
    job: &dyn GearJob,
    progress: &Progress,
    interrupt: &Interrupt,
    folder: Option<FlankFiles<'_>>,
    cut_one: impl Fn(u32, Side) -> Result<CutFlank<G, R>> + Sync,
    chips: impl Fn(&G, &[Layer], &FlankMaps) -> Vec<LastChips> + Sync,
) -> Result<CutFlanks<R>> {
    let parts = folder.map_or(Parts::all(), |(.., parts)| parts);
    let started = Instant::now();
    let output = &job.scene().output;
    let operations = map_operations(job);
    let flanks = flanks_of(job);
    let step = progress.step("cut", flanks.len() as u64, "flanks");
    let finished = all_flanks(&flanks, |&(tooth, side)| {
        if interrupt.is_raised() {
            return Ok(None);
        }
        let CutFlank { rays, layers, dexels, stats, evaluated_mm, report } = cut_one(tooth, side)?;
        let maps = needs_maps(parts).then(|| {
            let arcs_mm = rays.arcs_mm();
            let mut maps = FlankMaps::sample(tooth, side, [&arcs_mm, rays.rows_mm()], &layers, output.map_spacing_mm);
            maps.evaluated_mm.clone_from(&evaluated_mm);
            // The page shows no chips.
            if parts.has_any(&[Part::Maps, Part::Pictures]) {
                maps.take_chips(&chips(&rays, &layers, &maps));
            }
            maps
        });
        let surface = needs_surfaces(job, parts).then(|| SurfaceGrid::new(&rays, &layers, output.mesh_spacing_mm));
        let pictured = pictures::flank::shown(job, (tooth, side), parts, &rays, &layers)?;
        if let Some((folder, notes, _)) = folder {
            if let Some(maps) = maps.as_ref().filter(|_| parts.has(Part::Maps)) {
                maps.write(folder, &operations, notes)?;
            }
            if let Some(surface) = surface.as_ref().filter(|_| parts.has(Part::Meshes)) {
                meshes::write_flank(job, surface, tooth, side, folder)?;
            }
        }
        step.advance(1);
        Ok(Some(KeptFlank { report, maps, surface, pictured, stats, dexels }))
    })?;
    step.finish();
    let interrupted = finished.iter().any(Option::is_none);
    let mut work = Work { stats: CutStats::default(), dexels: 0, elapsed: started.elapsed(), interrupted };
    let (mut reports, mut maps, mut surfaces) = (Vec::new(), Vec::new(), Vec::new());
    let mut pictured = PicturedFlanks::new();
    for flank in finished.into_iter().flatten() {
        reports.push(flank.report);
        maps.extend(flank.maps);
        surfaces.extend(flank.surface);
        pictured.extend(flank.pictured);
        work.stats += flank.stats;
        work.dexels += flank.dexels;
    }
    Ok(CutFlanks { reports, maps: GearMaps::new(maps), surfaces, pictured, work })
}
