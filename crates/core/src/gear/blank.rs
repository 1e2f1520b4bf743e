//! The blank: the stock before cutting. Its outline is the pitch curve moved outwards along its normals by the
//! addendum.
//!
//! Heights over the pitch curve are measured along its normal; they decide where flanks end at the tip and where a ray
//! leaves the stock.

use super::PitchCurve;
use crate::error::Refusal;
use crate::math::convergence::{Step, iterate};
use crate::math::newton::{LastStep, newton};
use crate::math::roots::{bisect, sample_angle_rad};
use crate::units::TURN_RAD;
use glam::DVec2;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Last step to a foot, rad, and how many there are at most; four suffice near the curve.
const FOOT_RAD: f64 = 1e-13;
const FOOT_STEPS: u32 = 30;
/// Last step along a ray out of the blank, mm, and how many there are at most.
const EXIT_MM: f64 = 1e-9;
const EXIT_STEPS: u32 = 20;
/// Steps count on at least this climb (cosine between ray and normal), so that a grazing ray is not thrown far away.
const LEAST_CLIMB: f64 = 0.05;

/// Outline of the stock.
#[derive(Debug, Clone)]
pub struct Blank {
    curve: Arc<PitchCurve>,
    /// Distance of the outline from the pitch curve, mm.
    pub addendum_mm: f64,
}

impl Blank {
    /// Blank with the outline `addendum_mm` outside the pitch curve.
    ///
    /// # Errors
    /// A hollow of the pitch curve that is tighter than the addendum: the outline would cross itself.
    pub fn new(curve: Arc<PitchCurve>, addendum_mm: f64) -> Result<Self, Refusal> {
        let tightest = curve.facts().curvature_extrema.iter().map(|e| e.curvature_per_mm).fold(f64::INFINITY, f64::min);
        if tightest * addendum_mm <= -1.0 {
            return Err(Refusal::new(
                "gear.addendum_coefficient",
                format!(
                    "the blank's outline, {addendum_mm} mm outside the pitch curve, crosses itself in a hollow of \
                    radius {:.3} mm",
                    -1.0 / tightest
                ),
                "use a smaller addendum_coefficient or module_mm, or a pitch curve with a wider hollow",
            ));
        }
        Ok(Self { curve, addendum_mm })
    }

    /// The pitch curve.
    pub fn curve(&self) -> &PitchCurve {
        &self.curve
    }

    /// Point of the outline over the place of the pitch curve at `phi_rad`, gear frame, mm.
    pub fn outline_mm(&self, phi_rad: f64) -> DVec2 {
        let frame = self.curve.frame(phi_rad);
        frame.point_mm + self.addendum_mm * frame.normal
    }

    /// Height of a point over the pitch curve along the curve's normal, and the polar angle of the foot: the foot that
    /// Newton's method runs to from `phi_guess_rad`, or that of the nearest place of the curve where it runs to none (a
    /// point near the curve's centres of curvature).
    pub fn height(&self, point_mm: DVec2, phi_guess_rad: f64) -> (f64, f64) {
        let phi = newton("the foot of a normal", phi_guess_rad, LastStep::absolute(FOOT_RAD), FOOT_STEPS, |phi| {
            let frame = self.curve.frame(phi);
            let d = point_mm - frame.point_mm;
            // d/ds of the tangential distance is kappa h - ... = -(1 + kappa h) for an outward normal.
            let rate = frame.arc_rate_mm_per_rad * (1.0 + frame.curvature_per_mm * d.dot(frame.normal));
            let beside_mm = d.dot(frame.tangent);
            [beside_mm, beside_mm / rate]
        });
        let phi = phi.unwrap_or_else(|_| self.nearest_foot_rad(point_mm, phi_guess_rad));
        let frame = self.curve.frame(phi);
        ((point_mm - frame.point_mm).dot(frame.normal), phi)
    }

