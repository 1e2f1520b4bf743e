//! Thickness of a tooth on the pitch curve.

use super::crossing::Crossing;

/// Thickness of one finished tooth on the pitch curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thickness {
    /// Along the pitch curve, mm.
    pub arc_mm: f64,
    /// Straight, mm.
    pub chord_mm: f64,
}

impl Thickness {
    /// From where the left and the right flank of a tooth cross the pitch curve.
    pub fn between(left: Crossing, right: Crossing) -> Self {
        Self { arc_mm: left.arc_mm - right.arc_mm, chord_mm: left.point_mm.distance(right.point_mm) }
    }
}
