//! Integral of a positive function of period 2 pi, and its inverse, both in nanoseconds.
//!
//! In: the function (ds/dphi of a pitch curve, or the shortest time per radian of a machine), the angles where it is
//! not smooth, and the accuracy. Out: F(phi) unwrapped over any number of turns, and phi(F).
//!
//! Law: the turn is cut into panels that never straddle a break. On each panel the function is expanded in Legendre
//! polynomials from its values at Gauss-Legendre nodes and integrated term by term; the result is kept as one
//! polynomial, so that a query is a direct index and a Horner scheme. Panels are halved until the last two terms, which
//! bound what was cut off, fall under the accuracy. Whole turns add the closed value exactly.
//!
//! Road not taken: adaptive quadrature per query. It is as accurate and a thousand times slower, and two queries close
//! together would not be consistent to rounding.

use super::newton::{LastStep, newton, newton_within};
use crate::error::NotConverged;
use crate::units::TURN_RAD;

/// Gauss-Legendre nodes per panel.
const NODES: usize = 10;
/// More panels than this mean that the function is not integrable to the accuracy.
const MAX_PANELS: usize = 1 << 16;

/// Newton steps of the inverse before its panel is halved; three or four suffice.
const MOST_STEPS: u32 = 60;

/// Why a function has no such integral.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NotIntegrable {
    /// It is not positive and finite everywhere.
    #[error("the integrand is {value:e} at {at_rad:.6} rad, where it must be positive and finite")]
    NotPositive {
        /// Where.
        at_rad: f64,
        /// What it is there.
        value: f64,
    },
    /// The finest panels miss the accuracy.
    #[error("the integral is known to {reached:e} at best, {wanted:e} are wanted")]
    TooRough {
        /// Accuracy asked for, in the unit of the integral.
        wanted: f64,
        /// What the finest panels leave.
        reached: f64,
    },
    /// The panels' own rule is not found.
    #[error(transparent)]
    NoRule(#[from] NotConverged),
}

/// Prepared integral of a positive 2 pi-periodic function.
#[derive(Debug, Clone)]
pub struct PeriodicIntegral {
    /// Panel bounds, from 0 to 2 pi.
    bounds_rad: Vec<f64>,
    /// Integral from 0 to each bound.
    sums: Vec<f64>,
    /// Integral within each panel as a polynomial in x = -1 ..= 1.
    panels: Vec<[f64; NODES + 1]>,
    /// First panel that can contain an angle, for even slices of the turn.
    by_angle: Vec<usize>,
    /// The same for even slices of the closed value.
    by_value: Vec<usize>,
}

impl PeriodicIntegral {
    /// Prepares the integral of `f` over one turn; `breaks_rad` are the places in (0, 2 pi) where `f` is not smooth, in
    /// increasing order; `smoothness` is the number of panels per turn to begin with.
    ///
    /// # Errors
    /// The accuracy (in the unit of the integral) cannot be reached, or `f` is not positive and finite.
    pub fn new(
        f: impl Fn(f64) -> f64,
        breaks_rad: &[f64],
        smoothness: usize,
        accuracy: f64,
    ) -> Result<Self, NotIntegrable> {
        let basis = integrated_lagrange_basis()?;
        let mut split = smoothness.max(4);
        let mut reached = f64::INFINITY;
        while split <= MAX_PANELS {
            let bounds_rad = panel_bounds(breaks_rad, split);
            let mut panels = Vec::with_capacity(bounds_rad.len() - 1);
            let mut sums = vec![0.0];
            let mut worst: f64 = 0.0;
            for bound in bounds_rad.windows(2) {
                let (mid, half) = (f64::midpoint(bound[0], bound[1]), 0.5 * (bound[1] - bound[0]));
                let values = basis.nodes.map(|x| f(mid + half * x));
                if let Some(i) = values.iter().position(|v| !(v.is_finite() && *v > 0.0)) {
                    return Err(NotIntegrable::NotPositive { at_rad: mid + half * basis.nodes[i], value: values[i] });
                }
                let tail = |k: usize| basis.legendre_coefficient(k, &values).abs();
                worst = worst.max(half * (tail(NODES - 1) + tail(NODES - 2)));
                let polynomial: [f64; NODES + 1] =
                    std::array::from_fn(|p| half * (0..NODES).map(|i| basis.powers[i][p] * values[i]).sum::<f64>());
                let whole = half * (0..NODES).map(|i| basis.weights[i] * values[i]).sum::<f64>();
                sums.push(sums[sums.len() - 1] + whole);
                panels.push(polynomial);
            }
            if worst <= accuracy {
                let by_angle = first_panels(&bounds_rad);
                let by_value = first_panels(&sums);
                return Ok(Self { bounds_rad, sums, panels, by_angle, by_value });
            }
            reached = worst;
            split *= 2;
        }
        Err(NotIntegrable::TooRough { wanted: accuracy, reached })
    }

