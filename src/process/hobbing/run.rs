//! The order of a hobbing run: flanks cut and measured, the whole blank, and what is written about the gear.

pub mod blank;
mod findings;
pub mod force;
pub mod load;
mod marks;
mod points;
pub mod wear;

use super::foreseen::foresee;
use super::gear::cut_gear;
use super::report;
use crate::findings::Findings;
use crate::output::table::write_tables;
use crate::process::CutDone;
use crate::process::hobbing::axes_report::HobbingAxesReport;
use crate::process::hobbing::cut_section::HobbedSection;
use crate::process::hobbing::stage_costs::STAGE_COSTS;
use crate::process::hobbing::{HobCutter, HobbingJob};
use crate::steps::attempts::Attempts;
use crate::steps::frames::draw;
use crate::steps::frames::section::InSection;
use crate::steps::inspection::Inspected;
use crate::steps::meshes::ClosedBodies;
use crate::steps::parts::Part;
use crate::steps::report::{RunWords, deviations};
use crate::steps::{NO_BODY, Tools, axes, conclusion, meshes, sheets, stages, summary, write_meshes_and_pictures};
use crate::surface::SurfaceGrid;
use crate::texture;
use gearcut_core::error::Result;
use rayon::prelude::*;

/// Cuts a job and writes everything; `frames` is how many pictures of the cut as it happens are drawn.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error once a flank is finished.
pub(super) fn run(job: &HobbingJob, tools: &Tools, frames: Option<u32>) -> Result<CutDone> {
    let Tools { resolved, backend, backend_why, progress, interrupt, folder, parts, stages: wanted, notes } = *tools;
    let cutter = HobCutter::new(job)?;
    progress.plan(stages::plan(&cutter, parts, frames, &STAGE_COSTS));
    let motion = HobbingAxesReport::of_job(job);
    let foreseen = foresee(&cutter, &motion, wanted)?;
    let windows = foreseen.windows.as_slice();
    let mut gear = cut_gear(&cutter, backend, progress, interrupt, Some((folder, notes, parts)))?;
    let mut attempts = Attempts::new(progress);
    let textures = texture::measure(&cutter, windows, backend, progress, interrupt);
    let textures = attempts.of("texture", textures)?.unwrap_or_default();
    let lattices = attempts.of("lattice of marks", marks::measure(&cutter, windows, tools))?.unwrap_or_default();
    let whole = if gear.work.interrupted { None } else { blank::cut(&cutter, backend, progress, interrupt)? };
    gear.work.interrupted |= whole.is_none();
    let loads = whole.as_ref().map_or_else(Vec::new, |whole| load::measure(&cutter, &whole.blank));
    let forces = whole.as_ref().map_or_else(Vec::new, |whole| force::measure(&cutter, &whole.blank));
    let worn = whole.as_ref().and_then(|whole| wear::measure(&cutter, &whole.blank));
    let inspected = Inspected::new(&cutter, &gear.flanks, &gear.inspection)?;
    let measured = findings::Measured {
        inspected: &inspected,
        motion: &motion,
        foreseen: &foreseen.warnings,
        textures: &textures,
        lattices: &lattices,
        whole: whole.as_ref().map(|whole| (whole, loads.as_slice(), forces.as_slice())),
        wear: worn.as_ref(),
    };
    let mut found = findings::findings(&cutter, &gear, &measured)?;
    let mut load_charts = load::charts(job, &loads);
    load_charts.extend(force::bars(job, &forces));
    let wear_chart = worn.as_ref().and_then(|worn| wear::bars(job, worn));
    let force_charts = force::over_time(job, &forces);
    let points_chart = points::chart(&job.scene.name, &gear);
    if let Some(whole) = whole.as_ref().filter(|_| parts.has(Part::Meshes)) {
        attempts.of("mesh of the blank", meshes::write_blank(&cutter, &whole.blank.cut, folder))?;
    }
    if parts.has(Part::Chips) {
        let write = || {
            for (stem, chart) in load_charts.iter().chain(&wear_chart) {
                chart.write_svg(&folder.path(format!("load/{stem}.svg"))?)?;
            }
            for (stem, chart) in &force_charts {
                chart.write_svg(&folder.path(format!("load/{stem}.svg"))?)?;
            }
            Ok(())
        };
        attempts.of("charts of the hob's load", write())?;
    }
    if let Some(chart) = points_chart.as_ref().filter(|_| parts.has(Part::Pictures)) {
        let write = || chart.write_svg(&folder.path("pictures/offset_curves.svg")?);
        attempts.of("chart of the offset curves", write())?;
    }
    let sheets = sheets::write_sheets_and_flanks(&cutter, &gear.maps, windows, tools);
    attempts.of("sheets and pictures of flanks", sheets)?;
    attempts.of("tables", write_tables(&found, folder))?;
    if parts.has(Part::Texture) {
        attempts.of("files of texture", texture::write(&cutter, &textures, folder, notes))?;
    }
    if !gear.work.interrupted {
        let flanks = std::mem::take(&mut gear.surfaces);
        let bodies = || bodies(&cutter, flanks, tools);
        let drawn = write_meshes_and_pictures(&cutter, tools, &mut attempts, (&gear.pictured, &gear.maps), bodies)?;
        gear.work.interrupted = !drawn;
        if let Some(count) = frames {
            let draw = || draw(&mut InSection(HobbedSection::new(&cutter)?), &job.scene.name, count, tools);
            gear.work.interrupted |= attempts.of("frames", draw())? == Some(false);
        }
    }
    if parts.has(Part::Axes) {
        for operation in &motion {
            attempts.of("table and charts of the axes", axes::write(operation, folder))?;
        }
    }
    let words = RunWords { resolved_scene: resolved, backend: &backend.name_in_files(), backend_why };
    let inspection = report::inspection(&cutter, &gear, &inspected.verdict);
    attempts.of("inspection charts", deviations::write_charts(&inspection, folder))?;
    let sheet = deviations::inspection_page(&inspection, &job.scene, &found);
    if parts.has(Part::Report) {
        attempts.of("inspection sheet", deviations::write_sheet(&sheet, folder))?;
    }
    let charts = report::Charts {
        inspection: &inspection,
        loads: load_charts,
        forces: force_charts,
        wear: wear_chart.map(|(_, chart)| chart),
        blank: whole.as_ref().map(|whole| &whole.blank),
        points: points_chart,
    };
    let page = |found: &Findings| report::page(&cutter, &gear, found, charts, &motion, &words, folder);
    found.complete = !gear.work.interrupted;
    conclusion::write(&mut found, &motion, tools, &mut attempts, &job.scene, page, Some(sheet))?;
    let out = folder.results_path(found.complete);
    let flanks = gear.flanks.len();
    let summary = summary::text(&job.scene.gear, &found, [flanks, 0], &gear.work, &out, &backend.name());
    Ok(CutDone { findings: found, summary, work: gear.work })
}

/// The gear's closed bodies; none where the linkage as printed leaves no flanks to join.
fn bodies(cutter: &HobCutter, flanks: Vec<SurfaceGrid>, tools: &Tools) -> Result<Option<ClosedBodies>> {
    let Tools { backend, progress, .. } = *tools;
    if cutter.job.operations.iter().any(|operation| operation.linkage.law().is_as_printed()) {
        progress.note(&format!("{NO_BODY}: by the linkage as printed there are no flanks to join"));
        return Ok(None);
    }
    let roots = cut_roots(cutter, tools)?;
    meshes::gear(cutter, backend, flanks, roots, progress).map(Some)
}

/// Surfaces of all roots, space by space. Meshes alone show them: hobbing measures nothing there.
fn cut_roots(cutter: &HobCutter, tools: &Tools) -> Result<Vec<SurfaceGrid>> {
    let teeth = cutter.job.scene.gear.teeth;
    let step = tools.progress.step("roots", u64::from(teeth), "roots");
    let roots = (1..=teeth).into_par_iter().map(|space| {
        let root = cutter.root_surface(tools.backend, space);
        step.advance(1);
        root
    });
    let roots = roots.collect::<Result<_>>()?;
    step.finish();
    Ok(roots)
}
