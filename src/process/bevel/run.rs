//! The order of a bevel run: flanks cut and measured, texture, and what is written about the gear.
//!
//! No rays go through the whole blank, and no closed body is made: sections of the blank take no blades that look along
//! the head's axis. Flanks are written as meshes one by one, and pictures show them alone.

use super::axes_report::BevelAxesReport;
use super::findings;
use super::gear::cut_gear;
use super::job::BevelJob;
use super::report;
use crate::findings::RESULTS_FILE;
use crate::output::table::write_tables;
use crate::process::CutDone;
use crate::steps::parts::Part;
use crate::steps::report::RunWords;
use crate::steps::{
    NO_BODY, Tools, axes, sheets, stages, summary, write_meshes_and_pictures, write_programs, write_report,
};
use crate::texture;
use gearcut_core::error::Result;

/// Cuts a job and writes everything.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error once a flank is finished.
pub(super) fn run(job: &BevelJob, tools: &Tools) -> Result<CutDone> {
    let Tools { resolved, backend, backend_why, progress, interrupt, folder, parts, notes } = *tools;
    let costs = stages::Costs { before: &[], flank_s: 0.4, root_s: 0.0, blank_s: 0.0 };
    progress.plan(stages::plan(job, tools, None, &costs));
    // A window that lies on no flank is refused before the first cut.
    let windows = texture::windows(job)?;
    let gear = cut_gear(job, backend, progress, interrupt, Some((folder, notes, parts)))?;
    let textures = texture::measure(job, &windows, backend, progress, interrupt)?;
    let motion = BevelAxesReport::of_job(job);
    let found = findings::findings(job, &gear, &motion, &textures)?;
    sheets::write_sheets_and_deviations(job, &gear.maps, tools)?;
    write_tables(&found, folder)?;
    folder.write_json(RESULTS_FILE, &found.to_json())?;
    if parts.has(Part::Texture) {
        texture::write(job, &textures, folder, notes)?;
    }
    let mut work = gear.work;
    if !work.interrupted {
        work.interrupted = !write_meshes_and_pictures(job, tools, &gear.pictured, || {
            progress.note(&format!("{NO_BODY}: no closed body is made of a bevel gear"));
            Ok(None)
        })?;
    }
    if parts.has(Part::Axes) {
        for operation in &motion {
            axes::write(operation, folder)?;
        }
        write_programs(progress, || axes::write_programs(&motion, folder))?;
    }
    if parts.has(Part::Report) {
        let words = RunWords { resolved_scene: resolved, backend: &backend.name_in_files(), backend_why };
        write_report(tools, || report::page(job, &gear, &found, &motion, &words, folder))?;
    }
    let out = folder.results_path(!work.interrupted);
    let flanks = gear.flanks.len();
    let summary = summary::text(&job.scene.gear, &found, flanks, &work, &out, &backend.name());
    Ok(CutDone { findings: found, summary, work })
}
