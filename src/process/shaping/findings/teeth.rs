//! Single teeth: the stock and the allowances that an operation left, and the tooth as it is finished.

use super::headline::{NO_WITNESS, WITNESS};
use super::place;
use super::program::of_scene;
use crate::findings::{Datum, Place, Quantity, Section, Table, TableColumn};
use crate::measure::stock::{Extreme, Stock};
use crate::process::shaping::measure::gear_report::OperationAllowance;
use crate::process::shaping::measure::{FlankReport, GearReport};
use crate::process::shaping::target::FlankEnd;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// Why a lowest height, or what is known of whole flanks alone, is not known.
const BELOW_RANGE: &str = "the flank is cut deeper than its rays record, half a module under the target";

/// Smallest, largest and mean stock over some flanks (with their report, for the place) or roots.
pub fn stock_range(
    key: &str,
    title: &str,
    parts: &[(Option<&FlankReport>, Stock)],
    where_: &str,
    why: &str,
) -> Section {
    let found = |pick: fn(&Stock) -> Extreme, better: fn(f64, f64) -> bool, what: &str| {
        let definition = format!(
            "{what} stock {where_}, along the target's normal; negative where the operation cut below the target and \
             finishing takes nothing"
        );
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
    let mean = Quantity::number_or(
        (dexels > 0).then(|| sum / dexels as f64),
        "mm",
        format!("mean stock {where_}, over the dexels that the operation reached"),
        why,
    );
    Section::new(key, title)
        .with("smallest", found(|s| s.smallest, |a, b| a < b, "smallest"))
        .with("largest", found(|s| s.largest, |a, b| a > b, "largest"))
        .with("mean", mean)
}

fn flank_of(report: &GearReport, tooth: u32, side: Side) -> Option<&FlankReport> {
    report.flanks.iter().find(|f| f.tooth == tooth && f.side == side)
}

/// Stock that an operation left on the flanks of a tooth.
pub fn tooth_stock(report: &GearReport, operation: usize, tooth: u32) -> Section {
    let range = |side: Side, title: &str| {
        let stock = flank_of(report, tooth, side).and_then(|f| Some((Some(f), (*f.own.stock.get(operation)?)?)));
        let why = "the flank was not cut or not reached, or is cut away";
        stock_range(side.name(), title, &stock.into_iter().collect::<Vec<_>>(), "on the active flank", why)
    };
    Section::new(format!("tooth_{tooth:02}"), format!("tooth {tooth}"))
        .part(range(Side::Left, "left flank (larger arc)"))
        .part(range(Side::Right, "right flank (smaller arc)"))
}

/// Allowances that an operation left, tooth by tooth, in `tables/allowance_<operation>.csv`; empty and without a file
/// where it is the last one. Where a program cuts an `other_gear` than the scene's own strokes would, their limit and
/// their offset say nothing of it.
pub fn allowance(
    report: &GearReport,
    allowance: Option<&OperationAllowance>,
    operation: &str,
    other_gear: bool,
) -> Table {
    let missing = if other_gear {
        "a surface does not cross the pitch curve with its involute, or the flank is cut away; the limit of many \
         strokes and the offset are known of the scene's own strokes alone, and a program cuts others"
    } else {
        "a surface does not cross the pitch curve with its involute, or the flank is cut away"
    };
    let mm = |key, definition| TableColumn::new(key, "mm", definition).or(missing);
    let columns = vec![
        TableColumn::new("tooth", "1", "number of the tooth, from 1"),
        mm("A_x", "x of A in the gear frame: left flank as this operation leaves it, on the pitch curve"),
        mm("A_y", "y of A"),
        mm("B_x", "x of B in the gear frame: finished left flank on the pitch curve"),
        mm("B_y", "y of B"),
        mm("C_x", "x of C in the gear frame: finished right flank on the pitch curve"),
        mm("C_y", "y of C"),
        mm("D_x", "x of D in the gear frame: right flank as this operation leaves it, on the pitch curve"),
        mm("D_y", "y of D"),
        mm(
            "AB",
            "chord from A (this operation) to B (as finishing alone leaves it), left flank, on the pitch curve; \
             negative where A lies inside the finished tooth",
        ),
        mm(
            "CD",
            "chord from C (as finishing alone leaves it) to D (this operation), right flank, on the pitch curve; \
             negative where D lies inside the finished tooth",
        ),
        TableColumn::new("unevenness_mean_denominator", "%", "|AB - CD| over the mean of AB and CD")
            .or(missing)
            .as_bars(),
        TableColumn::new("unevenness_rack_denominator", "%", "|AB - CD| over delta_d tan(alpha)").or(if other_gear {
            missing
        } else {
            "a surface does not cross the pitch curve, or the operation has no offset over the last one"
        }),
        mm("envelope_AB", "AB in the limit of many strokes"),
        mm("envelope_CD", "CD in the limit of many strokes"),
        TableColumn::new(
            "envelope_unevenness_mean_denominator",
            "%",
            "|AB - CD| over the mean of AB and CD in the limit of many strokes",
        )
        .or(missing),
    ];
    let of_scene = |value: Option<f64>| value.filter(|_| !other_gear);
    let rows = allowance.into_iter().flat_map(|of| {
        of.strokes.iter().zip(&of.envelope).map(|(cut, envelope)| {
            let mut row = vec![Datum::from(cut.tooth)];
            for crossing in [cut.a, cut.b, cut.c, cut.d] {
                row.extend([crossing.map(|c| c.point_mm.x), crossing.map(|c| c.point_mm.y)].map(Datum::from));
            }
            row.extend(
                [
                    cut.ab_mm(),
                    cut.cd_mm(),
                    cut.unevenness_mean_percent(),
                    of_scene(cut.unevenness_rack_percent(of.rack_mm)),
                    of_scene(envelope.ab_mm()),
                    of_scene(envelope.cd_mm()),
                    of_scene(envelope.unevenness_mean_percent()),
                ]
                .map(Datum::from),
            );
            row
        })
    });
    let mut table = Table::new("allowance", "Allowance on the pitch curve, tooth by tooth", columns).with_rows(rows);
    table.period_rows = Some(report.period_teeth.max(1));
    if allowance.is_some() { table.in_file(&format!("allowance_{operation}")) } else { table }
}

/// One finished tooth; `other_gear` says why what is known of the scene's own strokes does not hold for this gear. It
/// does not hold for a flank that is cut away either, nor for its tooth's tip.
pub fn finished_tooth(report: &GearReport, tooth: u32, other_gear: Option<&str>) -> Section {
    let row = tooth as usize - 1;
    let thickness = report.inspection.thickness.get(row).copied().flatten();
    let is_lost = report.flanks.iter().any(|flank| flank.tooth == tooth && flank.own.is_lost);
    let mm = |value: Option<f64>, definition: &'static str, why| Quantity::number_or(value, "mm", definition, why);
    let crossing = "a flank does not cross the pitch curve or is cut away, or nothing is left between both";
    Section::new(format!("tooth_{tooth:02}"), format!("tooth {tooth}"))
        .with(
            "tip_land",
            of_scene(
                mm(report.tip_lands_mm.get(row).copied(), "width of the tip between the flanks", "not computed"),
                other_gear.or(is_lost.then_some("a flank of the tooth is cut away")),
            ),
        )
        .with(
            "thickness_arc",
            mm(thickness.map(|t| t.arc_mm), "tooth thickness along the pitch curve, from C to B", crossing),
        )
        .with(
            "thickness_chord",
            mm(thickness.map(|t| t.chord_mm), "tooth thickness straight from C to B on the pitch curve", crossing),
        )
        .with(
            "runout_of_space_after",
            Quantity::number_or(
                report.inspection.runout.as_ref().map(|r| r.radial_mm[row] * 1e3),
                "um",
                "place of a probe in the space after the tooth along the pitch curve's normal, positive outwards",
                "a flank was not cut, is cut away, or does not cross the pitch curve",
            ),
        )
        .part(finished_flank(report, tooth, Side::Left, other_gear))
        .part(finished_flank(report, tooth, Side::Right, other_gear))
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

fn finished_flank(report: &GearReport, tooth: u32, side: Side, other_gear: Option<&str>) -> Section {
    let flank = flank_of(report, tooth, side);
    let is_lost = flank.is_some_and(|flank| flank.own.is_lost);
    let other_gear = other_gear.or(is_lost.then_some(BELOW_RANGE));
    let not_cut = "the run was stopped before this flank was cut";
    let why = |reason: &'static str| match flank {
        Some(flank) if flank.own.is_lost => BELOW_RANGE,
        Some(_) => reason,
        None => not_cut,
    };
    let number = |value: Option<f64>, unit: &'static str, definition: &'static str, reason: &'static str| {
        Quantity::number_or(value, unit, definition, why(reason))
    };
    let mm = |of: fn(&FlankReport) -> f64, definition: &'static str| number(flank.map(of), "mm", definition, "");
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
        (Some(f), Some(cusp)) => Quantity::number(cusp.height_mm * 1e3, "um", definition).at(Place::on_flank(
            f.tooth,
            f.side.name(),
            cusp.arc_mm,
            0.0,
        )),
        _ => Quantity::undefined("um", definition, why("no cusp between facets of three dexels and more was met")),
    };
    let profile = flank.and_then(|f| f.profile);
    let um = |value: Option<f64>, definition: &'static str| {
        number(value.map(|v| v * 1e3), "um", definition, "the evaluated profile was not cut completely")
    };
    let lead = flank.and_then(|f| f.lead);
    let lead_um = |value: Option<f64>, definition: &'static str| {
        number(value.map(|v| v * 1e3), "um", definition, "the line along the tooth was not cut completely")
    };
    let side_index = usize::from(side == Side::Right);
    let pitch = report.inspection.pitch[side_index].as_ref();
    let row = tooth as usize - 1;
    let pitch_um = |value: Option<f64>, definition: &'static str| {
        Quantity::number_or(
            value.map(|v| v * 1e3),
            "um",
            definition,
            "a flank does not cross the pitch curve, or is cut away",
        )
    };
    let finished = flank.and_then(|f| f.own.finished);
    // Where rays end inside the cut, the lowest height is where they end.
    let lowest = |quantity: Quantity| match flank {
        Some(flank) if flank.own.below_range > 0 => quantity.without_value(BELOW_RANGE),
        _ => quantity,
    };
    Section::new(side.name(), format!("{} flank", side.name()))
        .with(
            "start_of_involute",
            of_scene(mm(|f| f.own.form.height_mm, "start of the involute as height over the pitch curve"), other_gear),
        )
        .with("start", of_scene(word(flank.map(|f| f.own.form.end), "what begins the flank"), other_gear))
        .with(
            "undercut",
            of_scene(
                number(
                    flank.and_then(|f| f.own.undercut_mm).map(|mm| mm * UM_PER_MM),
                    "um",
                    "how deep the path of the cutter's tip corner cuts below the flank under its start",
                    "the flank is not undercut",
                ),
                other_gear,
            ),
        )
        .with(
            "tip",
            of_scene(mm(|f| f.own.tip.height_mm, "end of the flank as height over the pitch curve"), other_gear),
        )
        .with("end", of_scene(word(flank.map(|f| f.own.tip.end), "what ends the flank"), other_gear))
        .with("length", of_scene(mm(|f| f.length_mm, "length of the profile from start to tip"), other_gear))
        .with(
            "evaluated_from",
            mm(
                |f| f.evaluated_mm[0],
                "arc from the start of the target's involute at which the evaluated profile begins",
            ),
        )
        .with(
            "evaluated_to",
            mm(
                |f| f.evaluated_mm[1],
                "arc from the start of the target's involute at which the evaluated profile ends",
            ),
        )
        .with(
            "smallest_height",
            lowest(at(
                finished.map(|h| h[0]),
                "smallest normal deviation of the finished surface on the evaluated profile",
                "no dexel of the evaluated profile was reached",
            )),
        )
        .with(
            "largest_height",
            at(
                finished.map(|h| h[1]),
                "largest normal deviation of the finished surface on the evaluated profile",
                "no dexel of the evaluated profile was reached",
            ),
        )
        .with(
            "deepest_cut",
            lowest(at(
                flank.and_then(|f| f.own.below_target),
                "deepest cut below the target anywhere on the flank",
                "nothing is cut more than a nanometre below the target",
            )),
        )
        .part(
            Section::new("profile", "profile deviations in the middle of the face, as ISO 1328-1 has them")
                .with(
                    "total",
                    um(profile.map(|p| p.total_mm), "F_alpha: range of heights along the evaluated profile, mid-face"),
                )
                .with("form", um(profile.map(|p| p.form_mm), "f_f_alpha: range about the mean line"))
                .with(
                    "slope",
                    um(profile.map(|p| p.slope_mm), "f_H_alpha: rise of the mean line, positive towards the tip"),
                ),
        )
        .part(
            Section::new("lead", "lead deviations at the pitch curve, as ISO 1328-1 has them")
                .with("total", lead_um(lead.map(|d| d.total_mm), "F_beta: range of heights along the tooth"))
                .with("form", lead_um(lead.map(|d| d.form_mm), "f_f_beta: range about the mean line"))
                .with("slope", lead_um(lead.map(|d| d.slope_mm), "f_H_beta: rise of the mean line over the face")),
        )
        .with(
            "largest_scallop",
            cusp(
                flank.and_then(|f| f.own.scallops).map(|s| s.largest),
                "highest cusp on the evaluated profile over the line that touches its two facets, mid-face",
            ),
        )
        .with(
            "scallop_at_pitch_curve",
            cusp(
                flank.and_then(|f| f.own.scallops).and_then(|s| s.at_pitch_curve),
                "the same of the cusp nearest to the pitch curve",
            ),
        )
        .with("witness_mark", at(flank.and_then(|f| f.own.witness), WITNESS, NO_WITNESS))
        .with(
            "single_pitch",
            pitch_um(
                pitch.map(|p| p.single_mm[row]),
                "f_p: arc of the pitch curve from the tooth before, less the mean pitch",
            ),
        )
        .with(
            "cumulative_pitch",
            pitch_um(pitch.map(|p| p.cumulative_mm[row]), "arc of the pitch curve from tooth 1, less its mean pitches"),
        )
        .with(
            "below_range_dexels",
            Quantity::count(
                flank.map_or(0, |f| f.own.below_range),
                "dexels",
                "dexels cut deeper than their rays record",
            ),
        )
        .with(
            "untouched_dexels",
            Quantity::count(flank.map_or(0, |f| f.untouched), "dexels", "dexels that no pass touched"),
        )
}
