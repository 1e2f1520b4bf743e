//! What to look at first on a shaped gear: what every gear has, then what only shaping finds.

use super::chips::peak;
use super::program;
use crate::findings::quantities::flanks::{NOT_CUT, SINGLE, START_OF_FLANK, UNDERCUT_FLANKS};
use crate::findings::{Entry, QuantityRow};
use crate::measure::stock::Extreme;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::cut::chips::{ChipLedger, OperationChips, StrokeChips};
use crate::process::shaping::gear::CutGear;
use crate::process::shaping::gear::measure::FlankReport;
use crate::process::shaping::gear::measure::unevenness::{ToothAllowance, summarise};
use crate::process::shaping::quantities::{
    ENTRY_FORCE, IDLE_STROKES, LARGEST_SECTION, NO_ALLOWANCE, NO_CUSP, NO_ENTRY, NO_FLANK, NO_WITNESS, POINTED_TEETH,
    RELIEF_RATIO, SCALLOP, TIP_LAND, UNEVENNESS_MAX, UNEVENNESS_MEAN, WITNESS_MARK,
};
use crate::process::shaping::target::FlankEnd;
use crate::steps::axes;
use crate::steps::inspection::headline::{self, Cutting, Placed};
use crate::steps::inspection::teeth::place;
use gearcut_core::units::UM_PER_MM;

/// The extreme that `better` prefers over all flanks, with `per_mm` of its unit in a mm.
fn extreme<'a>(
    row: &QuantityRow,
    per_mm: f64,
    flanks: &'a [FlankReport],
    pick: impl Fn(&'a FlankReport) -> Option<Extreme>,
    better: fn(f64, f64) -> bool,
    why: &'static str,
) -> Entry {
    let found = flanks.iter().filter_map(|flank| Some((flank, pick(flank)?)));
    match found.reduce(|best, next| if better(next.1.value_mm, best.1.value_mm) { next } else { best }) {
        Some((flank, extreme)) => row.of(extreme.value_mm * per_mm).at(place(flank, &extreme)),
        None => row.none(why),
    }
}

/// What to look at first.
pub fn headline(job: &ShapingJob, gear: &CutGear, motion: &[OperationAxes]) -> Vec<Entry> {
    let (report, chips) = (&gear.report, &gear.chips);
    let flanks = &report.flanks;
    // The operation in which something is largest, and its value there.
    let largest = |value: fn(&StrokeChips) -> f64| -> Placed {
        let of = |index: usize| chips.operations[index].largest(value).map_or(0.0, |(_, stroke)| value(stroke));
        let index = (0..job.operations.len()).reduce(|best, next| if of(next) > of(best) { next } else { best });
        peak(job, chips, index.unwrap_or(0), value)
    };
    let cutting = Cutting {
        operations: job.operations.len(),
        cycle_s: job.operations.iter().map(|o| o.schedule.time_s(o.count() as f64)).sum(),
        margin: axes::margin(motion),
        thickest_um: largest(|s| s.thickest_anywhere_mm() * UM_PER_MM),
        force_n: largest(|s| s.cutting_n),
        removed_mm3: Some(removed_mm3(job, chips)),
    };
    let mut entries = headline::headline(flanks, Some(&report.inspection), cutting, &gear.work);
    entries.extend(own(job, gear, motion));
    entries.extend([
        match largest(|s| s.area_mm2) {
            Ok((value, place)) => LARGEST_SECTION.of(value).at(place),
            Err(why) => LARGEST_SECTION.none(why),
        },
        ENTRY_FORCE
            .of_or(chips.operations.iter().filter_map(|o| o.entry()).map(|s| s.cutting_n).reduce(f64::max), NO_ENTRY),
        IDLE_STROKES.of(chips.operations.iter().map(OperationChips::idle).sum::<usize>()),
    ]);
    entries
}

fn removed_mm3(job: &ShapingJob, chips: &ChipLedger) -> f64 {
    (0..job.operations.len()).map(|index| chips.area_mm2(index)).sum::<f64>() * job.scene.gear.face_width_mm
}

/// Ends of flanks and tips, cusps, steps, relief, allowance.
fn own(job: &ShapingJob, gear: &CutGear, motion: &[OperationAxes]) -> [Entry; 9] {
    let report = &gear.report;
    let flanks = &report.flanks;
    // Ends and tips of flanks follow from the meshing condition: of the scene's own strokes.
    let other_gear = program::not_of_the_cut_gear(job, motion, report);
    let other_gear = other_gear.as_deref();
    let other_strokes = program::not_of_the_gear(job, motion);
    let form = |flank: &FlankReport| Some(Extreme { value_mm: flank.own.form.height_mm, arc_mm: 0.0, z_mm: 0.0 });
    let scallop = |flank: &FlankReport| {
        flank.own.scallops.map(|s| Extreme { value_mm: s.largest.height_mm, arc_mm: s.largest.arc_mm, z_mm: 0.0 })
    };
    let ends = |flank: &FlankReport| [flank.own.form.end, flank.own.tip.end];
    let undercut = flanks.iter().filter(|flank| ends(flank).contains(&FlankEnd::Undercut)).count();
    let pointed = flanks.iter().filter(|flank| flank.own.tip.end == FlankEnd::PointedTip).count().div_ceil(2);
    let relief = motion.iter().map(|operation| operation.relief().ratio).reduce(f64::min);
    let unevenness =
        report.allowances.last().and_then(|a| summarise(a.strokes.iter().map(ToothAllowance::unevenness_mean_percent)));
    let uneven = if job.operations.len() < 2 { SINGLE } else { NO_ALLOWANCE };
    [
        extreme(&START_OF_FLANK, 1.0, flanks, form, |a, b| a > b, NOT_CUT).unless(other_gear),
        UNDERCUT_FLANKS.of(undercut).unless(other_gear),
        TIP_LAND.of_or(report.tip_lands_mm.iter().copied().reduce(f64::min), NO_FLANK).unless(other_gear),
        POINTED_TEETH.of(pointed).unless(other_gear),
        extreme(&SCALLOP, UM_PER_MM, flanks, scallop, |a, b| a > b, NO_CUSP),
        extreme(&WITNESS_MARK, UM_PER_MM, flanks, |f| f.own.witness, |a, b| a.abs() > b.abs(), NO_WITNESS),
        RELIEF_RATIO.of_or(relief, NO_FLANK).unless(other_strokes.as_deref()),
        UNEVENNESS_MAX.of_or(unevenness.map(|u| u.max_percent), uneven),
        UNEVENNESS_MEAN.of_or(unevenness.map(|u| u.mean_percent), uneven),
    ]
}