    /// Foot of a point on the nearest place of the curve, in the turn nearest to `phi_guess_rad`. It cannot fail: the
    /// distance rises to both sides of the nearest of many samples, and its slope is bracketed between that one's
    /// neighbours.
    fn nearest_foot_rad(&self, point_mm: DVec2, phi_guess_rad: f64) -> f64 {
        let samples = self.curve.samples_per_turn();
        let apart_mm = |index: usize| self.curve.frame(sample_angle_rad(index, samples)).point_mm.distance(point_mm);
        let nearest = (1..=samples).min_by(|&a, &b| apart_mm(a).total_cmp(&apart_mm(b))).unwrap_or(1);
        let ahead = |phi: f64| {
            let frame = self.curve.frame(phi);
            (point_mm - frame.point_mm).dot(frame.tangent) > 0.0
        };
        let phi = bisect(ahead, sample_angle_rad(nearest - 1, samples), sample_angle_rad(nearest + 1, samples));
        phi + ((phi_guess_rad - phi) / TURN_RAD).round() * TURN_RAD
    }

    /// Distance from a point inside along a unit direction to the outline, at most `limit_mm`; `start_mm` is a first
    /// guess. Where Newton's method does not settle, the range from the point to the limit is halved.
    pub fn exit_mm(&self, point_mm: DVec2, direction: DVec2, phi_guess_rad: f64, start_mm: f64, limit_mm: f64) -> f64 {
        let height_and_foot = |t: f64| self.height(point_mm + t * direction, phi_guess_rad);
        let found = iterate("the way out of the blank", start_mm.clamp(0.0, limit_mm), EXIT_STEPS, |t| {
            let (height, phi) = height_and_foot(t);
            let climb = direction.dot(self.curve.frame(phi).normal);
            if climb <= 0.0 && height < self.addendum_mm {
                return ControlFlow::Break(limit_mm);
            }
            let residual = self.addendum_mm - height;
            let step = residual / climb.abs().max(LEAST_CLIMB);
            let to = (t + step).clamp(0.0, limit_mm);
            let done = step.abs() < EXIT_MM || (to == limit_mm && step > 0.0);
            if done { ControlFlow::Break(to) } else { ControlFlow::Continue(Step { to, residual }) }
        });
        found.unwrap_or_else(|_| bisect(|t| height_and_foot(t).0 < self.addendum_mm, 0.0, limit_mm))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::pitch_curve::examples::examples;

    /// Newton's method from any guess, and the fallback, against the foot that the point was made from.
    #[test]
    fn points_find_their_feet_with_and_without_newton() {
        for curve in examples() {
            let blank = Blank { curve: Arc::new(curve), addendum_mm: 2.0 };
            for i in 0..40 {
                let phi = 0.3 + 0.39 * f64::from(i);
                let frame = blank.curve.frame(phi);
                for height_mm in [-2.0, 0.0, 2.0] {
                    let point_mm = frame.point_mm + height_mm * frame.normal;
                    let (height, foot) = blank.height(point_mm, phi + 1e-3);
                    assert!((height - height_mm).abs() < 1e-12 && (foot - phi).abs() < 1e-12);
                    let nearest = blank.nearest_foot_rad(point_mm, phi + 1.0);
                    assert!((nearest - phi).abs() < 1e-12, "{nearest} for {phi}");
                }
            }
        }
    }

    /// The middle of a circle is as far from all its places: Newton's rate is zero there.
    #[test]
    fn a_point_without_a_foot_of_its_own_gets_the_nearest() {
        let circle = examples().swap_remove(0);
        let radius_mm = circle.facts().largest_radius_mm;
        let blank = Blank { curve: Arc::new(circle), addendum_mm: 2.0 };
        let (height, foot) = blank.height(DVec2::new(1e-14, 0.0), 1.0);
        assert!((height + radius_mm).abs() < 1e-9 && foot.is_finite(), "{height} at {foot}");
    }

    #[test]
    fn rays_leave_a_round_blank_where_its_circle_says() {
        let circle = examples().swap_remove(0);
        let outside_mm = circle.facts().largest_radius_mm + 2.0;
        let blank = Blank { curve: Arc::new(circle), addendum_mm: 2.0 };
        for angle in [0.0_f64, 0.4, 1.2, 1.5] {
            let point = DVec2::new(outside_mm - 3.0, 0.0);
            let direction = DVec2::from_angle(angle);
            let b = point.dot(direction);
            let exact = -b + (b * b + outside_mm * outside_mm - point.length_squared()).sqrt();
            let found = blank.exit_mm(point, direction, 0.0, 0.0, 100.0);
            assert!((found - exact).abs() < 1e-9, "{found} for {exact} at {angle}");
        }
    }
}
