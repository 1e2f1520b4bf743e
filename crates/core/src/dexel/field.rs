//! A field of dexels over one flank (or root) of the gear, and what an operation leaves on it.
//!
//! Columns follow each other along the profile; every column is a ray in the transverse plane, repeated at each row
//! along the tooth. Any origins and directions are allowed: the regular flank grid, the root fillet and odd inspection
//! rays are the same type. Heights are measured along the ray from its origin (on the target), in mm, positive where
//! material is left.

use glam::DVec2;

/// Id of "no pass": the blank's own surface.
pub const NO_PASS: u32 = u32::MAX;

/// One ray of the transverse plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// Arc length along the profile, mm.
    pub arc_mm: f64,
    /// Origin on the target, gear frame.
    pub origin_mm: DVec2,
    /// Unit direction out of the gear.
    pub normal: DVec2,
    /// Lowest height the ray can record (negative): deeper cuts are recorded as this value and counted.
    pub low_mm: f64,
    /// Height of the blank's surface along the ray.
    pub blank_mm: f64,
}

/// Rays over one flank or root.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Rays along the profile.
    pub columns: Vec<Column>,
    /// Places along the tooth, from the middle of the face, mm, increasing.
    pub rows_z_mm: Vec<f64>,
}

/// Heights and pass ids, column by column (rows contiguous).
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Height: normal deviation from the target, mm.
    pub heights_mm: Vec<f32>,
    /// Pass that left it, or [`NO_PASS`].
    pub passes: Vec<u32>,
}

impl Field {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows_z_mm.len()
    }

    /// Places of the columns along the profile, mm.
    pub fn arcs_mm(&self) -> Vec<f64> {
        self.columns.iter().map(|column| column.arc_mm).collect()
    }

    /// Number of dexels.
    pub fn len(&self) -> usize {
        self.columns.len() * self.rows()
    }

    /// No dexel at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The uncut blank.
    pub fn blank_layer(&self) -> Layer {
        let rows = self.rows();
        let heights_mm = self.columns.iter().flat_map(|c| std::iter::repeat_n(c.blank_mm as f32, rows)).collect();
        Layer { heights_mm, passes: vec![NO_PASS; self.len()] }
    }

    /// The same rays at some columns and rows alone.
    #[must_use]
    pub fn at(&self, [columns, rows]: [&[usize]; 2]) -> Self {
        Self {
            columns: columns.iter().map(|&column| self.columns[column]).collect(),
            rows_z_mm: rows.iter().map(|&row| self.rows_z_mm[row]).collect(),
        }
    }

    /// Circle round all rays of some columns between their lowest and their blank height: centre and radius.
    pub fn circle(columns: &[Column]) -> (DVec2, f64) {
        let ends = |c: &Column| [c.origin_mm + c.low_mm * c.normal, c.origin_mm + c.blank_mm * c.normal];
        let points = columns.iter().flat_map(ends);
        let low = points.clone().reduce(DVec2::min).unwrap_or_default();
        let high = points.clone().reduce(DVec2::max).unwrap_or_default();
        let center = 0.5 * (low + high);
        (center, points.map(|p| p.distance(center)).fold(0.0, f64::max))
    }
}

impl Layer {
    /// The layer of a field with so many rows, all of them like the one row of this.
    #[must_use]
    pub fn repeated(&self, rows: usize) -> Self {
        Self {
            heights_mm: self.heights_mm.iter().flat_map(|&height| std::iter::repeat_n(height, rows)).collect(),
            passes: self.passes.iter().flat_map(|&pass| std::iter::repeat_n(pass, rows)).collect(),
        }
    }

    /// Heights of one column.
    pub fn column(&self, column: usize, rows: usize) -> &[f32] {
        &self.heights_mm[column * rows..(column + 1) * rows]
    }
}
