//! The blank: the stock before cutting. Its outline, on the toothed side, is the pitch curve moved along its normals by
//! the addendum: outwards on an external gear, inwards on a ring with internal teeth. Its other side is round
//! ([`Back`]).
//!
//! Heights over the pitch curve are measured along its normal **towards the tips**, outwards on an external gear and
//! inwards on an internal one; they decide where flanks end at the tip and where a ray leaves the stock. With the sign
//! s of [`GearKind::tip_sign`] the foot of a height h is P + s h n, and d/ds of the distance beside it is -(1 + s h
//! kappa).

use super::dwell::Dwell;
use super::{Back, GearKind, PitchCurve, PitchFrame};
use crate::error::Refusal;
use crate::math::convergence::{Step, iterate};
use crate::math::newton::{LastStep, newton};
use crate::math::roots::{bisect, sample_angle_rad};
use crate::parameter;
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
    /// The side without teeth; its kind is the gear's.
    pub back: Back,
    dwell: Option<Dwell>,
}

impl Blank {
    /// Blank of an external gear without a bore, its outline `addendum_mm` outside the pitch curve.
    ///
    /// # Errors
    /// A hollow of the pitch curve that is tighter than the addendum, or a bulge tighter than a negative one: the
    /// outline would cross itself.
    pub fn new(curve: Arc<PitchCurve>, addendum_mm: f64) -> Result<Self, Refusal> {
        // Moved outwards the outline crosses itself in a hollow, moved inwards (a profile shift below -1) where the
        // curve bulges most; a circle has no extrema of its curvature, and both of these.
        let facts = curve.facts();
        let inwards = addendum_mm < 0.0;
        let sharpest = if inwards { facts.largest_curvature } else { facts.smallest_curvature }.curvature_per_mm;
        if sharpest * addendum_mm <= -1.0 {
            let (way, place) = if inwards { ("inside", "bulge") } else { ("outside", "hollow") };
            return Err(Refusal::new(
                parameter::ADDENDUM,
                format!(
                    "the blank's outline, {} mm {way} the pitch curve, crosses itself in a {place} of radius {:.3} mm",
                    addendum_mm.abs(),
                    1.0 / sharpest.abs()
                ),
                "use a smaller addendum or module, or a pitch curve with a wider hollow",
            ));
        }
        Ok(Self { curve, addendum_mm, back: Back::bore(0.0), dwell: None })
    }

    /// The same with a bore.
    #[must_use]
    pub fn with_bore(self, radius_mm: f64) -> Self {
        Self { back: Back::bore(radius_mm), ..self }
    }

    /// The same with the dwell of a sector; as it is where teeth go all round.
    ///
    /// # Errors
    /// A radius that the ends of the sector do not reach, or that lies in the bore.
    pub fn with_dwell(self, radius_mm: f64) -> Result<Self, Refusal> {
        let dwell = Dwell::new(&self.curve, radius_mm)?;
        if dwell.is_some() && self.back.radius_mm >= radius_mm {
            return Err(Refusal::new(
                parameter::DWELL_RADIUS,
                format!("the dwell of radius {radius_mm:.3} mm lies in the bore of radius {} mm", self.back.radius_mm),
                "give a smaller bore or a larger radius",
            ));
        }
        Ok(Self { dwell, ..self })
    }

    /// The stock's outline where a sector has no teeth.
    pub fn dwell(&self) -> Option<&Dwell> {
        self.dwell.as_ref()
    }

    /// The outline of the toothed side as a polygon, counter-clockwise, some `count` points to a turn.
    pub fn polygon_mm(&self, count: usize) -> Vec<DVec2> {
        let Some(dwell) = &self.dwell else {
            return (0..count).map(|i| self.outline_mm(TURN_RAD * i as f64 / count as f64)).collect();
        };
        let [from, to] = self.curve.toothed_rad();
        let parts = ((to - from) / TURN_RAD * count as f64).ceil().max(1.0) as usize;
        let mut points: Vec<DVec2> =
            (0..=parts).map(|i| self.outline_mm(from + (to - from) * i as f64 / parts as f64)).collect();
        let spacing_mm = TURN_RAD * dwell.radius_mm / count as f64;
        points.extend(dwell.path_mm([points[parts], points[0]], spacing_mm).iter().map(|[point, _]| *point));
        points
    }

