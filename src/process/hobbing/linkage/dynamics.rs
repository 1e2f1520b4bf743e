//! A hobbing machine's six axes over time: hob, work, tangential (X), radial (Y with the infeed), slide, shift.
//!
//! In: a linkage and the axis limits. Out: the linkage as a [`Motion`] in time. Rates follow from the feeds and from
//! the place on the pitch curve: within a piece of constant feeds they repeat with every cycle along it, and two
//! pieces with the same feeds move alike wherever they go over the same part of the curve. So each feed is searched
//! once in every place: a piece is left out where others with its feeds have shown all that it goes over
//! (`ShownArcs`). Rates jump between pieces; the infinite acceleration there is left to the control.

use super::{HobbingAxes, HobbingLinkage};
use crate::machine::{Axis, AxisKind, AxisMotion, Limits, Motion, MotionPiece};
use crate::process::hobbing::scene::model::HobbingAxisLimits;
use gearcut_core::math::Jet;

/// A piece shows this many cycles at most: one, and a tenth for humps that lie across its ends.
const SHOWN_CYCLES: f64 = 1.1;
/// Arcs that differ by less are one, in perimeters: rounding, far below a cell of the search.
const SAME_ARC: f64 = 1e-9;

/// The axes.
pub const AXES: [Axis; 6] = [
    Axis::new("hob spindle", "hob", 'B', AxisKind::Rotary),
    Axis::new("work spindle", "work", 'C', AxisKind::Rotary),
    Axis::new("X tangential", "x", 'X', AxisKind::Linear).called("tangential axis"),
    Axis::new("Y radial", "y", 'Y', AxisKind::Linear).called("radial axis"),
    Axis::new("Z slide", "slide", 'Z', AxisKind::Linear).called("slide").at_constant_feed(),
    Axis::new("shift", "shift", 'W', AxisKind::Linear).at_constant_feed(),
];

/// A scene's limits in the order of [`AXES`].
pub fn limits(of: &HobbingAxisLimits) -> [Limits; 6] {
    std::array::from_fn(|axis| Limits { speed: of.speeds[axis], acceleration: of.accelerations[axis] })
}

/// Axes in the order of [`AXES`].
pub fn in_order<const N: usize>(axes: &HobbingAxes<N>) -> [Jet<N>; 6] {
    [axes.hob_rad, axes.work_rad, axes.x_mm, axes.y_mm + axes.radial_mm, axes.slide_mm, axes.shift_mm]
}

/// All axes where their series are known.
pub fn motion(axes: &HobbingAxes<3>) -> [AxisMotion; 6] {
    in_order(axes).map(|series| AxisMotion::along(series, 1.0))
}

/// Over time, s.
impl Motion<6> for HobbingLinkage {
    const AXES: &'static [Axis; 6] = &AXES;

    fn at(&self, time_s: f64) -> [AxisMotion; 6] {
        motion(&self.axes(time_s))
    }

    fn pieces(&self) -> Vec<MotionPiece> {
        let cells = self.curve().samples_per_turn().clamp(256, 2048);
        let perimeter_mm = self.curve().perimeter_mm();
        let mut shown: Vec<([f64; 3], ShownArcs)> = Vec::new();
        let mut pieces = Vec::new();
        for ends in self.corners_s().windows(2) {
            let from = ends[0];
            let to = ends[1].min(from + SHOWN_CYCLES * self.cycle_s()) * (1.0 - 1e-12);
            let axes = self.axes::<2>(from);
            let feeds = [axes.slide_mm, axes.shift_mm, axes.radial_mm].map(|axis| axis.derivative(1));
            let arc = [from, to].map(|time_s| self.axes::<1>(time_s).arc_mm.value() / perimeter_mm);
            let at = shown.iter().position(|(others, _)| *others == feeds).unwrap_or_else(|| {
                shown.push((feeds, ShownArcs::default()));
                shown.len() - 1
            });
            if shown[at].1.add(arc) {
                pieces.push(MotionPiece { from, to, cells });
            }
        }
        pieces
    }
}

/// Arcs of the pitch curve that have been searched, in perimeters: parts of 0 to 1.
#[derive(Debug, Default)]
struct ShownArcs(Vec<[f64; 2]>);

impl ShownArcs {
    /// Adds the arc from `from` on to `to`, over the curve's beginning as often as it goes; says whether it has shown
    /// anything new.
    fn add(&mut self, [from, to]: [f64; 2]) -> bool {
        let start = from.rem_euclid(1.0);
        let end = start + (to - from).min(1.0);
        let parts = [[start, end.min(1.0)], [0.0, end - 1.0]];
        let parts = parts.into_iter().filter(|[from, to]| to - from > SAME_ARC);
        // What none of the arcs that were shown before covers.
        let mut new: Vec<[f64; 2]> = parts.collect();
        for &[low, high] in &self.0 {
            new = new
                .into_iter()
                .flat_map(|[from, to]| [[from, to.min(low)], [from.max(high), to]])
                .filter(|[from, to]| to - from > SAME_ARC)
                .collect();
        }
        self.0.extend(&new);
        !new.is_empty()
    }
}
