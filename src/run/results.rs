//! From what was measured to `results.json`: names, units, definitions, places.
//!
//! In: the job, the cut gear. Out: [`Results`]. Nothing is computed here but extremes over flanks.

use super::CutGear;
use super::chip_results::{ENTRY_FORCE, chip_results, entry, peak};
use super::tooth_results::{finished_tooth, operation_tooth, stock_range};
use crate::axes_report::{OperationAxes, linkage_words};
use crate::gear::target::FlankEnd;
use crate::job::Job;
use crate::measure::FlankReport;
use crate::measure::chips::StrokeChips;
use crate::measure::stock::{Extreme, Stock};
use crate::measure::unevenness::{ToothAllowance, Unevenness as Percent, summarise};
use crate::output::quantity::{Place, Quantity};
use crate::output::results::{BlankResults, Headline, OperationResults, Results, SCHEMA_VERSION, Spread, Unevenness};
use crate::texture::{self, WindowTexture};

/// Why a single operation has no stock.
const SINGLE: &str = "the scene has one operation; stock is what an earlier operation leaves";

/// Fills in the results.
pub fn results(job: &Job, cut: &CutGear, blank: Option<BlankResults>, textures: &[WindowTexture]) -> Results {
    let axes = OperationAxes::of_job(job);
    Results {
        schema_version: SCHEMA_VERSION,
        program: "gearcut".to_owned(),
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        scene: job.scene.name.clone(),
        complete: !cut.interrupted,
        period_teeth: cut.report.period_teeth,
        headline: headline(job, cut, &axes),
        operations: (0..job.operations.len()).map(|index| operation(job, cut, &axes, index)).collect(),
        blank,
        teeth: (1..=job.scene.gear.teeth).map(|tooth| finished_tooth(&cut.report, tooth)).collect(),
        texture: texture::results(job, textures),
    }
}

/// Place of an extreme on a flank.
pub fn place(flank: &FlankReport, at: &Extreme) -> Place {
    Place { tooth: flank.tooth, flank: flank.side.name().into(), u_mm: at.arc_mm, v_mm: at.lead_mm }
}

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