    /// Blank of a ring for internal teeth: its outline lies `addendum_mm` inside the pitch curve, and it is round
    /// outside, `rim_mm` beyond the curve's largest radius.
    ///
    /// # Errors
    /// A pitch curve that is curved more sharply than the addendum: the outline would cross itself.
    pub fn ring(curve: Arc<PitchCurve>, addendum_mm: f64, rim_mm: f64) -> Result<Self, Refusal> {
        let facts = curve.facts();
        let sharpest = facts.largest_curvature;
        if sharpest.curvature_per_mm * addendum_mm >= 1.0 {
            return Err(Refusal::new(
                parameter::ADDENDUM,
                format!(
                    "the blank's outline, {addendum_mm} mm inside the pitch curve, crosses itself where the curve has \
                    the radius {:.3} mm, at polar angle {:.3} deg",
                    1.0 / sharpest.curvature_per_mm,
                    sharpest.phi_rad.to_degrees()
                ),
                "use a smaller addendum or module, or a pitch curve that is nowhere curved so sharply",
            ));
        }
        let back = Back::ring(facts.largest_radius_mm + rim_mm);
        Ok(Self { curve, addendum_mm, back, dwell: None })
    }

    /// The pitch curve.
    pub fn curve(&self) -> &PitchCurve {
        &self.curve
    }

    /// External or internal.
    pub fn kind(&self) -> GearKind {
        self.back.kind
    }

    /// Unit normal of the pitch curve towards the tips, out of the stock.
    pub fn towards_tip(&self, frame: &PitchFrame) -> DVec2 {
        self.kind().tip_sign() * frame.normal
    }

    /// Point over the place of the pitch curve at `phi_rad`, gear frame, mm.
    pub fn at_height_mm(&self, phi_rad: f64, height_mm: f64) -> DVec2 {
        let frame = self.curve.frame(phi_rad);
        frame.point_mm + height_mm * self.towards_tip(&frame)
    }

    /// Point of the outline over the place of the pitch curve at `phi_rad`, gear frame, mm.
    pub fn outline_mm(&self, phi_rad: f64) -> DVec2 {
        self.at_height_mm(phi_rad, self.addendum_mm)
    }

