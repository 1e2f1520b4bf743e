//! The F-operator: what is taken off as form before texture is evaluated.
//!
//! Least squares over all measured points: a plane, a polynomial of second order (tilt, crowning along both axes,
//! twist), or that polynomial together with a circular cylinder. The cylinder's arc is more than its second order:
//! across half a chord t, `R - sqrt(R^2 - t^2) - t^2 / 2R = t^4 / 8R^3 + ...` stays in a polynomial's residual.
//! Direction and curvature of the cylinder start at the polynomial's larger principal curvature and are refined by a
//! search with shrinking steps; the polynomial is solved anew for every trial (variable projection).
//!
//! Road not taken: associating a nominal involute. Normal deviations from a target flank have it taken off already.

use super::surface::Surface;
use crate::error::TextureError;
use serde::Serialize;

/// Form to take off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Form {
    /// Nothing but the mean.
    None,
    /// Least-squares plane.
    Plane,
    /// Least-squares polynomial 1, x, y, x^2, x y, y^2.
    Poly2,
    /// Polynomial of second order and a circular cylinder, together.
    Poly2PlusCylinder,
}

impl Form {
    /// Words for the chain.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Plane => "least-squares plane",
            Self::Poly2 => "least-squares polynomial of second order",
            Self::Poly2PlusCylinder => "least-squares polynomial of second order plus circular cylinder",
        }
    }
}

/// Largest share of its radius that a cylinder may span to one side: beyond it the arc stands upright.
const LARGEST_SPAN: f64 = 0.95;

/// Takes the form off; the second value says more about what was taken where there is more to say.
///
/// # Errors
/// Too few points to determine the form.
pub fn remove(surface: &Surface, form: Form) -> Result<(Surface, Option<String>), TextureError> {
    let terms = match form {
        Form::None => return Ok((surface.clone(), None)),
        Form::Plane => 3,
        Form::Poly2 | Form::Poly2PlusCylinder => 6,
    };
    let frame = UnitCoordinates::of(surface);
    let fit = FittedPolynomial::new(surface, &frame, terms)?;
    if form != Form::Poly2PlusCylinder {
        return Ok((fit.residual(surface, &frame), None));
    }
    let cylinder = Cylinder::refined(surface, &frame, &fit)?;
    let note = cylinder.note();
    let taken = cylinder.subtracted(surface, &frame);
    let fit = FittedPolynomial::new(&taken, &frame, 6)?;
    Ok((fit.residual(&taken, &frame), Some(note)))
}

/// Coordinates from -1 to 1 over the surface: the normal equations stay well conditioned.
struct UnitCoordinates {
    half_um: [f64; 2],
    nx: usize,
    ny: usize,
}

impl UnitCoordinates {
    fn of(surface: &Surface) -> Self {
        let [x, y] = surface.size_mm();
        Self { half_um: [500.0 * x, 500.0 * y], nx: surface.nx(), ny: surface.ny() }
    }

    fn x(&self, column: usize) -> f64 {
        2.0 * column as f64 / (self.nx - 1) as f64 - 1.0
    }

    fn y(&self, row: usize) -> f64 {
        2.0 * row as f64 / (self.ny - 1) as f64 - 1.0
    }
}

/// 1, x, y, x^2, x y, y^2.
fn basis(x: f64, y: f64) -> [f64; 6] {
    [1.0, x, y, x * x, x * y, y * y]
}

/// Coefficients of the polynomial.
struct FittedPolynomial([f64; 6]);

impl FittedPolynomial {
    fn new(surface: &Surface, frame: &UnitCoordinates, terms: usize) -> Result<Self, TextureError> {
        let sums: [f64; 27] = surface.sum_rows(|row, heights| {
            let y = frame.y(row);
            let mut sums = [0.0; 27];
            for (column, &z) in heights.iter().enumerate().filter(|(_, z)| !z.is_nan()) {
                let b = basis(frame.x(column), y);
                let mut next = 0;
                for i in 0..6 {
                    for j in i..6 {
                        sums[next] += b[i] * b[j];
                        next += 1;
                    }
                    sums[21 + i] += b[i] * z;
                }
            }
            sums
        });
        let mut matrix = [[0.0; 7]; 6];
        let mut next = 0;
        #[expect(clippy::needless_range_loop, reason = "both halves of a symmetric matrix are written")]
        for i in 0..6 {
            for j in i..6 {
                matrix[i][j] = sums[next];
                matrix[j][i] = sums[next];
                next += 1;
            }
            matrix[i][6] = sums[21 + i];
        }
        solve(&mut matrix, terms).map(Self).ok_or(TextureError::FormUndetermined)
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        basis(x, y).iter().zip(self.0).map(|(b, c)| b * c).sum()
    }

