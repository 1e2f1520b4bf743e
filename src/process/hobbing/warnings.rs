//! The list of warnings of a hobbed gear: what its job knows before anything is cut, and what its run found.
//!
//! In: the passes and targets of a job with the motion of its axes; afterwards what was measured. Out: the list that
//! terminal, report, `results.json` and programs show ([`crate::findings::notice`]).

use super::axes_report::HobbingAxesReport;
use super::gear::HobbedGear;
use super::hob::HobEnd;
use super::job::PreparedHobbing;
use super::kept::ForeseenChip;
use super::measure::blank_report::HobbedBlankReport;
use super::measure::hob_load::OperationLoad;
use super::notices::{
    BeyondRecord, CurveClosure, HeadAngle, Hunting, MissedMarks, Protuberance, ResultantFeed, ThickChip,
    ThickChipAtEnd, TipRelief, Tops, Undercut,
};
use super::scene::model::HobbingKind;
use super::{HobCutter, HobbingJob, foreseen_chips};
use crate::findings::notice::ranked;
use crate::findings::notices::Unreached;
use crate::findings::{Notice, damage};
use crate::job::{RAY_DEPTH_MODULES, rows_z_mm};
use crate::measure::damage::{Damage, gouge_mm};
use crate::number_text::significant;
use crate::steps::{axes, check_curve, flanks_of, untouched_dexels};
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;
use rayon::prelude::*;

/// Teeth that are named in a sentence.
const MOST_NAMED: usize = 6;
/// Uncut chips thicker than this are warned about, mm: a choice, about twice what hobbing is usually planned for. No
/// published limit was found that holds for every hob.
pub const USUAL_CHIP_MM: f64 = 0.5;

/// Largest part of a feed without a row: a crest in its middle is sampled at (1 - a quarter)^2 of its height and more.
const MOST_PHASE_GAP: f64 = 0.25;
/// Spacing of rows that certainly have no larger gap, as a share of the feed: rows are fitted to the face.
const ENOUGH_ROWS: f64 = 0.2;
/// Lower feed marks are no part of any figure, um.
const LEAST_MARK_UM: f64 = 0.01;

/// What is known before anything is cut.
///
/// # Errors
/// A flank that the hob does not generate.
pub fn before(cutter: &HobCutter, motion: &[HobbingAxesReport]) -> Result<Vec<Notice>> {
    let job = cutter.job;
    let mut warnings = check_curve::warnings(&job.curve, &job.scene.gear);
    warnings.extend(hunting(job).into_iter().chain(of_operations(job)).chain(undercut(cutter)?));
    warnings.extend(topped(job));
    warnings.extend(missed_marks(job));
    if job.hob_spec.protuberance.is_some() {
        warnings.push(Protuberance {}.notice());
    }
    if !job.hob_spec.tip_reliefs.is_empty() {
        warnings.push(TipRelief {}.notice());
    }
    warnings.extend(foreseen_thick_chips(cutter)?);
    warnings.extend(unreached(cutter)?);
    warnings.extend(axes::warnings(motion));
    Ok(ranked(warnings))
}

/// What the run found on its flanks and, with the loads of the hob's teeth, in its blank, if that was cut.
///
/// # Errors
/// A blank field that does not fit in memory.
pub fn after(
    cutter: &HobCutter,
    gear: &HobbedGear,
    whole: Option<(&HobbedBlankReport, &[OperationLoad])>,
) -> Result<Vec<Notice>> {
    let mut warnings = of_flanks(cutter, gear);
    let untouched = gear.flanks.iter().map(|flank| flank.untouched).sum();
    warnings.extend(untouched_dexels(untouched, "the hob does not cover the whole face"));
    warnings.extend(gear.work.warnings());
    if let Some((report, loads)) = whole {
        warnings.extend(thick_chips(cutter, loads)?);
        warnings.extend(damaged(cutter.job, report));
    }
    Ok(warnings)
}

/// Starts that always meet the same tooth spaces.
fn hunting(job: &HobbingJob) -> Option<Notice> {
    let (starts, teeth) = (job.hob.starts, job.scene.gear.teeth);
    let common = greatest_common_divisor(starts, teeth);
    (common > 1).then(|| Hunting { starts, teeth, common }.notice())
}

/// Largest whole number that divides both.
pub fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

