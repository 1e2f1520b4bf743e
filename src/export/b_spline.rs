//! Cubic B-splines with clamped ends, in the plane or in space: places, and least squares through points.
//!
//! In: parameters and points. Out: control points, the first and the last of them the first and the last point. So two
//! faces that meet in a line of points have one edge to the last bit, next to any others.
//!
//! The normal equations of B-splines are banded and well conditioned (de Boor, *A Practical Guide to Splines*, XIV):
//! a Cholesky factor of four diagonals solves them. With as many points as control points they interpolate.

use glam::{DVec2, DVec3};
use std::iter::Sum;
use std::ops::{AddAssign, Div, Mul, Sub};

/// Degree of all of them.
pub const DEGREE: usize = 3;
/// A control point with a smaller pivot is not determined: with two points in a span it is a tenth and more.
const LEAST_PIVOT: f64 = 1e-6;
/// Basis functions that are not zero at a place.
const ORDER: usize = DEGREE + 1;

/// What splines run through.
pub trait SplinePoint:
    Copy + Default + AddAssign + Sub<Output = Self> + Mul<f64, Output = Self> + Div<f64, Output = Self> + Sum
{
}

impl SplinePoint for DVec2 {}
impl SplinePoint for DVec3 {}

/// Places where the polynomials of a spline meet.
#[derive(Debug, Clone, PartialEq)]
pub struct CubicKnots {
    /// All knots, those at both ends fourfold.
    knots: Vec<f64>,
}

impl CubicKnots {
    /// Knots at these places, rising, both ends included.
    pub fn new(places: &[f64]) -> Self {
        let end = |place: f64| std::iter::repeat_n(place, DEGREE);
        let (first, last) = (places[0], places[places.len() - 1]);
        Self { knots: end(first).chain(places.iter().copied()).chain(end(last)).collect() }
    }

    /// Knots for a curve through points at these parameters, at least four: all but the second and the last but one
    /// ("not a knot"), so that there are as many control points as points.
    pub fn through(params: &[f64]) -> Self {
        let last = params.len() - 1;
        Self::new(&(0..=last).filter(|&i| i != 1 && i != last - 1).map(|i| params[i]).collect::<Vec<_>>())
    }

    /// The places, each once.
    pub fn places(&self) -> &[f64] {
        &self.knots[DEGREE..self.knots.len() - DEGREE]
    }

    /// Number of control points.
    pub fn count(&self) -> usize {
        self.knots.len() - ORDER
    }

    /// Parameter at which a control point of the identity lies (Greville's abscissa).
    pub fn greville(&self, control: usize) -> f64 {
        self.knots[control + 1..=control + DEGREE].iter().sum::<f64>() / DEGREE as f64
    }

    /// The first control point that counts at a parameter, and the weights of that and the next three and their
    /// derivatives.
    fn weights(&self, param: f64) -> (usize, [f64; ORDER], [f64; ORDER]) {
        let u = &self.knots;
        let places = self.places();
        let span = DEGREE + places[1..places.len() - 1].partition_point(|&place| place <= param);
        let mut values = [1.0, 0.0, 0.0, 0.0];
        let mut lower = values;
        for degree in 1..=DEGREE {
            lower = values;
            let mut carried = 0.0;
            for k in 0..degree {
                let [from, to] = [u[span + 1 + k - degree], u[span + 1 + k]];
                let share = lower[k] / (to - from);
                values[k] = carried + (to - param) * share;
                carried = (param - from) * share;
            }
            values[degree] = carried;
        }
        // N' = 3 (N_i / (u_i+3 - u_i) - N_i+1 / (u_i+4 - u_i+1)), both of degree 2.
        let slope = |k: usize| lower[k] / (u[span + 1 + k] - u[span + k + 1 - DEGREE]);
        let derivatives = std::array::from_fn(|k| {
            let [before, own] = [if k > 0 { slope(k - 1) } else { 0.0 }, if k < DEGREE { slope(k) } else { 0.0 }];
            DEGREE as f64 * (before - own)
        });
        (span - DEGREE, values, derivatives)
    }

    /// What control points of any kind are at a parameter: the first that counts, with four weights.
    pub fn blend(&self, param: f64) -> (usize, [f64; ORDER]) {
        let (first, values, _) = self.weights(param);
        (first, values)
    }

    /// Place and derivative at a parameter.
    pub fn place_mm<P: SplinePoint>(&self, controls_mm: &[P], param: f64) -> [P; 2] {
        let (first, values, derivatives) = self.weights(param);
        [values, derivatives].map(|weights| (0..ORDER).map(|k| controls_mm[first + k] * weights[k]).sum())
    }