    /// Integral over one turn.
    pub fn closed(&self) -> f64 {
        self.sums[self.panels.len()]
    }

    /// Integral from 0 to `phi_rad`.
    pub fn at(&self, phi_rad: f64) -> f64 {
        let turns = (phi_rad / TURN_RAD).floor();
        let phi = phi_rad - turns * TURN_RAD;
        let i = find(&self.by_angle, &self.bounds_rad, phi);
        let (lo, hi) = (self.bounds_rad[i], self.bounds_rad[i + 1]);
        let x = (2.0 * phi - lo - hi) / (hi - lo);
        let within = self.panels[i].iter().rev().fold(0.0, |sum, c| sum * x + c);
        turns * self.closed() + (self.sums[i] + within)
    }

    /// The angle up to which the integral is `value`: the inverse of [`Self::at`], to rounding.
    pub fn angle_at(&self, value: f64) -> f64 {
        let turns = (value / self.closed()).floor();
        let rest = value - turns * self.closed();
        let i = find(&self.by_value, &self.sums, rest);
        let want = rest - self.sums[i];
        let start = 2.0 * want / (self.sums[i + 1] - self.sums[i]) - 1.0;
        // At the end of a turn rounding may put the start a last bit beyond the panel; its polynomial holds there, too.
        let panel = [start.min(-1.0), start.max(1.0)];
        // Quadratic: the step after the last one would be below rounding.
        let x = newton_within(start, panel, LastStep::absolute(1e-9), MOST_STEPS, |x| {
            let (mut f, mut slope) = (0.0, 0.0);
            for c in self.panels[i].iter().rev() {
                slope = slope * x + f;
                f = f * x + c;
            }
            [want - f, (want - f) / slope]
        });
        let half = 0.5 * (self.bounds_rad[i + 1] - self.bounds_rad[i]);
        turns * TURN_RAD + (self.bounds_rad[i] + half * (1.0 + x))
    }
}

/// Bounds of panels no wider than a turn divided by `split`, with a bound at every break.
fn panel_bounds(breaks_rad: &[f64], split: usize) -> Vec<f64> {
    let mut bounds = vec![0.0];
    let mut from = 0.0;
    for to in breaks_rad.iter().copied().chain([TURN_RAD]).filter(|b| *b > 1e-9 && *b <= TURN_RAD) {
        if to - from < 1e-9 && to < TURN_RAD {
            continue; // narrower than any angle that matters; the next panel takes it
        }
        let parts = ((to - from) / TURN_RAD * split as f64).ceil().max(1.0) as usize;
        for k in 1..parts {
            bounds.push(from + (to - from) * k as f64 / parts as f64);
        }
        bounds.push(to);
        from = to;
    }
    bounds
}

/// For even slices of the range of `bounds`: the panel that holds the beginning of the slice.
fn first_panels(bounds: &[f64]) -> Vec<usize> {
    let panels = bounds.len() - 1;
    let width = bounds[panels] / panels as f64;
    let mut panel = 0;
    (0..panels)
        .map(|slice| {
            while panel + 1 < panels && bounds[panel + 1] <= slice as f64 * width {
                panel += 1;
            }
            panel
        })
        .collect()
}

/// The panel whose bounds enclose `value`.
fn find(first: &[usize], bounds: &[f64], value: f64) -> usize {
    let last = first.len() - 1;
    let slice = ((value / bounds[last + 1] * (last + 1) as f64) as usize).min(last);
    let mut panel = first[slice];
    while panel > 0 && value < bounds[panel] {
        panel -= 1;
    }
    while panel < last && value >= bounds[panel + 1] {
        panel += 1;
    }
    panel
}

/// Gauss-Legendre rule and, for each node, the integral from -1 of its Lagrange polynomial in powers of x.
struct GaussRule {
    nodes: [f64; NODES],
    weights: [f64; NODES],
    powers: [[f64; NODES + 1]; NODES],
}

impl GaussRule {
    /// Coefficient of the Legendre polynomial of degree k in the expansion of the node values.
    fn legendre_coefficient(&self, k: usize, values: &[f64; NODES]) -> f64 {
        let sum: f64 = (0..NODES).map(|i| self.weights[i] * values[i] * legendre(k, self.nodes[i]).0).sum();
        (k as f64 + 0.5) * sum
    }
}

/// Legendre polynomial of degree n and its derivative, |x| < 1.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut p) = (0.0, 1.0);
    for k in 1..=n {
        let k = k as f64;
        (before, p) = (p, ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k);
    }
    (p, n as f64 * (before - x * p) / (1.0 - x * x))
}

