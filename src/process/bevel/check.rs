//! What a bevel scene means: blank, settings, head, operations, cost.

use super::axes_report::BevelAxesReport;
use super::blank::CellGrid;
use super::findings;
use super::job::BevelJob;
use super::stage_costs::STAGE_COSTS;
use crate::findings::Notice;
use crate::number_text::{plain, significant};
use crate::output::text::Sheet;
use crate::steps::axes;
use crate::steps::forecast::{ForecastSamples, whole_s};
use crate::steps::foreseen::{OF_WINDOWS, print_unknown};
use crate::steps::parts::Stages;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::error::Result;
use gearcut_core::terms::Side;

/// Rows of the bands that are cut for the forecast: a tile's and twice as many.
const BAND_ROWS: [usize; 2] = [96, 192];
/// Bytes of a dexel's ray: two vectors and the blank's height.
const BYTES_PER_RAY: usize = 52;

/// Prints everything; what must be known before cutting.
///
/// # Errors
/// Geometry that cannot be cut.
pub fn print(sheet: &mut Sheet, job: &BevelJob) -> Result<Vec<Notice>> {
    let operations = BevelAxesReport::of_job(job);
    sheet.heading(&format!("{}: {}", job.scene.name, gear_words(job)));
    print_blank(sheet, job)?;
    print_head(sheet, job);
    for operation in &operations {
        axes::print(operation, sheet);
    }
    // Before the cost: a cut does it as well.
    let foreseen = findings::foresee(job, &operations, Stages::ALL)?;
    print_cost(sheet, job)?;
    let kinds = ["parts of flanks that the roll does not cover", OF_WINDOWS];
    print_unknown(sheet, &kinds);
    Ok(foreseen.warnings)
}

/// The gear in a line.
pub(super) fn gear_words(job: &BevelJob) -> String {
    let settings = &job.finishing().settings;
    let kind = if job.spec.cones.hypoid_offset_mm == 0.0 { "Spiral bevel" } else { "Hypoid" };
    let not_generated = if settings.plunges() { " that is not generated (Formate)" } else { "" };
    format!(
        "{kind} gear{not_generated}, {} teeth, outer module {} mm, pitch angle {:.4} deg, face width {} mm",
        job.blank.teeth,
        significant(job.blank.outer_module_mm(), 6),
        job.blank.pitch_angle_rad.to_degrees(),
        plain(job.blank.face_width_mm)
    )
}

fn print_blank(sheet: &mut Sheet, job: &BevelJob) -> Result<()> {
    let blank = &job.blank;
    sheet.heading("Blank");
    let [pitch, face, root] = [blank.pitch_angle_rad, blank.face_angle_rad, blank.root_angle_rad].map(f64::to_degrees);
    sheet.line("cones", format!("pitch {pitch:.4}, face {face:.4}, root {root:.4} deg"));
    let (outer, mean) = (blank.outer_cone_distance_mm, blank.mean_cone_distance_mm());
    sheet.line("cone distances", format!("outer {outer:.4} mm, mean {mean:.4} mm"));
    let inner = outer - blank.face_width_mm;
    let depth = |at: f64| blank.addendum_mm(at) + blank.dedendum_mm(at);
    sheet.line(
        "whole depth",
        format!("{:.3} mm at the toe, {:.3} in the middle, {:.3} at the heel", depth(inner), depth(mean), depth(outer)),
    );
    for side in [Side::Left, Side::Right] {
        let (target, kind) = (job.target_of(side), job.kind_of(side));
        let spiral = spiral_words(target.row(0.0)?.spiral_angle_rad()?, 3);
        sheet.line(
            &format!("{} flanks", side.name()),
            format!(
                "{}, cut by {} blades, spiral angle {spiral}, profile {:.3} mm long",
                kind.flank(),
                kind.name(),
                target.length_mm()
            ),
        );
    }
    Ok(())
}

/// A spiral angle with its hand.
fn spiral_words(spiral_rad: f64, decimals: usize) -> String {
    let hand = if spiral_rad.is_sign_negative() { "left" } else { "right" };
    format!("{:.decimals$} deg {hand}-hand", spiral_rad.abs().to_degrees())
}