fn headline(job: &Job, cut: &CutGear, axes: &[OperationAxes]) -> Headline {
    let flanks = &cut.report.flanks;
    let last_stock = job.operations.len().checked_sub(2);
    let stock = |flank: &FlankReport| last_stock.and_then(|index| flank.stock[index]);
    let why = if last_stock.is_none() { SINGLE } else { "no flank was cut" };
    let none = "no flank was cut";
    let form = |flank: &FlankReport| Some(Extreme { value_mm: flank.form.height_mm, arc_mm: 0.0, lead_mm: 0.0 });
    let scallop = |flank: &FlankReport| {
        flank.scallops.map(|s| Extreme { value_mm: s.largest.height_mm, arc_mm: s.largest.arc_mm, lead_mm: 0.0 })
    };
    let undercut =
        flanks.iter().filter(|f| f.form.end == FlankEnd::Undercut || f.tip.end == FlankEnd::Undercut).count();
    let pointed = flanks.iter().filter(|f| f.tip.end == FlankEnd::PointedTip).count().div_ceil(2);
    let thickness: Vec<f64> = cut.report.thickness.iter().flatten().map(|t| t.arc_mm).collect();
    let narrowest = cut.report.tip_lands_mm.iter().copied().reduce(f64::min);
    let unevenness = cut
        .report
        .allowances
        .last()
        .and_then(|a| summarise(a.strokes.iter().map(ToothAllowance::unevenness_mean_percent)));
    let relief = axes.iter().map(|a| a.relief.ratio).reduce(f64::min);
    let margin = axes.iter().filter_map(OperationAxes::smallest_margin).reduce(f64::min);
    let cycle_s: f64 = job.operations.iter().map(|o| o.schedule.time_s(o.schedule.count() as f64)).sum();
    let removed_mm3: f64 =
        (0..job.operations.len()).map(|index| cut.chips.area_mm2(index)).sum::<f64>() * job.scene.gear.face_width_mm;
    // The operation in which something is largest.
    let largest = |value: fn(&StrokeChips) -> f64| {
        let of = |index: usize| cut.chips.operations[index].largest(value).map_or(0.0, |(_, stroke)| value(stroke));
        (0..job.operations.len()).reduce(|best, next| if of(next) > of(best) { next } else { best }).unwrap_or(0)
    };
    let thickness_why = "no tooth crosses the pitch curve with both flanks";
    Headline {
        smallest_normal_stock: quantity_at(
            extreme_over(flanks, |f| stock(f).map(|s| s.smallest), |a, b| a < b),
            1.0,
            "mm",
            "smallest stock that the last operation finds on the active flanks, along the target's normal",
            why,
        ),
        largest_normal_stock: quantity_at(
            extreme_over(flanks, |f| stock(f).map(|s| s.largest), |a, b| a > b),
            1.0,
            "mm",
            "largest stock that the last operation finds on the active flanks, along the target's normal",
            why,
        ),
        start_of_involute: quantity_at(
            extreme_over(flanks, form, |a, b| a > b),
            1.0,
            "mm",
            "highest start of the involute of all flanks, as height over the pitch curve",
            none,
        ),
        undercut_flanks: Quantity::count(undercut as u64, "flanks", "flanks whose generated profile turns back"),
        tip_land: Quantity::number_or(narrowest, "mm", "narrowest tip land of all teeth", none),
        pointed_teeth: Quantity::count(pointed as u64, "teeth", "teeth that are pointed below the blank's outline"),
        scallop_height: quantity_at(
            extreme_over(flanks, scallop, |a, b| a > b),
            1e3,
            "um",
            "highest cusp between two strokes' facets on the evaluated profiles, over the target",
            "no cusp between facets of three dexels and more was met: the dexels are too coarse for the feed",
        ),
        smallest_tooth_thickness: Quantity::number_or(
            thickness.iter().copied().reduce(f64::min),
            "mm",
            "smallest tooth thickness, arc of the pitch curve",
            thickness_why,
        ),
        largest_tooth_thickness: Quantity::number_or(
            thickness.iter().copied().reduce(f64::max),
            "mm",
            "largest tooth thickness, arc of the pitch curve",
            thickness_why,
        ),
        witness_mark: quantity_at(
            extreme_over(flanks, |f| f.witness, |a, b| a > b),
            1e3,
            "um",
            "how far what the first and last strokes left stands above the rest of its flank",
            "no dexel of an evaluated profile was left by the first or last strokes",
        ),
        axis_margin: Quantity::number_or(
            margin,
            "1",
            "what is left of the tightest axis limit, as a share of it",
            "the scene gives no axis limits",
        ),
        relief_ratio: Quantity::number_or(
            relief,
            "1",
            "smallest relief clearance on the return stroke, as a share of a circular gear's",
            none,
        ),
        cycle_time: Quantity::number(cycle_s, "s", "time of all double strokes of all operations"),
        largest_chip_section: peak(
            job,
            &cut.chips,
            largest(|s| s.area_mm2),
            "section of all chips of a stroke, all operations",
            "mm^2",
            &|s| s.area_mm2,
        ),
        largest_cutting_force: peak(
            job,
            &cut.chips,
            largest(|s| s.cutting_n),
            "cutting force along the stroke, all operations",
            "N",
            &|s| s.cutting_n,
        ),
        entry_cutting_force: entry(
            cut.chips.operations.iter().filter_map(|o| o.entry()).map(|s| s.cutting_n).reduce(f64::max),
            "N",
            ENTRY_FORCE,
        ),
        removal_rate: Quantity::number(
            removed_mm3 / (cycle_s / 60.0) / 1e3,
            "cm^3/min",
            "volume taken away by all operations over the time of their double strokes",
        ),
        idle_strokes: Quantity::count(
            cut.chips.operations.iter().map(|o| o.idle() as u64).sum(),
            "strokes",
            "strokes of all operations in which no cutter tooth meets material",
        ),
        unevenness_max: percent(
            unevenness.map(|u| u.max_percent),
            "largest |AB - CD| over the mean of AB and CD, all teeth, as cut",
            why,
        ),
        unevenness_mean: percent(
            unevenness.map(|u| u.mean_percent),
            "mean of |AB - CD| over the mean of AB and CD, all teeth, as cut",
            why,
        ),
    }
}

