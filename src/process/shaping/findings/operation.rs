//! One operation on a shaped gear: strokes, axes, chips, and the stock that it leaves.

use super::{chips, cmm, deflection, program, returns, strokes, teeth};
use crate::findings::Section;
use crate::findings::quantities::cutting::{CYCLE_TIME, LINKAGE, OFFSET, SHORT_OF_DEPTH};
use crate::findings::quantities::flanks::{LAST, NO_FLANK_REACHED};
use crate::measure::stock::Stock;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::cut::chips::ChipLedger;
use crate::process::shaping::gear::measure::unevenness::{ToothAllowance, Unevenness as Percent, summarise};
use crate::process::shaping::gear::measure::{FlankReport, GearReport};
use crate::process::shaping::quantities::{
    CIRCULAR_FEED, LARGEST_SPEED, MEAN_SPEED, SPREAD_MAX, SPREAD_MEAN, SPREADS, STOCK_OF_TEETH, STROKES,
};
use crate::steps::axes;
use gearcut_core::error::Refusal;
use std::f64::consts::PI;
use teeth::stock_range;

/// Everything that was found on an operation.
///
/// # Errors
/// A back-off so large that the retraction leads to no pose.
pub fn operation(
    job: &ShapingJob,
    report: &GearReport,
    ledger: &ChipLedger,
    motions: &[OperationAxes],
    index: usize,
) -> Result<Section, Refusal> {
    let (operation, motion) = (&job.operations[index], &motions[index]);
    // What is known of the scene's own strokes: of this operation, and of all that shape the gear.
    let other = program::not_of_the_operation(job, motion);
    let other_gear = program::not_of_the_gear(job, motions);
    let withheld = |section: Section, other: &Option<String>| match other {
        Some(why) => section.without_values(why, &[]),
        None => section,
    };
    let allowance = report.allowances.iter().find(|a| a.operation == index);
    let last = index + 1 == job.operations.len();
    let no_stock = if last { LAST } else { NO_FLANK_REACHED };
    let over_flanks: Vec<(Option<&FlankReport>, Stock)> =
        report.flanks.iter().filter_map(|f| Some((Some(f), (*f.own.stock.get(index)?)?))).collect();
    let over_fillets: Vec<(Option<&FlankReport>, Stock)> =
        report.flanks.iter().filter_map(|f| Some((Some(f), (*f.own.fillet_stock.get(index)?)?))).collect();
    let over_roots: Vec<(Option<&FlankReport>, Stock)> =
        report.roots.iter().filter_map(|r| Some((None, (*r.stock.get(index)?)?))).collect();
    let by_mean = |teeth: &[ToothAllowance]| summarise(teeth.iter().map(ToothAllowance::unevenness_mean_percent));
    let by_rack =
        |teeth: &[ToothAllowance], rack_mm| summarise(teeth.iter().map(|t| t.unevenness_rack_percent(rack_mm)));
    // As cut, and in the limit of many strokes; over the mean, and over the rack.
    let [cut, limit] = [", as cut", ", limit of many strokes"];
    let [mean, rack] = ["over the mean of AB and CD", "over delta_d tan(alpha)"];
    let spread = |key: &str, [over, of]: [&str; 2], found: Option<Percent>| {
        Section::new(key, format!("|AB - CD| {over}{of}")).entries([
            SPREAD_MAX.of_or(found.map(|u| u.max_percent), no_stock),
            SPREAD_MEAN.of_or(found.map(|u| u.mean_percent), no_stock),
        ])
    };
    let unevenness = SPREADS
        .section([])
        .part(spread("mean_denominator", [mean, cut], allowance.and_then(|a| by_mean(&a.strokes))))
        .part(withheld(
            spread("rack_denominator", [rack, cut], allowance.and_then(|a| by_rack(&a.strokes, a.rack_mm))),
            &other_gear,
        ))
        .part(withheld(
            spread("envelope_mean_denominator", [mean, limit], allowance.and_then(|a| by_mean(&a.envelope))),
            &other_gear,
        ))
        .part(withheld(
            spread("envelope_rack_denominator", [rack, limit], allowance.and_then(|a| by_rack(&a.envelope, a.rack_mm))),
            &other_gear,
        ));
    let (spec, schedule) = (&operation.spec, &operation.schedule);
    let strokes = operation.count();
    let speed_m_per_min = job.ram_speed_mm_per_s(index) * 60.0 / 1e3;
    let teeth_with_stock = if last { 0 } else { job.scene.gear.teeth };
    let section = Section::new(&spec.name, format!("Operation {}", spec.name))
        .entries([
            LINKAGE.of(operation.linkage.words()).unless(other.as_deref()),
            OFFSET.of(spec.offset_mm).unless(other.as_deref()),
            SHORT_OF_DEPTH.of(operation.short_of_depth_mm).unless(other.as_deref()),
            STROKES.of(strokes),
            LARGEST_SPEED.of(speed_m_per_min).unless(other.as_deref()),
            MEAN_SPEED.of(2.0 / PI * speed_m_per_min).unless(other.as_deref()),
            CIRCULAR_FEED.of(schedule.circular_feed_mm_per_stroke()).unless(other.as_deref()),
            CYCLE_TIME.of(schedule.time_s(strokes as f64)),
        ])
        .table(teeth::allowance(report, allowance, &spec.name, other_gear.is_some()))
        .part(axes::findings(motion))
        .parts(program::section(motion))
        .part(withheld(motion.relief_findings(), &other))
        .parts(motion.retraction_findings().map(|section| withheld(section, &other)))
        .parts(returns::section(job, index, other.as_deref())?)
        .part(chips::chips(job, ledger, index).table(strokes::strokes(job, ledger, index)))
        .parts(deflection::section(job, ledger, index))
        .parts(deflection::vibration(job, ledger, index))
        .part(stock_range("flank_stock", "Stock on all active flanks", &over_flanks, no_stock))
        .part(stock_range(
            "fillet_stock",
            "Stock on all flanks below the start of the operation's own involute or of the evaluated profile",
            &over_fillets,
            no_stock,
        ))
        .part(stock_range("root_stock", "Stock in all roots, on rays that do not end before it", &over_roots, no_stock))
        .part(unevenness)
        .parts(report.cmm.iter().find(|of| of.operation == index).map(|of| cmm::section(of, &spec.name)))
        .part(
            STOCK_OF_TEETH
                .section([])
                .parts((1..=teeth_with_stock).map(|tooth| teeth::tooth_stock(report, index, tooth))),
        );
    Ok(section)
}