fn print_head(sheet: &mut Sheet, job: &BevelJob) {
    let (head, settings) = (&job.head, &job.finishing().settings);
    sheet.heading("Head and settings");
    let source = if job.spec.head.radius_mm.is_some() { "given" } else { "inferred from the settings" };
    sheet.line("mean radius", format!("{:.4} mm, {source}", head.radius_mm));
    sheet.line(
        "settings",
        format!(
            "radial setting {:.4} mm, cradle angle {:.4} deg, sliding base {:.4} mm, root angle {:.4} deg",
            settings.radial_setting_mm,
            settings.cradle_angle_rad.to_degrees(),
            settings.sliding_base_mm,
            settings.root_angle_rad.to_degrees()
        ),
    );
    sheet.line("settings are", job.spec.settings_source());
    sheet.line(
        "settings say",
        format!(
            "radius {:.4} mm and spiral angle {} through the mean point, ratio of roll {:.6}",
            job.inferred.radius_mm,
            spiral_words(job.inferred_spiral_rad(), 4),
            job.inferred.roll_ratio
        ),
    );
    sheet.line(
        "blades",
        format!("{}, outside and inside in turn, point width {} mm", head.blades(), plain(head.point_width_mm)),
    );
    sheet.line(
        "in the work",
        format!("within {:.2} deg to either side of the slot's middle", head.half_window_rad.to_degrees()),
    );
    if !settings.tilt.is_none() {
        let [tilt, swivel] = [settings.tilt.tilt_rad, settings.tilt.swivel_rad].map(f64::to_degrees);
        sheet.line("head leans", format!("{tilt:.4} deg against the cradle's axis, swivel {swivel:.4} deg"));
    }
    let ratio = if settings.plunges() { "0: nothing rolls".to_owned() } else { format!("{:.6}", settings.roll.ratio) };
    sheet.line("ratio of roll", ratio);
    let missed_mm = job.depth_missed_mm();
    let words = if missed_mm > 0.0 { "short of" } else { "beyond" };
    sheet.line("tips stand", format!("{:.4} mm {words} the blank's roots, middle of the face", missed_mm.abs()));
}

/// Bands of flanks; of the blank a slot's cell on few of its rows.
fn print_cost(sheet: &mut Sheet, job: &BevelJob) -> Result<()> {
    let grid = CellGrid::of_scene(job)?;
    let (teeth, rows) = (job.blank.teeth, grid.rows());
    let rays = teeth as usize * grid.columns * rows;
    let passes = f64::from(job.slots.count()) / f64::from(teeth);
    let cut_band = |tooth, side, arcs_mm, rows_mm| {
        let rays = job.rays_over(tooth, side, arcs_mm, rows_mm)?;
        Ok(job.cut_field(&Cpu::default(), job.space_of(tooth, side), &rays.field)?.1)
    };
    let blank_s = || {
        let mut some = vec![0, (rows - 1) / 2, rows - 1];
        some.dedup();
        let of_some = |values: &[f64]| some.iter().map(|&row| values[row]).collect();
        let [distances_mm, middles_rad] = [of_some(&grid.distances_mm), of_some(&grid.middles_rad)];
        let cell = CellGrid { distances_mm, middles_rad, ..grid.clone() };
        let beside = job.neighbours_may_reach(&cell);
        let share = some.len() as f64 / (rows as f64 * f64::from(teeth));
        whole_s(share, || job.cut_cell(&Cpu::default(), &cell, 0, beside))
    };
    let samples = ForecastSamples {
        job,
        costs: &STAGE_COSTS,
        ray_bytes: BYTES_PER_RAY,
        rows: BAND_ROWS,
        one_column_in: 1,
        cut_band: &cut_band,
        blank: (
            format!(
                "{} thousand rays in {rows} rows, each met by some {passes:.0} passes",
                significant(1e-3 * rays as f64, 3)
            ),
            (rays * 2 * size_of::<f32>() * job.operations.len()) as f64,
        ),
        blank_s: &blank_s,
    };
    samples.print(sheet)
}
