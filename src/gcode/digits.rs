//! How many digits a program needs.

use crate::machine::AxisKind;

/// Share of the contour error that rounding of the written digits may take, for each axis.
const ROUNDING_SHARE: f64 = 0.05;

/// Digits after the point that keep rounding far below the contour error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Digits {
    /// Of angles in degrees.
    pub angle: usize,
    /// Of lengths in mm.
    pub length: usize,
}

impl Digits {
    /// Digits for a contour error where points up to `reach_mm` from an axis matter.
    pub fn new(contour_error_mm: f64, reach_mm: f64) -> Self {
        let step_mm = 2.0 * ROUNDING_SHARE * contour_error_mm;
        let digits = |step: f64| (-step.log10()).ceil().clamp(3.0, 12.0) as usize;
        Self { angle: digits((step_mm / reach_mm).to_degrees()), length: digits(step_mm) }
    }

    /// No more digits than a control takes.
    #[must_use]
    pub fn at_most(self, most: usize) -> Self {
        Self { angle: self.angle.min(most), length: self.length.min(most) }
    }

    /// Of positions of an axis.
    pub fn of(self, kind: AxisKind) -> usize {
        match kind {
            AxisKind::Rotary => self.angle,
            AxisKind::Linear => self.length,
        }
    }

    /// A position, rad or mm, as a reader of its digits takes it back.
    pub fn rounded(self, kind: AxisKind, position: f64) -> f64 {
        kind.read(Self::round(kind.shown(position), self.of(kind)))
    }

    /// A value as it is written.
    pub fn round(value: f64, digits: usize) -> f64 {
        let scale = 10_f64.powf(digits as f64);
        (value * scale).round() / scale
    }
}
