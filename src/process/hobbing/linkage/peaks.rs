//! Largest speeds and accelerations of the six axes.
//!
//! In: a linkage. Out: [`HobbingPeaks`] in the order hob, work, tangential (X), radial (Y with the infeed), slide,
//! shift. Within a stretch of constant feeds the rates repeat with every cycle along the pitch curve, so one cycle of
//! each stretch is searched. Rates jump between stretches; the infinite acceleration there is left to the control.

use super::{HobbingAxes, HobbingLinkage};
use crate::machine::Peak;
use crate::math::Jet;
use crate::math::extremum::maximum;
use crate::process::hobbing::scene::model::HobbingAxisLimits;

/// Stretches with the same feeds are searched once; so many different ones are looked at.
const MOST_STRETCHES: usize = 64;

/// Peaks of all axes; `stroke` of a [`Peak`] is the time in s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HobbingPeaks {
    /// Speeds, rad/s or mm/s.
    pub speeds: [Peak; 6],
    /// Accelerations, rad/s^2 or mm/s^2.
    pub accelerations: [Peak; 6],
}

/// Axes in the order of limits and peaks.
pub fn in_order<const N: usize>(axes: &HobbingAxes<N>) -> [Jet<N>; 6] {
    [axes.hob_rad, axes.work_rad, axes.x_mm, axes.y_mm + axes.radial_mm, axes.slide_mm, axes.shift_mm]
}

/// Peaks over a whole operation.
pub fn peaks(linkage: &HobbingLinkage, limits: &HobbingAxisLimits) -> HobbingPeaks {
    let corners = linkage.corners_s();
    let cells = linkage.curve().samples_per_turn().clamp(256, 2048);
    let pieces: Vec<[f64; 2]> = corners
        .windows(2)
        .take(MOST_STRETCHES)
        .map(|c| [c[0], c[1].min(c[0] + 1.1 * linkage.cycle_s()) * (1.0 - 1e-12)])
        .collect();
    let peak = |axis: usize, order: usize, limit: Option<f64>| {
        let value = |t: f64| in_order(&linkage.axes::<3>(t))[axis].derivative(order).abs();
        let best = pieces.iter().map(|[from, to]| maximum(value, *from, *to, cells));
        let (stroke, value) = best.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0.0, 0.0));
        Peak { value, stroke, limit }
    };
    HobbingPeaks {
        speeds: std::array::from_fn(|axis| peak(axis, 1, limits.speeds[axis])),
        accelerations: std::array::from_fn(|axis| peak(axis, 2, limits.accelerations[axis])),
    }
}
