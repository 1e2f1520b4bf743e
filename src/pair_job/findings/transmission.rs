//! Ratio and transmission error: what the pair is for, and how well it does it.

use super::tables;
use super::{ARCSEC_PER_RAD, at_moment, largest_at, of_involutes};
use crate::findings::{QuantityRow, Section, Table};
use crate::pair::assembly::Moment;
use crate::pair::rolling::{TransmissionError, peak_to_peak};
use crate::pair_job::fit::SIDES;
use crate::pair_job::quantities::{
    AMPLITUDE, AMPLITUDE_AT_RADIUS, HARMONIC, LARGEST_RATIO, LONG_WAVE_RANGE, MEAN_ERROR, MESH_RANGE, ORDER,
    PEAK_TO_PEAK, RANGE_AT_PITCH_POINT, RANGE_NORMAL, RATIO, RATIO_DEVIATION, SMALLEST_RATIO, TRANSMISSION_ERROR, WAVE,
    WAVES,
};
use crate::pair_job::rolled::RolledPair;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// Multiples of the turns and of the mesh that are listed.
const MULTIPLES: u32 = 4;

pub(super) fn ratio(rolled: &RolledPair) -> Section {
    let ratios = &rolled.ratios;
    let percent = |[asked, achieved]: &[f64; 2]| 100.0 * (achieved / asked - 1.0);
    let worst = largest_at(ratios.iter().map(|ratio| percent(ratio).abs()));
    let end = |row: &QuantityRow, sign: f64| {
        let at = largest_at(ratios.iter().map(|[asked, _]| sign * asked));
        row.of(ratios[at][0]).at(at_moment(rolled, at))
    };
    RATIO.section([
        end(&SMALLEST_RATIO, -1.0),
        end(&LARGEST_RATIO, 1.0),
        RATIO_DEVIATION.of(percent(&ratios[worst])).at(at_moment(rolled, worst)),
    ])
}

pub(super) fn errors(rolled: &RolledPair) -> Section {
    let parts = SIDES.iter().zip(&rolled.errors).map(|(side, error)| side_section(rolled, *side, error));
    TRANSMISSION_ERROR.section([]).parts(parts).table(tables::rolling(rolled))
}

fn side_section(rolled: &RolledPair, side: Side, error: &TransmissionError) -> Section {
    let moments = &rolled.period.moments;
    let range_arcsec = |rad: &[f64]| ARCSEC_PER_RAD * peak_to_peak(rad);
    let range_um = |arm_mm: &dyn Fn(&Moment) -> f64| {
        let um = |(rad, at): (&f64, &Moment)| UM_PER_MM * rad * arm_mm(at);
        peak_to_peak(&error.total_rad.iter().zip(moments).map(um).collect::<Vec<_>>())
    };
    let mean = error.total_rad.iter().sum::<f64>() / moments.len() as f64;
    let title = if side == Side::Right { "Right flanks drive" } else { "Left flanks drive" };
    Section::new(side.name(), title)
        .entries([
            PEAK_TO_PEAK.of(range_arcsec(&error.total_rad)),
            LONG_WAVE_RANGE.of(range_arcsec(&error.long_wave_rad)),
            MESH_RANGE.of(range_arcsec(&error.mesh_rad)),
            MEAN_ERROR.of(ARCSEC_PER_RAD * mean),
            RANGE_AT_PITCH_POINT.of(range_um(&|at| at.pitch.radius_mm[1])),
            of_involutes(rolled, &RANGE_NORMAL, range_um(&|at| rolled.fit.pitch.arm_mm(&at.pitch, side))),
        ])
        .table(listed(rolled, side, error))
        .table(all(rolled, side, error))
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
    let waves = named.into_iter().map(|(name, order)| {
        let wave = error.harmonics.iter().find(|wave| (wave.0 - order).abs() < 1e-9).map_or(f64::NAN, |wave| wave.1);
        (name, order, amplitudes(rolled, wave))
    });
    Table::over(WAVES.key, &format!("{}, {} flanks", WAVES.title, side.name()), waves)
        .column(&WAVE, |(name, ..)| name.clone())
        .column(&ORDER, |(_, order, _)| *order)
        .column(&AMPLITUDE, |(.., [arcsec, _])| *arcsec)
        .column(&AMPLITUDE_AT_RADIUS, |(.., [_, um])| *um)
        .into()
}

fn all(rolled: &RolledPair, side: Side, error: &TransmissionError) -> Table {
    let waves = error.harmonics.iter().enumerate().map(|(k, &(order, rad))| (k + 1, order, amplitudes(rolled, rad)));
    Table::over("harmonics", &format!("All waves, {} flanks", side.name()), waves)
        .column(&HARMONIC, |(number, ..)| *number)
        .column(&ORDER, |(_, order, _)| *order)
        .column(AMPLITUDE.as_column().undrawn(), |(.., [arcsec, _])| *arcsec)
        .column(&AMPLITUDE_AT_RADIUS, |(.., [_, um])| *um)
        .rows_in_file(&format!("harmonics_{}", side.name()))
}
