//! Ratio and transmission error: what the pair is for, and how well it does it.

use super::tables;
use super::{ARCSEC_PER_RAD, at_moment, largest_at};
use crate::findings::{Datum, Quantity, Section, Table, TableColumn};
use crate::pair::rolling::{TransmissionError, peak_to_peak};
use crate::pair_job::fit::SIDES;
use crate::pair_job::rolled::RolledPair;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// Multiples of the turns and of the mesh that are listed.
const MULTIPLES: u32 = 4;

pub(super) fn ratio(rolled: &RolledPair) -> Section {
    let ratios = &rolled.ratios;
    let percent = |[asked, achieved]: &[f64; 2]| 100.0 * (achieved / asked - 1.0);
    let worst = largest_at(ratios.iter().map(|ratio| percent(ratio).abs()));
    let end = |largest: bool| {
        let sign = if largest { 1.0 } else { -1.0 };
        let at = largest_at(ratios.iter().map(|[asked, _]| sign * asked));
        let what = if largest { "largest" } else { "smallest" };
        let definition = format!("{what} ratio r2 / r1 of the speeds of A and B that the pitch curves ask for");
        Quantity::number(ratios[at][0], "1", definition).at(at_moment(rolled, at))
    };
    Section::new("ratio", "Ratio").with("smallest", end(false)).with("largest", end(true)).with(
        "largest_deviation",
        Quantity::number(
            percent(&ratios[worst]),
            "%",
            "largest deviation of the ratio that the driving flanks achieve, mean between neighbouring positions, from \
                the one asked for",
        )
        .at(at_moment(rolled, worst)),
    )
}

pub(super) fn errors(rolled: &RolledPair) -> Section {
    let parts = SIDES.iter().zip(&rolled.errors).map(|(side, error)| side_section(rolled, *side, error));
    Section::new("transmission_error", "Transmission error").parts(parts).table(tables::rolling(rolled))
}

fn side_section(rolled: &RolledPair, side: Side, error: &TransmissionError) -> Section {
    let moments = &rolled.period.moments;
    let arcsec = |rad: f64, definition: &'static str| Quantity::number(ARCSEC_PER_RAD * rad, "arcsec", definition);
    let at_pitch_point_um: Vec<f64> =
        error.total_rad.iter().zip(moments).map(|(rad, at)| UM_PER_MM * rad * at.pitch.radius_mm[1]).collect();
    let normal_um: Vec<f64> = error
        .total_rad
        .iter()
        .zip(moments)
        .map(|(rad, at)| UM_PER_MM * rad * rolled.fit.pitch.arm_mm(&at.pitch, side))
        .collect();
    let mean = error.total_rad.iter().sum::<f64>() / moments.len() as f64;
    let title = if side == Side::Right { "Right flanks drive" } else { "Left flanks drive" };
    let um = |values: &[f64], definition: &'static str| Quantity::number(peak_to_peak(values), "um", definition);
    let section = Section::new(side.name(), title)
        .shown(
            "peak_to_peak",
            "peak to peak",
            arcsec(peak_to_peak(&error.total_rad), "largest less smallest rotation of B beyond what is asked for"),
        )
        .shown(
            "long_wave_peak_to_peak",
            "long wave",
            arcsec(peak_to_peak(&error.long_wave_rad), "of its waves longer than two teeth, peak to peak"),
        )
        .shown(
            "mesh_peak_to_peak",
            "tooth mesh",
            arcsec(peak_to_peak(&error.mesh_rad), "of what is left of it beside the long waves, peak to peak"),
        )
        .with("mean", arcsec(mean, "mean of the transmission error: a turn of B that no one feels"))
        .with(
            "peak_to_peak_at_pitch_point",
            um(&at_pitch_point_um, "transmission error times r2, across the line of centres, peak to peak"),
        )
        .with("peak_to_peak_normal", um(&normal_um, "transmission error along the flank's normal, peak to peak"));
    section.table(listed(rolled, side, error)).table(all(rolled, side, error))
}

fn columns(first: TableColumn) -> Vec<TableColumn> {
    vec![
        first,
        TableColumn::new("order", "1", "waves in a turn of A"),
        TableColumn::new("amplitude", "arcsec", "half the height of the wave").as_bars(),
        TableColumn::new("amplitude_at_mean_radius", "um", "the same on the circle as long as B's pitch curve"),
    ]
}

/// Amplitude of a wave in arcsec, and on B's mean pitch circle in um.
fn amplitudes(rolled: &RolledPair, rad: f64) -> [f64; 2] {
    let teeth = rolled.fit.pitch.teeth();
    [ARCSEC_PER_RAD * rad, UM_PER_MM * rad * 0.5 * teeth.module_mm * f64::from(teeth.count[1])]
}

/// The waves that have a name: turns of both gears and their multiples, and the mesh.
fn listed(rolled: &RolledPair, side: Side, error: &TransmissionError) -> Table {
    let teeth = rolled.fit.pitch.teeth();
    let [turn_a, turn_b] = [1.0, f64::from(teeth.count[0]) / f64::from(teeth.count[1])];
    let mesh = f64::from(teeth.count[0]);
    let mut named: Vec<(String, f64)> = Vec::new();
    if rolled.period.turns > 1 {
        named.push(("period".to_owned(), 1.0 / f64::from(rolled.period.turns)));
    }
    for (name, order) in [("turn of A", turn_a), ("turn of B", turn_b), ("mesh", mesh)] {
        // Equal numbers of teeth: both gears turn alike.
        if name == "turn of B" && turn_a == turn_b {
            continue;
        }
        named.extend((1..=MULTIPLES).map(|k| {
            let name = if k == 1 { name.to_owned() } else { format!("{k} x {name}") };
            (name, f64::from(k) * order)
        }));
    }
    let rows = named.into_iter().map(|(name, order)| {
        let wave = error.harmonics.iter().find(|wave| (wave.0 - order).abs() < 1e-9).map_or(f64::NAN, |wave| wave.1);
        let [arcsec, um] = amplitudes(rolled, wave);
        vec![Datum::Word(name), order.into(), arcsec.into(), um.into()]
    });
    let first = TableColumn::words("wave", "name of the wave");
    let mut columns = columns(first);
    for column in &mut columns[2..] {
        column.why = Some("there are too few positions for a wave so short".into());
    }
    Table::new("waves", &format!("Waves of the transmission error, {} flanks", side.name()), columns).with_rows(rows)
}

fn all(rolled: &RolledPair, side: Side, error: &TransmissionError) -> Table {
    let rows = error.harmonics.iter().enumerate().map(|(k, &(order, rad))| {
        let [arcsec, um] = amplitudes(rolled, rad);
        vec![((k + 1) as u64).into(), order.into(), arcsec.into(), um.into()]
    });
    let mut columns = columns(TableColumn::new("harmonic", "1", "waves in a period of the pair"));
    columns[2].chart = None;
    Table::new("harmonics", &format!("All waves, {} flanks", side.name()), columns)
        .with_rows(rows)
        .rows_in_file(&format!("harmonics_{}", side.name()))
}
