//! What to look at first on a shaped gear.

use super::chips::{ENTRY_FORCE, entry, peak};
use super::{place, program};
use crate::findings::{Entry, Quantity};
use crate::measure::stock::Extreme;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::chips::{ChipLedger, StrokeChips};
use crate::process::shaping::measure::unevenness::{ToothAllowance, summarise};
use crate::process::shaping::measure::{FlankReport, GearReport};
use crate::process::shaping::target::FlankEnd;
use crate::steps::axes;

/// Why a single operation has no stock.
const SINGLE: &str = "the scene has one operation; stock is what an earlier operation leaves";

/// The extreme that `better` prefers over all flanks.
fn extreme_over<'a>(
    flanks: &'a [FlankReport],
    pick: impl Fn(&'a FlankReport) -> Option<Extreme>,
    better: fn(f64, f64) -> bool,
) -> Option<(&'a FlankReport, Extreme)> {
    flanks
        .iter()
        .filter_map(|flank| pick(flank).map(|extreme| (flank, extreme)))
        .reduce(|best, next| if better(next.1.value_mm, best.1.value_mm) { next } else { best })
}

fn quantity_at(
    found: Option<(&FlankReport, Extreme)>,
    scale: f64,
    unit: &'static str,
    definition: &'static str,
    why: &str,
) -> Quantity {
    match found {
        Some((flank, extreme)) => {
            Quantity::number(extreme.value_mm * scale, unit, definition).at(place(flank, &extreme))
        }
        None => Quantity::undefined(unit, definition, why),
    }
}

/// What the witness mark is.
pub const WITNESS: &str = "largest step where finishing strokes meet that are more than half a turn apart, mid-face: \
                           how far the later facet lies over the earlier, negative where it is deeper";
/// Why there is none.
pub const NO_WITNESS: &str = "on no evaluated profile do facets of three dexels and more meet that are more than half \
                              a turn apart";

