//! The F-operator of profiles: what is taken off a line as form before it is filtered.
//!
//! In: heights of a line without holes. Out: what is left. Least squares over all points: the mean, a straight line, a
//! polynomial, or the arc of a circle. Polynomials are built one degree after the other, each at right angles to those
//! before it over the points themselves, so that no system of equations becomes ill-conditioned. The arc is a circle
//! by its height, slope and curvature in the middle of the line, found by Gauss-Newton from the parabola: a tilted arc
//! is no parabola and no untilted arc with a tilt beside it.

use crate::error::TextureError;
use serde::Serialize;

/// Form to take off a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LineForm {
    /// The mean alone.
    None,
    /// Least-squares straight line.
    Line,
    /// Least-squares arc of a circle.
    Arc,
    /// Least-squares polynomial of this degree, 2 to 5.
    Polynomial(u8),
}

/// Steps of Gauss-Newton at most; a handful is usual.
const STEPS: usize = 50;

impl LineForm {
    /// Words for the chain.
    pub fn name(self) -> String {
        match self {
            Self::None => "mean".to_owned(),
            Self::Line => "least-squares line".to_owned(),
            Self::Arc => "least-squares arc of a circle".to_owned(),
            Self::Polynomial(degree) => format!("least-squares polynomial of degree {degree}"),
        }
    }

    /// What is left of heights `spacing_um` apart without this form.
    ///
    /// # Errors
    /// An arc that fits no circle.
    pub fn removed(self, heights_um: &[f64], spacing_um: f64) -> Result<Vec<f64>, TextureError> {
        match self {
            Self::None => Ok(without_polynomial(heights_um, 0)),
            Self::Line => Ok(without_polynomial(heights_um, 1)),
            Self::Polynomial(degree) => Ok(without_polynomial(heights_um, degree)),
            Self::Arc => without_arc(heights_um, spacing_um),
        }
    }
}

/// Places from -1 to 1.
fn places(count: usize) -> Vec<f64> {
    (0..count).map(|i| 2.0 * i as f64 / (count - 1) as f64 - 1.0).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Takes `b` off `a` as far as they point the same way.
fn reject(a: &mut [f64], b: &[f64]) {
    let share = dot(a, b) / dot(b, b);
    for (a, b) in a.iter_mut().zip(b) {
        *a -= share * b;
    }
}

fn without_polynomial(heights_um: &[f64], degree: u8) -> Vec<f64> {
    let x = places(heights_um.len());
    let mut left = heights_um.to_vec();
    let mut before: Vec<Vec<f64>> = Vec::new();
    for _ in 0..=degree {
        let mut next: Vec<f64> = match before.last() {
            None => vec![1.0; x.len()],
            Some(last) => last.iter().zip(&x).map(|(p, x)| p * x).collect(),
        };
        for lower in &before {
            reject(&mut next, lower);
        }
        reject(&mut left, &next);
        before.push(next);
    }
    left
}

/// Height over the middle of a circle with slope tan(phi) and curvature k there, at the distance u along the line: the
/// smaller root of k/2 (u^2 + w^2) = w cos(phi) - u sin(phi), which stays good as k goes to 0. NaN beyond the circle.
fn arc(u: f64, slope: f64, curvature: f64) -> f64 {
    let cos = 1.0 / slope.hypot(1.0);
    let c = 0.5 * curvature * u * u + u * slope * cos;
    2.0 * c / (cos + (cos * cos - 2.0 * curvature * c).sqrt())
}

fn without_arc(heights_um: &[f64], spacing_um: f64) -> Result<Vec<f64>, TextureError> {
    let half_um = 0.5 * spacing_um * (heights_um.len() - 1) as f64;
    let u: Vec<f64> = places(heights_um.len()).iter().map(|x| x * half_um).collect();
    let left = |[height, slope, curvature]: [f64; 3]| -> Vec<f64> {
        heights_um.iter().zip(&u).map(|(z, &u)| z - height - arc(u, slope, curvature)).collect()
    };
    // From the level line: the first step finds the parabola.
    let mut found = [heights_um.iter().sum::<f64>() / heights_um.len() as f64, 0.0, 0.0];
    let steps = [1e-3, 1e-3 / half_um, 1e-3 / (half_um * half_um)];
    let mut rest = left(found);
    for _ in 0..STEPS {
        let mut columns: Vec<Vec<f64>> = Vec::new();
        for k in 0..3 {
            let [mut up, mut down] = [found; 2];
            up[k] += steps[k];
            down[k] -= steps[k];
            columns.push(left(down).iter().zip(left(up)).map(|(d, u)| (d - u) / (2.0 * steps[k])).collect());
        }
        let change = least_squares(&columns, &rest);
        let next: [f64; 3] = std::array::from_fn(|k| found[k] + change[k]);
        let after = left(next);
        if after.iter().any(|z| z.is_nan()) {
            return Err(TextureError::NoArc);
        }
        let settled = (0..3).all(|k| change[k].abs() <= 1e-6 * steps[k]);
        (found, rest) = (next, after);
        if settled {
            return Ok(rest);
        }
    }
    Err(TextureError::UnsettledArc { steps: STEPS })
}

/// Coefficients of `columns` in the least-squares fit of `values`, by columns at right angles to each other.
fn least_squares(columns: &[Vec<f64>], values: &[f64]) -> Vec<f64> {
    let n = columns.len();
    let mut square = columns.to_vec();
    let mut upper = vec![vec![0.0; n]; n];
    for j in 0..n {
        for i in 0..j {
            upper[i][j] = dot(&square[j], &square[i]) / dot(&square[i], &square[i]);
            let (low, high) = square.split_at_mut(j);
            for (a, b) in high[0].iter_mut().zip(&low[i]) {
                *a -= upper[i][j] * b;
            }
        }
    }
    let mut solution: Vec<f64> = square.iter().map(|q| dot(values, q) / dot(q, q)).collect();
    for i in (0..n).rev() {
        for j in i + 1..n {
            solution[i] -= upper[i][j] * solution[j];
        }
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;

    fn largest(values: &[f64]) -> f64 {
        values.iter().fold(0.0, |most, z| most.max(z.abs()))
    }

    #[test]
    fn polynomials_take_their_own_off() {
        let x = places(501);
        for degree in 0..=5 {
            let line: Vec<f64> = x.iter().map(|x| 7.0 - 3.0 * x.powi(i32::from(degree)) + 0.5 * x.powi(0)).collect();
            assert!(largest(&without_polynomial(&line, degree)) < 1e-12, "{degree}");
            assert!(degree == 0 || largest(&without_polynomial(&line, degree - 1)) > 0.01, "{degree}");
        }
    }

    /// Circle of 3 mm round a point 0.4 mm beside the middle of a line of 4 mm: a parabola leaves tens of um.
    #[test]
    fn a_tilted_arc_goes_wholly() {
        let (r, x0, spacing) = (3000.0_f64, 400.0, 2.0);
        let line: Vec<f64> =
            (0..2001).map(|i| f64::from(i) * spacing - 2000.0 - x0).map(|x| (r * r - x * x).sqrt() - r).collect();
        assert!(largest(&LineForm::Polynomial(2).removed(&line, spacing).expect("a form")) > 10.0);
        assert!(largest(&LineForm::Arc.removed(&line, spacing).expect("a circle")) < 1e-6);
        // A straight line is a circle without curvature.
        let tilted: Vec<f64> = (0..500).map(|i| 0.02 * f64::from(i) + 3.0).collect();
        assert!(largest(&LineForm::Arc.removed(&tilted, spacing).expect("a circle")) < 1e-9);
    }
}
