//! The order of a shaping run: chips, flanks and roots cut and measured, the whole blank, and what is written about the
//! gear.

mod blank;
mod chip_files;
mod files;
mod frames;

use self::frames::ShapedFrames;
use super::gear::cut_gear;
use super::gear::measure::{cmm, cutter_wear};
use crate::findings::Findings;
use crate::process::CutDone;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::cut::section::CutSection;
use crate::process::shaping::findings::foreseen::foresee;
use crate::process::shaping::findings::warnings;
use crate::process::shaping::scene::model::Shaping;
use crate::process::shaping::stage_costs::STAGE_COSTS;
use crate::process::shaping::{findings, report};
use crate::steps::attempts::Attempts;
use crate::steps::frames::draw;
use crate::steps::frames::section::InSection;
use crate::steps::inspection::Inspected;
use crate::steps::inspection::headline::quality;
use crate::steps::parts::{Part, Stage};
use crate::steps::planar::blank_findings;
use crate::steps::report::{RunWords, deviations};
use crate::steps::{Tools, Work, conclusion, meshes, stages, summary, write_meshes_and_pictures};
use crate::texture;
use gearcut_core::error::{Error, Result};
use gearcut_core::terms::Side;
use std::mem::take;

/// Cuts a job and writes everything; `frames` is how many pictures of the cut as it happens are drawn.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error once a flank is finished.
pub(super) fn run(job: &ShapingJob, tools: &Tools, frames: Option<u32>) -> Result<CutDone> {
    let Tools { resolved, backend, backend_why, progress, interrupt, folder, parts, stages: wanted, notes } = *tools;
    progress.plan(stages::plan(job, parts, frames, &STAGE_COSTS));
    let motion = OperationAxes::of_job(job);
    let ring = findings::ring::of_job(job, &motion);
    let foreseen = foresee(job, &motion, ring.as_ref(), wanted)?;
    let mut gear = cut_gear(job, wanted, backend, (progress, interrupt), Some((folder, notes, parts)))?;
    if gear.report.flanks.is_empty() {
        return Err(Error::Interrupted);
    }
    let mut attempts = Attempts::new(progress);
    if let Some(spec) = Shaping::of(&job.scene).and_then(|own| own.cmm).filter(|_| !gear.work.interrupted) {
        let flanks = &gear.report.flanks;
        let is_lost = |tooth: u32, side: Side| {
            flanks.iter().any(|flank| (flank.tooth, flank.side) == (tooth, side) && flank.own.is_lost)
        };
        let measured = cmm::measure(job, backend, &spec, is_lost);
        gear.report.cmm = attempts.of("coordinate measurement", measured)?.unwrap_or_default();
    }
    let textures = texture::measure(job, &foreseen.windows, backend, progress, interrupt);
    let textures = attempts.of("texture", textures)?.unwrap_or_default();
    let cut_blank = wanted.has(Stage::Blank) && !gear.work.interrupted;
    let blank = if cut_blank { blank::cut(job, backend, progress, interrupt) } else { Ok(None) };
    let blank = attempts.of("whole blank", blank)?;
    let mut interrupted = gear.work.interrupted || wanted.has(Stage::Blank) && matches!(blank, Some(None));
    let whole = blank.flatten();
    let worn = cutter_wear::measure(job, &gear.chips).filter(|_| wanted.has(Stage::Chips));
    let wear_chart = worn.as_ref().and_then(|worn| findings::wear::bars(job, worn));
    let mut sections = findings::sections(job, &gear.report, &gear.chips, &motion)?;
    sections.extend(ring);
    sections.extend(worn.map(|worn| findings::wear::findings(job, &worn)));
    let inspected = Inspected::new(job, &gear.report.flanks, &gear.report.inspection)?;
    let other_gear = findings::program::not_of_the_cut_gear(job, &motion, &gear.report);
    sections.extend(inspected.sections(&job.scene.measure, other_gear.as_deref()));
    sections.extend(whole.as_ref().map(|(cut, report)| blank_findings::findings(&job.planar(), cut, report)));
    sections.extend([texture::findings(job, &textures), texture::roughness(job, &textures)]);
    let mut list = foreseen.warnings;
    let blank_report = whole.as_ref().map(|(_, report)| report);
    list.extend(warnings::after(job, &gear.report, &gear.chips, &gear.work, blank_report));
    list.extend(inspected.warnings());
    list.extend(texture::warnings(job, &textures));
    let headline = quality(&inspected, &list).into_iter().chain(findings::headline(job, &gear, &motion));
    let complete = !gear.work.interrupted;
    let mut found = Findings::new("shaping", &job.scene.name, complete, headline, list, sections);
    files::write(job, &gear, (&motion, &foreseen.windows), &found, tools, &mut attempts)?;
    if let Some((stem, chart)) = wear_chart.as_ref().filter(|_| parts.has(Part::Chips)) {
        let write = || chart.write_svg(&folder.path(format!("chips/{stem}.svg"))?);
        attempts.of("chart of the cutter's wear", write())?;
    }
    if parts.has(Part::Texture) {
        attempts.of("files of texture", texture::write(job, &textures, folder, notes))?;
    }
    if !interrupted {
        if let Some((cut, _)) = whole.as_ref().filter(|_| parts.has(Part::Meshes)) {
            attempts.of("mesh of the blank", meshes::write_blank(job, cut, folder))?;
        }
        let (flanks, roots) = (take(&mut gear.surfaces), take(&mut gear.roots));
        interrupted |= !write_meshes_and_pictures(job, tools, &mut attempts, (&gear.pictured, &gear.maps), || {
            meshes::gear(job, tools.backend, flanks, roots, progress).map(Some)
        })?;
        if let Some(count) = frames {
            let draw = || draw(&mut InSection(ShapedFrames(job, CutSection::new(job)?)), &job.scene.name, count, tools);
            interrupted |= attempts.of("frames", draw())? == Some(false);
        }
    }
    let words = RunWords { resolved_scene: resolved, backend: &backend.name_in_files(), backend_why };
    let inspection = report::inspection(job, &gear.report, &inspected.verdict);
    attempts.of("inspection charts", deviations::write_charts(&inspection, folder))?;
    let sheet = deviations::inspection_page(&inspection, &job.scene, &found);
    if parts.has(Part::Report) {
        attempts.of("inspection sheet", deviations::write_sheet(&sheet, folder))?;
    }
    let wear_chart = wear_chart.map(|(_, chart)| chart);
    let page = |found: &Findings| report::page(job, &gear, found, (&inspection, wear_chart), &motion, &words, folder);
    found.complete = !interrupted;
    conclusion::write(&mut found, &motion, tools, &mut attempts, &job.scene, page, Some(sheet))?;
    let out = folder.results_path(found.complete);
    let work = Work { interrupted, ..gear.work };
    let flanks = [gear.report.flanks.len(), gear.report.lost()];
    let summary = summary::text(&job.scene.gear, &found, flanks, &work, &out, &backend.name());
    Ok(CutDone { findings: found, summary, work })
}
