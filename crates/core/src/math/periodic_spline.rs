//! Periodic cubic spline through the points of a table.
//!
//! In: polar angles and radii of measured or computed points. Out: a radius law with continuous curvature (C2); the
//! third derivative is constant between points and jumps at them. Law: continuity of the first derivative at every
//! point gives a cyclic tridiagonal system for the second derivatives (de Boor, *A Practical Guide to Splines*, 1978,
//! ch. IV), solved with the Sherman-Morrison formula.
//!
//! Road not taken: trigonometric interpolation. It is smoother, but rings on points that are not evenly spaced.

use crate::error::Refusal;
use crate::math::Jet;
use crate::units::TURN_RAD;

/// A sector's end is a point's angle within this, rad: digits of drawings, 0.1 um at 100 mm.
const END_RAD: f64 = 1e-6;
const KEY: &str = crate::parameter::TABLE_POINTS;

/// Periodic C2 spline, scaled so that the mean of its points is one.
#[derive(Debug, Clone)]
pub struct PeriodicSpline {
    /// Angles of the points, increasing, within one turn from the first.
    angles_rad: Vec<f64>,
    /// Radii divided by their mean.
    radii: Vec<f64>,
    /// Second derivatives at the points.
    bends: Vec<f64>,
    /// Points of a sector: the outermost cubics go on beyond them.
    is_open: bool,
}

impl PeriodicSpline {
    /// Spline and the mean radius (mm) that it was scaled by.
    ///
    /// # Errors
    /// Fewer than four points, a radius that is not positive, angles out of order, or points over a full turn or more;
    /// a sector beyond the points.
    pub fn new(points_rad_mm: &[[f64; 2]], sector_rad: Option<[f64; 2]>) -> Result<(Self, f64), Refusal> {
        let n = points_rad_mm.len();
        if n < 4 {
            let problem = format!("{n} points do not give a closed curve with continuous curvature");
            return Err(Refusal::new(KEY, problem, "give at least 4 points; 100 or more describe a gear"));
        }
        for (i, [phi, r]) in points_rad_mm.iter().enumerate() {
            if !(phi.is_finite() && r.is_finite() && *r > 0.0) {
                let problem = format!("point {} is ({phi} rad, {r} mm); radii must be positive", i + 1);
                return Err(Refusal::new(KEY, problem, "remove or correct the point"));
            }
        }
        if let Some(i) = points_rad_mm.windows(2).position(|p| p[1][0] <= p[0][0]) {
            let problem = format!(
                "polar angles must increase, but point {} at {} deg follows point {} at {} deg",
                i + 2,
                points_rad_mm[i + 1][0].to_degrees(),
                i + 1,
                points_rad_mm[i][0].to_degrees()
            );
            return Err(Refusal::new(KEY, problem, "sort the points by angle and remove doubles"));
        }
        let span_rad = points_rad_mm[n - 1][0] - points_rad_mm[0][0];
        if span_rad >= TURN_RAD - 1e-9 {
            let problem = format!("the points span {} deg, a full turn or more", span_rad.to_degrees());
            return Err(Refusal::new(
                KEY,
                problem,
                "leave out the last point: the curve closes on the first by itself",
            ));
        }
        let mean_mm = points_rad_mm.iter().map(|p| p[1]).sum::<f64>() / n as f64;
        let angles_rad: Vec<f64> = points_rad_mm.iter().map(|p| p[0]).collect();
        let radii: Vec<f64> = points_rad_mm.iter().map(|p| p[1] / mean_mm).collect();
        let bends = match sector_rad {
            None => second_derivatives(&angles_rad, &radii),
            Some(sector_rad) => {
                let points_rad = [angles_rad[0], angles_rad[n - 1]];
                // The sector may be counted in another turn than the points.
                let into_rad = (sector_rad[0] - points_rad[0] + END_RAD).rem_euclid(TURN_RAD) - END_RAD;
                let width_rad = sector_rad[1] - sector_rad[0];
                if points_rad[0] + into_rad + width_rad > points_rad[1] + END_RAD {
                    let [from, to] = points_rad.map(f64::to_degrees);
                    let problem = format!("the points reach from {from} to {to} deg, and the sector is wider");
                    return Err(Refusal::new(KEY, problem, "give points over the whole sector, its ends included"));
                }
                open_second_derivatives(&angles_rad, &radii)
            }
        };
        Ok((Self { angles_rad, radii, bends, is_open: sector_rad.is_some() }, mean_mm))
    }

