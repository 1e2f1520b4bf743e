//! The regular grid that maps are made on.
//!
//! In: two axes with names, meaning and spacing in mm. Out: the order of the values and their places.
//!
//! Values lie with v fastest: `index = u * v.count + v`. A map is mostly long along v and short along u, so that order
//! gives pictures and EXR rows as they are drawn: v to the right.

/// One axis of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapAxis {
    /// Short name, such as `v`.
    pub name: String,
    /// What it runs along, such as "along the tooth".
    pub meaning: String,
    /// Place of the first value, mm.
    pub start_mm: f64,
    /// Distance between values, mm; positive.
    pub step_mm: f64,
    /// Number of values.
    pub count: usize,
}

impl MapAxis {
    /// Place of value `index`, mm.
    pub fn place_mm(&self, index: usize) -> f64 {
        self.start_mm + self.step_mm * index as f64
    }

    /// Length that the cells cover, mm: half a step beyond the first and the last value.
    pub fn length_mm(&self) -> f64 {
        self.step_mm * self.count as f64
    }

    /// Outer edge of the first cell, mm.
    pub fn low_edge_mm(&self) -> f64 {
        self.start_mm - 0.5 * self.step_mm
    }

    fn is_sound(&self) -> bool {
        self.count > 0 && self.start_mm.is_finite() && self.step_mm.is_finite() && self.step_mm > 0.0
    }
}

/// Regular grid over a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct MapGrid {
    /// The slow axis, upward in pictures.
    pub u: MapAxis,
    /// The fast axis, to the right in pictures.
    pub v: MapAxis,
}

impl MapGrid {
    /// Number of values on the grid.
    pub fn count(&self) -> usize {
        self.u.count * self.v.count
    }

    /// Place (u, v) of value `index`, mm.
    pub fn place_mm(&self, index: usize) -> (f64, f64) {
        (self.u.place_mm(index / self.v.count), self.v.place_mm(index % self.v.count))
    }

    /// Why `values` values cannot lie on this grid, if they cannot.
    pub fn mismatch(&self, values: usize) -> Option<String> {
        if !self.u.is_sound() || !self.v.is_sound() {
            return Some("both axes of a map need at least one value and a positive spacing".to_owned());
        }
        (values != self.count())
            .then(|| format!("{values} values for a grid of {} x {} = {}", self.u.count, self.v.count, self.count()))
    }
}
