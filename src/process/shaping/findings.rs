//! What a run finds on a shaped gear: headline, operations, deviations, teeth.
//!
//! In: the job, what was measured, the chip ledger. Out: entries and sections of the tree. Nothing is computed here but
//! extremes over flanks.

pub mod blank;
mod chips;
mod teeth;

use crate::cut::CutStats;
use crate::findings::{Entry, Place, Quantity, Section};
use crate::measure::deviation::{PitchDeviations, Runout};
use crate::measure::stock::{Extreme, Stock};
use crate::output::text::significant;
use crate::process::shaping::Job;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::chips::{ChipLedger, StrokeChips};
use crate::process::shaping::measure::unevenness::{ToothAllowance, Unevenness as Percent, summarise};
use crate::process::shaping::measure::{FlankReport, GearReport};
use crate::process::shaping::target::FlankEnd;
use crate::steps::axes;
use crate::units::UM_PER_MM;
use chips::{ENTRY_FORCE, entry, peak};
use teeth::stock_range;

/// Why a single operation has no stock.
const SINGLE: &str = "the scene has one operation; stock is what an earlier operation leaves";
/// Why there is no pitch deviation.
const NOT_CROSSED: &str = "a flank was not cut or does not cross the pitch curve";
/// Cuts below the target deeper than this are worth a warning: far above the resolution, below every tolerance on a
/// gear drawing.
const GOUGE_MM: f64 = 1e-4;

/// Operations, deviations and teeth.
pub fn sections(job: &Job, report: &GearReport, ledger: &ChipLedger, motion: &[OperationAxes]) -> Vec<Section> {
    let operations = (0..job.operations.len()).map(|index| operation(job, report, ledger, &motion[index], index));
    let period = "teeth after which the pitch curve repeats: the first period of tables and charts";
    let teeth = (1..=job.scene.gear.teeth).map(|tooth| teeth::finished_tooth(report, tooth));
    vec![
        Section::new("operations", "Operations").parts(operations),
        deviations(report),
        Section::new("teeth", "Finished teeth")
            .with("period_teeth", Quantity::count(report.period_teeth.into(), "teeth", period))
            .parts(teeth),
    ]
}

/// What a gear inspector states of the whole gear.
fn deviations(report: &GearReport) -> Section {
    let um = |mm: Option<f64>, definition: &'static str| {
        Quantity::number_or(mm.map(|mm| mm * UM_PER_MM), "um", definition, NOT_CROSSED)
    };
    let worst = report
        .flanks
        .iter()
        .filter_map(|flank| Some((flank, flank.profile?)))
        .reduce(|best, next| if next.1.total_mm > best.1.total_mm { next } else { best });
    let profile = um(
        worst.map(|(_, profile)| profile.total_mm),
        "largest range of heights over the target along an evaluated profile, middle of the face",
    );
    let profile = match worst {
        Some((flank, of)) => {
            let middle_mm = 0.5 * (of.between_mm[0] + of.between_mm[1]);
            profile.at(Place::on_flank(flank.tooth, flank.side.name(), middle_mm, 0.0))
        }
        None => profile,
    };
    let pitch = |pick: fn(&PitchDeviations) -> f64, definition: &'static str| {
        um(report.pitch.iter().flatten().map(pick).reduce(f64::max), definition)
    };
    Section::new("deviations", "Deviations of the finished gear")
        .shown("profile_deviation", "profile deviation F_alpha", profile)
        .shown(
            "single_pitch_deviation",
            "single pitch deviation f_p",
            pitch(
                PitchDeviations::largest_single_mm,
                "largest single pitch deviation of either flank, arc on the pitch curve",
            ),
        )
        .shown(
            "total_pitch_deviation",
            "total pitch deviation F_p",
            pitch(PitchDeviations::total_mm, "range of the cumulative pitch deviations, larger of both flanks"),
        )
        .shown(
            "runout",
            "runout F_r",
            um(
                report.runout.as_ref().map(Runout::total_mm),
                "range of a probe's place along the pitch curve's normal over all spaces",
            ),
        )
}

