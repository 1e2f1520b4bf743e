//! The chip with which every place of a flank got its surface.

/// The last chips on a field after one operation, column by column (rows contiguous).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LastChips {
    /// Uncut chip thickness, mm; NaN where no pass came.
    pub thickness_mm: Vec<f32>,
    /// Part of the edge: 0 none, 1 right, 2 tip, 3 left.
    pub sides: Vec<u32>,
    /// The pass; [`gearcut_core::dexel::NO_PASS`] where none came.
    pub passes: Vec<u32>,
}
