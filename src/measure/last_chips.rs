//! The chip with which every place of a flank got its surface.

use gearcut_core::dexel::NO_PASS;

/// The last chips on a field after one operation, column by column (rows contiguous).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LastChips {
    /// Uncut chip thickness, mm; NaN where no pass came.
    pub thickness_mm: Vec<f32>,
    /// Part of the edge: 0 none, 1 right, 2 tip, 3 left.
    pub sides: Vec<u8>,
    /// The pass; [`NO_PASS`] where none came.
    pub passes: Vec<u32>,
}

impl LastChips {
    /// Nothing yet, with room for so many places.
    pub fn with_capacity(places: usize) -> Self {
        Self {
            thickness_mm: Vec::with_capacity(places),
            sides: Vec::with_capacity(places),
            passes: Vec::with_capacity(places),
        }
    }

    /// So many places that no pass came to.
    pub fn none(places: usize) -> Self {
        Self { thickness_mm: vec![f32::NAN; places], sides: vec![0; places], passes: vec![NO_PASS; places] }
    }
}
