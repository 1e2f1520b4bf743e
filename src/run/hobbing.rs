//! Hobbing scenes: cut and measured flank by flank, and what is written about the gear as a whole.

pub mod blank;
mod files;
pub mod load;
mod marks;
pub(super) mod points;
mod results;
mod summary;

pub(super) use results::headline;
pub(super) use summary::warnings;

use super::report::RunWords;
use super::{Tools, Work, all_flanks, flanks_of, map_operations, meshes, report, write_meshes_and_pictures};
use crate::axes_report::HobbingAxesReport;
use crate::cut::{Backend, CutStats};
use crate::error::{Error, Result};
use crate::gcode;
use crate::gear::generation::Side;
use crate::job::{HobCutter, HobbingJob};
use crate::measure::crossing::Crossing;
use crate::measure::deviation::{self, PitchDeviations, Runout};
use crate::measure::gear_report::Thickness;
use crate::measure::hobbed_report::{self, HobbedReport};
use crate::measure::offset_curves::{self, CurvePoint};
use crate::output::flank_maps::FlankMaps;
use crate::output::folder::OutputFolder;
use crate::output::interrupt::Interrupt;
use crate::output::progress::Progress;
use crate::output::report::REPORT_FILE;
use crate::surface::SurfaceGrid;
use crate::texture;
use serde_json::Value;
use std::f64::consts::PI;
use std::path::Path;
use std::time::{Duration, Instant};

/// A hobbed and measured gear.
#[derive(Debug)]
pub struct HobbedGear {
    /// Finished flanks in order.
    pub flanks: Vec<HobbedReport>,
    /// Where five curves beside the pitch curve cross them.
    pub points: Vec<Vec<CurvePoint>>,
    /// Pitch deviations of left and right flanks.
    pub pitch: [Option<PitchDeviations>; 2],
    /// Places of a probe in the space after each tooth.
    pub runout: Option<Runout>,
    /// Thickness of each tooth on the pitch curve.
    pub thickness: Vec<Option<Thickness>>,
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
        let points = offset_curves::measure(cutter, backend, tooth, side)?;
        let places = [flank.rays.arcs_mm.as_slice(), flank.rays.leads_mm.as_slice()];
        let maps = FlankMaps::sample(tooth, side, places, &flank.layers, output.map_spacing_mm);
        let surface = SurfaceGrid::new(&flank.rays, &flank.layers, output.mesh_spacing_mm);
        if let Some((folder, notes)) = folder {
            maps.write(folder, &operations, notes)?;
            meshes::write_flank(cutter, &surface, tooth, side, folder)?;
        }
        step.advance(1);
        let dexels = (flank.rays.field.len() * flank.layers.len()) as u64;
        Ok(Some((report, points, maps, surface, flank.stats, dexels)))
    })?;
    step.finish();
    let interrupted = finished.iter().any(Option::is_none);
    let mut gear = HobbedGear {
        flanks: Vec::new(),
        points: Vec::new(),
        pitch: [None, None],
        runout: None,
        thickness: Vec::new(),
        maps: Vec::new(),
        surfaces: Vec::new(),
        passes: cutter.operations.iter().map(crate::passes::HobTeeth::count).collect(),
        work: Work { stats: CutStats::default(), dexels: 0, elapsed: Duration::ZERO, interrupted },
    };
    for (report, points, maps, surface, stats, dexels) in finished.into_iter().flatten() {
        gear.flanks.push(report);
        gear.points.push(points);
        gear.maps.push(maps);
        gear.surfaces.push(surface);
        gear.work.stats += stats;
        gear.work.dexels += dexels;
    }
    gear.work.elapsed = started.elapsed();
    if gear.flanks.is_empty() {
        return Err(Error::Interrupted);
    }
    measure_teeth(cutter, &mut gear);
    Ok(gear)
}

/// Pitch, runout and thickness from where the flanks cross the pitch curve in the middle of the face.
fn measure_teeth(cutter: &HobCutter, gear: &mut HobbedGear) {
    let spec = &cutter.job.scene.gear;
    let crossings = |side: Side| -> Vec<Option<Crossing>> {
        (1..=spec.teeth)
            .map(|tooth| {
                let at = gear.flanks.iter().position(|flank| flank.tooth == tooth && flank.side == side)?;
                offset_curves::pitch_crossing(&gear.points[at], cutter)
            })
            .collect()
    };
    let [left, right] = [Side::Left, Side::Right].map(crossings);
    let (curve, pitch_mm) = (&cutter.job.curve, PI * spec.transverse_module_mm());
    gear.pitch = [&left, &right].map(|side| deviation::pitch(side, pitch_mm, curve.perimeter_mm()));
    gear.runout = deviation::runout(curve, &left, &right, spec.transverse_pressure_angle_rad());
    gear.thickness =
        left.iter().zip(&right).map(|(left, right)| Some(Thickness::between((*left)?, (*right)?))).collect();
}

/// Cuts a job and writes everything.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error once a flank is finished.
pub(super) fn run(job: &HobbingJob, tools: &Tools, out: &Path) -> Result<(Value, String, Work)> {
    let Tools { resolved, backend, backend_why, progress, interrupt, folder, notes } = *tools;
    let cutter = HobCutter::new(job)?;
    // A window that lies on no flank, or too large a blank field, is refused before the first cut.
    job.blank_grid()?;
    texture::windows(&cutter)?;
    let mut gear = cut_gear(&cutter, backend, progress, interrupt, Some((folder, notes)))?;
    let textures = texture::measure(&cutter, backend, progress, interrupt)?;
    let lattices = marks::measure(&cutter, tools)?;
    let whole = if gear.work.interrupted { None } else { blank::cut(&cutter, backend, progress, interrupt)? };
    gear.work.interrupted |= whole.is_none();
    let mut results = results::results(&cutter, &gear, &textures, &lattices)?;
    let loads = whole.as_ref().map_or_else(Vec::new, |whole| load::measure(&cutter, &whole.blank));
    if let Some(whole) = &whole {
        results["hob_load"] = results::value(&load::results(job, &loads))?;
        results["blank"] = blank::results(&cutter, whole)?;
        load::write(job, &loads, folder)?;
        blank::write(&cutter, whole, folder)?;
    }
    files::write(&cutter, &gear, &results, folder, notes)?;
    marks::write(&lattices, folder)?;
    points::write(&job.scene.name, &gear, folder)?;
    texture::write(&cutter, &textures, folder, notes)?;
    if job.operations.iter().any(|operation| operation.linkage.law().is_as_printed()) {
        progress.note("mesh/gear.* and pictures of the gear are left out: what the linkage as printed leaves has no flanks to join");
    } else if !gear.work.interrupted {
        let surfaces = std::mem::take(&mut gear.surfaces);
        gear.work.interrupted = !write_meshes_and_pictures(&cutter, surfaces, tools)?;
    }
    for operation in HobbingAxesReport::of_job(job) {
        operation.write(job, folder)?;
    }
    for note in gcode::hobbing::write_all(job, folder)? {
        progress.note(&note);
    }
    let words = RunWords { resolved_scene: resolved, backend: &backend.name(), backend_why };
    report::hobbing::page(&cutter, &gear, &texture::results(&cutter, &textures), &lattices, &loads, &words, folder)?
        .write(&folder.path(REPORT_FILE)?)?;
    let summary = summary::summary(job, &gear, &lattices, out, &backend.name());
    Ok((results, summary, gear.work))
}
