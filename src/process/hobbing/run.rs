//! Hobbing scenes: cut and measured flank by flank, and what is written about the gear as a whole.

pub mod blank;
mod files;
mod findings;
pub mod load;
mod marks;
pub(super) mod points;

use crate::cut::{Backend, CutStats};
use crate::error::{Error, Result};
use crate::interrupt::Interrupt;
use crate::measure::crossing::Crossing;
use crate::measure::deviation::{self, PitchDeviations, Runout};
use crate::measure::thickness::Thickness;
use crate::output::flank_maps::FlankMaps;
use crate::output::progress::Progress;
use crate::process::CutDone;
use crate::process::hobbing::axes_report::HobbingAxesReport;
use crate::process::hobbing::measure::flank_report;
use crate::process::hobbing::measure::flank_report::HobbedReport;
use crate::process::hobbing::measure::offset_curves;
use crate::process::hobbing::measure::offset_curves::CurvePoint;
use crate::process::hobbing::report;
use crate::process::hobbing::{HobCutter, HobbingJob};
use crate::steps::parts::{Part, Parts};
use crate::steps::report::RunWords;
use crate::steps::{
    FlankFiles, Tools, Work, all_flanks, axes, flanks_of, map_operations, meshes, needs_maps, needs_surfaces, stages,
    summary, write_meshes_and_pictures, write_programs, write_report,
};
use crate::surface::SurfaceGrid;
use crate::terms::Side;
use crate::texture;
use std::f64::consts::PI;
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
    /// Their maps at map spacing; empty where nothing that is written needs them.
    pub maps: Vec<FlankMaps>,
    /// Their surfaces at mesh spacing; empty where nothing that is written needs them.
    pub surfaces: Vec<SurfaceGrid>,
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
    let parts = folder.map_or(Parts::all(), |(.., parts)| parts);
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
        let report = flank_report::measure(tooth, side, &flank);
        let points = offset_curves::measure(cutter, backend, tooth, side)?;
        let places = [flank.rays.arcs_mm.as_slice(), flank.rays.leads_mm.as_slice()];
        let maps =
            needs_maps(parts).then(|| FlankMaps::sample(tooth, side, places, &flank.layers, output.map_spacing_mm));
        let surface =
            needs_surfaces(cutter, parts).then(|| SurfaceGrid::new(&flank.rays, &flank.layers, output.mesh_spacing_mm));
        if let Some((folder, notes, _)) = folder {
            if let Some(maps) = maps.as_ref().filter(|_| parts.has(Part::Maps)) {
                maps.write(folder, &operations, notes)?;
            }
            if let Some(surface) = surface.as_ref().filter(|_| parts.has(Part::Meshes)) {
                meshes::write_flank(cutter, surface, tooth, side, folder)?;
            }
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
        passes: cutter.operations.iter().map(crate::passes::TurningPasses::count).collect(),
        work: Work { stats: CutStats::default(), dexels: 0, elapsed: Duration::ZERO, interrupted },
    };
    for (report, points, maps, surface, stats, dexels) in finished.into_iter().flatten() {
        gear.flanks.push(report);
        gear.points.push(points);
        gear.maps.extend(maps);
        gear.surfaces.extend(surface);
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
pub(super) fn run(job: &HobbingJob, tools: &Tools) -> Result<CutDone> {
    let Tools { resolved, backend, backend_why, progress, interrupt, folder, parts, notes } = *tools;
    let cutter = HobCutter::new(job)?;
    progress.plan(stages::plan(
        &cutter,
        tools,
        None,
        &stages::Costs { before: &[("marks", 0.03)], flank_s: 0.6, blank_s: 0.15 },
    ));
    // A window that lies on no flank, or too large a blank field, is refused before the first cut.
    job.blank_grid()?;
    texture::windows(&cutter)?;
    let mut gear = cut_gear(&cutter, backend, progress, interrupt, Some((folder, notes, parts)))?;
    let textures = texture::measure(&cutter, backend, progress, interrupt)?;
    let lattices = marks::measure(&cutter, tools)?;
    let whole = if gear.work.interrupted { None } else { blank::cut(&cutter, backend, progress, interrupt)? };
    gear.work.interrupted |= whole.is_none();
    let loads = whole.as_ref().map_or_else(Vec::new, |whole| load::measure(&cutter, &whole.blank));
    let motion = HobbingAxesReport::of_job(job);
    let measured = findings::Measured {
        motion: &motion,
        textures: &textures,
        lattices: &lattices,
        whole: whole.as_ref().map(|whole| (whole, loads.as_slice())),
    };
    let found = findings::findings(&cutter, &gear, &measured);
    if let Some(whole) = &whole {
        load::write(job, &loads, folder, parts)?;
        blank::write(&cutter, whole, folder, parts)?;
    }
    let results = found.to_json();
    files::write(&cutter, &gear, &results, tools)?;
    marks::write(&lattices, folder)?;
    points::write(&job.scene.name, &gear, folder, parts)?;
    if parts.has(Part::Texture) {
        texture::write(&cutter, &textures, folder, notes)?;
    }
    if !needs_surfaces(&cutter, parts) {
        // Nothing of the whole gear is asked for.
    } else if job.operations.iter().any(|operation| operation.linkage.law().is_as_printed()) {
        progress.note(
            "mesh/gear.* and pictures of the gear are left out: what the linkage as printed leaves has no \
            flanks to join",
        );
    } else if !gear.work.interrupted {
        let surfaces = std::mem::take(&mut gear.surfaces);
        gear.work.interrupted = !write_meshes_and_pictures(&cutter, surfaces, tools)?;
    }
    if parts.has(Part::Axes) {
        for operation in &motion {
            axes::write(operation, folder)?;
        }
        write_programs(progress, || axes::write_programs(&motion, folder))?;
    }
    if parts.has(Part::Report) {
        let words = RunWords { resolved_scene: resolved, backend: &backend.name_in_files(), backend_why };
        write_report(tools, || report::page(&cutter, &gear, &found, &loads, &motion, &words, folder))?;
    }
    let out = folder.results_path(!gear.work.interrupted);
    let flanks = gear.flanks.len();
    let summary = summary::text(&job.scene.gear, &found, flanks, &gear.work, &out, &backend.name());
    Ok(CutDone { results, summary, work: gear.work })
}
