//! The blank: the stock before cutting. Its outline is the pitch curve moved outwards along its normals by the addendum.
//!
//! Heights over the pitch curve are measured along its normal; they decide where flanks end at the tip and where a ray leaves the stock.

use super::PitchCurve;
use crate::error::Refusal;
use glam::DVec2;
use std::sync::Arc;

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
                    "the blank's outline, {addendum_mm} mm outside the pitch curve, crosses itself in a hollow of radius {:.3} mm",
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

    /// Height of a point over the pitch curve along the curve's normal, and the polar angle of the foot; Newton's method from `phi_guess_rad`.
    pub fn height(&self, point_mm: DVec2, phi_guess_rad: f64) -> (f64, f64) {
        let mut phi = phi_guess_rad;
        for _ in 0..30 {
            let frame = self.curve.frame(phi);
            let d = point_mm - frame.point_mm;
            // d/ds of the tangential distance is kappa h - ... = -(1 + kappa h) for an outward normal.
            let rate = frame.arc_rate_mm_per_rad * (1.0 + frame.curvature_per_mm * d.dot(frame.normal));
            let step = d.dot(frame.tangent) / rate;
            phi += step;
            if step.abs() < 1e-13 {
                break;
            }
        }
        let frame = self.curve.frame(phi);
        ((point_mm - frame.point_mm).dot(frame.normal), phi)
    }

    /// Distance from a point inside along a unit direction to the outline, at most `limit_mm`; `start_mm` is a first guess.
    pub fn exit_mm(&self, point_mm: DVec2, direction: DVec2, phi_guess_rad: f64, start_mm: f64, limit_mm: f64) -> f64 {
        let mut t = start_mm.clamp(0.0, limit_mm);
        for _ in 0..20 {
            let (height, phi) = self.height(point_mm + t * direction, phi_guess_rad);
            let climb = direction.dot(self.curve.frame(phi).normal);
            if climb <= 0.0 && height < self.addendum_mm {
                return limit_mm;
            }
            let step = (self.addendum_mm - height) / climb.abs().max(0.05);
            t = (t + step).clamp(0.0, limit_mm);
            if step.abs() < 1e-9 || (t == limit_mm && step > 0.0) {
                break;
            }
        }
        t
    }
}
