//! Hobbing scenes: cut and measured flank by flank, and what is written about the gear as a whole.

mod files;
mod results;
mod summary;

use super::{Tools, Work, all_flanks, flanks_of, map_operations, meshes, write_meshes_and_pictures};
use crate::cut::{Backend, CutStats};
use crate::error::{Error, Result};
use crate::gear::generation::Side;
use crate::job::{HobCutter, HobbingJob};
use crate::measure::hobbed_report::{self, HobbedReport};
use crate::output::flank_maps::FlankMaps;
use crate::output::folder::OutputFolder;
use crate::output::interrupt::Interrupt;
use crate::output::progress::Progress;
use crate::surface::SurfaceGrid;
use crate::texture;
use serde_json::Value;
use std::path::Path;
use std::time::{Duration, Instant};

/// A hobbed and measured gear.
#[derive(Debug)]
pub struct HobbedGear {
    /// Finished flanks in order.
    pub flanks: Vec<HobbedReport>,
    /// Their maps at map spacing.
    pub maps: Vec<FlankMaps>,
    /// Their surfaces at mesh spacing.
    pub surfaces: Vec<SurfaceGrid>,
    /// Passes of every operation.
    pub passes: Vec<u32>,
    /// How much work it was.
    pub work: Work,
}

/// Cuts and measures all flanks; maps go to `folder` as soon as a flank is done.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error: what is finished is returned.
pub fn cut_gear(
    cutter: &HobCutter,
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
    folder: Option<(&OutputFolder, &[(String, String)])>,
) -> Result<HobbedGear> {
    let started = Instant::now();
    let output = &cutter.job.scene.output;
    let operations = map_operations(cutter);
    let flanks = flanks_of(cutter);
    let step = progress.step("cut", flanks.len() as u64, "flanks");
    let finished = all_flanks(&flanks, |&(tooth, side): &(u32, Side)| {
        if interrupt.is_raised() {
            return Ok(None);
        }
        let flank = cutter.cut(backend, tooth, side)?;
        let report = hobbed_report::measure(tooth, side, &flank);
        let places = [flank.rays.arcs_mm.as_slice(), flank.rays.leads_mm.as_slice()];
        let maps = FlankMaps::sample(tooth, side, places, &flank.layers, output.map_spacing_mm);
        let surface = SurfaceGrid::new(&flank.rays, &flank.layers, output.mesh_spacing_mm);
        if let Some((folder, notes)) = folder {
            maps.write(folder, &operations, notes)?;
            meshes::write_flank(cutter, &surface, tooth, side, folder)?;
        }
        step.advance(1);
        let dexels = (flank.rays.field.len() * flank.layers.len()) as u64;
        Ok(Some((report, maps, surface, flank.stats, dexels)))
    })?;
    step.finish();
    let interrupted = finished.iter().any(Option::is_none);
    let mut gear = HobbedGear {
        flanks: Vec::new(),
        maps: Vec::new(),
        surfaces: Vec::new(),
        passes: cutter.operations.iter().map(crate::passes::HobTeeth::count).collect(),
        work: Work { stats: CutStats::default(), dexels: 0, elapsed: Duration::ZERO, interrupted },
    };
    for (report, maps, surface, stats, dexels) in finished.into_iter().flatten() {
        gear.flanks.push(report);
        gear.maps.push(maps);
        gear.surfaces.push(surface);
        gear.work.stats += stats;
        gear.work.dexels += dexels;
    }
    gear.work.elapsed = started.elapsed();
    if gear.flanks.is_empty() {
        return Err(Error::Interrupted);
    }
    Ok(gear)
}

/// Cuts a job and writes everything.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error once a flank is finished.
pub(super) fn run(job: &HobbingJob, tools: &Tools, out: &Path) -> Result<(Value, String, Work)> {
    let Tools { backend, progress, interrupt, folder, notes, .. } = *tools;
    let cutter = HobCutter::new(job)?;
    // A window that lies on no flank is refused before the first cut.
    texture::windows(&cutter)?;
    let mut gear = cut_gear(&cutter, backend, progress, interrupt, Some((folder, notes)))?;
    let textures = texture::measure(&cutter, backend, progress, interrupt)?;
    let results = results::results(&cutter, &gear, &textures)?;
    files::write(&cutter, &gear, &results, folder, notes)?;
    texture::write(&cutter, &textures, folder, notes)?;
    if job.operations.iter().any(|operation| operation.linkage.law().is_as_printed()) {
        progress.note("mesh/gear.* and pictures of the gear are left out: what the linkage as printed leaves has no flanks to join");
    } else if !gear.work.interrupted {
        let surfaces = std::mem::take(&mut gear.surfaces);
        gear.work.interrupted = !write_meshes_and_pictures(&cutter, surfaces, tools)?;
    }
    let summary = summary::summary(job, &gear, out, &backend.name());
    Ok((results, summary, gear.work))
}
