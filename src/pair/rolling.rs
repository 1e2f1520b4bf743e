//! A whole period of a pair: how the driven gear turns when the driver turns evenly over the teeth.
//!
//! In: gears in mesh and a number of positions. Out: every moment, and the transmission error split into what is longer
//! than two teeth and what comes with the teeth.
//!
//! Positions follow each other evenly along the pitch curve, not in the angle of the driver: so the teeth pass evenly
//! on non-circular gears too, and the harmonics of the mesh are single lines. The period is the number of turns after
//! which the same teeth meet again: z2 / gcd(z1, z2) of the driver.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::assembly::{Meshing, Moment};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::terms::Side;

/// Fewest positions that a tooth needs before its passage can be told from a step.
pub const LEAST_POSITIONS_PER_TOOTH: u32 = 8;
/// Harmonics of the mesh that are listed.
const MESH_HARMONICS: usize = 4;

/// A period of the pair.
#[derive(Debug, Clone, PartialEq)]
pub struct RolledPeriod {
    /// Moments, even along the driver's pitch curve.
    pub moments: Vec<Moment>,
    /// Turns of the driver.
    pub turns: u32,
    /// Teeth of the driver.
    pub teeth: u32,
}

/// Transmission error of a side over a period, rad.
#[derive(Debug, Clone, PartialEq)]
pub struct TransmissionError {
    /// At every moment.
    pub total_rad: Vec<f64>,
    /// Mean and waves longer than two teeth.
    pub long_wave_rad: Vec<f64>,
    /// The rest.
    pub mesh_rad: Vec<f64>,
    /// Orders per turn of the driver, and amplitudes (half the height of the wave).
    pub harmonics: Vec<(f64, f64)>,
}

/// Turns of the driver after which the same teeth meet.
pub fn turns_of_period([driver, driven]: [u32; 2]) -> u32 {
    let gcd = |mut a: u32, mut b: u32| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    driven / gcd(driver, driven)
}

/// Whether so many positions are enough for the teeth of a period.
///
/// # Errors
/// They are not; how many would be.
pub fn enough(count: [u32; 2], positions: usize) -> Result<(), Refusal> {
    let turns = turns_of_period(count);
    let teeth = turns * count[0];
    let least = (LEAST_POSITIONS_PER_TOOTH * teeth) as usize;
    if positions >= least {
        return Ok(());
    }
    Err(Refusal::new(
        "positions",
        format!("{positions} positions are too few for the {teeth} teeth that pass in the {turns} turns of a period"),
        format!("take {least} or more: {LEAST_POSITIONS_PER_TOOTH} per tooth"),
    ))
}

/// Rolls a pair over its period; `passed` is called after every position and may end the work.
///
/// # Errors
/// Too few positions for the teeth of the period; flanks out of reach; those of `passed`.
pub fn roll(meshing: &Meshing, positions: usize, passed: impl Fn() -> Result<()> + Sync) -> Result<RolledPeriod> {
    let count = meshing.pitch.teeth().count;
    enough(count, positions)?;
    let turns = turns_of_period(count);
    let curve = meshing.pitch.curve();
    let travel_mm = f64::from(turns) * curve.perimeter_mm();
    let moment = |i: usize| -> Result<Moment> {
        let moment = meshing.at(curve.phi_at_arc(travel_mm * i as f64 / positions as f64))?;
        passed()?;
        Ok(moment)
    };
    let moments = (0..positions).into_par_iter().map(moment).collect::<Result<_>>()?;
    Ok(RolledPeriod { moments, turns, teeth: count[0] })
}

impl RolledPeriod {
    /// Transmission error of a side.
    pub fn transmission_error(&self, side: Side) -> TransmissionError {
        let total_rad: Vec<f64> = self
            .moments
            .iter()
            .map(|moment| if side == Side::Right { moment.right.error_rad } else { moment.left.error_rad })
            .collect();
        let n = total_rad.len();
        // Waves per period: those of half the number of teeth are two teeth long.
        let per_tooth = (self.turns * self.teeth) as usize;
        // Whole turns are taken off in integers, so waves need the sines of n angles only.
        let sines: Vec<(f64, f64)> = (0..n).map(|i| (TAU * i as f64 / n as f64).sin_cos()).collect();
        let wave = |k: usize| {
            let (mut cos, mut sin) = (0.0, 0.0);
            for (i, value) in total_rad.iter().enumerate() {
                let angle = sines[k * i % n];
                cos += value * angle.1;
                sin += value * angle.0;
            }
            let share = if k == 0 { 1.0 } else { 2.0 } / n as f64;
            [share * cos, share * sin]
        };
        let listed = (MESH_HARMONICS * per_tooth).min((n - 1) / 2);
        let waves: Vec<[f64; 2]> = (0..=listed).into_par_iter().map(wave).collect();
        let long = waves.len().min(per_tooth.div_ceil(2));
        let long_wave_rad: Vec<f64> = (0..n)
            .into_par_iter()
            .map(|i| {
                waves[..long].iter().enumerate().fold(0.0, |sum, (k, [cos, sin])| {
                    let angle = sines[k * i % n];
                    sum + cos * angle.1 + sin * angle.0
                })
            })
            .collect();
        let mesh_rad = total_rad.iter().zip(&long_wave_rad).map(|(total, long)| total - long).collect();
        let order = |k: usize| k as f64 / f64::from(self.turns);
        let harmonics = waves.iter().enumerate().skip(1).map(|(k, [c, s])| (order(k), c.hypot(*s))).collect();
        TransmissionError { total_rad, long_wave_rad, mesh_rad, harmonics }
    }

    /// Ratio dphi_1 / dphi_2 at every moment: asked for by the pitch curves, and achieved by the driving flanks, from
    /// the differences between the moments before and after.
    pub fn ratios(&self) -> Vec<[f64; 2]> {
        let n = self.moments.len();
        let turn_1 = TAU * f64::from(self.turns);
        (0..n)
            .map(|i| {
                let (before, after) = (&self.moments[(i + n - 1) % n], &self.moments[(i + 1) % n]);
                let step_rad = (after.pitch.phi_1_rad - before.pitch.phi_1_rad).rem_euclid(turn_1);
                let pitch = &self.moments[i].pitch;
                let [r1, r2] = pitch.radius_mm;
                let slope = (after.right.error_rad - before.right.error_rad) / step_rad;
                [r2 / r1, 1.0 / (r1 / r2 + slope)]
            })
            .collect()
    }
}

/// Largest less smallest value.
pub fn peak_to_peak(values: &[f64]) -> f64 {
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    high - low
}
