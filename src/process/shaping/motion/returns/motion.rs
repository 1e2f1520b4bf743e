//! What retraction asks of the machine's axes: travel, speed, acceleration, and the time that it takes.
//!
//! In: a schedule, a retraction plan that the axes carry out, the ram's travel, the axis limits. Out:
//! [`RetractionMotion`]. Law: the axes may move while the ram is outside the face. With the length L of approach,
//! face and overrun and the middle of the stroke z_m, the ram is at a place z at theta = arccos(2 (z - z_m) / L)
//! and at 2 pi - theta; below the face it stays for 1 - theta(-B/2) / pi of a double stroke, above it for theta(B/2) /
//! pi. In the shorter of the two, T, an axis travels s from rest to rest, half of it speeding up evenly and half
//! slowing down:
//!
//! ```text
//! speed 2 s / T        acceleration 4 s / T^2
//! ```
//!
//! Limits v and a of an axis ask for T >= 2 s / v and T >= 2 sqrt(s / a). Where the ram leaves less time, the double
//! stroke has to last longer in the same proportion: that is what the retraction costs. The travel of the feed is not
//! in it; it goes on in the return stroke beside.
//!
//! A relief mechanism of the machine's own, driven by the ram, draws back along the line of centres and costs nothing.

use super::plan::RetractionPlan;
use crate::machine::Limits;
use crate::process::shaping::linkage::{CutterPose, StrokeSchedule, StrokeState};
use glam::DVec2;
use std::f64::consts::TAU;

/// When the ram passes the ends of the face, in double strokes from the moment when it cuts the middle of the face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RamTimes {
    /// The cutting stroke leaves the face.
    pub cut_ends: f64,
    /// The return stroke enters it.
    pub return_begins: f64,
    /// The return stroke passes the middle of the face.
    pub return_middle: f64,
    /// The return stroke leaves it.
    pub return_ends: f64,
    /// The return stroke ends, and the next cutting stroke begins.
    pub top: f64,
    /// The next cutting stroke enters it.
    pub next_begins: f64,
}

impl RamTimes {
    /// Of a ram with these travels, mm.
    pub fn new(face_width_mm: f64, approach_mm: f64, overrun_mm: f64) -> Self {
        let length_mm = approach_mm + face_width_mm + overrun_mm;
        let middle_mm = 0.5 * (approach_mm - overrun_mm);
        let angle = |z_mm: f64| (2.0 * (z_mm - middle_mm) / length_mm).clamp(-1.0, 1.0).acos();
        let [middle, bottom, top] = [0.0, -0.5 * face_width_mm, 0.5 * face_width_mm].map(angle);
        Self {
            cut_ends: (bottom - middle) / TAU,
            return_begins: (TAU - bottom - middle) / TAU,
            return_middle: (TAU - 2.0 * middle) / TAU,
            return_ends: (TAU - top - middle) / TAU,
            top: (TAU - middle) / TAU,
            next_begins: (TAU + top - middle) / TAU,
        }
    }

    /// The shorter stay outside the face, in double strokes.
    pub fn shortest_stay(&self) -> f64 {
        (self.return_begins - self.cut_ends).min(self.next_begins - self.return_ends)
    }
}

/// Axis positions of the cutter drawn back from a stroke: work angle, cutter angle, centre distance, on the turn on
/// which the stroke has them.
pub fn axes_of(stroke: &StrokeState, retracted: &CutterPose) -> [f64; 3] {
    // By both sine and cosine: an angle by its cosine alone is off by 1e-8 rad near zero.
    let from = DVec2::from_angle(stroke.psi_c_rad);
    let moved_rad = from.perp_dot(retracted.center_mm).atan2(from.dot(retracted.center_mm));
    let turned_rad = retracted.angle_rad - stroke.pose.angle_rad;
    [stroke.psi_c_rad + moved_rad, stroke.psi_b_rad + turned_rad - moved_rad, retracted.center_mm.length()]
}

/// What one axis has to do for the retraction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AddedMotion {
    /// Largest travel, rad or mm, and the stroke that has it.
    pub travel: f64,
    /// That stroke.
    pub stroke: usize,
    /// Largest speed, per s; infinite where the ram leaves no time.
    pub speed: f64,
    /// Largest acceleration, per s^2.
    pub acceleration: f64,
}

/// What the retraction of an operation asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RetractionMotion {
    /// Each axis, in the order of [`crate::process::shaping::linkage::dynamics::AXES`].
    pub axes: [AddedMotion; 3],
    /// Time outside the face at each end of the stroke, s.
    pub time_s: f64,
    /// Time that the axis limits ask for, s; `None` where no limit is given.
    pub needed_s: Option<f64>,
    /// Strokes in which the cutter is turned.
    pub turned_strokes: usize,
}

impl RetractionMotion {
    /// Of a schedule whose return strokes follow a plan; `None` where the machine's own relief draws back.
    pub fn new(schedule: &StrokeSchedule, plan: &RetractionPlan, ram: &RamTimes, limits: &[Limits; 3]) -> Option<Self> {
        if !plan.is_in_axes() {
            return None;
        }
        let time_s = ram.shortest_stay() * schedule.time_s(1.0);
        let mut axes = [AddedMotion { travel: 0.0, stroke: 0, speed: 0.0, acceleration: 0.0 }; 3];
        let mut turned_strokes = 0;
        for stroke in 0..schedule.count() {
            let state = schedule.state(stroke as f64);
            let back = plan.retracted(schedule.linkage(), &state.pose, state.phi_rad);
            turned_strokes += usize::from((back.angle_rad - state.pose.angle_rad).abs() > 0.0);
            let here = [state.psi_c_rad, state.psi_b_rad, state.center_distance_mm];
            for ((axis, there), here) in axes.iter_mut().zip(axes_of(&state, &back)).zip(here) {
                let travel = (there - here).abs();
                if travel > axis.travel {
                    (axis.travel, axis.stroke) = (travel, stroke);
                }
            }
        }
        for axis in &mut axes {
            if axis.travel > 0.0 {
                (axis.speed, axis.acceleration) = (2.0 * axis.travel / time_s, 4.0 * axis.travel / (time_s * time_s));
            }
        }
        let needs = axes.iter().zip(limits).flat_map(|(axis, limits)| {
            let by_speed = limits.speed.map(|speed| 2.0 * axis.travel / speed);
            let by_acceleration = limits.acceleration.map(|most| 2.0 * (axis.travel / most).sqrt());
            [by_speed, by_acceleration].into_iter().flatten()
        });
        Some(Self { axes, time_s, needed_s: needs.reduce(f64::max), turned_strokes })
    }

    /// Factor by which the double stroke has to last longer; `None` where no limit is given.
    pub fn slowdown(&self) -> Option<f64> {
        self.needed_s.map(|needed_s| (needed_s / self.time_s).max(1.0))
    }
}