fn of_operations(job: &HobbingJob) -> Vec<Notice> {
    let mut told = Vec::new();
    for operation in &job.operations {
        let (name, geometry) = (&operation.spec.name, operation.linkage.geometry());
        let right = geometry.gear_hand * geometry.helix_angle_rad - geometry.hob_hand * geometry.lead_angle_rad;
        if (geometry.head_angle_rad - right).abs() > 1e-9 {
            let [head_deg, right_deg] = [geometry.head_angle_rad, right].map(|rad| format!("{:.4}", rad.to_degrees()));
            told.push(HeadAngle { operation: name, head_deg, right_deg }.notice());
        }
        let closure_mm = job.curve.closure_error_mm().abs() * operation.linkage.end_s() / operation.linkage.cycle_s();
        if closure_mm > 1e-3 * job.scene.gear.module_mm {
            told.push(CurveClosure { operation: name, closure_mm: significant(closure_mm, 3) }.notice());
        }
        if let HobbingKind::Diagonal { .. } = operation.spec.kind
            && (operation.plan.slide_feeds_mm[0] - operation.plan.slide_feeds_mm[1]).abs() > 1e-9
        {
            let [first, second] = operation.plan.slide_feeds_mm;
            let factor = significant((first.max(second) / first.min(second)).powi(2), 3);
            let [first_mm, second_mm] = [first, second].map(|mm| significant(mm, 4));
            told.push(ResultantFeed { operation: name, first_mm, second_mm, factor }.notice());
        }
    }
    told
}

/// Rows of flanks that lie about whole feeds apart, so that they meet every feed mark near the same phase. A draft's
/// rows are far apart by intention.
fn missed_marks(job: &HobbingJob) -> Option<Notice> {
    let (gear, feeds_mm) = (&job.scene.gear, job.finishing().plan.slide_feeds_mm);
    let height_um = UM_PER_MM * job.feed_mark_mm(job.finishing())?;
    let rows_mm = rows_z_mm(gear.face_width_mm, job.scene.fields.lead_spacing_mm);
    let missed = feeds_mm.into_iter().find(|&feed_mm| largest_phase_gap(&rows_mm, feed_mm) > MOST_PHASE_GAP + 1e-9)?;
    (!job.scene.is_draft && height_um > LEAST_MARK_UM).then(|| {
        let rows_um = significant(UM_PER_MM * (rows_mm[1] - rows_mm[0]), 4);
        let enough_um = significant(UM_PER_MM * ENOUGH_ROWS * missed, 3);
        let [feed_mm, height_um] = [significant(missed, 4), significant(height_um, 3)];
        MissedMarks { rows_um, feed_mm, height_um, enough_um }.notice()
    })
}

/// Largest part of a period in which no row lies, as a share of it.
fn largest_phase_gap(rows_mm: &[f64], period_mm: f64) -> f64 {
    let mut phases: Vec<f64> = rows_mm.iter().map(|row| (row / period_mm).rem_euclid(1.0)).collect();
    phases.sort_unstable_by(f64::total_cmp);
    let around = phases[0] + 1.0 - phases[phases.len() - 1];
    phases.windows(2).map(|pair| pair[1] - pair[0]).fold(around, f64::max)
}

/// A hob whose roots cut the gear's tips.
fn topped(job: &HobbingJob) -> Option<Notice> {
    let [tip_mm, stock_mm] = [&job.blank, &job.stock].map(|of| of.addendum_mm);
    let (tip, under) = (significant(tip_mm, 4), significant(stock_mm - tip_mm, 3));
    job.tops_the_gear().then(|| Tops { tip_mm: tip, under_mm: under }.notice())
}

/// Teeth whose involute the hob's tip corner cuts away in the middle of the face.
fn undercut(cutter: &HobCutter) -> Result<Option<Notice>> {
    let of = |(tooth, side)| Ok(cutter.target(tooth, side)?.middle_undercut.then_some(tooth));
    let flanks: Vec<Option<u32>> = flanks_of(cutter).into_par_iter().map(of).collect::<Result<_>>()?;
    let mut teeth: Vec<u32> = flanks.into_iter().flatten().collect();
    teeth.dedup();
    let named: Vec<String> = teeth.iter().take(MOST_NAMED).map(u32::to_string).collect();
    let more = if teeth.len() > MOST_NAMED { ", ..." } else { "" };
    let undercut = || Undercut { count: teeth.len(), teeth: format!("{}{more}", named.join(", ")) };
    Ok((!teeth.is_empty()).then(|| undercut().notice()))
}

