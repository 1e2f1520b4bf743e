//! A shaped gear, cut and measured: flank by flank, root by root, chip by chip.

use crate::interrupt::Interrupt;
use crate::output::progress::Progress;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::chips::{ChipLedger, last_chips_on_map};
use crate::process::shaping::measure::gear_report::{RootReport, root_stock};
use crate::process::shaping::measure::{GearReport, flank_report, gear_report};
use crate::steps::cut_flanks::{CutFlank, cut_flanks, dexels_of};
use crate::steps::gear_maps::GearMaps;
use crate::steps::parts::Parts;
use crate::steps::pictures::flank::PicturedFlanks;
use crate::steps::planar::CutField;
use crate::steps::{FlankFiles, Work, needs_maps, needs_surfaces};
use crate::surface::SurfaceGrid;
use gearcut_core::cut::Backend;
use gearcut_core::error::{Error, Result};
use rayon::prelude::*;
use std::time::Instant;

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
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
    folder: Option<FlankFiles<'_>>,
) -> Result<CutGear> {
    let started = Instant::now();
    let chips = follow_chips(job, progress, interrupt)?;
    let parts = folder.map_or(Parts::all(), |(.., parts)| parts);
    let are_shown = needs_maps(parts) || needs_surfaces(job, parts);
    let cut = cut_flanks(
        job,
        progress,
        interrupt,
        folder,
        |tooth, side| {
            let target = job.target_flank(tooth, side);
            let field = job.flank_field(target);
            let rows_z_mm = field.rows_z_mm.clone();
            let cut = job.cut_distinct_rows_on_flank(backend, (tooth, side), field)?;
            let report = flank_report::measure(job, target, &cut, &rows_z_mm);
            let evaluated_mm = report.own.active_mm.iter().copied().chain([report.evaluated_mm]).collect();
            let dexels = dexels_of(&cut.layers) * cut.copies(&rows_z_mm) as u64;
            let CutField { field, layers, stats } = if are_shown { cut.over_rows(rows_z_mm) } else { cut };
            Ok(CutFlank { rays: field, layers, dexels, stats, evaluated_mm, report })
        },
        |field, layers, maps| last_chips_on_map(job, field, &maps.chip_places(layers, field.rows())),
    )?;
    let roots = cut_roots(job, backend, needs_surfaces(job, parts) && !cut.work.interrupted)?;
    let (root_reports, roots): (Vec<RootReport>, Vec<Option<SurfaceGrid>>) = roots.into_iter().unzip();
    let report = gear_report::measure(job, cut.reports, root_reports);
    let roots = roots.into_iter().flatten().collect();
    let work = Work { elapsed: started.elapsed(), ..cut.work };
    Ok(CutGear { report, chips, maps: cut.maps, surfaces: cut.surfaces, pictured: cut.pictured, roots, work })
}

/// Roots of one job of the backend: their fields are small, and so are their layers.
const ROOTS_AT_ONCE: usize = 64;

/// Cuts every root once, for the stock that operations find in it and, if meshes need it, for its surface; nothing
/// where neither is asked for.
fn cut_roots(
    job: &ShapingJob,
    backend: &dyn Backend,
    surfaces: bool,
) -> Result<Vec<(RootReport, Option<SurfaceGrid>)>> {
    if job.operations.len() < 2 && !surfaces {
        return Ok(Vec::new());
    }
    let spaces: Vec<u32> = (1..=job.scene.gear.teeth).collect();
    let mut roots = Vec::with_capacity(spaces.len());
    for spaces in spaces.chunks(ROOTS_AT_ONCE) {
        let fields = spaces.par_iter().map(|&space| job.root_field(space)).collect();
        let cut = job.cut_fields(backend, fields)?;
        roots.par_extend(spaces.par_iter().zip(cut).map(|(&space, cut)| {
            let surface = || SurfaceGrid::new(&cut.field, &cut.layers, job.scene.output.mesh_spacing_mm);
            (root_stock(space, &cut), surfaces.then(surface))
        }));
    }
    Ok(roots)
}

/// All strokes in order of time, space by space.
fn follow_chips(job: &ShapingJob, progress: &Progress, interrupt: &Interrupt) -> Result<ChipLedger> {
    let step = progress.step("chips", u64::from(job.scene.gear.teeth), "tooth spaces");
    let chips = ChipLedger::new(job, &|| {
        step.advance(1);
        !interrupt.is_raised()
    });
    step.finish();
    chips.ok_or(Error::Interrupted)
}
