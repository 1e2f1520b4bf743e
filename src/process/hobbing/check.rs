//! What a hobbing scene means: hob, teeth, operations.

use crate::drawn_tooth::drawn_words;
use crate::findings::Notice;
use crate::number_text::{plain, significant};
use crate::output::text::Sheet;
use crate::process::hobbing::axes_report::HobbingAxesReport;
use crate::process::hobbing::measure::hoffmeister;
use crate::process::hobbing::stage_costs::STAGE_COSTS;
use crate::process::hobbing::warnings::greatest_common_divisor;
use crate::process::hobbing::{HobCutter, HobbingJob, foreseen, foreseen_chips};
use crate::steps::axes;
use crate::steps::check_curve::{self, gear_words};
use crate::steps::flanks_of;
use crate::steps::forecast::{ForecastSamples, whole_s};
use crate::steps::inspection;
use crate::steps::parts::Stages;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::dexel::{BlankField, BlankGrid};
use gearcut_core::error::Result;
use gearcut_core::gear::blank_outline::BlankOutline;
use gearcut_core::terms::Side;
use rayon::prelude::*;

/// Rows of the bands that are cut for the forecast. Over fewer than half of a tile's rows planning has no third row to
/// tell bent heights from straight ones, and keeps thousands of passes.
const BAND_ROWS: [usize; 2] = [96, 192];
/// Bytes of a dexel's ray: two vectors and the blank's height.
const BYTES_PER_RAY: usize = 52;

/// Prints everything; what must be known before cutting.
///
/// # Errors
/// Geometry that cannot be cut.
pub fn print(sheet: &mut Sheet, job: &HobbingJob) -> Result<Vec<Notice>> {
    let operations = HobbingAxesReport::of_job(job);
    let cutter = HobCutter::new(job)?;
    let teeth = FormPoints::of(&cutter)?;
    sheet.heading(&format!("{}: {}", job.scene.name, gear_words(&job.scene)));
    check_curve::print(sheet, &job.curve, &job.scene.gear, None);
    inspection::print(sheet, &cutter)?;
    print_hob(sheet, job);
    teeth.print(sheet);
    for operation in &operations {
        axes::print(operation, sheet);
    }
    // Before the cost: a cut does it as well.
    let foreseen = foreseen::foresee(&cutter, &operations, Stages::ALL)?;
    print_chips(sheet, &cutter)?;
    print_cost(sheet, &cutter)?;
    foreseen::print(sheet);
    Ok(foreseen.warnings)
}

fn print_hob(sheet: &mut Sheet, job: &HobbingJob) {
    let hob = &job.hob;
    let hand = if hob.hand > 0.0 { "right" } else { "left" };
    sheet.heading("Hob");
    let starts = if hob.starts == 1 { "1 start".to_owned() } else { format!("{} starts", hob.starts) };
    sheet.line("thread", format!("{starts}, {hand}-hand, lead angle {:.4} deg", hob.lead_angle_rad.to_degrees()));
    sheet
        .line("diameters", format!("pitch {:.3} mm, tip {:.3} mm", 2.0 * hob.pitch_radius_mm, 2.0 * hob.tip_radius_mm));
    if let Some(tooth) = hob.drawn() {
        sheet.line("tooth", drawn_words(tooth));
    }
    let (first, last) = (&hob.teeth[0], &hob.teeth[hob.teeth.len() - 1]);
    sheet.line(
        "teeth",
        format!(
            "{} in {} gashes, {} to {} along the thread from the entering end, one every {:.4} mm",
            hob.teeth.len(),
            hob.gashes,
            first.label(hob.starts),
            last.label(hob.starts),
            hob.tooth_spacing_mm()
        ),
    );
    let length = job.finishing().plan.contact_half_length_mm;
    sheet.line(
        "full contact takes",
        format!(
            "{:.3} of {} mm to generate flanks; roughing the blank out takes more, not counted here",
            2.0 * length,
            plain(hob.length_mm)
        ),
    );
    let common = greatest_common_divisor(hob.starts, job.scene.gear.teeth);
    sheet.line(
        "hunting",
        match (hob.starts, common) {
            (1, _) => "one start cuts every tooth".to_owned(),
            (_, 1) => "every start cuts every tooth".to_owned(),
            (starts, common) => {
                format!("{starts} starts and {} teeth share the divisor {common}", job.scene.gear.teeth)
            }
        },
    );
}