/// The panel basis. Lagrange polynomial i is sum over k of (k + 1/2) w_i P_k(x_i) P_k(x), and the integral of P_k from
/// -1 is (P_{k+1} - P_{k-1}) / (2 k + 1).
fn integrated_lagrange_basis() -> Result<GaussRule, NotConverged> {
    let mut nodes = [0.0; NODES];
    let mut weights = [0.0; NODES];
    for i in 0..NODES {
        let start = -((i as f64 + 0.75) / (NODES as f64 + 0.5) * std::f64::consts::PI).cos();
        // On until nothing moves: rounding may keep the last bits from resting.
        let x = newton("a Gauss-Legendre node", start, LastStep::default(), 10, |x| {
            let (p, slope) = legendre(NODES, x);
            [p, -(p / slope)]
        })
        .or_else(|error| error.settled(1e-15))?;
        let slope = legendre(NODES, x).1;
        nodes[i] = x;
        weights[i] = 2.0 / ((1.0 - x * x) * slope * slope);
    }
    let mut p = vec![[0.0; NODES + 1]; NODES + 1]; // P_k in powers of x
    p[0][0] = 1.0;
    p[1][1] = 1.0;
    for k in 1..NODES {
        for e in 0..=NODES {
            let shifted = if e == 0 { 0.0 } else { p[k][e - 1] };
            p[k + 1][e] = ((2 * k + 1) as f64 * shifted - k as f64 * p[k - 1][e]) / (k + 1) as f64;
        }
    }
    let mut powers = [[0.0; NODES + 1]; NODES];
    for i in 0..NODES {
        for k in 0..NODES {
            let share = 0.5 * weights[i] * legendre(k, nodes[i]).0;
            for e in 0..=NODES {
                let below = if k == 0 { if e == 0 { -1.0 } else { 0.0 } } else { p[k - 1][e] };
                powers[i][e] += share * (p[k + 1][e] - below);
            }
        }
    }
    Ok(GaussRule { nodes, weights, powers })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrates_and_inverts_a_wave() {
        let f = |phi: f64| 2.0 + (3.0 * phi).cos();
        let exact = |phi: f64| 2.0 * phi + (3.0 * phi).sin() / 3.0;
        let integral = PeriodicIntegral::new(f, &[], 8, 1e-13).unwrap();
        assert!((integral.closed() - 2.0 * TURN_RAD).abs() < 1e-13);
        for i in -200..400 {
            let phi = f64::from(i) * 0.0731;
            let value = integral.at(phi);
            assert!((value - exact(phi)).abs() < 2e-13, "at {phi}: {}", value - exact(phi));
            assert!((integral.angle_at(value) - phi).abs() < 2e-14 * (1.0 + phi.abs()));
        }
    }

    /// Rounding may put a value a last bit before the turn that its division by the turn's integral says.
    #[test]
    fn ends_of_turns_are_inverted_from_either_side() {
        let integral = PeriodicIntegral::new(|phi: f64| 135.0 + 40.0 * phi.cos(), &[], 8, 1e-13).unwrap();
        for turns in -300..=300 {
            let end = f64::from(turns) * integral.closed();
            for value in [end.next_down(), end, end.next_up()] {
                let phi = f64::from(turns) * TURN_RAD;
                assert!((integral.angle_at(value) - phi).abs() < 2e-14 * (1.0 + phi.abs()), "{turns}");
            }
        }
    }

    #[test]
    fn panels_respect_breaks() {
        let kink = 1.234;
        let f = |phi: f64| 1.0 + (phi.rem_euclid(TURN_RAD) - kink).abs();
        let integral = PeriodicIntegral::new(f, &[kink], 4, 1e-12).unwrap();
        let exact = TURN_RAD + 0.5 * (kink * kink + (TURN_RAD - kink).powi(2));
        assert!((integral.closed() - exact).abs() < 1e-12);
        assert!(integral.panels.len() < 8);
    }

    #[test]
    fn refuses_what_is_not_positive() {
        let refused = |f: &dyn Fn(f64) -> f64| PeriodicIntegral::new(f, &[], 8, 1e-10).unwrap_err();
        match refused(&f64::cos) {
            NotIntegrable::NotPositive { at_rad, value } => {
                assert!(value < 0.0 && (value - at_rad.cos()).abs() < 1e-15);
            }
            other => panic!("{other}"),
        }
        assert!(matches!(refused(&|_| f64::NAN), NotIntegrable::NotPositive { value, .. } if value.is_nan()));
    }

    #[test]
    fn what_is_too_rough_says_how_far_it_came() {
        let rough = |phi: f64| 1.0 + (phi - 1.0).abs().sqrt();
        match PeriodicIntegral::new(rough, &[], 8, 1e-13).unwrap_err() {
            NotIntegrable::TooRough { wanted, reached } => {
                assert!(wanted == 1e-13 && reached > wanted && reached < 1e-3);
            }
            other => panic!("{other}"),
        }
    }
}
