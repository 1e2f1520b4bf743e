//! The list of warnings of a shaped gear: what its job knows before anything is cut, and what its run found.
//!
//! In: the job with the motion of its axes; afterwards what was measured. Out: the list that terminal, report,
//! `results.json` and programs show ([`crate::findings::warning`]). Sentences that only one subject can make stand with
//! it (teeth, ring, return strokes, axes); here they come together with their severity.

use super::chips::{ChipLedger, OperationChips, StrokeChips, entries};
use super::findings::{program, returns, ring};
use super::measure::below_finished::below_finished;
use super::measure::{FlankReport, GearReport, closing};
use super::scene::model::Retraction;
use super::stroke_noise;
use super::tooth_facts::{self, ToothFacts};
use super::{ShapingJob, axes_report::OperationAxes};
use crate::findings::warning::ranked;
use crate::findings::{Section, Warning};
use crate::measure::damage::gouge_mm;
use crate::measure::stock::Extreme;
use crate::output::text::significant;
use crate::steps::planar::blank_findings;
use crate::steps::planar::blank_report::BlankReport;
use crate::steps::{Work, axes, check_curve};
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;

/// Cuts below the target deeper than this are worth a warning: far above the resolution, below every tolerance on a
/// gear drawing.
const BELOW_TARGET_MM: f64 = 1e-4;
/// Cutting force beyond which a ram is taken to stall where the scene gives no `machine.limits.cutting_force_n`, N. A
/// shaper for module 20, among the strongest that are built, is laid out for 36.42 kN ("Design and analysis of
/// hydraulic main drive system for large-scale CNC gear shaping machines", zhygear.com).
pub const USUAL_FORCE_N: f64 = 40e3;

/// What is known before anything is cut; `ring`: what the cutter can do in a ring, if the gear is one.
///
/// # Errors
/// A back-off so large that the retraction leads to no pose.
pub fn before(job: &ShapingJob, motion: &[OperationAxes], ring: Option<&Section>) -> Result<Vec<Warning>> {
    let mut warnings = check_curve::warnings(&job.curve, &job.scene.gear);
    // Facts of the teeth are those of the scene's own strokes.
    let mut sentences = match program::not_of_the_gear(job, motion) {
        None => tooth_facts::warnings(job, &ToothFacts::of_job(job)),
        Some(_) => Vec::new(),
    };
    for (index, (operation, motion)) in job.operations.iter().zip(motion).enumerate() {
        let other = program::not_of_the_operation(job, motion);
        match returns::section(job, index, other.as_deref())? {
            Some(section) => sentences.extend(returns::warning(&operation.spec.name, &section)),
            None => {
                sentences.push("machine.back_off_mm = 0: the cutter returns along the surfaces that it has cut".into());
                break;
            }
        }
    }
    warnings.extend(sentences.into_iter().map(Warning::warn));
    warnings.extend(ring.into_iter().flat_map(|section| ring::warnings(section, gouge_mm(job.scene.gear.module_mm))));
    warnings.extend(too_deep(job));
    warnings.extend(axes::warnings(motion));
    warnings.extend(program::warnings(job, motion));
    warnings.extend(stroke_noise::warnings(job));
    if job.is_as_cut() {
        warnings.extend(entry_forces(job));
    }
    Ok(ranked(warnings))
}

/// What the run found on its flanks, in its chips and in its blank, if that was cut.
pub fn after(
    job: &ShapingJob,
    report: &GearReport,
    chips: &ChipLedger,
    work: &Work,
    blank: Option<&BlankReport>,
) -> Vec<Warning> {
    let mut warnings = forces(job, chips);
    let depth_mm = deepest_evaluated(report).map_or(0.0, |(_, deepest)| -deepest.value_mm);
    // The blank names what made the damage; where it says nothing, the flanks do.
    if !blank.is_some_and(|blank| !blank.gouges.is_empty() || !blank.interference.is_empty()) {
        warnings.extend(below_target(job, report));
    }
    warnings.extend(beyond_record(report));
    warnings.extend(unsettled(report));
    warnings.extend(uncut(report));
    warnings.extend(closing::warnings(job, report));
    warnings.extend(work.warnings());
    if let Some(blank) = blank {
        warnings.extend(blank_findings::warnings(&job.planar(), blank, depth_mm));
        warnings.extend(rubbing(job, blank));
    }
    warnings
}

