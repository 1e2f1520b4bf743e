//! The order of a shaping run: chips, flanks and roots cut and measured, the whole blank, and what is written about the
//! gear.

mod blank;
mod chip_files;
mod files;
mod frames;

use super::gear::cut_gear;
use super::{findings, report};
use crate::findings::Findings;
use crate::process::CutDone;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::steps::parts::Part;
use crate::steps::planar::blank_findings;
use crate::steps::report::RunWords;
use crate::steps::{
    Tools, Work, axes, meshes, stages, summary, write_meshes_and_pictures, write_programs, write_report,
};
use crate::texture;
use gearcut_core::error::{Error, Result};
use std::mem::take;

/// Cuts a job and writes everything; `frames` is how many pictures of the cut as it happens are drawn.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error once a flank is finished.
pub(super) fn run(job: &ShapingJob, tools: &Tools, frames: Option<u32>) -> Result<CutDone> {
    let Tools { resolved, backend, backend_why, progress, interrupt, folder, parts, notes } = *tools;
    progress.plan(stages::plan(
        job,
        tools,
        frames,
        &stages::Costs { before: &[("chips", 0.05)], flank_s: 0.03, root_s: 0.0, blank_s: 0.04 },
    ));
    // A window that lies on no flank, or too large a blank field, is refused before the first cut.
    let windows = texture::windows(job)?;
    job.planar().blank_grid()?;
    let mut gear = cut_gear(job, backend, progress, interrupt, Some((folder, notes, parts)))?;
    if gear.report.flanks.is_empty() {
        return Err(Error::Interrupted);
    }
    let textures = texture::measure(job, &windows, backend, progress, interrupt)?;
    let whole = if gear.work.interrupted { None } else { blank::cut(job, backend, progress, interrupt)? };
    let motion = OperationAxes::of_job(job);
    let mut sections = findings::sections(job, &gear.report, &gear.chips, &motion);
    sections.extend(whole.as_ref().map(|(cut, report)| blank_findings::findings(&job.planar(), cut, report)));
    sections.push(texture::findings(job, &textures));
    let mut warnings = findings::warnings(&gear.report, &gear.work, &motion);
    warnings.extend(whole.as_ref().and_then(|(_, report)| blank::rubbing_warning(job, report)));
    let found = Findings {
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        process: "shaping".to_owned(),
        scene: job.scene.name.clone(),
        complete: !gear.work.interrupted,
        headline: findings::headline(job, &gear.report, &gear.chips, &motion),
        warnings,
        sections,
    };
    files::write(job, &gear, &motion, &found, tools)?;
    if parts.has(Part::Texture) {
        texture::write(job, &textures, folder, notes)?;
    }
    let mut interrupted = whole.is_none();
    if let Some((cut, _)) = &whole {
        if parts.has(Part::Meshes) {
            meshes::write_blank(job, cut, folder)?;
        }
        let (flanks, roots) = (take(&mut gear.surfaces), take(&mut gear.roots));
        interrupted |= !write_meshes_and_pictures(job, tools, &gear.pictured, || {
            meshes::gear(job, tools.backend, flanks, roots, progress).map(Some)
        })?;
        if let Some(count) = frames {
            let drawn = frames::draw(job, count, progress, interrupt, folder)?;
            if drawn < count {
                progress.note(&format!("stopped: {drawn} of {count} frames are drawn"));
                interrupted = true;
            }
        }
    }
    if parts.has(Part::Axes) {
        write_programs(progress, || axes::write_programs(&motion, folder))?;
    }
    if parts.has(Part::Report) {
        let words = RunWords { resolved_scene: resolved, backend: &backend.name_in_files(), backend_why };
        write_report(tools, || report::page(job, &gear, &found, &motion, &words, folder))?;
    }
    let out = folder.results_path(!interrupted);
    let work = Work { interrupted, ..gear.work };
    let flanks = gear.report.flanks.len();
    let summary = summary::text(&job.scene.gear, &found, flanks, &work, &out, &backend.name());
    Ok(CutDone { findings: found, summary, work })
}