    /// Value and derivatives at any angle.
    pub fn at(&self, phi_rad: f64) -> Jet<4> {
        let n = self.angles_rad.len();
        let first = self.angles_rad[0];
        let mut phi = first + (phi_rad - first).rem_euclid(TURN_RAD);
        let mut i = self.angles_rad.partition_point(|a| *a <= phi).clamp(1, n) - 1;
        if self.is_open && i == n - 1 {
            let before = first + TURN_RAD - phi;
            (phi, i) = if phi - self.angles_rad[i] < before { (phi, n - 2) } else { (first - before, 0) };
        }
        let j = (i + 1) % n;
        let h = width(&self.angles_rad, i);
        let (u, v) = (phi - self.angles_rad[i], self.angles_rad[i] + h - phi);
        let (a, b, p, q) = (self.bends[i], self.bends[j], self.radii[i], self.radii[j]);
        Jet::from_derivatives([
            (a * v.powi(3) + b * u.powi(3)) / (6.0 * h) + (p / h - a * h / 6.0) * v + (q / h - b * h / 6.0) * u,
            (b * u * u - a * v * v) / (2.0 * h) + (q - p) / h - (b - a) * h / 6.0,
            (a * v + b * u) / h,
            (b - a) / h,
        ])
    }

    /// Points as angles in [0, 2 pi), increasing.
    pub fn knots_rad(&self) -> Vec<f64> {
        let mut knots: Vec<f64> = self.angles_rad.iter().map(|a| a.rem_euclid(TURN_RAD)).collect();
        knots.sort_by(f64::total_cmp);
        knots
    }
}

/// Width of the interval that begins at point i.
fn width(angles_rad: &[f64], i: usize) -> f64 {
    match angles_rad.get(i + 1) {
        Some(next) => next - angles_rad[i],
        None => angles_rad[0] + TURN_RAD - angles_rad[i],
    }
}

/// h_{i-1} M_{i-1} + 2 (h_{i-1} + h_i) M_i + h_i M_{i+1} = 6 (slope_i - slope_{i-1}), indices cyclic.
fn second_derivatives(angles_rad: &[f64], radii: &[f64]) -> Vec<f64> {
    let n = radii.len();
    let h: Vec<f64> = (0..n).map(|i| width(angles_rad, i)).collect();
    let slope: Vec<f64> = (0..n).map(|i| (radii[(i + 1) % n] - radii[i]) / h[i]).collect();
    let before = |i: usize| (i + n - 1) % n;
    let mut diagonal: Vec<f64> = (0..n).map(|i| 2.0 * (h[before(i)] + h[i])).collect();
    let right: Vec<f64> = (0..n).map(|i| 6.0 * (slope[i] - slope[before(i)])).collect();
    // Cyclic = tridiagonal + u v^T, u = (gamma, 0 ... 0, corner), v = (1, 0 ... 0, corner / gamma)
    let corner = h[n - 1];
    let gamma = -diagonal[0];
    diagonal[0] -= gamma;
    diagonal[n - 1] -= corner * corner / gamma;
    let mut u = vec![0.0; n];
    (u[0], u[n - 1]) = (gamma, corner);
    let y = solve_tridiagonal(&diagonal, &h, right);
    let z = solve_tridiagonal(&diagonal, &h, u);
    let along_v = |x: &[f64]| x[0] + corner / gamma * x[n - 1];
    let factor = along_v(&y) / (1.0 + along_v(&z));
    y.iter().zip(&z).map(|(y, z)| y - factor * z).collect()
}

/// The same for points that are not closed: second derivatives at both ends are those of the cubic through the four
/// outermost points, so that a cubic is met exactly.
fn open_second_derivatives(angles_rad: &[f64], radii: &[f64]) -> Vec<f64> {
    let n = radii.len();
    let [first, last] = [[0, 1, 2, 3], [n - 1, n - 2, n - 3, n - 4]]
        .map(|at| bend_of_cubic(at.map(|i| angles_rad[i]), at.map(|i| radii[i])));
    let h: Vec<f64> = angles_rad.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let slope: Vec<f64> = (0..n - 1).map(|i| (radii[i + 1] - radii[i]) / h[i]).collect();
    let diagonal: Vec<f64> = (1..n - 1).map(|i| 2.0 * (h[i - 1] + h[i])).collect();
    let mut right: Vec<f64> = (1..n - 1).map(|i| 6.0 * (slope[i] - slope[i - 1])).collect();
    right[0] -= h[0] * first;
    right[n - 3] -= h[n - 2] * last;
    let inner = solve_tridiagonal(&diagonal, &h[1..n - 1], right);
    [first].into_iter().chain(inner).chain([last]).collect()
}

