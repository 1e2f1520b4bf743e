//! How the offset falls to its final value from stroke to stroke.
//!
//! In: the scene's infeed. Out: the offset (mm) and its slope as a piecewise linear function of the stroke, and how
//! many strokes plunge before the rolling begins. Law: every plunging stroke takes the same depth, every rolling stroke
//! of the infeed takes the same depth; the offset runs along the direction of the linkage.

use crate::process::shaping::scene::model::Infeed;
use gearcut_core::math::Jet;

/// Offset against stroke.
#[derive(Debug, Clone, Copy)]
pub(super) struct InfeedPlan {
    /// Offset when all infeed is done.
    final_offset_mm: f64,
    plunge_depth_mm: f64,
    plunge_strokes: f64,
    roll_depth_mm: f64,
    roll_strokes: f64,
}

impl InfeedPlan {
    /// Plan for an infeed; `strokes_over` gives the number of rolling strokes over a work angle from the start.
    pub(super) fn new(infeed: Infeed, final_offset_mm: f64, strokes_over: impl Fn(f64) -> f64) -> Self {
        let (plunge_depth_mm, strokes, roll_depth_mm, angle_rad) = match infeed {
            Infeed::None => (0.0, 0, 0.0, 0.0),
            Infeed::Plunge { depth_mm, strokes } => (depth_mm, strokes, 0.0, 0.0),
            Infeed::Spiral { depth_mm, angle_rad } => (0.0, 0, depth_mm, angle_rad),
            Infeed::PlungeAndRoll { plunge_depth_mm, strokes, roll_depth_mm, angle_rad } => {
                (plunge_depth_mm, strokes, roll_depth_mm, angle_rad)
            }
        };
        let roll_strokes = if angle_rad > 0.0 { strokes_over(angle_rad) } else { 0.0 };
        Self { final_offset_mm, plunge_depth_mm, plunge_strokes: f64::from(strokes), roll_depth_mm, roll_strokes }
    }

    /// Strokes before the rolling begins.
    pub(super) fn plunge_strokes(&self) -> usize {
        self.plunge_strokes as usize
    }

    /// Offset (mm) against the stroke coordinate, with its slope to the right.
    pub(super) fn offset(&self, stroke: f64) -> Jet<3> {
        if self.plunge_strokes > 0.0 && stroke < self.plunge_strokes {
            let left = 1.0 - stroke / self.plunge_strokes;
            let offset_mm = self.final_offset_mm + self.roll_depth_mm + self.plunge_depth_mm * left;
            return Jet::linear(offset_mm, -self.plunge_depth_mm / self.plunge_strokes);
        }
        let rolled = stroke - self.plunge_strokes;
        if rolled < 0.0 {
            return Jet::constant(self.final_offset_mm + self.roll_depth_mm);
        }
        if rolled < self.roll_strokes {
            let left = 1.0 - rolled / self.roll_strokes;
            let slope = -self.roll_depth_mm / self.roll_strokes;
            return Jet::linear(self.final_offset_mm + self.roll_depth_mm * left, slope);
        }
        Jet::constant(self.final_offset_mm)
    }

    /// Strokes (coordinates) at which the slope of the offset jumps.
    pub(super) fn corners(&self) -> [f64; 2] {
        [self.plunge_strokes, self.plunge_strokes + self.roll_strokes]
    }

    /// Largest offset of any stroke from 0 on, mm.
    pub(super) fn largest_offset_mm(&self) -> f64 {
        self.final_offset_mm + self.roll_depth_mm.max(0.0) + self.plunge_depth_mm.max(0.0)
    }
}
