//! All flanks of a gear, cut and measured in parallel, each written and thinned out as soon as it is done.
//!
//! In: the job; how the process cuts and measures the flanks of a [`FlankQueue`], which takes each when it is done.
//! Out: [`CutFlanks`]: reports, maps and surfaces at their own spacings, and what pictures show. The dexels themselves
//! are dropped flank by flank: of a gear they would fill the memory.

use super::gear_maps::GearMaps;
use super::parts::{Part, Parts};
use super::pictures::flank::PicturedFlanks;
use super::{FlankFiles, Work, flanks_of, meshes, needs_maps, needs_surfaces, operation_names, pictures};
use crate::interrupt::Interrupt;
use crate::job::GearJob;
use crate::measure::last_chips::LastChips;
use crate::output::flank_maps::FlankMaps;
use crate::progress::Progress;
use crate::surface::SurfaceGrid;
use gearcut_core::cut::CutStats;
use gearcut_core::dexel::{Layer, RayGrid};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use web_time::Instant;

/// One flank after all operations.
#[derive(Debug)]
pub struct CutFlank<G, R> {
    /// Rays: all of them where maps, meshes or pictures show the flank.
    pub rays: G,
    /// What each operation left, in order; empty where nothing that is written shows dexels.
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

/// Takes the flank of an index.
type TakeFlank<'a, G, R> = dyn Fn(usize, CutFlank<G, R>) -> Result<()> + Sync + 'a;

/// Flanks that wait to be cut, and what is done with each that is cut and measured.
pub struct FlankQueue<'a, G, R> {
    /// Teeth and sides, in order.
    pub list: &'a [(u32, Side)],
    interrupt: &'a Interrupt,
    take: &'a TakeFlank<'a, G, R>,
}

impl<G, R> FlankQueue<'_, G, R> {
    /// Tooth and side of an index, when its turn comes; nothing after Ctrl-C.
    pub fn next(&self, index: usize) -> Option<(u32, Side)> {
        (!self.interrupt.is_raised()).then(|| self.list[index])
    }

    /// Takes the flank of an index.
    ///
    /// # Errors
    /// Files.
    pub fn take(&self, index: usize, flank: CutFlank<G, R>) -> Result<()> {
        (self.take)(index, flank)
    }
}

/// Cuts all flanks; `cut_all` cuts and measures those of a queue, `chips` says what chips left the cells of a flank's
/// maps (nothing where a process does not follow them). Maps and meshes go to `folder` as soon as a flank is done, if
/// they are among the parts that it shall hold.
///
/// # Errors
/// Those of `cut_all`; files. Ctrl-C is no error: what is finished is returned.
pub fn cut_flanks<G: RayGrid, R: Send>(
    job: &dyn GearJob,
    progress: &Progress,
    interrupt: &Interrupt,
    folder: Option<FlankFiles<'_>>,
    cut_all: impl FnOnce(&FlankQueue<G, R>) -> Result<()>,
    chips: impl Fn(&G, &[Layer], &FlankMaps) -> Vec<LastChips> + Sync,
) -> Result<CutFlanks<R>> {
    let parts = folder.map_or(Parts::all(), |(.., parts)| parts);
    let started = Instant::now();
    let output = &job.scene().output;
    let operations = operation_names(job);
    let flanks = flanks_of(job);
    let step = progress.step("cut", flanks.len() as u64, "flanks");
    let finished = Mutex::new(BTreeMap::new());
    let take = |index: usize, flank: CutFlank<G, R>| {
        let (tooth, side) = flanks[index];
        let CutFlank { rays, layers, dexels, stats, evaluated_mm, report } = flank;
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
        let kept = KeptFlank { report, maps, surface, pictured, stats, dexels };
        finished.lock().unwrap_or_else(PoisonError::into_inner).insert(index, kept);
        Ok(())
    };
    cut_all(&FlankQueue { list: &flanks, interrupt, take: &take })?;
    step.finish();
    let finished = finished.into_inner().unwrap_or_else(PoisonError::into_inner);
    let interrupted = finished.len() < flanks.len();
    let mut work = Work { stats: CutStats::default(), dexels: 0, elapsed: started.elapsed(), interrupted };
    let (mut reports, mut maps, mut surfaces) = (Vec::new(), Vec::new(), Vec::new());
    let mut pictured = PicturedFlanks::new();
    for flank in finished.into_values() {
        reports.push(flank.report);
        maps.extend(flank.maps);
        surfaces.extend(flank.surface);
        pictured.extend(flank.pictured);
        work.stats += flank.stats;
        work.dexels += flank.dexels;
    }
    Ok(CutFlanks { reports, maps: GearMaps::new(maps), surfaces, pictured, work })
}
