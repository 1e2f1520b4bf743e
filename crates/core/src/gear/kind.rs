//! On which side of the pitch curve the material of a gear lies.

/// External or internal gear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GearKind {
    /// Teeth point outwards; the material lies inside the pitch curve.
    #[default]
    External,
    /// Teeth point towards the axis; the material is a ring round the pitch curve.
    Internal,
}

impl GearKind {
    /// Direction of tooth tips along the outward normal of the pitch curve: +1 external, -1 internal.
    pub fn tip_sign(self) -> f64 {
        match self {
            Self::External => 1.0,
            Self::Internal => -1.0,
        }
    }

    /// `external` or `internal`.
    pub fn name(self) -> &'static str {
        match self {
            Self::External => "external",
            Self::Internal => "internal",
        }
    }
}
