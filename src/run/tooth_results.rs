//! The rows of `results.json` that belong to one tooth.

use super::results::place;
use crate::gear::generation::Side;
use crate::gear::target::FlankEnd;
use crate::measure::gear_report::OperationAllowance;
use crate::measure::stock::{Extreme, Stock};
use crate::measure::{FlankReport, GearReport};
use crate::output::quantity::{Place, Quantity};
use crate::output::results::{FinishedFlank, FinishedTooth, OperationTooth, ProfileDeviations, StockRange};

/// Smallest, largest and mean stock over some flanks (with their report, for the place) or roots.
pub fn stock_range(parts: &[(Option<&FlankReport>, Stock)], where_: &str, why: &str) -> StockRange {
    let found = |pick: fn(&Stock) -> Extreme, better: fn(f64, f64) -> bool, what: &str| {
        let definition = format!("{what} stock {where_}, along the target's normal");
        let best = parts
            .iter()
            .map(|(flank, stock)| (flank, pick(stock)))
            .reduce(|best, next| if better(next.1.value_mm, best.1.value_mm) { next } else { best });
        match best {
            Some((flank, extreme)) => {
                let quantity = Quantity::number(extreme.value_mm, "mm", definition);
                match flank {
                    Some(flank) => quantity.at(place(flank, &extreme)),
                    None => quantity,
                }
            }
            None => Quantity::undefined("mm", definition, why),
        }
    };
    let dexels: u64 = parts.iter().map(|(_, stock)| stock.dexels).sum();
    let sum: f64 = parts.iter().map(|(_, stock)| stock.mean_mm * stock.dexels as f64).sum();
    StockRange {
        smallest: found(|s| s.smallest, |a, b| a < b, "smallest"),
        largest: found(|s| s.largest, |a, b| a > b, "largest"),
        mean: Quantity::number_or(
            (dexels > 0).then(|| sum / dexels as f64),
            "mm",
            format!("mean stock {where_}, over the dexels that the operation reached"),
            why,
        ),
    }
}

fn flank_of(report: &GearReport, tooth: u32, side: Side) -> Option<&FlankReport> {
    report.flanks.iter().find(|f| f.tooth == tooth && f.side == side)
}

/// Stock and allowances that an operation left on tooth number `row` + 1.
pub fn operation_tooth(
    report: &GearReport,
    allowance: &OperationAllowance,
    operation: usize,
    row: usize,
) -> OperationTooth {
    let (cut, envelope) = (&allowance.strokes[row], &allowance.envelope[row]);
    let range = |side| {
        let stock = flank_of(report, cut.tooth, side).and_then(|f| Some((Some(f), (*f.stock.get(operation)?)?)));
        stock_range(&stock.into_iter().collect::<Vec<_>>(), "on the flank", "the flank was not cut or not reached")
    };
    let crossing_why = "a surface does not cross the pitch curve with its involute";
    let mm = |value, definition: &'static str| Quantity::number_or(value, "mm", definition, crossing_why);
    OperationTooth {
        index: cut.tooth,
        left: range(Side::Left),
        right: range(Side::Right),
        ab: mm(cut.ab_mm(), "chord from A (this operation) to B (finished), left flank, on the pitch curve"),
        cd: mm(cut.cd_mm(), "chord from C (finished) to D (this operation), right flank, on the pitch curve"),
        unevenness_mean_denominator: Quantity::number_or(
            cut.unevenness_mean_percent(),
            "%",
            "|AB - CD| over the mean of AB and CD",
            crossing_why,
        ),
        unevenness_rack_denominator: Quantity::number_or(
            cut.unevenness_rack_percent(allowance.rack_mm),
            "%",
            "|AB - CD| over delta_d tan(alpha)",
            "a surface does not cross the pitch curve, or the operation has no offset over the last one",
        ),
        envelope_ab: mm(envelope.ab_mm(), "AB in the limit of many strokes"),
        envelope_cd: mm(envelope.cd_mm(), "CD in the limit of many strokes"),
    }
}

/// One finished tooth.
pub fn finished_tooth(report: &GearReport, tooth: u32) -> FinishedTooth {
    let row = tooth as usize - 1;
    let thickness = report.thickness.get(row).copied().flatten();
    let why = "a flank does not cross the pitch curve";
    FinishedTooth {
        index: tooth,
        left: finished_flank(report, tooth, Side::Left),
        right: finished_flank(report, tooth, Side::Right),
        tip_land: Quantity::number_or(
            report.tip_lands_mm.get(row).copied(),
            "mm",
            "width of the tip between the flanks",
            "not computed",
        ),
        thickness_arc: Quantity::number_or(
            thickness.map(|t| t.arc_mm),
            "mm",
            "tooth thickness along the pitch curve, from C to B",
            why,
        ),
        thickness_chord: Quantity::number_or(
            thickness.map(|t| t.chord_mm),
            "mm",
            "tooth thickness straight from C to B on the pitch curve",
            why,
        ),
    }
}

fn end_words(end: FlankEnd) -> &'static str {
    match end {
        FlankEnd::CutterCorner => "cutter corner",
        FlankEnd::Undercut => "undercut",
        FlankEnd::BlankOutline => "blank outline",
        FlankEnd::CutterBase => "cutter base",
        FlankEnd::PointedTip => "pointed tip",
    }
}

