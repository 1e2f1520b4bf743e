//! A shaped gear, cut and measured: flank by flank, root by root, chip by chip.

pub mod measure;
pub mod ring;
mod surfaces;
pub mod tooth_facts;

use crate::interrupt::Interrupt;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::cut::chips::{ChipLedger, last_chips_on_map};
use crate::process::shaping::gear::measure::flank_report::FlankReport;
use crate::process::shaping::gear::measure::gear_report::{RootReport, root_stock};
use crate::process::shaping::gear::measure::{GearReport, flank_report, gear_report};
use crate::process::shaping::sections::{GearPart, ShapedRays};
use crate::progress::Progress;
use crate::steps::cut_flanks::{CutFlank, FlankQueue, cut_flanks};
use crate::steps::gear_maps::GearMaps;
use crate::steps::parts::{Parts, Stage, Stages};
use crate::steps::pictures::flank::PicturedFlanks;
use crate::steps::planar::{CutField, cut_fields};
use crate::steps::{FlankFiles, Work, needs_maps, needs_surfaces};
use crate::surface::SurfaceGrid;
use gearcut_core::cut::Backend;
use gearcut_core::dexel::figures::LinesAt;
use gearcut_core::error::{Error, Result};
use std::sync::{Mutex, PoisonError};
use web_time::Instant;

/// A cut and measured gear, before anything is written about it as a whole.
#[derive(Debug)]
pub struct CutGear {
    /// What was measured.
    pub report: GearReport,
    /// What every stroke takes away.
    pub chips: ChipLedger,
    /// Maps of all finished flanks at map spacing.
    pub maps: GearMaps,
    /// Surfaces of all finished flanks at mesh spacing, in order; empty where nothing that is written needs them.
    pub surfaces: Vec<SurfaceGrid>,
    /// What pictures of single flanks show.
    pub pictured: PicturedFlanks,
    /// Surfaces of all roots at mesh spacing, in order; empty where nothing that is written needs them.
    pub roots: Vec<SurfaceGrid>,
    /// How much work it was, chips and roots included in its time.
    pub work: Work,
}

/// Cuts and measures all flanks and roots of a job; maps and meshes of flanks go to `folder` as soon as a flank is
/// done, if they are among the parts that it shall hold.
///
/// # Errors
/// Geometry, the backend, files. Ctrl-C is no error: what is finished is returned.
pub fn cut_gear(
    job: &ShapingJob,
    wanted: Stages,
    backend: &dyn Backend,
    (progress, interrupt): (&Progress, &Interrupt),
    folder: Option<FlankFiles<'_>>,
) -> Result<CutGear> {
    let started = Instant::now();
    let chips = follow_chips(job, wanted.has(Stage::Chips), progress, interrupt)?;
    let parts = folder.map_or(Parts::all(), |(.., parts)| parts);
    let are_shown = needs_maps(parts) || needs_surfaces(job, parts);
    let cut_all = |flanks: &FlankQueue<ShapedRays, FlankReport>| {
        let make = |index: usize| {
            let Some((tooth, side)) = flanks.next(index) else { return Ok(None) };
            let target = job.target_flank(tooth, side);
            let field = job.flank_field(target);
            let lines = (!are_shown).then(|| flank_report::lines(job, target, &field));
            job.prepare_on(backend, GearPart::Flank(tooth, side), field, lines).map(Some)
        };
        let rows_z_mm = job.planar().rows_z_mm(job.scene.fields.lead_spacing_mm);
        let take = |index: usize, cut: CutField| {
            let (tooth, side) = flanks.list[index];
            let report = flank_report::measure(job, job.target_flank(tooth, side), &cut, &rows_z_mm);
            let evaluated_mm = report.own.active_mm.iter().copied().chain([report.evaluated_mm]).collect();
            let dexels = (cut.field.len() * job.operations.len() * cut.copies(&rows_z_mm)) as u64;
            let cut = if are_shown { cut.over_rows(rows_z_mm.clone()) } else { cut };
            let CutField { field, layers, stats, .. } = cut;
            let rays = job.in_space(GearPart::Flank(tooth, side), field)?;
            flanks.take(index, CutFlank { rays, layers, dexels, stats, evaluated_mm, report })
        };
        cut_fields(backend, flanks.list.len(), make, take)
    };
    let cut = cut_flanks(job, progress, interrupt, folder, cut_all, |rays: &ShapedRays, layers, maps| match rays {
        ShapedRays::Straight(field) => last_chips_on_map(job, field, &maps.chip_places(layers, field.rows())),
        ShapedRays::Helical(_) => Vec::new(),
    })?;
    let root_surfaces = needs_surfaces(job, parts) && !cut.work.interrupted;
    let (root_reports, roots) = if root_surfaces || wanted.has(Stage::Roots) {
        cut_roots(job, backend, root_surfaces)?
    } else {
        (Vec::new(), Vec::new())
    };
    let report = gear_report::measure(job, cut.reports, root_reports, wanted.has(Stage::Allowances));
    let work = Work { elapsed: started.elapsed(), ..cut.work };
    Ok(CutGear { report, chips, maps: cut.maps, surfaces: cut.surfaces, pictured: cut.pictured, roots, work })
}

/// Cuts every root once, for the stock that operations find in it and, if meshes need it, for its surface; nothing
/// where neither is asked for.
fn cut_roots(job: &ShapingJob, backend: &dyn Backend, surfaces: bool) -> Result<(Vec<RootReport>, Vec<SurfaceGrid>)> {
    if job.operations.len() < 2 && !surfaces {
        return Ok((Vec::new(), Vec::new()));
    }
    let space = |index: usize| index as u32 + 1;
    let lines = (!surfaces).then(LinesAt::default);
    let part = |index| GearPart::Root(space(index), job.planar().root_spacing_mm());
    let make = |index| job.prepare_on(backend, part(index), job.root_field(space(index)), lines).map(Some);
    let rows_z_mm = job.planar().root_rows_z_mm();
    let done = Mutex::new(Vec::new());
    let take = |index, cut: CutField| {
        let cut = cut.over_rows(rows_z_mm.clone());
        let stock = root_stock(space(index), &cut);
        let surface = || -> Result<SurfaceGrid> {
            let rays = job.in_space(part(index), cut.field)?;
            Ok(SurfaceGrid::new(&rays, &cut.layers, job.scene.output.mesh_spacing_mm))
        };
        let root = (stock, surfaces.then(surface).transpose()?);
        done.lock().unwrap_or_else(PoisonError::into_inner).push(root);
        Ok(())
    };
    cut_fields(backend, job.scene.gear.teeth as usize, make, take)?;
    let mut roots = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    roots.sort_by_key(|(report, _)| report.space);
    let (reports, surfaces): (_, Vec<Option<SurfaceGrid>>) = roots.into_iter().unzip();
    Ok((reports, surfaces.into_iter().flatten().collect()))
}

/// All strokes in order of time, space by space; the ledger has no chips unless they are `wanted`.
fn follow_chips(job: &ShapingJob, wanted: bool, progress: &Progress, interrupt: &Interrupt) -> Result<ChipLedger> {
    let (first, last) = job.spaces().into_inner();
    // An empty range where nothing is followed.
    let spaces = first.max(u32::from(!wanted))..=if wanted { last } else { 0 };
    let step = progress.step("chips", spaces.clone().count() as u64, "tooth spaces");
    let chips = ChipLedger::of_spaces(job, spaces, &|| {
        step.advance(1);
        !interrupt.is_raised()
    });
    step.finish();
    chips.ok_or(Error::Interrupted)
}
