//! Rays of a surface with the places of their columns and rows on it: what grids of surfaces are made of.
//!
//! In: rays. Out: points and normals in space, whatever the gear. Gears whose rows stand in transverse sections
//! ([`Field`], [`PlacedRays`]) give points of those sections, so that their bodies can be lofted from one to the next;
//! all others ([`FreeRays`]) give the points of the rays themselves.

use super::{Field, SpatialField};
use glam::DVec3;

/// Rays of a flank, root or tip, column by column along the profile and row by row along the tooth.
pub trait RayGrid {
    /// Place of each column along the target profile, mm, increasing.
    fn arcs_mm(&self) -> Vec<f64>;

    /// Place of each row along the tooth, mm, increasing.
    fn rows_mm(&self) -> &[f64];

    /// Point where the surface stands `height_mm` over the target, gear frame, mm.
    fn point_mm(&self, column: usize, row: usize, height_mm: f64) -> DVec3;

    /// Unit normal of the target out of the gear; where points are those of a section, its part in that section.
    fn normal(&self, column: usize, row: usize) -> DVec3;

    /// Whether the target runs straight along the gear's axis.
    fn is_straight(&self) -> bool;
}

impl RayGrid for Field {
    fn arcs_mm(&self) -> Vec<f64> {
        self.arcs_mm()
    }

    fn rows_mm(&self) -> &[f64] {
        &self.rows_z_mm
    }

    fn point_mm(&self, column: usize, row: usize, height_mm: f64) -> DVec3 {
        let column = &self.columns[column];
        (column.origin_mm + height_mm * column.normal).extend(self.rows_z_mm[row])
    }

    fn normal(&self, column: usize, _: usize) -> DVec3 {
        self.columns[column].normal.extend(0.0)
    }

    fn is_straight(&self) -> bool {
        true
    }
}

/// Rays in space whose rows stand in transverse sections: flanks of helical gears.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedRays {
    /// Rays; the origins of a row stand in its transverse section.
    pub field: SpatialField,
    /// Places of the columns along the profile, mm.
    pub arcs_mm: Vec<f64>,
    /// Places of the rows along the tooth, mm.
    pub rows_z_mm: Vec<f64>,
}

impl RayGrid for PlacedRays {
    fn arcs_mm(&self) -> Vec<f64> {
        self.arcs_mm.clone()
    }

    fn rows_mm(&self) -> &[f64] {
        &self.rows_z_mm
    }

    /// A normal that leans along the axis by nz leaves the section; a surface `height_mm` along it cuts the section
    /// height / cos(lean) from the origin, to the first order in heights over radii of curvature.
    fn point_mm(&self, column: usize, row: usize, height_mm: f64) -> DVec3 {
        let ray = self.field.ray(column, row);
        let across = ray.normal.truncate();
        (ray.origin_mm.truncate() + height_mm / across.length_squared() * across).extend(self.rows_z_mm[row])
    }

    fn normal(&self, column: usize, row: usize) -> DVec3 {
        self.field.ray(column, row).normal.truncate().normalize().extend(0.0)
    }

    fn is_straight(&self) -> bool {
        false
    }
}

/// Rays anywhere in space: flanks of bevel gears, whose rows stand in no common section.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeRays {
    /// Rays.
    pub field: SpatialField,
    /// Places of the columns along the profile, mm.
    pub arcs_mm: Vec<f64>,
    /// Places of the rows along the tooth, mm.
    pub rows_mm: Vec<f64>,
}

impl RayGrid for FreeRays {
    fn arcs_mm(&self) -> Vec<f64> {
        self.arcs_mm.clone()
    }

    fn rows_mm(&self) -> &[f64] {
        &self.rows_mm
    }

    fn point_mm(&self, column: usize, row: usize, height_mm: f64) -> DVec3 {
        self.field.ray(column, row).at(height_mm)
    }

    fn normal(&self, column: usize, row: usize) -> DVec3 {
        self.field.ray(column, row).normal
    }

    fn is_straight(&self) -> bool {
        false
    }
}
