//! A field of dexels whose rays stand anywhere in space: flanks of helical gears, where every row along the tooth has a
//! profile of its own.
//!
//! Columns follow each other along the profile, rows along the tooth, as in [`super::Field`]; but each dexel has its
//! own origin and direction. They lie component by component and row after row, as the kernels read them. Heights count
//! from the origin along the direction, in mm, positive where material is left; what a cut leaves is a [`Layer`] like
//! any other.

use super::{Layer, NO_PASS};
use glam::DVec3;

/// A ray of space in the gear frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Origin on the target, mm.
    pub origin_mm: DVec3,
    /// Unit direction out of the gear.
    pub normal: DVec3,
}

impl Ray {
    /// Point at a height.
    pub fn at(&self, height_mm: f64) -> DVec3 {
        self.origin_mm + height_mm * self.normal
    }
}

/// Rays over one flank.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialField {
    columns: usize,
    rows: usize,
    origins_mm: [Vec<f64>; 3],
    normals: [Vec<f64>; 3],
    /// Lowest height the rays can record (negative): deeper cuts are recorded as this value.
    pub low_mm: f64,
    /// Height of the blank's surface along every ray, column by column, mm.
    pub blank_mm: Vec<f32>,
}

impl SpatialField {
    /// Field of `columns` by `rows` rays; `ray(column, row)` gives each with the height of the blank's surface along
    /// it.
    pub fn new(columns: usize, rows: usize, low_mm: f64, mut ray: impl FnMut(usize, usize) -> (Ray, f64)) -> Self {
        let mut field = Self {
            columns,
            rows,
            origins_mm: [(); 3].map(|()| Vec::with_capacity(columns * rows)),
            normals: [(); 3].map(|()| Vec::with_capacity(columns * rows)),
            low_mm,
            blank_mm: Vec::with_capacity(columns * rows),
        };
        for column in 0..columns {
            for row in 0..rows {
                let (Ray { origin_mm, normal }, blank_mm) = ray(column, row);
                for (axis, values) in field.origins_mm.iter_mut().enumerate() {
                    values.push(origin_mm[axis]);
                }
                for (axis, values) in field.normals.iter_mut().enumerate() {
                    values.push(normal[axis]);
                }
                field.blank_mm.push(blank_mm as f32);
            }
        }
        field
    }

    /// Number of columns.
    #[inline]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Number of rows.
    #[inline]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of dexels.
    #[inline]
    pub fn len(&self) -> usize {
        self.blank_mm.len()
    }

    /// No dexel at all.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.blank_mm.is_empty()
    }

    /// Place of a dexel in layers and in the component lists.
    #[inline]
    pub fn index(&self, column: usize, row: usize) -> usize {
        column * self.rows + row
    }

    /// One ray.
    #[inline]
    pub fn ray(&self, column: usize, row: usize) -> Ray {
        let at = self.index(column, row);
        let vector = |lists: &[Vec<f64>; 3]| DVec3::new(lists[0][at], lists[1][at], lists[2][at]);
        Ray { origin_mm: vector(&self.origins_mm), normal: vector(&self.normals) }
    }

    /// One column alone.
    #[must_use]
    pub fn column(&self, column: usize) -> Self {
        Self::new(1, self.rows, self.low_mm, |_, row| {
            (self.ray(column, row), f64::from(self.blank_mm[self.index(column, row)]))
        })
    }

    /// Origins, component by component, mm.
    pub fn origins_mm(&self) -> &[Vec<f64>; 3] {
        &self.origins_mm
    }

    /// Directions, component by component.
    pub fn normals(&self) -> &[Vec<f64>; 3] {
        &self.normals
    }

    /// The uncut blank.
    pub fn blank_layer(&self) -> Layer {
        Layer { heights_mm: self.blank_mm.clone(), passes: vec![NO_PASS; self.len()] }
    }
}
