//! Linear least squares with columns that come one after the other, and the covariance of the solution.
//!
//! In: columns and a right side, both over the noise's standard deviation, so that residuals are standard normal where
//! the model holds. Out: an orthonormal basis that grows ([`ColumnBasis`]), what columns would explain beyond it, and
//! the solution with its covariance ([`ColumnSolution`]).
//!
//! Modified Gram-Schmidt, twice, which keeps the basis orthogonal to rounding (Björck, *Numerical Methods for Least
//! Squares Problems*, 1996, 2.4.5 and 2.4.7).
//!
//! **Why there are two.** [`super::least_squares`] takes equations one by one, keeps nothing but a triangle, and
//! refuses unknowns that are not determined. Here unknowns come one by one while all equations are there: one that the
//! others say already is left out instead, and every vector can be asked what of it they do not explain.
//!
//! Road not taken: the normal equations, which square the condition; a crate for linear algebra, where nalgebra asks
//! for twenty versions of glam in the lock file, for the sake of these lines.

/// What is left of a column beside the basis, as a share of it, below which it counts as a part of what is there: far
/// above rounding and the errors of differences, far below what noise can tell apart.
pub const DEPENDENT: f64 = 1e-4;

/// An orthonormal basis of columns, with how they are made of it.
#[derive(Debug, Clone, Default)]
pub struct ColumnBasis {
    /// Unit vectors.
    units: Vec<Vec<f64>>,
    /// Each accepted column in terms of the unit vectors up to its own: the upper triangle R, column by column.
    upper: Vec<Vec<f64>>,
}

/// The coefficients of the columns of a basis.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnSolution {
    /// Coefficients.
    pub values: Vec<f64>,
    /// Their covariance for residuals of variance 1.
    pub covariance: Vec<Vec<f64>>,
    /// Sum of the squared residuals.
    pub chi_square: f64,
    /// Values less coefficients.
    pub freedom: usize,
}

impl ColumnBasis {
    /// How many columns it has.
    pub fn columns(&self) -> usize {
        self.units.len()
    }

    /// Takes a column up; `false` where it is a combination of those that are there, which then stand for it.
    pub fn take(&mut self, column: &[f64]) -> bool {
        let (rest, shares) = self.beside(column);
        let length = norm(&rest);
        if length <= DEPENDENT * norm(column) {
            return false;
        }
        self.units.push(rest.iter().map(|value| value / length).collect());
        self.upper.push(shares.into_iter().chain([length]).collect());
        true
    }

    /// What of a vector is beside the basis, and its components along the unit vectors.
    pub fn beside(&self, column: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut rest = column.to_vec();
        let mut shares = vec![0.0; self.units.len()];
        for _ in 0..2 {
            for (unit, share) in self.units.iter().zip(&mut shares) {
                let along = dot(unit, &rest);
                *share += along;
                rest.iter_mut().zip(unit).for_each(|(value, unit)| *value -= along * unit);
            }
        }
        (rest, shares)
    }

    /// Sum of squares that would be left of `values`.
    pub fn left_of(&self, values: &[f64]) -> f64 {
        let (rest, _) = self.beside(values);
        dot(&rest, &rest)
    }

    /// Least squares of `values` by the columns.
    pub fn solve(&self, values: &[f64]) -> ColumnSolution {
        let (rest, shares) = self.beside(values);
        let count = self.columns();
        // R x = Q^T y, from the last row up; the columns of the inverse of R likewise.
        let back = |right: &[f64]| {
            let mut x = right.to_vec();
            for i in (0..count).rev() {
                let known: f64 = (i + 1..count).map(|j| self.upper[j][i] * x[j]).sum();
                x[i] = (x[i] - known) / self.upper[i][i];
            }
            x
        };
        let unit = |i: usize| (0..count).map(|j| if i == j { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        let inverse: Vec<Vec<f64>> = (0..count).map(|i| back(&unit(i))).collect();
        let covariance = (0..count)
            .map(|i| (0..count).map(|j| inverse.iter().map(|column| column[i] * column[j]).sum()).collect())
            .collect();
        ColumnSolution {
            values: back(&shares),
            covariance,
            chi_square: dot(&rest, &rest),
            freedom: values.len().saturating_sub(count),
        }
    }
}

/// Length of a vector.
pub fn norm(values: &[f64]) -> f64 {
    dot(values, values).sqrt()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Longley-like by hand: y = 1 + 2 x at x = 0, 1, 2, with residuals 1, -2, 1, which are orthogonal to both columns.
    #[test]
    fn a_line_through_three_points_is_the_one_by_hand() {
        let mut basis = ColumnBasis::default();
        assert!(basis.take(&[1.0, 1.0, 1.0]) && basis.take(&[0.0, 1.0, 2.0]));
        assert!(!basis.take(&[3.0, 5.0, 7.0]), "it is a combination of both");
        let ColumnSolution { values, covariance, chi_square, freedom } = basis.solve(&[2.0, 1.0, 6.0]);
        assert!((values[0] - 1.0).abs() < 1e-14 && (values[1] - 2.0).abs() < 1e-14, "{values:?}");
        // (X^T X)^-1 = [[3, 3], [3, 5]]^-1 = [[5, -3], [-3, 3]] / 6.
        let expected = [[5.0 / 6.0, -0.5], [-0.5, 0.5]];
        for (row, expected) in covariance.iter().zip(expected) {
            assert!(row.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{covariance:?}");
        }
        assert!((chi_square - 6.0).abs() < 1e-13 && freedom == 1);
    }

    /// Läuchli's columns: the normal equations lose their difference at this epsilon, the basis keeps it.
    #[test]
    fn nearly_equal_columns_are_told_apart_as_far_as_they_can_be() {
        let epsilon = 1e-3;
        let mut basis = ColumnBasis::default();
        assert!(basis.take(&[1.0, epsilon, 0.0]) && basis.take(&[1.0, 0.0, epsilon]));
        let ColumnSolution { values, .. } = basis.solve(&[2.0, epsilon, epsilon]);
        assert!(values.iter().all(|value| (value - 1.0).abs() < 1e-9), "{values:?}");
        assert!(!ColumnBasis { ..basis.clone() }.take(&[2.0, epsilon, epsilon]));
    }
}