/// Place of an extreme on a flank.
pub fn place(flank: &FlankReport, at: &Extreme) -> Place {
    Place::on_flank(flank.tooth, flank.side.name(), at.arc_mm, at.lead_mm)
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

/// What to look at first.
pub fn headline(job: &Job, report: &GearReport, chips: &ChipLedger, motion: &[OperationAxes]) -> Vec<Entry> {
    let flanks = &report.flanks;
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
    let thickness: Vec<f64> = report.thickness.iter().flatten().map(|t| t.arc_mm).collect();
    let narrowest = report.tip_lands_mm.iter().copied().reduce(f64::min);
    let unevenness =
        report.allowances.last().and_then(|a| summarise(a.strokes.iter().map(ToothAllowance::unevenness_mean_percent)));
    let relief = motion.iter().map(|operation| operation.relief.ratio).reduce(f64::min);
    let cycle_s: f64 = job.operations.iter().map(|o| o.schedule.time_s(o.schedule.count() as f64)).sum();
    let removed_mm3: f64 =
        (0..job.operations.len()).map(|index| chips.area_mm2(index)).sum::<f64>() * job.scene.gear.face_width_mm;
    // The operation in which something is largest.
    let largest = |value: fn(&StrokeChips) -> f64| {
        let of = |index: usize| chips.operations[index].largest(value).map_or(0.0, |(_, stroke)| value(stroke));
        (0..job.operations.len()).reduce(|best, next| if of(next) > of(best) { next } else { best }).unwrap_or(0)
    };
    let thickness_why = "no tooth crosses the pitch curve with both flanks";
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
            quantity_at(
                extreme_over(flanks, form, |a, b| a > b),
                1.0,
                "mm",
                "highest start of the involute of all flanks, as height over the pitch curve",
                none,
            ),
        ),
        Entry::headline(
            "undercut_flanks",
            "undercut flanks",
            Quantity::count(undercut as u64, "flanks", "flanks whose generated profile turns back"),
        ),
        Entry::headline(
            "tip_land",
            "narrowest tip land",
            Quantity::number_or(narrowest, "mm", "narrowest tip land of all teeth", none),
        ),
        Entry::headline(
            "pointed_teeth",
            "pointed teeth",
            Quantity::count(pointed as u64, "teeth", "teeth that are pointed below the blank's outline"),
        ),
        Entry::headline(
            "scallop_height",
            "highest scallop",
            quantity_at(
                extreme_over(flanks, scallop, |a, b| a > b),
                1e3,
                "um",
                "highest cusp between two strokes' facets on the evaluated profiles, over the target",
                "no cusp between facets of three dexels and more was met: the dexels are too coarse for the feed",
            ),
        ),
        Entry::headline(
            "smallest_tooth_thickness",
            "thinnest tooth, arc",
            Quantity::number_or(
                thickness.iter().copied().reduce(f64::min),
                "mm",
                "smallest tooth thickness, arc of the pitch curve",
                thickness_why,
            ),
        ),
        Entry::headline(
            "largest_tooth_thickness",
            "thickest tooth, arc",
            Quantity::number_or(
                thickness.iter().copied().reduce(f64::max),
                "mm",
                "largest tooth thickness, arc of the pitch curve",
                thickness_why,
            ),
        ),
        Entry::headline(
            "witness_mark",
            "witness mark",
            quantity_at(
                extreme_over(flanks, |f| f.witness, |a, b| a > b),
                1e3,
                "um",
                "how far what the first and last strokes left stands above the rest of its flank",
                "no dexel of an evaluated profile was left by the first or last strokes",
            ),
        ),
        axes::margin_entry(motion),
        Entry::headline(
            "relief_ratio",
            "relief over a round gear's",
            Quantity::number_or(
                relief,
                "1",
                "smallest relief clearance on the return stroke, as a share of a circular gear's",
                none,
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
                why,
            ),
        ),
        Entry::headline(
            "unevenness_mean",
            "mean unevenness",
            percent(
                unevenness.map(|u| u.mean_percent),
                "mean of |AB - CD| over the mean of AB and CD, all teeth, as cut",
                why,
            ),
        ),
    ]
}

fn percent(value: Option<f64>, definition: &'static str, why: &str) -> Quantity {
    Quantity::number_or(value, "%", definition, why)
}