    /// Height of a point over the pitch curve along the curve's normal, positive towards the tips, and the polar angle
    /// of the foot: the foot that Newton's method runs to from `phi_guess_rad`, or that of the nearest place of the
    /// curve where it runs to none (a point near the curve's centres of curvature).
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
        (self.kind().tip_sign() * (point_mm - frame.point_mm).dot(frame.normal), phi)
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
            let climb = direction.dot(self.towards_tip(&self.curve.frame(phi)));
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
            let curve = Arc::new(curve);
            for blank in [Blank::new(curve.clone(), 2.0).unwrap(), Blank::ring(curve.clone(), 2.0, 10.0).unwrap()] {
                for i in 0..40 {
                    let phi = 0.3 + 0.39 * f64::from(i);
                    let frame = curve.frame(phi);
                    for outwards_mm in [-2.0, 0.0, 2.0] {
                        let point_mm = frame.point_mm + outwards_mm * frame.normal;
                        let height_mm = if blank.kind() == GearKind::External { outwards_mm } else { -outwards_mm };
                        let (height, foot) = blank.height(point_mm, phi + 1e-3);
                        assert!((height - height_mm).abs() < 1e-12 && (foot - phi).abs() < 1e-12);
                        let nearest = blank.nearest_foot_rad(point_mm, phi + 1.0);
                        assert!((nearest - phi).abs() < 1e-12, "{nearest} for {phi}");
                        assert!(blank.at_height_mm(phi, height_mm).distance(point_mm) < 1e-12);
                    }
                }
            }
        }
    }

    /// The middle of a circle is as far from all its places: Newton's rate is zero there.
    #[test]
    fn a_point_without_a_foot_of_its_own_gets_the_nearest() {
        let circle = examples().swap_remove(0);
        let radius_mm = circle.facts().largest_radius_mm;
        let blank = Blank::new(Arc::new(circle), 2.0).unwrap();
        let (height, foot) = blank.height(DVec2::new(1e-14, 0.0), 1.0);
        assert!((height + radius_mm).abs() < 1e-9 && foot.is_finite(), "{height} at {foot}");
    }

    /// A profile shift below -1 has the tips inside the pitch circle.
    #[test]
    fn tips_may_lie_inside_the_pitch_curve_up_to_its_bulges() {
        for (curve, is_round) in examples().into_iter().zip([true].into_iter().chain(std::iter::repeat(false))) {
            let curve = Arc::new(curve);
            let bulge_mm = 1.0 / curve.facts().largest_curvature.curvature_per_mm;
            let inside = Blank::new(curve.clone(), -0.9 * bulge_mm).unwrap();
            let height_mm = inside.height(inside.outline_mm(1.0), 1.0).0;
            assert!(!is_round || (height_mm + 0.9 * bulge_mm).abs() < 1e-9, "{height_mm}");
            let refused = Blank::new(curve, -1.1 * bulge_mm).unwrap_err().problem;
            assert!(refused.contains("inside the pitch curve, crosses itself in a bulge"), "{refused}");
        }
    }

    #[test]
    fn rays_leave_a_round_blank_where_its_circle_says() {
        let circle = examples().swap_remove(0);
        let outside_mm = circle.facts().largest_radius_mm + 2.0;
        let blank = Blank::new(Arc::new(circle), 2.0).unwrap();
        for angle in [0.0_f64, 0.4, 1.2, 1.5] {
            let point = DVec2::new(outside_mm - 3.0, 0.0);
            let direction = DVec2::from_angle(angle);
            let b = point.dot(direction);
            let exact = -b + (b * b + outside_mm * outside_mm - point.length_squared()).sqrt();
            let found = blank.exit_mm(point, direction, 0.0, 0.0, 100.0);
            assert!((found - exact).abs() < 1e-9, "{found} for {exact} at {angle}");
        }
    }

    /// Rays out of a ring run inwards, and leave it where they meet the circle of its tips.
    #[test]
    fn rays_leave_a_ring_where_the_circle_of_its_tips_says() {
        let circle = examples().swap_remove(0);
        let tips_mm = circle.facts().largest_radius_mm - 2.0;
        let blank = Blank::ring(Arc::new(circle), 2.0, 10.0).unwrap();
        assert!((blank.back.radius_mm - tips_mm - 12.0).abs() < 1e-12);
        for angle in [0.0_f64, 0.4, 1.2] {
            let point = DVec2::new(tips_mm + 3.0, 0.0);
            let direction = -DVec2::from_angle(angle);
            let b = point.dot(direction);
            let root = b * b + tips_mm * tips_mm - point.length_squared();
            let exact = if root > 0.0 { -b - root.sqrt() } else { 20.0 };
            let found = blank.exit_mm(point, direction, 0.0, 0.0, 20.0);
            assert!((found - exact).abs() < 1e-9, "{found} for {exact} at {angle}");
        }
    }

    #[test]
    fn a_ring_whose_tips_would_cross_is_refused() {
        let ellipse = Arc::new(examples().swap_remove(2));
        let sharpest_mm = ellipse.facts().smallest_curvature_radius_mm;
        assert!(Blank::ring(ellipse.clone(), 0.99 * sharpest_mm, 10.0).is_ok());
        let refusal = Blank::ring(ellipse, 1.01 * sharpest_mm, 10.0).unwrap_err();
        assert_eq!(refusal.key, parameter::ADDENDUM);
    }
}
