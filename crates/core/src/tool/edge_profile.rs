//! Profiles of segments as analytic functions: x over y, in the frame of the segment's chord.
//!
//! In: an involute, a straight line or any smooth curve of the blade. Out: x and slope at a y, from which the table of
//! a segment is fitted ([`super::edge_table`]). Newton's method finds the parameter of the curve that belongs to a y.

use super::involute::Involute;
use crate::error::NotConverged;
use crate::frame::Rigid2;
use crate::math::newton::{LastStep, newton};
use glam::DVec2;

/// Newton steps to a place of a profile at most. They go on until rounding alone moves the place, which is then known
/// to [`SETTLED`], as a share of one plus the parameter.
const PROFILE_STEPS: u32 = 50;
const SETTLED: f64 = 1e-12;

/// x over y of a segment in its own frame.
pub trait EdgeProfile {
    /// x in mm and dx/dy at `y_mm`.
    ///
    /// # Errors
    /// The place with this y is not found.
    fn x_and_slope(&self, y_mm: f64) -> Result<[f64; 2], NotConverged>;
}

/// Part of an involute as a profile over its chord.
pub(super) struct InvoluteProfile {
    involute: Involute,
    segment_from_blade: Rigid2,
    roll_range: [f64; 2],
    /// y at the ends of the range.
    y_range_mm: [f64; 2],
}

impl InvoluteProfile {
    pub(super) fn new(involute: Involute, segment_from_blade: Rigid2, roll_range: [f64; 2]) -> Self {
        let y_range_mm = roll_range.map(|u| segment_from_blade.point(involute.point(u)).y);
        Self { involute, segment_from_blade, roll_range, y_range_mm }
    }
}

impl EdgeProfile for InvoluteProfile {
    fn x_and_slope(&self, y_mm: f64) -> Result<[f64; 2], NotConverged> {
        // dp/du = r_b u e(u), e the direction to the base circle's contact point: Newton on y(u) from the chord's share
        // of u^2.
        let ([u0, u1], [y0, y1]) = (self.roll_range, self.y_range_mm);
        let y_at = |u: f64| self.segment_from_blade.point(self.involute.point(u)).y;
        let start = (u0 * u0 + (u1 * u1 - u0 * u0) * (y_mm - y0) / (y1 - y0)).max(0.25 * u0 * u0).sqrt();
        let mut tangent = DVec2::Y;
        let last = LastStep { absolute: 1e-16, relative: 1e-15 };
        let u = newton("the roll of an involute's point", start, last, PROFILE_STEPS, |u| {
            let along = -self.involute.side * self.segment_from_blade.direction(self.involute.normal(u)).perp();
            tangent = along;
            let missing_mm = y_mm - y_at(u);
            let step = missing_mm / (self.involute.base_radius_mm * u * along.y);
            // The involute begins at roll 0.
            [missing_mm, if step < -0.5 * u { -0.5 * u } else { step }]
        })
        .or_else(|error| error.settled(SETTLED * (1.0 + error.last.abs())))?;
        Ok([self.segment_from_blade.point(self.involute.point(u)).x, tangent.x / tangent.y])
    }
}

/// A smooth curve in the blade frame over a parameter, nearly proportional to the place along its chord.
pub trait BladeCurve {
    /// Point (mm) and derivative with respect to the parameter.
    fn point_and_rate(&self, parameter: f64) -> [DVec2; 2];
}

/// Part of a [`BladeCurve`] as a profile over its chord.
pub(super) struct CurveProfile<'a, C> {
    pub curve: &'a C,
    pub segment_from_blade: Rigid2,
    pub range: [f64; 2],
}

impl<C: BladeCurve> EdgeProfile for CurveProfile<'_, C> {
    fn x_and_slope(&self, y_mm: f64) -> Result<[f64; 2], NotConverged> {
        let at = |w: f64| {
            let [point, rate] = self.curve.point_and_rate(w);
            [self.segment_from_blade.point(point), self.segment_from_blade.direction(rate)]
        };
        let ([w0, w1], [y0, y1]) = (self.range, self.range.map(|w| at(w)[0].y));
        let start = w0 + (w1 - w0) * (y_mm - y0) / (y1 - y0);
        let w = newton("the parameter of a profile's point", start, LastStep::relative(1e-15), PROFILE_STEPS, |w| {
            let [point, rate] = at(w);
            [y_mm - point.y, (y_mm - point.y) / rate.y]
        })
        .or_else(|error| error.settled(SETTLED * (1.0 + error.last.abs())))?;
        let [point, rate] = at(w);
        Ok([point.x, rate.x / rate.y])
    }
}

/// The chord itself.
pub(super) struct StraightProfile;

impl EdgeProfile for StraightProfile {
    fn x_and_slope(&self, _y_mm: f64) -> Result<[f64; 2], NotConverged> {
        Ok([0.0, 0.0])
    }
}
