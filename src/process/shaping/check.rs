//! What a shaping scene means: teeth, axes, return strokes, cost.

mod along;
mod returns;
mod ring;
mod teeth;

use crate::findings::Notice;
use crate::number_text::plain;
use crate::output::flank_maps::FlankMaps;
use crate::output::text::Sheet;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::cut::chips::{ChipLedger, last_chips_on_map};
use crate::process::shaping::findings;
use crate::process::shaping::findings::foreseen;
use crate::process::shaping::gear::tooth_facts::ToothFacts;
use crate::process::shaping::sections::GearPart;
use crate::process::shaping::stage_costs::STAGE_COSTS;
use crate::steps::axes;
use crate::steps::check_curve::{self, gear_words};
use crate::steps::forecast::{ForecastSamples, one_in, whole_s};
use crate::steps::inspection;
use crate::steps::parts::Stages;
use crate::steps::planar::CutField;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::dexel::RayGrid as _;
use gearcut_core::error::Result;

/// Rows of the bands that are cut for the forecast: what the kernel takes at once, and twice as many.
const BAND_ROWS: [usize; 2] = [16, 32];
/// Of so many tooth spaces and tiles of the blank one is looked at.
const ONE_IN: usize = 16;

/// Prints everything; what must be known before cutting.
///
/// # Errors
/// Geometry that cannot be cut.
pub fn print(sheet: &mut Sheet, job: &ShapingJob) -> Result<Vec<Notice>> {
    let facts = ToothFacts::of_job(job);
    let operations = OperationAxes::of_job(job);

    sheet.heading(&format!("{}: {}", job.scene.name, gear_words(&job.scene)));
    check_curve::print(sheet, &job.curve, &job.scene.gear, Some(job.cutter.pitch_radius_mm));
    inspection::print(sheet, job)?;
    let other_gear = findings::program::not_of_the_gear(job, &operations);
    teeth::print(sheet, job, &facts, other_gear.is_some());
    let ring = findings::ring::of_job(job, &operations);
    if let Some(ring) = &ring {
        ring::print(sheet, ring, job.blank.addendum_mm);
    }
    for operation in &operations {
        axes::print(operation, sheet);
    }
    returns::print(sheet, job, &operations)?;
    // Before the cost: a cut does it as well.
    let foreseen = foreseen::foresee(job, &operations, ring.as_ref(), Stages::ALL)?;
    print_cost(sheet, job)?;
    foreseen::print(sheet, job);
    Ok(foreseen.warnings)
}

/// Bands with the chips of their maps; the blank's chips, space by space, and its rays, tile by tile.
fn print_cost(sheet: &mut Sheet, job: &ShapingJob) -> Result<()> {
    let (grid, spacing_mm) = (job.planar().blank_grid()?, job.scene.output.map_spacing_mm);
    let slices = grid.slices_z_mm.len();
    let rays = grid.rows.iter().map(|row| row.count).sum::<usize>() * slices;
    let rays_apart_mm = plain(job.scene.fields.blank_spacing_mm);
    let cut_band = |tooth, side, arcs_mm: Vec<f64>, rows_mm| {
        let field = job.field_over(job.target_flank(tooth, side), arcs_mm.into_iter(), rows_mm);
        let CutField { field, layers, stats, .. } = job.cut_on(&Cpu::default(), GearPart::Flank(tooth, side), field)?;
        let maps = FlankMaps::sample(tooth, side, [&field.arcs_mm(), field.rows_mm()], &layers, spacing_mm);
        if job.helix.is_none() {
            last_chips_on_map(job, &field, &maps.chip_places(&layers, field.rows()));
        }
        Ok(stats)
    };
    let blank_s = || {
        let share = 1.0 / ONE_IN as f64;
        let chips_s = whole_s(share, || Ok(ChipLedger::new(job, &one_in(ONE_IN))))?;
        // What lacks tiles ends with its first slice, and with the first operation.
        let share = share / (slices * job.operations.len()) as f64;
        let cut = || job.cut_blank(&Cpu::default(), job.planar().blank_field()?, &one_in(ONE_IN));
        Ok(chips_s + whole_s(share, cut)?)
    };
    let samples = ForecastSamples {
        job,
        costs: &STAGE_COSTS,
        ray_bytes: 0,
        rows: BAND_ROWS,
        // Where edges are rounded, every ray is followed by itself.
        one_column_in: if job.cutter_spec.edge_rounding.is_some() { ONE_IN } else { 1 },
        cut_band: &cut_band,
        blank: (format!("{rays} rays {rays_apart_mm} mm apart in {slices} sections"), grid.estimated_bytes(&job.blank)),
        blank_s: &blank_s,
    };
    samples.print(sheet)?;
    if job.machine.vibration.is_some() {
        sheet.line("vibration", "not in that time: the mass is followed row by row, which takes many times as long");
    }
    Ok(())
}