    fn residual(&self, surface: &Surface, frame: &UnitCoordinates) -> Surface {
        map_points(surface, frame, |x, y, z| z - self.at(x, y))
    }
}

fn map_points(surface: &Surface, frame: &UnitCoordinates, f: impl Fn(f64, f64, f64) -> f64 + Sync) -> Surface {
    use rayon::prelude::*;
    let nx = surface.nx();
    let mut heights = surface.heights_um().to_vec();
    heights.par_chunks_mut(nx).enumerate().for_each(|(row, line)| {
        let y = frame.y(row);
        for (column, z) in line.iter_mut().enumerate() {
            *z = f(frame.x(column), y, *z);
        }
    });
    surface.with_heights(heights)
}

/// Gauss elimination of the first `terms` unknowns with pivoting; the others stay 0.
pub(crate) fn solve(m: &mut [[f64; 7]; 6], terms: usize) -> Option<[f64; 6]> {
    for i in 0..terms {
        let pivot = (i..terms).max_by(|&a, &b| m[a][i].abs().total_cmp(&m[b][i].abs()))?;
        m.swap(i, pivot);
        if m[i][i].abs() < 1e-9 * m[0][0].abs().max(1.0) {
            return None;
        }
        for k in i + 1..terms {
            let factor = m[k][i] / m[i][i];
            let upper = m[i];
            for (value, above) in m[k].iter_mut().zip(upper) {
                *value -= factor * above;
            }
        }
    }
    let mut solution = [0.0; 6];
    for i in (0..terms).rev() {
        let known: f64 = (i + 1..terms).map(|j| m[i][j] * solution[j]).sum();
        solution[i] = (m[i][6] - known) / m[i][i];
    }
    Some(solution)
}

/// First step of the axis in the search for a cylinder, rad; the curvature begins with a tenth of itself, and both
/// shrink alike.
const FIRST_ANGLE_STEP_RAD: f64 = 0.05;
/// What is left of the steps after a round that finds nothing better. Found by trial; it decides about time alone.
const SHRINK: f64 = 0.4;
/// Steps of the axis above this are not settled, rad: both unknowns are then known to a thousandth of their first
/// steps, 1e-4 of the curvature, and the misfit near its least value to the square of that.
const SETTLED_RAD: f64 = 5e-5;
/// Rounds that are gone through in any case, and at most.
const LEAST_ROUNDS: u32 = 40;
const MOST_ROUNDS: u32 = 400;

/// Circular cylinder whose axis lies along the surface.
#[derive(Clone, Copy)]
struct Cylinder {
    /// Signed curvature across the axis, 1/um.
    curvature: f64,
    /// Direction across the axis against x, rad.
    angle: f64,
}

impl Cylinder {
    fn refined(surface: &Surface, frame: &UnitCoordinates, fit: &FittedPolynomial) -> Result<Self, TextureError> {
        let [hx, hy] = frame.half_um;
        let c = fit.0;
        // Principal curvatures of the polynomial in um.
        let (xx, xy, yy) = (2.0 * c[3] / (hx * hx), c[4] / (hx * hy), 2.0 * c[5] / (hy * hy));
        let (mean, half) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
        let major = 0.5 * (2.0 * xy).atan2(xx - yy);
        let (curvature, angle) =
            if mean >= 0.0 { (mean + half, major) } else { (mean - half, major + std::f64::consts::FRAC_PI_2) };
        let mut best = Self { curvature, angle }.held_upright(frame);
        let misfit = |cylinder: Self| -> Result<f64, TextureError> {
            let taken = cylinder.subtracted(surface, frame);
            let left = FittedPolynomial::new(&taken, frame, 6)?.residual(&taken, frame);
            Ok(left.sum_rows(|_, row| [row.iter().filter(|z| !z.is_nan()).map(|z| z * z).sum()])[0])
        };
        let mut least = misfit(best)?;
        // Coordinate search with shrinking steps: two unknowns, each trial a linear fit. No trial is taken that fits
        // worse, and a round without a better one shrinks both steps: it ends near a least misfit of this polynomial's
        // valley, or with an error.
        let (mut curvature_step, mut angle_step) = (0.1 * best.curvature, FIRST_ANGLE_STEP_RAD);
        let mut rounds = 0;
        while rounds < LEAST_ROUNDS || angle_step > SETTLED_RAD {
            if rounds == MOST_ROUNDS {
                return Err(TextureError::NoCylinder {
                    rounds: MOST_ROUNDS as usize,
                    step: [angle_step, curvature_step],
                    at: [best.angle, best.curvature],
                });
            }
            rounds += 1;
            let trials = [
                Self { curvature: best.curvature + curvature_step, ..best },
                Self { curvature: best.curvature - curvature_step, ..best },
                Self { angle: best.angle + angle_step, ..best },
                Self { angle: best.angle - angle_step, ..best },
            ];
            let mut better = None;
            for trial in trials.map(|t| t.held_upright(frame)) {
                let left = misfit(trial)?;
                if left < least * (1.0 - 1e-12) {
                    least = left;
                    better = Some(trial);
                }
            }
            match better {
                Some(trial) => best = trial,
                None => (curvature_step, angle_step) = (SHRINK * curvature_step, SHRINK * angle_step),
            }
        }
        Ok(best)
    }

