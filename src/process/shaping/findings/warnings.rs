//! The list of warnings of a shaped gear: what its job knows before anything is cut, and what its run found.
//!
//! In: the job with the motion of its axes; afterwards what was measured. Out: the list that terminal, report,
//! `results.json` and programs show ([`crate::findings::notice`]). Sentences that only one subject can make stand with
//! it (teeth, ring, return strokes, axes); here they come together with their severity.

use crate::findings::notice::ranked;
use crate::findings::{Notice, Section};
use crate::measure::damage::gouge_mm;
use crate::measure::stock::Extreme;
use crate::number_text::significant;
use crate::process::shaping::cut::chips::{ChipLedger, OperationChips, StrokeChips, entries};
use crate::process::shaping::cut::stroke_noise;
use crate::process::shaping::findings::{program, returns, ring};
use crate::process::shaping::gear::measure::below_finished::below_finished;
use crate::process::shaping::gear::measure::{FlankReport, GearReport, closing};
use crate::process::shaping::gear::tooth_facts::{self, ToothFacts};
use crate::process::shaping::notices::{
    BeyondRecord, DeeperByEnvelope, DeeperByOffset, FlankBelowTarget, FlankGouge, Force, GuideLead, HelixChips,
    NoBackOff, ReturnRubs, Uncut, Unsettled,
};
use crate::process::shaping::scene::model::Retraction;
use crate::process::shaping::{ShapingJob, axes_report::OperationAxes};
use crate::steps::planar::blank_findings;
use crate::steps::planar::blank_report::BlankReport;
use crate::steps::{Work, axes, check_curve};
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;
use std::f64::consts::PI;

/// Cuts below the target deeper than this are worth a warning: far above the resolution, below every tolerance on a
/// gear drawing.
const BELOW_TARGET_MM: f64 = 1e-4;
/// A helix slope that is worth a warning: a tenth of what the finest class of ISO 1328-1 allows.
const LEAST_SLOPE_UM: f64 = 0.1;
/// Cutting force beyond which a ram is taken to stall where the scene gives no `machine.limits.cutting_force_n`, N. A
/// shaper for module 20, among the strongest that are built, is laid out for 36.42 kN ("Design and analysis of
/// hydraulic main drive system for large-scale CNC gear shaping machines", zhygear.com).
pub const USUAL_FORCE_N: f64 = 40e3;

/// What follows from the shapes of gear and cutter alone.
pub fn of_shapes(job: &ShapingJob, motion: &[OperationAxes]) -> Vec<Notice> {
    let ring = ring::of_job(job, motion);
    ranked(of_teeth(job, motion).into_iter().chain(of_ring(job, ring.as_ref())).chain(too_deep(job)))
}

fn of_teeth(job: &ShapingJob, motion: &[OperationAxes]) -> Vec<Notice> {
    let mut warnings = check_curve::warnings(&job.curve, &job.scene.gear);
    // Facts of the teeth are those of the scene's own strokes.
    if program::not_of_the_gear(job, motion).is_none() {
        warnings.extend(tooth_facts::warnings(job, &ToothFacts::of_job(job)));
    }
    warnings
}

/// What a helical guide leaves, and what is not followed along it.
fn of_helix(job: &ShapingJob) -> Vec<Notice> {
    let Some(helix) = &job.helix else { return Vec::new() };
    let slope_um = helix.slope(job.blank.kind(), job.cutter.pitch_radius_mm) * job.scene.gear.face_width_mm * UM_PER_MM;
    // The lead of a cutter's helix is pi m z0 / sin(beta).
    let sine = PI * job.scene.gear.module_mm * f64::from(job.cutter.teeth) / helix.lead_mm;
    let lead = GuideLead {
        lead_mm: significant(helix.lead_mm, 9),
        needed_mm: significant(helix.needed_lead_mm, 9),
        slope_um: significant(slope_um.abs(), 3),
        angle_deg: significant(sine.min(1.0).asin().to_degrees(), 9),
    };
    let lead = (slope_um.abs() > LEAST_SLOPE_UM).then(|| lead.notice());
    lead.into_iter().chain([HelixChips {}.notice()]).collect()
}

fn of_ring(job: &ShapingJob, ring: Option<&Section>) -> Vec<Notice> {
    ring.map_or_else(Vec::new, |section| ring::warnings(section, gouge_mm(job.scene.gear.module_mm)))
}

