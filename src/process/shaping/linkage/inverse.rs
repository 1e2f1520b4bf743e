//! From the work angle back to the polar angle.
//!
//! In: the lag alpha(phi) = phi - psi_c(phi) of a linkage whose work angle increases with phi, and a work angle. Out:
//! phi, unwrapped, to rounding. Law: Steffensen's iteration, which Gao et al. 2017 use as well: the residual is its own
//! step for the divided difference, so that convergence is quadratic without a derivative. Here every value also
//! narrows a bracket, which begins as psi_c -+ pi/2 because |alpha| < pi/2; an iterate that leaves it is replaced by
//! its middle, and after a few iterations only halving is left. The iteration therefore cannot fail.
//!
//! Starts come from a table ([`Starts`]) good to about 1e-9 rad: two or three evaluations are left.
//!
//! Road not taken: a table fine enough to be the answer. The offset changes during infeed, and with it the function.

use crate::units::TURN_RAD;
use std::f64::consts::FRAC_PI_2;

/// Smallest step of the divided difference, rad: rounding in the lag (1e-15) then disturbs the slope by 1e-8 at most.
const SMALLEST_PROBE_RAD: f64 = 1e-7;
/// Iterations after which only halving is used.
const PATIENCE: usize = 20;

/// The phi at which phi - `lag`(phi) = `psi_c_rad`, from a guess.
pub(super) fn solve(lag: impl Fn(f64) -> f64, psi_c_rad: f64, start_rad: f64) -> f64 {
    let residual = |phi: f64| psi_c_rad + lag(phi) - phi;
    let (mut lo, mut hi) = (psi_c_rad - FRAC_PI_2, psi_c_rad + FRAC_PI_2);
    let mut phi = start_rad.clamp(lo, hi);
    for iteration in 0..100 {
        let missing = residual(phi);
        if missing == 0.0 {
            return phi;
        }
        if missing > 0.0 {
            lo = phi;
        } else {
            hi = phi;
        }
        let mut next = f64::midpoint(lo, hi);
        if iteration < PATIENCE {
            let probe = missing.abs().max(SMALLEST_PROBE_RAD).copysign(missing);
            let slope = (missing - residual(phi + probe)) / probe;
            let newton = phi + missing / slope;
            if newton >= lo && newton <= hi {
                next = newton;
            }
        }
        let step = next - phi;
        phi = next;
        if step.abs() < 1e-9 && iteration < PATIENCE || step.abs() < 1e-15 * (1.0 + phi.abs()) {
            break; // the error left is about the product of this step and the probe, below rounding
        }
    }
    phi
}

/// Table of phi - psi_c over one turn of psi_c, cubic with slopes.
#[derive(Debug, Clone)]
pub(super) struct Starts {
    /// Value and slope (per cell) of phi - psi_c at even psi_c.
    nodes: Vec<[f64; 2]>,
}

impl Starts {
    /// Fills the table; `lag` gives alpha(phi) and its derivative.
    pub(super) fn new(lag: impl Fn(f64) -> [f64; 2], cells: usize) -> Self {
        let width = TURN_RAD / cells as f64;
        let mut ahead = 0.0;
        let nodes = (0..cells)
            .map(|i| {
                let psi = i as f64 * width;
                let phi = solve(|phi| lag(phi)[0], psi, psi + ahead);
                ahead = phi - psi;
                let turn = 1.0 - lag(phi)[1]; // dpsi_c/dphi
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