fn finished_flank(report: &GearReport, tooth: u32, side: Side) -> FinishedFlank {
    let flank = flank_of(report, tooth, side);
    let not_cut = "the run was stopped before this flank was cut";
    let why = |reason: &'static str| if flank.is_some() { reason } else { not_cut };
    let number = |value: Option<f64>, unit: &'static str, definition: &'static str, reason: &'static str| {
        Quantity::number_or(value, unit, definition, why(reason))
    };
    let word = |end: Option<FlankEnd>, definition: &'static str| match end {
        Some(end) => Quantity::text(end_words(end), definition),
        None => Quantity::undefined("1", definition, not_cut),
    };
    let at = |extreme: Option<Extreme>, definition: &'static str, reason: &'static str| match (flank, extreme) {
        (Some(flank), Some(extreme)) => {
            Quantity::number(extreme.value_mm * 1e3, "um", definition).at(place(flank, &extreme))
        }
        _ => Quantity::undefined("um", definition, why(reason)),
    };
    let cusp = |cusp: Option<crate::measure::scallop::Cusp>, definition: &'static str| match (flank, cusp) {
        (Some(f), Some(cusp)) => Quantity::number(cusp.height_mm * 1e3, "um", definition).at(Place {
            tooth: f.tooth,
            flank: f.side.name().into(),
            u_mm: cusp.arc_mm,
            v_mm: 0.0,
        }),
        _ => Quantity::undefined("um", definition, why("no cusp between facets of three dexels and more was met")),
    };
    let profile = flank.and_then(|f| f.profile);
    let um = |value: Option<f64>, definition: &'static str| {
        number(value.map(|v| v * 1e3), "um", definition, "the evaluated profile was not cut completely")
    };
    let side_index = usize::from(side == Side::Right);
    let pitch = report.pitch[side_index].as_ref();
    let row = tooth as usize - 1;
    let pitch_um = |value: Option<f64>, definition: &'static str| {
        Quantity::number_or(value.map(|v| v * 1e3), "um", definition, "a flank does not cross the pitch curve")
    };
    let finished = flank.and_then(|f| f.finished);
    FinishedFlank {
        start_of_involute: number(
            flank.map(|f| f.form.height_mm),
            "mm",
            "start of the involute as height over the pitch curve",
            "",
        ),
        start: word(flank.map(|f| f.form.end), "what begins the flank"),
        tip: number(flank.map(|f| f.tip.height_mm), "mm", "end of the flank as height over the pitch curve", ""),
        end: word(flank.map(|f| f.tip.end), "what ends the flank"),
        length: number(flank.map(|f| f.length_mm), "mm", "length of the profile from start to tip", ""),
        evaluated_from: number(
            flank.map(|f| f.evaluated_mm[0]),
            "mm",
            "arc from the start of the involute at which the evaluated profile begins",
            "",
        ),
        evaluated_to: number(
            flank.map(|f| f.evaluated_mm[1]),
            "mm",
            "arc from the start of the involute at which the evaluated profile ends",
            "",
        ),
        smallest_height: at(
            finished.map(|h| h[0]),
            "lowest finished surface over the target on the evaluated profile",
            "no dexel of the evaluated profile was reached",
        ),
        largest_height: at(
            finished.map(|h| h[1]),
            "highest finished surface over the target on the evaluated profile",
            "no dexel of the evaluated profile was reached",
        ),
        deepest_cut: at(
            flank.and_then(|f| f.undercut),
            "deepest cut below the target anywhere on the flank",
            "nothing is cut more than a nanometre below the target",
        ),
        profile: ProfileDeviations {
            total: um(profile.map(|p| p.total_mm), "F_alpha: range of heights along the evaluated profile, mid-face"),
            form: um(profile.map(|p| p.form_mm), "f_f_alpha: range about the mean line"),
            slope: um(profile.map(|p| p.slope_mm), "f_H_alpha: rise of the mean line, positive towards the tip"),
        },
        largest_scallop: cusp(
            flank.and_then(|f| f.scallops).map(|s| s.largest),
            "highest cusp on the evaluated profile, mid-face",
        ),
        scallop_at_pitch_curve: cusp(
            flank.and_then(|f| f.scallops).and_then(|s| s.at_pitch_curve),
            "cusp nearest to the pitch curve, mid-face",
        ),
        witness_mark: at(
            flank.and_then(|f| f.witness),
            "how far what the first and last strokes left stands above the rest of the flank",
            "the first and last strokes left nothing on the evaluated profile",
        ),
        single_pitch: pitch_um(
            pitch.map(|p| p.single_mm[row]),
            "f_p: arc of the pitch curve from the tooth before, less pi m",
        ),
        cumulative_pitch: pitch_um(
            pitch.map(|p| p.cumulative_mm[row]),
            "arc of the pitch curve from tooth 1, less its pitches",
        ),
        below_range_dexels: Quantity::count(
            flank.map_or(0, |f| f.below_range),
            "dexels",
            "dexels cut deeper than their rays record",
        ),
        untouched_dexels: Quantity::count(flank.map_or(0, |f| f.untouched), "dexels", "dexels that no pass touched"),
    }
}