/// What is known before anything is cut; `ring`: what the cutter can do in a ring, if the gear is one.
///
/// # Errors
/// A back-off so large that the retraction leads to no pose.
pub fn before(job: &ShapingJob, motion: &[OperationAxes], ring: Option<&Section>) -> Result<Vec<Notice>> {
    let mut warnings = of_teeth(job, motion);
    for (index, (operation, motion)) in job.operations.iter().zip(motion).enumerate() {
        let other = program::not_of_the_operation(job, motion);
        match returns::section(job, index, other.as_deref())? {
            Some(section) => warnings.extend(returns::warning(&operation.spec.name, &section)),
            None => {
                warnings.push(NoBackOff {}.notice());
                break;
            }
        }
    }
    warnings.extend(of_ring(job, ring));
    warnings.extend(too_deep(job));
    warnings.extend(axes::warnings(motion));
    warnings.extend(program::warnings(job, motion));
    warnings.extend(stroke_noise::warnings(job));
    warnings.extend(of_helix(job));
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
) -> Vec<Notice> {
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
    warnings.extend(super::deflection::chatter(job));
    warnings.extend(work.warnings());
    if let Some(blank) = blank {
        warnings.extend(blank_findings::warnings(&job.planar(), blank, depth_mm));
        warnings.extend(rubbing(job, blank));
    }
    warnings
}

/// Operations that leave finishing less than nothing: cuts into the finished flanks.
fn too_deep(job: &ShapingJob) -> Vec<Notice> {
    let gouge_mm = gouge_mm(job.scene.gear.module_mm);
    let earlier = &job.operations[..job.operations.len() - 1];
    let by_offset = earlier.iter().filter_map(|operation| {
        let deeper_mm = job.finishing().spec.offset_mm - operation.spec.offset_mm;
        (deeper_mm > 0.0).then(|| {
            let depth_mm = deeper_mm * job.scene.gear.pressure_angle_rad.sin();
            let deeper = DeeperByOffset {
                operation: &operation.spec.name,
                deeper_mm: significant(deeper_mm, 3),
                depth_um: significant(UM_PER_MM * depth_mm, 3),
            };
            deeper.notice().fault_where(depth_mm > gouge_mm)
        })
    });
    let by_flank = below_finished(job).into_iter().map(|below| {
        let deeper = DeeperByEnvelope {
            operation: &job.operations[below.operation].spec.name,
            depth_um: significant(UM_PER_MM * below.depth_mm, 3),
            flanks: below.flanks,
            tooth: below.tooth,
            side: below.side.name(),
            height_mm: format!("{:.2}", below.height_mm),
        };
        deeper.notice().fault_where(below.depth_mm > gouge_mm)
    });
    by_offset.chain(by_flank).collect()
}

/// Operations whose first stroke asks more of the ram than it gives.
fn entry_forces(job: &ShapingJob) -> Vec<Notice> {
    let what = "the first stroke comes at full depth and takes";
    let way_out = "give the operation an infeed, or leave it less stock (the force is an upper bound: chips of several \
                   sides count twice where they meet)";
    let told = |(operation, stroke): (usize, Option<StrokeChips>)| {
        beyond_ram(job, operation, what, stroke?.cutting_n, way_out)
    };
    entries(job).into_iter().enumerate().filter_map(told).collect()
}

/// Operations whose later strokes do.
fn forces(job: &ShapingJob, chips: &ChipLedger) -> Vec<Notice> {
    let told = |(operation, chips): (usize, &OperationChips)| {
        let (stroke, largest) = chips.largest(|stroke| stroke.cutting_n)?;
        let what = format!("the cutting force reaches, at stroke {stroke},");
        let way_out = "take more strokes, or more revolutions to full depth";
        beyond_ram(job, operation, &what, largest.cutting_n, way_out)
    };
    chips.operations.iter().enumerate().filter_map(told).collect()
}

