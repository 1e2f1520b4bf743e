//! Teeth and flanks of a finished gear, one by one, and all flanks side by side; the same for every process.
//!
//! In: measured flanks and the pitch and thickness of teeth. Out: entries of the sections of a tooth and a flank, and
//! the table `teeth.flanks`; the process adds its own.

use crate::findings::quantities::flanks::{
    BELOW_RANGE, EVALUATED_FROM, EVALUATED_TO, F_ALPHA, F_BETA, F_F_ALPHA, F_F_BETA, F_H_ALPHA, F_H_BETA, FEW_DEXELS,
    HIGHEST_DEVIATION, LOWEST_DEVIATION, NO_TRACE, NOT_CUT, STOCK_LARGEST, STOCK_MEAN, STOCK_SMALLEST, UNREACHED,
    UNTOUCHED_DEXELS,
};
use crate::findings::quantities::teeth::{
    CUMULATIVE_PITCH, FLANK, FLANK_PITCH, NOT_CROSSED, PROBE_PLACE, THICKNESS_ARC, THICKNESS_CHORD, TOOTH,
};
use crate::findings::{Columns, Entry, Place, QuantityRow, Table};
use crate::measure::deviation::TraceDeviation;
use crate::measure::inspection::{FlankSurface, GearInspection, InspectedFlank};
use crate::measure::stock::Extreme;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// The figures of a trace: total, slope, form.
type Figures = [(&'static QuantityRow, fn(&TraceDeviation) -> f64); 3];

/// Those of the profile.
pub const PROFILE: Figures =
    [(&F_ALPHA, |of| of.total_mm), (&F_H_ALPHA, |of| of.slope_mm), (&F_F_ALPHA, |of| of.form_mm)];
/// Those of the helix.
pub const HELIX: Figures = [(&F_BETA, |of| of.total_mm), (&F_H_BETA, |of| of.slope_mm), (&F_F_BETA, |of| of.form_mm)];

/// Thickness of a tooth, and the place of a probe in the space after it.
pub fn tooth(gear: &GearInspection, tooth: u32) -> [Entry; 3] {
    let row = tooth as usize - 1;
    let thickness = gear.thickness.get(row).copied().flatten();
    let probe_mm = gear.runout.as_ref().and_then(|of| of.radial_mm.get(row).copied());
    [
        THICKNESS_ARC.of_or(thickness.map(|of| of.arc_mm), NOT_CROSSED),
        THICKNESS_CHORD.of_or(thickness.map(|of| of.chord_mm), NOT_CROSSED),
        PROBE_PLACE.of_or(probe_mm.map(|mm| mm * UM_PER_MM), NOT_CROSSED),
    ]
}

/// Pitch of a flank.
pub fn pitch(gear: &GearInspection, tooth: u32, side: Side) -> [Entry; 2] {
    let (pitch, row) = (gear.pitch[usize::from(side == Side::Right)].as_ref(), tooth as usize - 1);
    let um = |mm: f64| mm * UM_PER_MM;
    [
        FLANK_PITCH.of_or(pitch.map(|of| um(of.single_mm[row])), NOT_CROSSED),
        CUMULATIVE_PITCH.of_or(pitch.map(|of| um(of.cumulative_mm[row])), NOT_CROSSED),
    ]
}

/// Deviations of a flank; none of one that was not cut.
pub fn flank<Own: FlankSurface>(flank: Option<&InspectedFlank<Own>>) -> Vec<Entry> {
    let why = |reason: &'static str| match flank {
        None => NOT_CUT,
        Some(flank) if flank.own.is_lost() => BELOW_RANGE,
        Some(_) => reason,
    };
    let height = |row: &QuantityRow, end: usize| match flank.and_then(|of| Some((of, of.own.deviations()?[end]))) {
        Some(_) if end == 0 && flank.is_some_and(|of| of.own.is_below_range()) => row.none(BELOW_RANGE),
        Some((flank, of)) => row.of(of.value_mm * UM_PER_MM).at(place(flank, &of)),
        None => row.none(why(UNREACHED)),
    };
    let no_trace = if flank.is_some_and(|of| of.untouched == 0) { FEW_DEXELS } else { NO_TRACE };
    let figure = |of: Option<&TraceDeviation>, (row, value): (&QuantityRow, fn(&TraceDeviation) -> f64)| {
        row.of_or(of.map(|of| value(of) * UM_PER_MM), why(no_trace))
    };
    let (profile, helix) = (flank.and_then(|of| of.profile.as_ref()), flank.and_then(|of| of.lead.as_ref()));
    let mut entries = vec![
        EVALUATED_FROM.of_or(flank.map(|of| of.evaluated_mm[0]), why(NOT_CUT)),
        EVALUATED_TO.of_or(flank.map(|of| of.evaluated_mm[1]), why(NOT_CUT)),
        height(&LOWEST_DEVIATION, 0),
        height(&HIGHEST_DEVIATION, 1),
    ];
    entries.extend(PROFILE.map(|of| figure(profile, of)));
    entries.extend(HELIX.map(|of| figure(helix, of)));
    entries.push(UNTOUCHED_DEXELS.of(flank.map_or(0, |of| of.untouched)));
    entries
}

/// Place of an extreme on a flank.
pub fn place<Own>(flank: &InspectedFlank<Own>, at: &Extreme) -> Place {
    Place::on_flank(flank.tooth, flank.side.name(), at.arc_mm, at.z_mm)
}

/// All flanks that were cut side by side, with the stock of the operations before the last one.
pub fn flank_table<'a, Own: FlankSurface>(
    flanks: &'a [InspectedFlank<Own>],
    earlier: impl IntoIterator<Item = &'a str>,
) -> Columns<&'a InspectedFlank<Own>> {
    let mut table = Table::over("flanks", "Finished flanks", flanks)
        .column(&TOOTH, |of| of.tooth)
        .column(&FLANK, |of| of.side.name())
        .column(&EVALUATED_FROM, |of| of.evaluated_mm[0])
        .column(&EVALUATED_TO, |of| of.evaluated_mm[1]);
    for (index, name) in earlier.into_iter().enumerate() {
        let of = |row: &QuantityRow| row.as_column().keyed(format!("{name}_{}", row.key));
        table = table
            .column(of(&STOCK_SMALLEST), |of| of.own.stock(index).map(|of| of.ends[0].value_mm))
            .column(of(&STOCK_LARGEST), |of| of.own.stock(index).map(|of| of.ends[1].value_mm))
            .column(of(&STOCK_MEAN), |of| of.own.stock(index).map(|of| of.mean_mm));
    }
    let um = |value: Option<f64>| value.map(|mm| mm * UM_PER_MM);
    let known = |of: &InspectedFlank<Own>| !of.own.is_below_range();
    table = table
        .column(&LOWEST_DEVIATION, |of| um(of.own.deviations().filter(|_| known(of)).map(|of| of[0].value_mm)))
        .column(&HIGHEST_DEVIATION, |of| um(of.own.deviations().map(|of| of[1].value_mm)));
    for (row, value) in PROFILE {
        table = table.column(row, |of| um(of.profile.as_ref().map(value)));
    }
    for (row, value) in HELIX {
        table = table.column(row, |of| um(of.lead.as_ref().map(value)));
    }
    table
}
