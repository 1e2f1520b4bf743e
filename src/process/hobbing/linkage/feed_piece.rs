//! Pieces of constant feeds: how the rolling runs in time within each of them.
//!
//! In: a linkage's law, the state at the beginning of a piece and its feeds. Out: [`FeedPiece`], and the polar angle
//! and the extra rotation as printed at a time of it. Where the law keeps an angle even, time is an integral over the
//! polar angle.

use super::HobbingLinkage;
use crate::process::hobbing::scene::model::{EvenMotion, ExtraRotation, LinkageForm};
use gearcut_core::error::Refusal;
use gearcut_core::math::Jet;
use gearcut_core::math::periodic_integral::PeriodicIntegral;
use std::f64::consts::PI;
use std::sync::Arc;

/// Accuracy of the time integrals, s: 1e-10 mm at a metre per second.
const TIME_ACCURACY_S: f64 = 1e-13;

/// One piece of the feed path with the state at its beginning.
#[derive(Debug, Clone)]
pub(super) struct FeedPiece {
    pub start_s: f64,
    /// Slide, shift, radial: value at the beginning and rate.
    pub slide: [f64; 2],
    pub shift: [f64; 2],
    pub radial: [f64; 2],
    /// s at the beginning.
    pub arc_mm: f64,
    /// What follows s from time.
    pub clock: Clock,
    /// As printed: extra rotation at the beginning, rate times radius, and the integral of time over radius.
    pub drift: Option<Drift>,
}

/// From time to the place on the pitch curve.
#[derive(Debug, Clone)]
pub(super) enum Clock {
    /// Arc at a constant rate, mm/s.
    Arc(f64),
    /// Time is an integral over theta; value at the beginning.
    Polar(Arc<PeriodicIntegral>, f64),
}

/// Extra rotation as printed: rate / r, integrated over theta.
#[derive(Debug, Clone)]
pub(super) struct Drift {
    pub start_rad: f64,
    pub rate_mm_per_s: f64,
    pub integral: Arc<PeriodicIntegral>,
    pub start_integral: f64,
}

impl HobbingLinkage {
    pub(super) fn piece(
        &self,
        start_s: f64,
        [slide, shift, radial]: [f64; 3],
        [slide_rate, shift_rate, radial_rate]: [f64; 3],
        arc_mm: f64,
        drift_rad: f64,
    ) -> Result<FeedPiece, Refusal> {
        let g = &self.geometry;
        let printed = self.is_printed();
        let from_shift = g.arc_per_shift() * shift_rate;
        let from_slide = g.arc_per_slide() * slide_rate;
        let extra_mm_per_s = match self.law.extra {
            ExtraRotation::Hob => 0.0,
            ExtraRotation::Work if printed => from_shift,
            ExtraRotation::Work => from_shift + from_slide,
        };
        let rate = |theta: f64| self.polar_rate(theta, extra_mm_per_s).value();
        let backwards = |why: String| {
            Refusal::new(
                "operation.axial_feed_mm_per_revolution",
                format!(
                    "the feeds' share of the rolling is faster than the rolling itself, or the pitch curve is not \
convex where the law needs it: {why}"
                ),
                "use smaller feeds; on a pitch curve with hollows keep the arc even (basis = \"arc_length\")",
            )
        };
        let clock = match self.law.even {
            EvenMotion::ArcLength => {
                let arc_rate = self.curve.perimeter_mm() / self.cycle_s + extra_mm_per_s;
                if arc_rate <= 0.0 {
                    return Err(backwards(format!("the arc would grow by {arc_rate} mm/s")));
                }
                Clock::Arc(arc_rate)
            }
            EvenMotion::RotationAngle | EvenMotion::PolarAngle => {
                let integral = self.integral(|theta| 1.0 / rate(theta)).map_err(backwards)?;
                let start = integral.at(self.curve.phi_at_arc(arc_mm));
                Clock::Polar(Arc::new(integral), start)
            }
        };
        let drift = if printed {
            let integral =
                self.integral(|theta| 1.0 / (rate(theta) * self.curve.radius(theta).value())).map_err(backwards)?;
            let resultant = slide_rate + shift_rate * g.head_angle_rad.sin();
            Some(Drift {
                start_rad: drift_rad,
                rate_mm_per_s: g.arc_per_slide() * resultant,
                start_integral: integral.at(self.curve.phi_at_arc(arc_mm)),
                integral: Arc::new(integral),
            })
        } else {
            None
        };
        Ok(FeedPiece {
            start_s,
            slide: [slide, slide_rate],
            shift: [shift, shift_rate],
            radial: [radial, radial_rate],
            arc_mm,
            clock,
            drift,
        })
    }

    fn integral(&self, f: impl Fn(f64) -> f64) -> Result<PeriodicIntegral, String> {
        let panels = (self.curve.samples_per_turn() / 8).max(16);
        PeriodicIntegral::new(f, &self.curve.breaks_rad(), panels, TIME_ACCURACY_S).map_err(|why| why.to_string())
    }

    /// Whether the printed form differs from the exact one: it does where the work carries the extra rotation.
    fn is_printed(&self) -> bool {
        self.law.form == LinkageForm::AsPrinted && self.law.extra == ExtraRotation::Work
    }

    /// d theta / dt at `theta` with one derivative, when feeds add `extra_mm_per_s` to the rolling.
    pub(super) fn polar_rate(&self, theta: f64, extra_mm_per_s: f64) -> Jet<2> {
        let radius = self.curve.radius(theta);
        let r = radius.truncate::<2>();
        let dr = radius.differentiate::<2>();
        let d2r = radius.differentiate::<3>().differentiate::<2>();
        let square = r * r + dr * dr;
        let per_arc = square.sqrt().recip();
        let even = match self.law.even {
            EvenMotion::ArcLength => per_arc * (self.curve.perimeter_mm() / self.cycle_s),
            EvenMotion::RotationAngle => {
                // d theta / d phi, Liu et al. 2013, Eq. 5.
                let turn = square / (square + dr * dr - r * d2r);
                turn * (2.0 * PI / self.cycle_s)
            }
            EvenMotion::PolarAngle => Jet::constant(2.0 * PI / self.cycle_s),
        };
        even + per_arc * extra_mm_per_s
    }

    /// theta and printed extra rotation at a time of a piece.
    pub(super) fn polar_and_drift(&self, piece: &FeedPiece, time_s: f64) -> [f64; 2] {
        let passed = time_s - piece.start_s;
        let theta = match &piece.clock {
            Clock::Arc(rate) => self.curve.phi_at_arc(piece.arc_mm + rate * passed),
            Clock::Polar(integral, start) => integral.angle_at(start + passed),
        };
        let drift = piece
            .drift
            .as_ref()
            .map_or(0.0, |d| d.start_rad + d.rate_mm_per_s * (d.integral.at(theta) - d.start_integral));
        [theta, drift]
    }
}