/// Flanks that do not reach an end that the scene names.
fn unreached(cutter: &HobCutter) -> Result<Option<Notice>> {
    let named = cutter.job.scene.measure.heights_mm();
    let of = |(tooth, side)| {
        let ends_mm = cutter.measured_ends_mm(cutter.target(tooth, side)?);
        Ok(named.iter().zip(ends_mm).any(|(named, end)| named.is_some() && end.is_none()))
    };
    let flanks: Vec<bool> = flanks_of(cutter).into_par_iter().map(of).collect::<Result<_>>()?;
    let flanks = flanks.into_iter().filter(|&is_unreached| is_unreached).count();
    Ok((flanks > 0).then(|| Unreached { flanks }.notice()))
}

fn of_flanks(cutter: &HobCutter, gear: &HobbedGear) -> Vec<Notice> {
    let job = cutter.job;
    let mut warnings = Vec::new();
    let reach_mm = RAY_DEPTH_MODULES * job.scene.gear.module_mm;
    let lowest_mm = gear.flanks.iter().filter_map(|f| f.own.finished).map(|h| h.ends[0].value_mm).fold(0.0, f64::min);
    if lowest_mm < -0.999 * reach_mm {
        warnings.push(BeyondRecord { reach_mm }.notice());
    }
    warnings
}

/// Operations of which it is known before the cut that their hob teeth take chips thicker than is usual.
fn foreseen_thick_chips(cutter: &HobCutter) -> Result<Vec<Notice>> {
    let job = cutter.job;
    let of = |(operation, chip): (&PreparedHobbing, &Option<ForeseenChip>)| {
        let chip = chip.filter(|chip| chip.thickness_mm > USUAL_CHIP_MM)?;
        let what = format!("a chip at least {} mm thick in the middle of the face", significant(chip.thickness_mm, 3));
        Some(thick_chip(job, operation, (chip.tooth, chip.missed_end), &what))
    };
    Ok(job.operations.iter().zip(foreseen_chips::of(cutter)?).filter_map(of).collect())
}

/// Operations whose hob teeth take chips thicker than is usual, which was not known before: elsewhere on the gear.
fn thick_chips(cutter: &HobCutter, loads: &[OperationLoad]) -> Result<Vec<Notice>> {
    let job = cutter.job;
    let known = foreseen_chips::of(cutter)?.iter().map(|chip| chip.is_some_and(|of| of.thickness_mm > USUAL_CHIP_MM));
    let of = |((operation, load), known): ((&PreparedHobbing, &OperationLoad), bool)| {
        let tooth = load.peak(|load| load.thickness_mm)?;
        let thickness_mm = load.teeth[tooth].thickness_mm;
        (!known && thickness_mm > USUAL_CHIP_MM).then(|| {
            let what = format!("a chip {} mm thick", significant(thickness_mm, 3));
            thick_chip(job, operation, (tooth, load.end_that_is_missed(&job.hob, tooth)), &what)
        })
    };
    Ok(job.operations.iter().zip(loads).zip(known).filter_map(of).collect())
}

/// The sentence on a chip of a tooth, by the end of the hob beyond which there would be teeth to share it.
fn thick_chip(
    job: &HobbingJob,
    operation: &PreparedHobbing,
    (tooth, missed_end): (usize, Option<HobEnd>),
    chip: &str,
) -> Notice {
    let tooth = job.hob.teeth[tooth].label(job.hob.starts);
    let (usual_mm, shift_mm) = (USUAL_CHIP_MM, significant(operation.plan.shift_range_mm[0], 4));
    let operation = &operation.spec.name;
    let Some(end) = missed_end else { return ThickChip { operation, tooth, chip, usual_mm }.notice() };
    let side = match end {
        HobEnd::Entering => "above",
        HobEnd::Leaving => "below",
    };
    ThickChipAtEnd { operation, tooth, chip, usual_mm, end: end.name(), side, shift_mm }.notice()
}

/// Cuts below the target; what a protuberance, tip relief or semi-topping takes there it is made to take.
fn damaged(job: &HobbingJob, report: &HobbedBlankReport) -> Vec<Notice> {
    if job.hob_spec.protuberance.is_some() || !job.hob_spec.tip_reliefs.is_empty() {
        return Vec::new();
    }
    let by =
        |d: &Damage| format!("operation {} in turn {} of the hob", job.operations[d.operation].spec.name, d.stroke);
    let gouge_mm = gouge_mm(job.scene.gear.module_mm);
    [&report.gouges, &report.interference]
        .into_iter()
        .filter_map(|places| damage::warning(places, 0.0, gouge_mm, by))
        .collect()
}
