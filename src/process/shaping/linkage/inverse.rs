//! From the work angle back to the polar angle.
//!
//! In: the lag alpha(phi) = phi - psi_c(phi) of a linkage whose work angle increases with phi, and a work angle. Out:
//! phi, unwrapped, to rounding. Law: Steffensen's iteration, which Gao et al. 2017 use as well: the residual is its own
//! step for the divided difference, so that convergence is quadratic without a derivative. Its steps are taken within a
//! bracket ([`newton_within`]), psi_c -+ pi/2 because |alpha| < pi/2, so that the iteration cannot fail.
//!
//! Starts come from a table ([`Starts`]) good to about 1e-9 rad: two or three evaluations are left.
//!
//! Road not taken: a table fine enough to be the answer. The offset changes during infeed, and with it the function.

use gearcut_core::math::newton::{LastStep, newton_within};
use gearcut_core::units::TURN_RAD;
use std::f64::consts::FRAC_PI_2;

/// Smallest step of the divided difference, rad: rounding in the lag (1e-15) then disturbs the slope by 1e-8 at most.
const SMALLEST_PROBE_RAD: f64 = 1e-7;
/// Iterations after which only halving is used.
const PATIENCE: u32 = 20;
/// Last step, rad.
const LAST_STEP_RAD: f64 = 1e-9;

/// The phi at which phi - `lag`(phi) = `psi_c_rad`, from a guess.
pub(super) fn solve(lag: impl Fn(f64) -> f64, psi_c_rad: f64, start_rad: f64) -> f64 {
    let residual = |phi: f64| psi_c_rad + lag(phi) - phi;
    let bracket = [psi_c_rad - FRAC_PI_2, psi_c_rad + FRAC_PI_2];
    let start_rad = start_rad.clamp(bracket[0], bracket[1]);
    // The error left is about the product of the last step and the probe, below rounding.
    newton_within(start_rad, bracket, LastStep::absolute(LAST_STEP_RAD), PATIENCE, |phi| {
        let missing = residual(phi);
        let probe = missing.abs().max(SMALLEST_PROBE_RAD).copysign(missing);
        let slope = (missing - residual(phi + probe)) / probe;
        [missing, missing / slope]
    })
}

/// Table of phi - psi_c over one turn of psi_c, cubic with slopes.
#[derive(Debug, Clone)]
pub(super) struct Starts {
    /// Value and slope (per cell) of phi - psi_c at even psi_c.
    nodes: Vec<[f64; 2]>,
}

impl Starts {
    /// Fills the table; `lag` is alpha(phi), `slope` its derivative.
    pub(super) fn new([lag, slope]: [&dyn Fn(f64) -> f64; 2], cells: usize) -> Self {
        let width = TURN_RAD / cells as f64;
        let mut ahead = 0.0;
        let nodes = (0..cells)
            .map(|i| {
                let psi = i as f64 * width;
                let phi = solve(lag, psi, psi + ahead);
                ahead = phi - psi;
                let turn = 1.0 - slope(phi); // dpsi_c/dphi
                [ahead, width * (1.0 / turn - 1.0)]
            })
            .collect();
        Self { nodes }
    }

    /// A table without information: phi = psi_c.
    pub(super) fn none() -> Self {
        Self { nodes: vec![[0.0; 2]] }
    }

    /// Guess for phi.
    pub(super) fn guess(&self, psi_c_rad: f64) -> f64 {
        let cells = self.nodes.len();
        let at = psi_c_rad * (cells as f64 / TURN_RAD);
        let cell = at.floor();
        let (u, i) = (at - cell, cell.rem_euclid(cells as f64) as usize % cells);
        let [[p, dp], [q, dq]] = [self.nodes[i], self.nodes[(i + 1) % cells]];
        let v = 1.0 - u;
        psi_c_rad + v * v * (p * (1.0 + 2.0 * u) + dp * u) + u * u * (q * (1.0 + 2.0 * v) - dq * v)
    }
}
