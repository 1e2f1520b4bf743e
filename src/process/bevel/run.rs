//! The order of a bevel run: flanks cut and measured, texture, the whole blank, the chips of a slot, and what is
//! written about the gear.

use super::axes_report::BevelAxesReport;
use super::drawing::{self, Drawn};
use super::findings::{self, BevelMeasured};
use super::gear::cut_gear;
use super::job::BevelJob;
use super::report;
use super::slot_frames::SlotFrames;
use super::stage_costs::STAGE_COSTS;
use super::{blank, body, chips};
use crate::findings::Findings;
use crate::output::atomic::write_bytes_atomically;
use crate::output::table::write_tables;
use crate::process::CutDone;
use crate::steps::attempts::Attempts;
use crate::steps::frames::draw;
use crate::steps::meshes::ClosedBodies;
use crate::steps::parts::Part;
use crate::steps::report::RunWords;
use crate::steps::{Tools, axes, conclusion, sheets, stages, summary, write_meshes_and_pictures};
use crate::texture;
use gearcut_core::error::Result;
use gearcut_core::terms::Side;

/// Cuts a job and writes everything; `frames` is how many pictures of the cut as it happens are drawn.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error once a flank is finished.
pub(super) fn run(job: &BevelJob, tools: &Tools, frames: Option<u32>) -> Result<CutDone> {
    let Tools { resolved, backend, backend_why, progress, interrupt, folder, parts, stages: wanted, notes } = *tools;
    progress.plan(stages::plan(job, parts, frames, &STAGE_COSTS));
    let motion = BevelAxesReport::of_job(job);
    let foreseen = findings::foresee(job, &motion, wanted)?;
    let gear = cut_gear(job, backend, progress, interrupt, Some((folder, notes, parts)))?;
    let mut attempts = Attempts::new(progress);
    let textures = texture::measure(job, &foreseen.windows, backend, progress, interrupt);
    let textures = attempts.of("texture", textures)?.unwrap_or_default();
    let mut work = gear.work;
    let whole = if work.interrupted { None } else { blank::cut(job, backend, progress, interrupt)? };
    let slot = job.space_of(1, Side::Left);
    let ledger = match &whole {
        Some(whole) => chips::measure(job, &whole.grid, slot, progress, interrupt)?,
        None => None,
    };
    work.interrupted |= ledger.is_none();
    let measured = BevelMeasured {
        foreseen: &foreseen.warnings,
        motion: &motion,
        textures: &textures,
        whole: whole.as_ref().zip(ledger.as_ref()),
    };
    let mut found = findings::findings(job, &gear, &measured)?;
    let charts = ledger.as_ref().map_or_else(Default::default, |ledger| findings::whole::charts(job, ledger));
    if parts.has(Part::Chips) {
        let write = || {
            for (stem, chart) in &charts.0 {
                chart.write_svg(&folder.path(format!("load/{stem}.svg"))?)?;
            }
            for (stem, chart) in &charts.1 {
                chart.write_svg(&folder.path(format!("load/{stem}.svg"))?)?;
            }
            Ok(())
        };
        attempts.of("charts of the chips", write())?;
    }
    if parts.has(Part::Pictures) {
        let svg = drawing::svg(&Drawn::of(job));
        let write = || write_bytes_atomically(&folder.path("pictures/settings.svg")?, svg.as_bytes());
        attempts.of("drawing of the settings", write())?;
    }
    let sheets = sheets::write_sheets_and_flanks(job, &gear.maps, &foreseen.windows, tools);
    attempts.of("sheets and pictures of flanks", sheets)?;
    attempts.of("tables", write_tables(&found, folder))?;
    if parts.has(Part::Texture) {
        attempts.of("files of texture", texture::write(job, &textures, folder, notes))?;
    }
    if !work.interrupted {
        let spacing_mm = job.scene.output.mesh_spacing_mm;
        let body = |whole| ClosedBodies { whole: body::body(job, whole, spacing_mm), pictured: None };
        let bodies = || Ok(whole.as_ref().map(body));
        work.interrupted = !write_meshes_and_pictures(job, tools, &mut attempts, (&gear.pictured, &gear.maps), bodies)?;
        if let Some(count) = frames {
            let draw = || draw(&mut SlotFrames::new(job)?, &job.scene.name, count, tools);
            work.interrupted |= attempts.of("frames", draw())? == Some(false);
        }
    }
    if parts.has(Part::Axes) {
        for operation in &motion {
            attempts.of("table and charts of the axes", axes::write(operation, folder))?;
        }
    }
    let words = RunWords { resolved_scene: resolved, backend: &backend.name_in_files(), backend_why };
    let page = |found: &Findings| report::page(job, &gear, found, (whole.as_ref(), charts), &motion, &words, folder);
    found.complete = !work.interrupted;
    conclusion::write(&mut found, &motion, tools, &mut attempts, &job.scene, page, None)?;
    let out = folder.results_path(found.complete);
    let flanks = gear.flanks.len();
    let summary = summary::text(&job.scene.gear, &found, [flanks, 0], &work, &out, &backend.name());
    Ok(CutDone { findings: found, summary, work })
}