fn operation(job: &Job, report: &GearReport, ledger: &ChipLedger, motion: &OperationAxes, index: usize) -> Section {
    let operation = &job.operations[index];
    let allowance = report.allowances.iter().find(|a| a.operation == index);
    let last = index + 1 == job.operations.len();
    let why = if last { "the last operation leaves no stock to itself" } else { "no flank was reached" };
    let over_flanks: Vec<(Option<&FlankReport>, Stock)> =
        report.flanks.iter().filter_map(|f| Some((Some(f), (*f.stock.get(index)?)?))).collect();
    let over_roots: Vec<(Option<&FlankReport>, Stock)> =
        report.roots.iter().filter_map(|r| Some((None, (*r.stock.get(index)?)?))).collect();
    let by_mean = |teeth: &[ToothAllowance]| summarise(teeth.iter().map(ToothAllowance::unevenness_mean_percent));
    let by_rack =
        |teeth: &[ToothAllowance], rack_mm| summarise(teeth.iter().map(|t| t.unevenness_rack_percent(rack_mm)));
    // As cut, and in the limit of many strokes; over the mean, and over the rack.
    let [cut, limit] = [", as cut", ", limit of many strokes"];
    let [mean, rack] = ["over the mean of AB and CD", "over delta_d tan(alpha)"];
    let spread = |key: &str, [over, of]: [&str; 2], found: Option<Percent>| {
        let of_words = if of == cut { cut } else { ", in the limit of many strokes" };
        Section::new(key, format!("|AB - CD| {over}{of}"))
            .shown(
                "max",
                "max",
                Quantity::number_or(
                    found.map(|u| u.max_percent),
                    "%",
                    format!("largest |AB - CD| {over}{of_words}"),
                    why,
                ),
            )
            .shown(
                "mean",
                "mean",
                Quantity::number_or(
                    found.map(|u| u.mean_percent),
                    "%",
                    format!("mean over the teeth of |AB - CD| {over}{of_words}"),
                    why,
                ),
            )
    };
    let unevenness = Section::new("unevenness", "Unevenness of the allowance")
        .part(spread("mean_denominator", [mean, cut], allowance.and_then(|a| by_mean(&a.strokes))))
        .part(spread("rack_denominator", [rack, cut], allowance.and_then(|a| by_rack(&a.strokes, a.rack_mm))))
        .part(spread("envelope_mean_denominator", [mean, limit], allowance.and_then(|a| by_mean(&a.envelope))))
        .part(spread(
            "envelope_rack_denominator",
            [rack, limit],
            allowance.and_then(|a| by_rack(&a.envelope, a.rack_mm)),
        ));
    let (spec, schedule) = (&operation.spec, &operation.schedule);
    let strokes = schedule.count();
    let stock_of_teeth = allowance.into_iter().flat_map(|of| &of.strokes);
    Section::new(&spec.name, format!("Operation {}", spec.name))
        .with("linkage", Quantity::text(operation.linkage.words(), "linkage of cutter and work"))
        .with("offset", Quantity::number(spec.offset_mm, "mm", "delta_d in force, thickness allowance included"))
        .with("strokes", Quantity::count(strokes as u64, "strokes", "strokes, plunging ones included"))
        .with(
            "circular_feed",
            Quantity::number(
                schedule.circular_feed_mm_per_stroke(),
                "mm per stroke",
                "mean arc of the pitch curve per double stroke",
            ),
        )
        .with(
            "cycle_time",
            Quantity::number(schedule.time_s(strokes as f64), "s", "time of the operation's double strokes"),
        )
        .table(teeth::allowance(report, allowance))
        .part(axes::findings(motion))
        .part(motion.relief_findings())
        .part(chips::chips(job, ledger, index))
        .part(stock_range("flank_stock", "Stock on all active flanks", &over_flanks, "on all active flanks", why))
        .part(stock_range(
            "root_stock",
            "Stock in all roots",
            &over_roots,
            "in all roots, on rays that do not end before it",
            why,
        ))
        .part(unevenness)
        .part(
            Section::new("teeth", "Stock of each tooth")
                .parts(stock_of_teeth.map(|of| teeth::tooth_stock(report, index, of.tooth))),
        )
}

/// What a reader must know before trusting the numbers.
pub fn warnings(report: &GearReport, stats: &CutStats, interrupted: bool, motion: &[OperationAxes]) -> Vec<String> {
    let mut warnings = Vec::new();
    let below: u64 = report.flanks.iter().map(|f| f.below_range).sum();
    if below > 0 {
        warnings.push(format!("{below} dexels were cut deeper than their rays record: heights there are upper bounds"));
    }
    let untouched: u64 = report.flanks.iter().map(|f| f.untouched).sum();
    if untouched > 0 {
        warnings.push(format!("{untouched} dexels were touched by no pass: part of the flanks is still the blank"));
    }
    let deepest = report
        .flanks
        .iter()
        .filter_map(|flank| Some((flank, flank.undercut?)))
        .min_by(|a, b| a.1.value_mm.total_cmp(&b.1.value_mm))
        .filter(|(_, deepest)| deepest.value_mm < -GOUGE_MM);
    if let Some((flank, deepest)) = deepest {
        let count = report.flanks.iter().filter(|f| f.undercut.is_some_and(|u| u.value_mm < -GOUGE_MM)).count();
        warnings.push(format!(
            "{count} flanks are cut below the target, tooth {} {} by {} um, {:.2} mm above the start of the involute",
            flank.tooth,
            flank.side.name(),
            significant(-deepest.value_mm * 1e3, 3),
            deepest.arc_mm
        ));
    }
    if stats.unconverged > 0 {
        let count = stats.unconverged;
        warnings
            .push(format!("{count} rays did not converge: their heights may be too large; please report the scene"));
    }
    if interrupted {
        warnings.push("stopped by Ctrl-C: figures cover the finished flanks only".to_owned());
    }
    warnings.extend(axes::warnings(motion));
    warnings
}