    fn reach_um(&self, frame: &UnitCoordinates) -> f64 {
        let (sin, cos) = self.angle.sin_cos();
        (frame.half_um[0] * cos).abs() + (frame.half_um[1] * sin).abs()
    }

    fn held_upright(mut self, frame: &UnitCoordinates) -> Self {
        let limit = LARGEST_SPAN / self.reach_um(frame);
        self.curvature = self.curvature.clamp(-limit, limit);
        self
    }

    fn subtracted(&self, surface: &Surface, frame: &UnitCoordinates) -> Surface {
        let (sin, cos) = self.angle.sin_cos();
        let [hx, hy] = frame.half_um;
        let k = self.curvature;
        map_points(surface, frame, |x, y, z| {
            let t = x * hx * cos + y * hy * sin;
            // (1 - sqrt(1 - k^2 t^2)) / k without the cancellation at small k.
            z - k * t * t / (1.0 + (1.0 - (k * t).powi(2)).sqrt())
        })
    }

    fn note(&self) -> String {
        let radius_mm = 1e-3 / self.curvature.abs();
        if !radius_mm.is_finite() {
            return "cylinder: a plane, no curvature is left".to_owned();
        }
        format!(
            "cylinder: radius {radius_mm:.4} mm ({}), axis at {:.2} deg from +x",
            if self.curvature < 0.0 { "convex" } else { "concave" },
            (self.angle.to_degrees() + 90.0).rem_euclid(180.0)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surface(f: impl Fn(f64, f64) -> f64) -> Surface {
        let heights = (0..60).flat_map(|j| (0..80).map(move |i| (f64::from(i) * 20.0, f64::from(j) * 30.0)));
        Surface::new(80, 60, 20.0, 30.0, heights.map(|(x, y)| f(x, y)).collect()).expect("a grid")
    }

    fn largest(s: &Surface) -> f64 {
        s.heights_um().iter().filter(|z| !z.is_nan()).fold(0.0, |m, z| m.max(z.abs()))
    }

    #[test]
    fn forms_take_their_own_shape_off_and_nothing_else() {
        let plane = surface(|x, y| 3.0 + 0.01 * x - 0.02 * y);
        assert!(largest(&remove(&plane, Form::Plane).expect("fits").0) < 1e-9);
        let bowl = surface(|x, y| 3.0 + 0.01 * x + 1e-5 * (x * x - x * y + 2.0 * y * y));
        assert!(largest(&remove(&bowl, Form::Poly2).expect("fits").0) < 1e-8);
        assert!(largest(&remove(&bowl, Form::Plane).expect("fits").0) > 1.0);
        assert_eq!(remove(&bowl, Form::None).expect("nothing to fit").0, bowl);
    }

    #[test]
    fn holes_do_not_pull_the_form() {
        let mut heights = surface(|x, y| 0.01 * x - 0.02 * y).heights_um().to_vec();
        for hole in heights.iter_mut().step_by(7) {
            *hole = f64::NAN;
        }
        let holed = Surface::new(80, 60, 20.0, 30.0, heights).expect("a grid");
        assert!(largest(&remove(&holed, Form::Plane).expect("fits").0) < 1e-9);
    }

    #[test]
    fn a_cylinder_is_more_than_its_second_order() {
        // Radius 5 mm, axis 30 deg from x, with tilt, twist and crowning on top.
        let (sin, cos) = 120_f64.to_radians().sin_cos();
        let barrel = surface(|x, y| {
            let t = (x - 790.0) * cos + (y - 885.0) * sin;
            (5000.0_f64.powi(2) - t * t).sqrt() + 0.03 * x + 2e-6 * x * y + 1e-6 * y * y
        });
        assert!(largest(&remove(&barrel, Form::Poly2).expect("fits").0) > 0.5, "fourth order stays");
        let (left, note) = remove(&barrel, Form::Poly2PlusCylinder).expect("fits");
        assert!(largest(&left) < 1e-3, "{} um left, {note:?}", largest(&left));
        let note = note.expect("the cylinder is named");
        assert!(note.contains("convex") && note.contains("radius 5.0"), "{note}");
    }
}