/// Bands of flanks; of the blank some spaces in the slice in the middle, or that slice where its spaces are not apart.
fn print_cost(sheet: &mut Sheet, cutter: &HobCutter) -> Result<()> {
    let job = cutter.job;
    let grid = job.blank_grid()?;
    let slices = grid.slices_z_mm.len();
    let rays = grid.rows.iter().map(|row| row.count).sum::<usize>() * slices;
    let rays_apart_mm = plain(job.scene.fields.blank_spacing_mm);
    let cut_band = |tooth, side, arcs_mm, rows_mm| {
        let rays = cutter.rays_over(cutter.target(tooth, side)?, arcs_mm, rows_mm);
        Ok(cutter.cut_field(&Cpu::default(), &rays.field)?.1)
    };
    let blank_s = || {
        let share = 1.0 / slices as f64;
        if let Some(of_slice) = foreseen_chips::share_of_slice(job) {
            return whole_s(share * of_slice, || foreseen_chips::cut_spaces(cutter));
        }
        let middle = BlankGrid { slices_z_mm: vec![grid.slices_z_mm[slices / 2]], ..grid.clone() };
        let field = BlankField::new(middle, &BlankOutline::new(&job.stock));
        whole_s(share, || cutter.cut_blank(&Cpu::default(), field, &|| true))
    };
    let samples = ForecastSamples {
        job: cutter,
        costs: &STAGE_COSTS,
        ray_bytes: BYTES_PER_RAY,
        rows: BAND_ROWS,
        one_column_in: 1,
        cut_band: &cut_band,
        blank: (format!("{rays} rays {rays_apart_mm} mm apart in {slices} sections"), grid.estimated_bytes(&job.stock)),
        blank_s: &blank_s,
    };
    samples.print(sheet)
}

/// The thickest chip that is known before the cut, and the formula that shops know.
fn print_chips(sheet: &mut Sheet, cutter: &HobCutter) -> Result<()> {
    let known = foreseen_chips::of(cutter)?.iter().flatten();
    let thickest = known.max_by(|a, b| a.thickness_mm.total_cmp(&b.thickness_mm));
    let formula_mm = hoffmeister::thickest_chip_mm(cutter.job);
    if thickest.is_some() || formula_mm.is_some() {
        sheet.heading("Chips");
    }
    if let Some(chip) = thickest {
        let tooth = cutter.job.hob.teeth[chip.tooth].label(cutter.job.hob.starts);
        let thickness = significant(chip.thickness_mm, 3);
        sheet.line("thickest chip", format!("{thickness} mm at least, hob tooth {tooth}, middle of the face"));
    }
    if let Some(thickness_mm) = formula_mm {
        sheet.line("by Hoffmeister's formula", format!("{} mm", significant(thickness_mm, 3)));
    }
    Ok(())
}

/// Form points of all flanks in the middle of the face.
struct FormPoints {
    /// Tooth, side, height over the pitch curve, undercut.
    flanks: Vec<(u32, Side, f64, bool)>,
}

impl FormPoints {
    fn of(cutter: &HobCutter) -> Result<Self> {
        let flank = |(tooth, side): (u32, Side)| {
            let target = cutter.target(tooth, side)?;
            Ok((tooth, side, target.middle_form_height_mm, target.middle_undercut))
        };
        Ok(Self { flanks: flanks_of(cutter).into_par_iter().map(flank).collect::<Result<_>>()? })
    }

    fn print(&self, sheet: &mut Sheet) {
        let lowest = self.flanks.iter().min_by(|a, b| a.2.total_cmp(&b.2));
        let highest = self.flanks.iter().max_by(|a, b| a.2.total_cmp(&b.2));
        sheet.heading("Teeth");
        if let (Some(low), Some(high)) = (lowest, highest) {
            let [from, to] = [low, high].map(|flank| format!("{:.3} mm", flank.2));
            let heights = if from == to {
                format!("{from} on all teeth")
            } else {
                let [from_at, to_at] = [low, high].map(|flank| format!("(tooth {} {})", flank.0, flank.1.name()));
                format!("{from} {from_at} to {to} {to_at}")
            };
            sheet.line("flanks begin", format!("{heights} over the pitch curve, in the middle of the face"));
        }
        let undercut = self.flanks.iter().filter(|flank| flank.3).count();
        sheet.line("undercut flanks", format!("{undercut} of {}", self.flanks.len()));
    }
}
