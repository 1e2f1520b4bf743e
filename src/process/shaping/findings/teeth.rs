//! Single teeth: the stock and the allowances that an operation left, and the tooth as it is finished.

use super::program::NOT_WHOLE;
use crate::findings::quantities::flanks::{
    BELOW_RANGE, NO_STOCK_HERE, NOT_CUT, PROFILE_LENGTH, START_OF_FLANK, STOCK_LARGEST, STOCK_MEAN, STOCK_SMALLEST,
};
use crate::findings::quantities::teeth::TOOTH;
use crate::findings::{QuantityRow, Section, Table};
use crate::measure::scallop::Cusp;
use crate::measure::stock::{Extreme, Stock};
use crate::process::shaping::gear::measure::gear_report::OperationAllowance;
use crate::process::shaping::gear::measure::unevenness::ToothAllowance;
use crate::process::shaping::gear::measure::{FlankReport, GearReport};
use crate::process::shaping::quantities::{
    A_X, A_Y, AB, B_X, B_Y, BELOW_RANGE_DEXELS, BELOW_TARGET, C_X, C_Y, CD, D_X, D_Y, ENVELOPE_AB, ENVELOPE_CD,
    ENVELOPE_UNEVENNESS, FLANK_END, FLANK_START, NO_CUSP_HERE, NO_WITNESS, NOTHING_BELOW, SCALLOP,
    SCALLOP_AT_PITCH_CURVE, SOUND, TIP_HEIGHT, TIP_LAND, UNDERCUT, UNEVENNESS, UNEVENNESS_RACK, WITNESS_MARK,
};
use crate::process::shaping::target::FlankEnd;
use crate::steps::inspection::teeth::{self, place};
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// Smallest, largest and mean stock over some flanks (with their report, for the place) or roots.
pub fn stock_range(key: &str, title: &str, parts: &[(Option<&FlankReport>, Stock)], why: &'static str) -> Section {
    let found = |row: &QuantityRow, pick: fn(&Stock) -> Extreme, better: fn(f64, f64) -> bool| {
        let all = parts.iter().map(|(flank, stock)| (*flank, pick(stock)));
        match all.reduce(|best, next| if better(next.1.value_mm, best.1.value_mm) { next } else { best }) {
            Some((flank, extreme)) => row.of(extreme.value_mm).at(flank.map(|flank| place(flank, &extreme))),
            None => row.none(why),
        }
    };
    let dexels: u64 = parts.iter().map(|(_, stock)| stock.dexels).sum();
    let sum: f64 = parts.iter().map(|(_, stock)| stock.mean_mm * stock.dexels as f64).sum();
    Section::new(key, title).entries([
        found(&STOCK_SMALLEST, |s| s.smallest, |a, b| a < b),
        found(&STOCK_LARGEST, |s| s.largest, |a, b| a > b),
        STOCK_MEAN.of_or((dexels > 0).then(|| sum / dexels as f64), why),
    ])
}

fn flank_of(report: &GearReport, tooth: u32, side: Side) -> Option<&FlankReport> {
    report.flanks.iter().find(|f| f.tooth == tooth && f.side == side)
}

/// Stock that an operation left on the flanks of a tooth.
pub fn tooth_stock(report: &GearReport, operation: usize, tooth: u32) -> Section {
    let range = |side: Side, title: &str| {
        let stock = flank_of(report, tooth, side).and_then(|f| Some((Some(f), (*f.own.stock.get(operation)?)?)));
        stock_range(side.name(), title, &stock.into_iter().collect::<Vec<_>>(), NO_STOCK_HERE)
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
    type Tooth<'a> = (&'a OperationAllowance, (&'a ToothAllowance, &'a ToothAllowance));
    let teeth = allowance.into_iter().flat_map(|of| of.strokes.iter().zip(&of.envelope).map(move |pair| (of, pair)));
    let of_scene = |value: Option<f64>| value.filter(|_| !other_gear);
    let mut table: Table = Table::over("allowance", "Allowance on the pitch curve, tooth by tooth", teeth)
        .column(&TOOTH, |(_, (cut, _)): &Tooth| cut.tooth)
        .column(&A_X, |(_, (cut, _))| cut.a.map(|c| c.point_mm.x))
        .column(&A_Y, |(_, (cut, _))| cut.a.map(|c| c.point_mm.y))
        .column(&B_X, |(_, (cut, _))| cut.b.map(|c| c.point_mm.x))
        .column(&B_Y, |(_, (cut, _))| cut.b.map(|c| c.point_mm.y))
        .column(&C_X, |(_, (cut, _))| cut.c.map(|c| c.point_mm.x))
        .column(&C_Y, |(_, (cut, _))| cut.c.map(|c| c.point_mm.y))
        .column(&D_X, |(_, (cut, _))| cut.d.map(|c| c.point_mm.x))
        .column(&D_Y, |(_, (cut, _))| cut.d.map(|c| c.point_mm.y))
        .column(&AB, |(_, (cut, _))| cut.ab_mm())
        .column(&CD, |(_, (cut, _))| cut.cd_mm())
        .column(&UNEVENNESS, |(_, (cut, _))| cut.unevenness_mean_percent())
        .column(&UNEVENNESS_RACK, |(of, (cut, _))| of_scene(cut.unevenness_rack_percent(of.rack_mm)))
        .column(&ENVELOPE_AB, |(_, (_, limit))| of_scene(limit.ab_mm()))
        .column(&ENVELOPE_CD, |(_, (_, limit))| of_scene(limit.cd_mm()))
        .column(&ENVELOPE_UNEVENNESS, |(_, (_, limit))| of_scene(limit.unevenness_mean_percent()))
        .into();
    table.period_rows = Some(report.period_teeth.max(1));
    if allowance.is_some() { table.in_file(&format!("allowance_{operation}")) } else { table }
}