/// Operations that leave finishing less than nothing: cuts into the finished flanks.
fn too_deep(job: &ShapingJob) -> Vec<Warning> {
    let gouge_mm = gouge_mm(job.scene.gear.module_mm);
    let told = |depth_mm: f64, text: String| {
        if depth_mm > gouge_mm { Warning::fault(text) } else { Warning::warn(text) }
    };
    let earlier = &job.operations[..job.operations.len() - 1];
    let by_offset = earlier.iter().filter_map(|operation| {
        let deeper_mm = job.finishing().spec.offset_mm - operation.spec.offset_mm;
        (deeper_mm > 0.0).then(|| {
            let depth_mm = deeper_mm * job.scene.gear.pressure_angle_rad.sin();
            told(
                depth_mm,
                format!(
                    "operation {}: it goes {} mm deeper than finishing and cuts some {} um into every flank: give it a \
                     larger offset_mm",
                    operation.spec.name,
                    significant(deeper_mm, 3),
                    significant(UM_PER_MM * depth_mm, 3)
                ),
            )
        })
    });
    let by_flank = below_finished(job).into_iter().map(|below| {
        told(
            below.depth_mm,
            format!(
                "operation {}: its envelope lies up to {} um below {} of the finished flanks, deepest on tooth {} {}, \
                 {:.2} mm over the pitch curve: leave more stock, or take the linkage of finishing",
                job.operations[below.operation].spec.name,
                significant(UM_PER_MM * below.depth_mm, 3),
                below.flanks,
                below.tooth,
                below.side.name(),
                below.height_mm
            ),
        )
    });
    by_offset.chain(by_flank).collect()
}

/// Operations whose first stroke asks more of the ram than it gives.
fn entry_forces(job: &ShapingJob) -> Vec<Warning> {
    let what = "the first stroke comes at full depth and takes";
    let way_out = "give the operation an infeed, or leave it less stock";
    let told = |(operation, stroke): (usize, Option<StrokeChips>)| {
        beyond_ram(job, operation, what, stroke?.cutting_n, way_out)
    };
    entries(job).into_iter().enumerate().filter_map(told).collect()
}

/// Operations whose later strokes do.
fn forces(job: &ShapingJob, chips: &ChipLedger) -> Vec<Warning> {
    let told = |(operation, chips): (usize, &OperationChips)| {
        let (stroke, largest) = chips.largest(|stroke| stroke.cutting_n)?;
        let what = format!("the cutting force reaches, at stroke {stroke},");
        let way_out = "take more strokes, or more revolutions to full depth";
        beyond_ram(job, operation, &what, largest.cutting_n, way_out)
    };
    chips.operations.iter().enumerate().filter_map(told).collect()
}

/// A force beyond what the ram gives.
fn beyond_ram(job: &ShapingJob, operation: usize, what: &str, force_n: f64, way_out: &str) -> Option<Warning> {
    let asked_n = job.machine.limits.cutting_force_n;
    let limit_n = asked_n.unwrap_or(USUAL_FORCE_N);
    let source = match asked_n {
        Some(_) => "machine.limits.cutting_force_n",
        None => "what rams for module 20 are built for; machine.limits.cutting_force_n states another limit",
    };
    let kn = |force_n: f64| significant(force_n / 1e3, 3);
    (force_n > limit_n).then(|| {
        Warning::warn(format!(
            "operation {}: {what} {} kN, more than {} kN ({source}): {way_out}",
            job.operations[operation].spec.name,
            kn(force_n),
            kn(limit_n)
        ))
    })
}

/// Dexels that do not tell how deep they were cut.
fn beyond_record(report: &GearReport) -> Option<Warning> {
    let below: u64 = report.flanks.iter().map(|f| f.own.below_range).sum();
    (below > 0).then(|| {
        Warning::warn(format!("{below} dexels were cut deeper than their rays record: heights there are upper bounds"))
    })
}

/// Flanks that are still the blank somewhere below their tip corner.
fn uncut(report: &GearReport) -> Option<Warning> {
    let flanks: Vec<_> = report.flanks.iter().filter_map(|flank| Some((flank, flank.own.uncut?))).collect();
    let (flank, most) = flanks.iter().max_by_key(|(_, uncut)| uncut.dexels)?;
    let dexels: u64 = flanks.iter().map(|(_, uncut)| uncut.dexels).sum();
    Some(Warning::warn(format!(
        "{dexels} dexels were reached by no pass: part of {} flanks is still the blank, most of tooth {} {}: {} % of \
         it, beginning {:.2} mm above the start of the involute",
        flanks.len(),
        flank.tooth,
        flank.side.name(),
        significant(100.0 * most.share, 3),
        most.from_mm
    )))
}

