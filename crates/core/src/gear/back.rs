//! The round back of the stock: the surface opposite to its teeth.
//!
//! The stock lies between its toothed side, a curve that goes round the gear axis, and its back, a circle about that
//! axis: the bore of an external gear, the outer surface of a ring with internal teeth. Everything that must know on
//! which side of a curve the material lies asks here.

use super::GearKind;
use std::f64::consts::PI;

/// Circle about the gear axis that ends the stock away from the teeth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Back {
    /// On which side of it the material lies: outside a bore, inside the circle round a ring.
    pub kind: GearKind,
    /// Radius, mm; 0 for an external gear without a bore.
    pub radius_mm: f64,
}

impl Back {
    /// The bore of an external gear; 0 for none.
    pub fn bore(radius_mm: f64) -> Self {
        Self { kind: GearKind::External, radius_mm }
    }

    /// The outside of a ring with internal teeth.
    pub fn ring(radius_mm: f64) -> Self {
        Self { kind: GearKind::Internal, radius_mm }
    }

    /// `bore` or `rim`: its name in meshes.
    pub fn name(&self) -> &'static str {
        match self.kind {
            GearKind::External => "bore",
            GearKind::Internal => "rim",
        }
    }

    /// Half of the chord that it cuts from a line so far from the axis, mm; 0 on lines that pass by.
    pub fn half_chord_mm(&self, line_mm: f64) -> f64 {
        (self.radius_mm * self.radius_mm - line_mm * line_mm).max(0.0).sqrt()
    }

    /// Section of the stock between it and a closed curve round the axis, from the area that the curve encloses, mm2.
    pub fn section_mm2(&self, enclosed_mm2: f64) -> f64 {
        self.kind.tip_sign() * (enclosed_mm2 - PI * self.radius_mm * self.radius_mm)
    }
}