    /// Control points of the curve that is nearest to points at rising parameters, by least squares, and passes through
    /// the first and the last one; `None`: the points do not determine them.
    pub fn fit<P: SplinePoint>(&self, params: &[f64], points_mm: &[P]) -> Option<Vec<P>> {
        let (count, last) = (self.count(), points_mm.len() - 1);
        let ends_mm = [points_mm[0], points_mm[last]];
        // Rows of the symmetric matrix from three before the diagonal to the diagonal; ends are known.
        let mut band = vec![[0.0_f64; ORDER]; count];
        let mut right = vec![P::default(); count];
        for (&param, &point_mm) in params.iter().zip(points_mm).take(last).skip(1) {
            let (first, values) = self.blend(param);
            let known = |control: usize| control == 0 || control == count - 1;
            let end_mm = |control: usize| ends_mm[usize::from(control > 0)];
            let rest_mm = (0..ORDER)
                .filter(|&k| known(first + k))
                .fold(point_mm, |rest_mm, k| rest_mm - end_mm(first + k) * values[k]);
            for i in (0..ORDER).filter(|&i| !known(first + i)) {
                right[first + i] += rest_mm * values[i];
                for k in (0..=i).filter(|&k| !known(first + k)) {
                    band[first + i][DEGREE + k - i] += values[i] * values[k];
                }
            }
        }
        for of in [0, count - 1] {
            band[of][DEGREE] = 1.0;
            right[of] = ends_mm[usize::from(of > 0)];
        }
        // Cholesky's factor in place, and forward.
        for i in 0..count {
            let from = i.saturating_sub(DEGREE);
            for k in from..=i {
                let shared = (from.max(k.saturating_sub(DEGREE))..k)
                    .map(|m| band[i][DEGREE + m - i] * band[k][DEGREE + m - k])
                    .sum::<f64>();
                let rest = band[i][DEGREE + k - i] - shared;
                band[i][DEGREE + k - i] = if k < i { rest / band[k][DEGREE] } else { rest.sqrt() };
            }
            if band[i][DEGREE].is_nan() || band[i][DEGREE] <= LEAST_PIVOT {
                return None;
            }
            let known: P = (from..i).map(|m| right[m] * band[i][DEGREE + m - i]).sum();
            right[i] = (right[i] - known) / band[i][DEGREE];
        }
        for i in (0..count).rev() {
            let known: P = (i + 1..count.min(i + ORDER)).map(|m| right[m] * band[m][DEGREE + i - m]).sum();
            right[i] = (right[i] - known) / band[i][DEGREE];
        }
        right[0] = ends_mm[0];
        right[count - 1] = ends_mm[1];
        Some(right)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cubic is its own spline on any knots, so is the identity; the derivative is that of the polynomial.
    #[test]
    fn cubics_are_met_to_rounding() {
        let cubic = |t: f64| DVec2::new(1.0 + t - 2.0 * t * t * t, 3.0 * t * t - t);
        let slope = |t: f64| DVec2::new(1.0 - 6.0 * t * t, 6.0 * t - 1.0);
        let knots = CubicKnots::new(&[0.0, 0.1, 0.15, 0.6, 1.0]);
        let params: Vec<f64> = (0..=40).map(|i| f64::from(i) / 40.0).collect();
        let points: Vec<DVec2> = params.iter().map(|&t| cubic(t)).collect();
        let controls = knots.fit(&params, &points).expect("determined");
        assert_eq!((controls.len(), controls[0], controls[6]), (7, points[0], points[40]));
        for t in (0..=1000).map(|i| f64::from(i) / 1000.0) {
            let [place, along] = knots.place_mm(&controls, t);
            assert!(place.distance(cubic(t)) < 1e-12 && along.distance(slope(t)) < 1e-10, "{t}: {place} {along}");
        }
        let through = CubicKnots::through(&[-2.0, -1.0, 0.5, 1.0, 2.0]);
        assert_eq!((through.count(), through.places()), (5, &[-2.0, 0.5, 2.0][..]));
        let identity: Vec<DVec2> = (0..5).map(|i| DVec2::splat(through.greville(i))).collect();
        assert!((through.place_mm(&identity, 0.7)[0].x - 0.7).abs() < 1e-14);
    }

    /// As many points as control points are interpolated; a span without points is not determined.
    #[test]
    fn points_are_met_and_gaps_are_seen() {
        let params = [0.0, 0.2, 0.3, 0.5, 0.8, 1.0];
        let points = params.map(|t: f64| DVec2::from_angle(3.0 * t));
        let through = CubicKnots::through(&params);
        let controls = through.fit(&params, &points).expect("determined");
        for (&t, point) in params.iter().zip(points) {
            assert!(through.place_mm(&controls, t)[0].distance(point) < 1e-12);
        }
        assert!(CubicKnots::new(&[0.0, 0.82, 0.85, 0.9, 1.0]).fit(&params, &points).is_none());
    }
}