/// A force beyond what the ram gives.
fn beyond_ram(job: &ShapingJob, operation: usize, what: &str, force_n: f64, way_out: &str) -> Option<Notice> {
    let asked_n = job.machine.limits.cutting_force_n;
    let limit_n = asked_n.unwrap_or(USUAL_FORCE_N);
    let source = match asked_n {
        Some(_) => "machine.limits.cutting_force_n",
        None => "what rams for module 20 are built for; machine.limits.cutting_force_n states another limit",
    };
    let kn = |force_n: f64| significant(force_n / 1e3, 3);
    (force_n > limit_n).then(|| {
        let operation = &job.operations[operation].spec.name;
        Force { operation, what, force_kn: kn(force_n), limit_kn: kn(limit_n), source, way_out }.notice()
    })
}

/// Dexels that do not tell how deep they were cut.
fn beyond_record(report: &GearReport) -> Option<Notice> {
    let dexels: u64 = report.flanks.iter().map(|f| f.own.below_range).sum();
    (dexels > 0).then(|| BeyondRecord { dexels }.notice())
}

/// Flanks that are still the blank somewhere below their tip corner.
fn uncut(report: &GearReport) -> Option<Notice> {
    let flanks: Vec<_> = report.flanks.iter().filter_map(|flank| Some((flank, flank.own.uncut?))).collect();
    let (flank, most) = flanks.iter().max_by_key(|(_, uncut)| uncut.dexels)?;
    let dexels: u64 = flanks.iter().map(|(_, uncut)| uncut.dexels).sum();
    let uncut = Uncut {
        dexels,
        flanks: flanks.len(),
        tooth: flank.tooth,
        side: flank.side.name(),
        percent: significant(100.0 * most.share, 3),
        from_mm: format!("{:.2}", most.from_mm),
    };
    Some(uncut.notice())
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
fn below_target(job: &ShapingJob, report: &GearReport) -> Option<Notice> {
    let gouge_mm = gouge_mm(job.scene.gear.module_mm);
    let gouge = deepest_evaluated(report).filter(|(_, deepest)| -deepest.value_mm > gouge_mm);
    let is_gouge = gouge.is_some();
    let deepest = gouge.or_else(|| deepest_below(report));
    let (flank, deepest) = deepest.filter(|(_, deepest)| deepest.value_mm < -BELOW_TARGET_MM)?;
    let cut = report.flanks.iter().filter_map(|flank| flank.own.below_target);
    let count = cut.filter(|deepest| deepest.value_mm < -BELOW_TARGET_MM).count();
    let at_least = if flank.own.below_range > 0 { "at least " } else { "" };
    let (tooth, side) = (flank.tooth, flank.side.name());
    let depth_um = format!("{at_least}{}", significant(-deepest.value_mm * UM_PER_MM, 3));
    let (arc_mm, gouge_um) = (format!("{:.2}", deepest.arc_mm), significant(gouge_mm * UM_PER_MM, 3));
    Some(if is_gouge {
        FlankGouge { count, tooth, side, depth_um, arc_mm, gouge_um }.notice()
    } else {
        FlankBelowTarget { count, tooth, side, depth_um, arc_mm, gouge_um }.notice()
    })
}

/// Flanks that cross the pitch curve nowhere that can be stated.
fn unsettled(report: &GearReport) -> Option<Notice> {
    let (tooth, side) = report.unsettled.first()?;
    Some(Unsettled { count: report.unsettled.len(), tooth, side: side.name() }.notice())
}

/// Return strokes that enter surfaces that stay.
fn rubbing(job: &ShapingJob, report: &BlankReport) -> Option<Notice> {
    let on_gear = || report.rubbing.iter().filter(|rubbing| rubbing.stays).map(|rubbing| &rubbing.damage);
    let deepest = on_gear().max_by(|a, b| a.depth_mm.total_cmp(&b.depth_mm))?;
    let volume_mm3 = on_gear().fold(0.0, |sum, damage| sum + damage.volume_mm3);
    let way_out = match job.machine.retraction {
        Retraction::CenterLine => "set machine.retraction = \"auto\"",
        _ => "set another machine.retraction or machine.back_off_mm",
    };
    let rubs = ReturnRubs {
        operation: &job.operations[deepest.operation].spec.name,
        stroke: deepest.stroke,
        depth_um: significant(UM_PER_MM * deepest.depth_mm, 3),
        tooth: deepest.place.tooth,
        side: deepest.place.side.name(),
        volume_mm3: significant(volume_mm3, 3),
        way_out,
    };
    Some(rubs.notice())
}