/// Second derivative at the first of four places of the cubic through them, by divided differences.
fn bend_of_cubic(x: [f64; 4], y: [f64; 4]) -> f64 {
    let mut d = y;
    for k in 1..4 {
        for i in (k..4).rev() {
            d[i] = (d[i] - d[i - 1]) / (x[i] - x[i - k]);
        }
    }
    2.0 * (d[2] + d[3] * ((x[0] - x[1]) + (x[0] - x[2])))
}

/// Symmetric tridiagonal system with off-diagonal entries `off[i]` between i and i + 1; diagonally dominant.
fn solve_tridiagonal(diagonal: &[f64], off: &[f64], mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    let mut pivot = diagonal.to_vec();
    for i in 1..n {
        let factor = off[i - 1] / pivot[i - 1];
        pivot[i] -= factor * off[i - 1];
        right[i] -= factor * right[i - 1];
    }
    right[n - 1] /= pivot[n - 1];
    for i in (0..n - 1).rev() {
        right[i] = (right[i] - off[i] * right[i + 1]) / pivot[i];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Open points of a cubic give the cubic; the ends of a sector lie within the points.
    #[test]
    fn open_points_of_a_cubic_are_met_exactly() {
        let r = |phi: f64| 50.0 + 4.0 * phi - 3.0 * phi * phi + 1.5 * phi.powi(3);
        let points: Vec<[f64; 2]> = [0.1, 0.3, 0.4, 0.7, 0.9, 1.3].map(|phi| [phi, r(phi)]).to_vec();
        let (spline, mean_mm) = PeriodicSpline::new(&points, Some([0.1, 1.3])).unwrap();
        for i in 0..=120 {
            let phi = 0.1 + 0.01 * f64::from(i);
            let found = spline.at(phi) * mean_mm;
            assert!((found.value() - r(phi)).abs() < 1e-12, "{} at {phi}", found.value() - r(phi));
            assert!((found.derivative(1) - 4.0 + 6.0 * phi - 4.5 * phi * phi).abs() < 1e-10);
            assert!((found.derivative(2) + 6.0 - 9.0 * phi).abs() < 1e-10);
        }
        let wider = PeriodicSpline::new(&points, Some([0.1, 1.4])).unwrap_err();
        assert!(wider.problem.contains("the sector is wider"), "{}", wider.problem);
    }

    #[test]
    fn reproduces_a_smooth_curve_and_is_periodic() {
        let r = |phi: f64| 50.0 + 4.0 * (2.0 * phi + 0.3).cos();
        let points: Vec<[f64; 2]> = (0..400)
            .map(|i| (f64::from(i) + 0.3 * f64::from(i % 3)) * TURN_RAD / 401.0 + 0.2)
            .map(|phi| [phi, r(phi)])
            .collect();
        let (spline, mean_mm) = PeriodicSpline::new(&points, None).unwrap();
        for [phi, r_mm] in &points {
            assert!((spline.at(*phi).value() * mean_mm - r_mm).abs() < 1e-12);
        }
        for i in 0..777 {
            let phi = f64::from(i) * 0.01 - 1.0;
            let jet = spline.at(phi) * mean_mm;
            assert!((jet.value() - r(phi)).abs() < 1e-6);
            assert!((jet.derivative(2) + 16.0 * (2.0 * phi + 0.3).cos()).abs() < 1e-2);
            let turned = spline.at(phi + TURN_RAD) * mean_mm;
            assert!((turned.derivative(1) - jet.derivative(1)).abs() < 1e-9);
        }
    }

    #[test]
    fn refuses_bad_tables() {
        let circle: Vec<[f64; 2]> = (0..8).map(|i| [f64::from(i) * TURN_RAD / 8.0, 30.0]).collect();
        assert!(PeriodicSpline::new(&circle, None).is_ok());
        assert!(PeriodicSpline::new(&circle[..3], None).is_err());
        let mut closed = circle.clone();
        closed.push([TURN_RAD, 30.0]);
        assert!(PeriodicSpline::new(&closed, None).unwrap_err().way_out.contains("last point"));
        let mut swapped = circle.clone();
        swapped.swap(2, 3);
        assert!(PeriodicSpline::new(&swapped, None).unwrap_err().problem.contains("increase"));
        let mut negative = circle;
        negative[5][1] = -1.0;
        assert!(PeriodicSpline::new(&negative, None).unwrap_err().problem.contains("point 6"));
    }
}