/// The flank that is cut deepest below the target, and where.
fn deepest_below(report: &GearReport) -> Option<(&FlankReport, Extreme)> {
    let cuts = report.flanks.iter().filter_map(|flank| Some((flank, flank.own.below_target?)));
    cuts.min_by(|a, b| a.1.value_mm.total_cmp(&b.1.value_mm))
}

/// The same on evaluated profiles: beside them the ends of a tooth are broken.
fn deepest_evaluated(report: &GearReport) -> Option<(&FlankReport, Extreme)> {
    let lowest = |flank: &FlankReport| {
        if flank.own.is_lost { flank.own.below_target } else { flank.own.finished.map(|[lowest, _]| lowest) }
    };
    let cuts = report.flanks.iter().filter_map(|flank| Some((flank, lowest(flank)?)));
    cuts.min_by(|a, b| a.1.value_mm.total_cmp(&b.1.value_mm))
}

/// Flanks whose heights lie below the target: a fault where an evaluated profile has a gouge.
fn below_target(job: &ShapingJob, report: &GearReport) -> Option<Warning> {
    let gouge_mm = gouge_mm(job.scene.gear.module_mm);
    let gouge = deepest_evaluated(report).filter(|(_, deepest)| -deepest.value_mm > gouge_mm);
    let is_gouge = gouge.is_some();
    let deepest = gouge.or_else(|| deepest_below(report));
    let (flank, deepest) = deepest.filter(|(_, deepest)| deepest.value_mm < -BELOW_TARGET_MM)?;
    let cut = report.flanks.iter().filter_map(|flank| flank.own.below_target);
    let count = cut.filter(|deepest| deepest.value_mm < -BELOW_TARGET_MM).count();
    let at_least = if flank.own.below_range > 0 { "at least " } else { "" };
    let text = format!(
        "{count} flanks are cut below the target, tooth {} {} by {at_least}{} um, {:.2} mm above the start of the \
         involute: {}deeper than {} um",
        flank.tooth,
        flank.side.name(),
        significant(-deepest.value_mm * UM_PER_MM, 3),
        deepest.arc_mm,
        if is_gouge { "a gouge is " } else { "on evaluated profiles a gouge is " },
        significant(gouge_mm * UM_PER_MM, 3)
    );
    Some(if is_gouge { Warning::fault(text) } else { Warning::warn(text) })
}

/// Flanks that cross the pitch curve nowhere that can be stated.
fn unsettled(report: &GearReport) -> Option<Warning> {
    let (tooth, side) = report.unsettled.first()?;
    Some(Warning::fault(format!(
        "{} flanks jump where they meet the pitch curve, first that of tooth {tooth} {}: their pitch, thickness and \
         allowance are not known",
        report.unsettled.len(),
        side.name()
    )))
}

/// Return strokes that enter surfaces that stay.
fn rubbing(job: &ShapingJob, report: &BlankReport) -> Option<Warning> {
    let on_gear = || report.rubbing.iter().filter(|rubbing| rubbing.stays).map(|rubbing| &rubbing.damage);
    let deepest = on_gear().max_by(|a, b| a.depth_mm.total_cmp(&b.depth_mm))?;
    let volume_mm3 = on_gear().fold(0.0, |sum, damage| sum + damage.volume_mm3);
    let way_out = match job.machine.retraction {
        Retraction::CenterLine => "set machine.retraction = \"auto\"",
        _ => "set another machine.retraction or machine.back_off_mm",
    };
    Some(Warning::warn(format!(
        "operation {}: in the gear as cut, the returning cutter stands after stroke {} {} um deep in tooth {} {}, and \
         in {} mm^3 in all: {way_out}; gearcut check says where it clears",
        job.operations[deepest.operation].spec.name,
        deepest.stroke,
        significant(UM_PER_MM * deepest.depth_mm, 3),
        deepest.place.tooth,
        deepest.place.side.name(),
        significant(volume_mm3, 3),
    )))
}