/// One finished tooth; `other_gear` says why what is known of the scene's own strokes does not hold for this gear. It
/// does not hold for a flank that is cut away either, nor for its tooth's tip.
pub fn finished_tooth(report: &GearReport, tooth: u32, other_gear: Option<&str>) -> Section {
    let is_lost = report.flanks.iter().any(|flank| flank.tooth == tooth && flank.own.is_lost);
    let tip_land_mm = report.tip_lands_mm.get(tooth as usize - 1).copied();
    Section::new(format!("tooth_{tooth:02}"), format!("tooth {tooth}"))
        .entries([TIP_LAND.of_or(tip_land_mm, NOT_CUT).unless(other_gear.or(is_lost.then_some(NOT_WHOLE)))])
        .entries(teeth::tooth(&report.inspection, tooth))
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
    let lost = flank.filter(|flank| flank.own.is_lost).map(|_| BELOW_RANGE);
    let other_gear = other_gear.or(lost);
    let why = |reason: &'static str| lost.unwrap_or(if flank.is_some() { reason } else { NOT_CUT });
    let at = |row: &QuantityRow, extreme: Option<Extreme>, reason: &'static str| match (flank, extreme) {
        (Some(flank), Some(extreme)) => row.of(extreme.value_mm * UM_PER_MM).at(place(flank, &extreme)),
        _ => row.none(why(reason)),
    };
    let cusp = |row: &QuantityRow, cusp: Option<Cusp>| {
        let extreme = cusp.map(|of| Extreme { value_mm: of.height_mm, arc_mm: of.arc_mm, z_mm: 0.0 });
        at(row, extreme, NO_CUSP_HERE)
    };
    let own = flank.map(|flank| &flank.own);
    let lowest = at(&BELOW_TARGET, own.and_then(|of| of.below_target), NOTHING_BELOW);
    let is_below = own.is_some_and(|of| of.below_range > 0);
    let of_scene = [
        START_OF_FLANK.of_or(own.map(|of| of.form.height_mm), why(NOT_CUT)),
        FLANK_START.of_or(own.map(|of| end_words(of.form.end)), why(NOT_CUT)),
        UNDERCUT.of_or(own.and_then(|of| of.undercut_mm).map(|mm| mm * UM_PER_MM), why(SOUND)),
        TIP_HEIGHT.of_or(own.map(|of| of.tip.height_mm), why(NOT_CUT)),
        FLANK_END.of_or(own.map(|of| end_words(of.tip.end)), why(NOT_CUT)),
        PROFILE_LENGTH.of_or(flank.map(|of| of.length_mm), why(NOT_CUT)),
    ];
    Section::new(side.name(), format!("{} flank", side.name()))
        .entries(of_scene.map(|entry| entry.unless(other_gear)))
        .entries(teeth::flank(flank))
        .entries([
            // Where rays end inside the cut, the lowest height is where they end.
            lowest.unless(is_below.then_some(BELOW_RANGE)),
            cusp(&SCALLOP, own.and_then(|of| of.scallops).map(|of| of.largest)),
            cusp(&SCALLOP_AT_PITCH_CURVE, own.and_then(|of| of.scallops).and_then(|of| of.at_pitch_curve)),
            at(&WITNESS_MARK, own.and_then(|of| of.witness), NO_WITNESS),
        ])
        .entries(teeth::pitch(&report.inspection, tooth, side))
        .entries([BELOW_RANGE_DEXELS.of(own.map_or(0, |of| of.below_range))])
}