/// What to look at first.
pub fn headline(job: &ShapingJob, report: &GearReport, chips: &ChipLedger, motion: &[OperationAxes]) -> Vec<Entry> {
    let flanks = &report.flanks;
    let last_stock = job.operations.len().checked_sub(2);
    let stock = |flank: &FlankReport| last_stock.and_then(|index| flank.own.stock[index]);
    let none = "no flank was cut";
    let why = if last_stock.is_none() {
        SINGLE
    } else {
        "no flank has a stock: they were not cut or reached, or are cut away"
    };
    let uneven = if last_stock.is_none() { SINGLE } else { "no tooth has an allowance on both flanks" };
    let form = |flank: &FlankReport| Some(Extreme { value_mm: flank.own.form.height_mm, arc_mm: 0.0, z_mm: 0.0 });
    let scallop = |flank: &FlankReport| {
        flank.own.scallops.map(|s| Extreme { value_mm: s.largest.height_mm, arc_mm: s.largest.arc_mm, z_mm: 0.0 })
    };
    let undercut =
        flanks.iter().filter(|f| f.own.form.end == FlankEnd::Undercut || f.own.tip.end == FlankEnd::Undercut).count();
    let pointed = flanks.iter().filter(|f| f.own.tip.end == FlankEnd::PointedTip).count().div_ceil(2);
    let thickness: Vec<f64> = report.inspection.thickness.iter().flatten().map(|t| t.arc_mm).collect();
    let narrowest = report.tip_lands_mm.iter().copied().reduce(f64::min);
    let unevenness =
        report.allowances.last().and_then(|a| summarise(a.strokes.iter().map(ToothAllowance::unevenness_mean_percent)));
    let relief = motion.iter().map(|operation| operation.relief.ratio).reduce(f64::min);
    let cycle_s: f64 = job.operations.iter().map(|o| o.schedule.time_s(o.count() as f64)).sum();
    let removed_mm3: f64 =
        (0..job.operations.len()).map(|index| chips.area_mm2(index)).sum::<f64>() * job.scene.gear.face_width_mm;
    // The operation in which something is largest.
    let largest = |value: fn(&StrokeChips) -> f64| {
        let of = |index: usize| chips.operations[index].largest(value).map_or(0.0, |(_, stroke)| value(stroke));
        (0..job.operations.len()).reduce(|best, next| if of(next) > of(best) { next } else { best }).unwrap_or(0)
    };
    let thickness_why = "no tooth crosses the pitch curve with both flanks, or nothing is left between them";
    // Ends and tips of flanks follow from the meshing condition: of the scene's own strokes.
    let other_gear = program::not_of_the_cut_gear(job, motion, report);
    let other_strokes = program::not_of_the_gear(job, motion);
    let of_scene = |quantity: Quantity| program::of_scene(quantity, other_gear.as_deref());
    // What is left of a gear that is cut away says of how many teeth it is, or nothing where most are gone.
    let teeth = job.scene.gear.teeth as usize;
    let of_teeth = |definition: &str| match report.lost() {
        0 => definition.to_owned(),
        _ => format!("{definition}, of {} of {teeth} teeth; the others are cut away", thickness.len()),
    };
    let are_most_gone = report.lost() > 0 && 2 * thickness.len() < teeth;
    let of_left = |pick: fn(f64, f64) -> f64, definition: &str| {
        let value = thickness.iter().copied().reduce(pick).filter(|_| !are_most_gone);
        let why = if are_most_gone { "most teeth are cut away" } else { thickness_why };
        Quantity::number_or(value, "mm", of_teeth(definition), why)
    };
    vec![
        Entry::headline(
            "smallest_normal_stock",
            "smallest normal stock",
            quantity_at(
                extreme_over(flanks, |f| stock(f).map(|s| s.smallest), |a, b| a < b),
                1.0,
                "mm",
                "smallest stock that the last operation finds on the active flanks, along the target's normal",
                why,
            ),
        ),
        Entry::headline(
            "largest_normal_stock",
            "largest normal stock",
            quantity_at(
                extreme_over(flanks, |f| stock(f).map(|s| s.largest), |a, b| a > b),
                1.0,
                "mm",
                "largest stock that the last operation finds on the active flanks, along the target's normal",
                why,
            ),
        ),
        Entry::headline(
            "start_of_involute",
            "highest start of involute",
            of_scene(quantity_at(
                extreme_over(flanks, form, |a, b| a > b),
                1.0,
                "mm",
                "highest start of the involute of all flanks, as height over the pitch curve",
                none,
            )),
        ),
        Entry::headline(
            "undercut_flanks",
            "undercut flanks",
            of_scene(Quantity::count(undercut as u64, "flanks", "flanks whose generated profile turns back")),
        ),
        Entry::headline(
            "tip_land",
            "narrowest tip land",
            of_scene(Quantity::number_or(narrowest, "mm", "narrowest tip land of all teeth", none)),
        ),
        Entry::headline(
            "pointed_teeth",
            "pointed teeth",
            of_scene(Quantity::count(pointed as u64, "teeth", "teeth that are pointed below the blank's outline")),
        ),
        Entry::headline(
            "scallop_height",
            "highest scallop",
            quantity_at(
                extreme_over(flanks, scallop, |a, b| a > b),
                1e3,
                "um",
                "height of the highest cusp on the evaluated profiles over the line that touches its two facets, \
                 mid-face",
                "no cusp between facets of three dexels and more was met: the dexels are too coarse for the feed",
            ),
        ),
        Entry::headline(
            "highest_deviation",
            "highest deviation",
            quantity_at(
                extreme_over(flanks, |f| f.own.finished.map(|[_, highest]| highest), |a, b| a > b),
                1e3,
                "um",
                "largest normal deviation of the finished surface on the evaluated part of any flank, scallops \
                 included",
                none,
            ),
        ),
        Entry::headline(
            "smallest_tooth_thickness",
            "thinnest tooth, arc",
            of_left(f64::min, "smallest tooth thickness, arc of the pitch curve"),
        ),
        Entry::headline(
            "largest_tooth_thickness",
            "thickest tooth, arc",
            of_left(f64::max, "largest tooth thickness, arc of the pitch curve"),
        ),
        Entry::headline(
            "witness_mark",
            "witness mark",
            quantity_at(
                extreme_over(flanks, |f| f.own.witness, |a, b| a.abs() > b.abs()),
                1e3,
                "um",
                WITNESS,
                NO_WITNESS,
            ),
        ),
        axes::margin_entry(motion),
        Entry::headline(
            "relief_ratio",
            "relief over a round gear's",
            program::of_scene(
                Quantity::number_or(
                    relief,
                    "1",
                    "smallest relief clearance on the return stroke, as a share of a circular gear's",
                    none,
                ),
                other_strokes.as_deref(),
            ),
        ),
        Entry::headline(
            "cycle_time",
            "time of all strokes",
            Quantity::number(cycle_s, "s", "time of all double strokes of all operations"),
        ),
        Entry::headline(
            "largest_chip_section",
            "largest chip section",
            peak(
                job,
                chips,
                largest(|s| s.area_mm2),
                "section of all chips of a stroke, all operations",
                "mm^2",
                &|s| s.area_mm2,
            ),
        ),
        Entry::headline(
            "largest_cutting_force",
            "largest cutting force",
            peak(job, chips, largest(|s| s.cutting_n), "cutting force along the stroke, all operations", "N", &|s| {
                s.cutting_n
            }),
        ),
        Entry::headline(
            "entry_cutting_force",
            "first stroke at full depth",
            entry(
                chips.operations.iter().filter_map(|o| o.entry()).map(|s| s.cutting_n).reduce(f64::max),
                "N",
                ENTRY_FORCE,
            ),
        ),
        Entry::headline(
            "removal_rate",
            "removal rate",
            Quantity::number(
                removed_mm3 / (cycle_s / 60.0) / 1e3,
                "cm^3/min",
                "volume taken away by all operations over the time of their double strokes",
            ),
        ),
        Entry::headline(
            "idle_strokes",
            "idle strokes",
            Quantity::count(
                chips.operations.iter().map(|o| o.idle() as u64).sum(),
                "strokes",
                "strokes of all operations in which no cutter tooth meets material",
            ),
        ),
        Entry::headline(
            "unevenness_max",
            "largest unevenness",
            percent(
                unevenness.map(|u| u.max_percent),
                "largest |AB - CD| over the mean of AB and CD, all teeth, as cut",
                uneven,
            ),
        ),
        Entry::headline(
            "unevenness_mean",
            "mean unevenness",
            percent(
                unevenness.map(|u| u.mean_percent),
                "mean of |AB - CD| over the mean of AB and CD, all teeth, as cut",
                uneven,
            ),
        ),
    ]
}

fn percent(value: Option<f64>, definition: &'static str, why: &str) -> Quantity {
    Quantity::number_or(value, "%", definition, why)
}
