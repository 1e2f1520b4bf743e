//! Linear least squares with a few unknowns, and polynomials fitted to samples.
//!
//! In: equations, or values over a window. Out: the unknowns; for a polynomial its coefficients and the largest error
//! at the samples.
//!
//! The equations go through Givens rotations one by one (Golub and Van Loan, Matrix Computations, 5.2.5), which keep
//! the digits that normal equations would square away; nothing larger than a triangle of the unknowns is kept. A
//! polynomial is fitted over tau in [-1, 1], where even order 12 loses few digits.

use crate::error::NotConverged;

/// An unknown whose pivot is below this share of the largest is not determined by the equations.
const LEAST_PIVOT: f64 = 1e-13;

/// Unknowns x that make the sum of (a . x - b)^2 smallest over all equations (a, b).
///
/// # Errors
/// The equations do not determine all unknowns.
pub fn solve<const N: usize>(equations: impl IntoIterator<Item = ([f64; N], f64)>) -> Result<[f64; N], NotConverged> {
    let found = solve_any(N, equations.into_iter().map(|(row, value)| (row.to_vec(), value)))?;
    Ok(std::array::from_fn(|i| found[i]))
}

/// [`solve`] for a number of unknowns that is not known before.
///
/// # Errors
/// The equations do not determine all unknowns.
pub fn solve_any(unknowns: usize, equations: impl Iterator<Item = (Vec<f64>, f64)>) -> Result<Vec<f64>, NotConverged> {
    let mut triangle = vec![vec![0.0_f64; unknowns + 1]; unknowns];
    for (mut row, value) in equations {
        row.push(value);
        for pivot in 0..unknowns {
            let length = triangle[pivot][pivot].hypot(row[pivot]);
            if length == 0.0 {
                continue;
            }
            let (cos, sin) = (triangle[pivot][pivot] / length, row[pivot] / length);
            for (kept, new) in triangle[pivot].iter_mut().zip(&mut row).skip(pivot) {
                (*kept, *new) = (cos * *kept + sin * *new, cos * *new - sin * *kept);
            }
        }
    }
    let largest = (0..unknowns).map(|i| triangle[i][i].abs()).fold(0.0, f64::max);
    let mut found = vec![0.0; unknowns];
    for i in (0..unknowns).rev() {
        let pivot = triangle[i][i];
        if pivot.abs() <= LEAST_PIVOT * largest {
            return Err(NotConverged {
                what: "the unknowns of a least-squares problem",
                after: i as u32,
                last: pivot,
                last_step: f64::INFINITY,
                residual: triangle[i][unknowns],
            });
        }
        let known: f64 = (i + 1..unknowns).map(|k| triangle[i][k] * found[k]).sum();
        found[i] = (triangle[i][unknowns] - known) / pivot;
    }
    Ok(found)
}

/// A polynomial over a window.
#[derive(Debug, Clone, PartialEq)]
pub struct WindowFit {
    /// Ends of the window.
    pub window: [f64; 2],
    /// Coefficients of tau^0, tau^1 and so on; tau runs from -1 to 1 over the window.
    pub in_tau: Vec<f64>,
    /// Largest error at the samples, in the unit of the values.
    pub largest_error: f64,
}

impl WindowFit {
    /// Fit of an order to a function at `samples` even places of a window, both ends among them.
    ///
    /// # Errors
    /// No more samples than coefficients are too few.
    pub fn new(
        value: impl Fn(f64) -> f64,
        window: [f64; 2],
        order: usize,
        samples: usize,
    ) -> Result<Self, NotConverged> {
        let [from, to] = window;
        let places: Vec<f64> = (0..samples).map(|i| 2.0 * i as f64 / (samples - 1) as f64 - 1.0).collect();
        let at = |tau: f64| value(0.5 * (from + to) + 0.5 * (to - from) * tau);
        let equation = |&tau: &f64| {
            let powers = std::iter::successors(Some(1.0), |power| Some(power * tau)).take(order + 1);
            (powers.collect(), at(tau))
        };
        let in_tau = solve_any(order + 1, places.iter().map(equation))?;
        let mut fit = Self { window, in_tau, largest_error: 0.0 };
        fit.largest_error = places.iter().map(|&tau| (fit.at_tau(tau) - at(tau)).abs()).fold(0.0, f64::max);
        Ok(fit)
    }

    /// Value of the polynomial, in the window or beyond it.
    pub fn at(&self, place: f64) -> f64 {
        let [from, to] = self.window;
        self.at_tau((2.0 * place - from - to) / (to - from))
    }

    fn at_tau(&self, tau: f64) -> f64 {
        self.in_tau.iter().rev().fold(0.0, |sum, coefficient| sum * tau + coefficient)
    }

    /// Coefficients of powers of the place itself, as controls take them. They lose digits where the window is narrow
    /// and far from 0.
    pub fn in_place(&self) -> Vec<f64> {
        let [from, to] = self.window;
        let (slope, offset) = (2.0 / (to - from), -(from + to) / (to - from));
        let mut powers: Vec<f64> = Vec::new();
        for coefficient in self.in_tau.iter().rev() {
            // powers <- powers * (offset + slope place) + coefficient.
            let mut next = vec![0.0; powers.len() + 1];
            for (i, power) in powers.iter().enumerate() {
                next[i] += offset * power;
                next[i + 1] += slope * power;
            }
            next[0] += coefficient;
            if powers.is_empty() {
                next.truncate(1);
            }
            powers = next;
        }
        powers
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_their_own_fits() {
        let cubic = |t: f64| 4.0 - t * (3.0 - t * (0.5 - 0.25 * t));
        let fit = WindowFit::new(cubic, [2.0, 7.0], 3, 40).unwrap();
        assert!(fit.largest_error < 1e-12 && (fit.at(9.0) - cubic(9.0)).abs() < 1e-10);
        for (got, wanted) in fit.in_place().iter().zip([4.0, -3.0, 0.5, -0.25]) {
            assert!((got - wanted).abs() < 1e-11, "{got} not {wanted}");
        }
        let missed = WindowFit::new(cubic, [2.0, 7.0], 2, 40).unwrap();
        // The best quadratic misses a cubic by about a Chebyshev polynomial: c (half window)^3 / 4.
        assert!(missed.largest_error > 0.9 * 0.25 * 2.5_f64.powi(3) / 4.0);
    }

    #[test]
    fn too_few_equations_are_reported() {
        assert!(WindowFit::new(f64::sin, [0.0, 1.0], 4, 4).is_err());
        assert!(solve([([1.0, 2.0], 1.0), ([2.0, 4.0], 2.0)]).is_err());
        let line = solve([([1.0, 0.0], 1.0), ([1.0, 1.0], 2.5), ([1.0, 2.0], 4.0)]).unwrap();
        assert!((line[0] - 1.0).abs() < 1e-15 && (line[1] - 1.5).abs() < 1e-15);
    }
}