fn percent(value: Option<f64>, definition: &'static str, why: &str) -> Quantity {
    Quantity::number_or(value, "%", definition, why)
}

fn operation(job: &Job, cut: &CutGear, axes: &[OperationAxes], index: usize) -> OperationResults {
    let operation = &job.operations[index];
    let allowance = cut.report.allowances.iter().find(|a| a.operation == index);
    let last = index + 1 == job.operations.len();
    let why = if last { "the last operation leaves no stock to itself" } else { "no flank was reached" };
    let over_flanks: Vec<(Option<&FlankReport>, Stock)> =
        cut.report.flanks.iter().filter_map(|f| Some((Some(f), (*f.stock.get(index)?)?))).collect();
    let over_roots: Vec<(Option<&FlankReport>, Stock)> =
        cut.report.roots.iter().filter_map(|r| Some((None, (*r.stock.get(index)?)?))).collect();
    let spread = |values: Option<Percent>, what: &'static str, mean: &'static str| Spread {
        max: percent(values.map(|u| u.max_percent), what, why),
        mean: percent(values.map(|u| u.mean_percent), mean, why),
    };
    let by_mean = |teeth: &[ToothAllowance]| summarise(teeth.iter().map(ToothAllowance::unevenness_mean_percent));
    let by_rack =
        |teeth: &[ToothAllowance], rack_mm| summarise(teeth.iter().map(|t| t.unevenness_rack_percent(rack_mm)));
    OperationResults {
        name: operation.spec.name.clone(),
        linkage: linkage_words(operation.spec.linkage).to_owned(),
        offset: Quantity::number(operation.spec.offset_mm, "mm", "delta_d in force, thickness allowance included"),
        strokes: Quantity::count(operation.schedule.count() as u64, "strokes", "strokes, plunging ones included"),
        circular_feed: Quantity::number(
            operation.schedule.circular_feed_mm_per_stroke(),
            "mm per stroke",
            "mean arc of the pitch curve per double stroke",
        ),
        cycle_time: Quantity::number(
            operation.schedule.time_s(operation.schedule.count() as f64),
            "s",
            "time of the operation's double strokes",
        ),
        axes: axes[index].axes_results(),
        relief: axes[index].relief_results(),
        chips: chip_results(job, &cut.chips, index),
        flank_stock: stock_range(&over_flanks, "on all active flanks", why),
        root_stock: stock_range(&over_roots, "in all roots, on rays that do not end before it", why),
        unevenness: Unevenness {
            mean_denominator: spread(
                allowance.and_then(|a| by_mean(&a.strokes)),
                "largest |AB - CD| over the mean of AB and CD, as cut",
                "mean over the teeth of |AB - CD| over the mean of AB and CD, as cut",
            ),
            rack_denominator: spread(
                allowance.and_then(|a| by_rack(&a.strokes, a.rack_mm)),
                "largest |AB - CD| over delta_d tan(alpha), as cut",
                "mean over the teeth of |AB - CD| over delta_d tan(alpha), as cut",
            ),
            envelope_mean_denominator: spread(
                allowance.and_then(|a| by_mean(&a.envelope)),
                "largest |AB - CD| over the mean of AB and CD, in the limit of many strokes",
                "mean over the teeth of |AB - CD| over the mean of AB and CD, in the limit of many strokes",
            ),
            envelope_rack_denominator: spread(
                allowance.and_then(|a| by_rack(&a.envelope, a.rack_mm)),
                "largest |AB - CD| over delta_d tan(alpha), in the limit of many strokes",
                "mean over the teeth of |AB - CD| over delta_d tan(alpha), in the limit of many strokes",
            ),
        },
        teeth: allowance
            .map(|a| (0..a.strokes.len()).map(|i| operation_tooth(&cut.report, a, index, i)).collect())
            .unwrap_or_default(),
    }
}
