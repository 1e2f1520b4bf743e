//! Rays of a flank with the places of their columns and rows: what grids of surfaces are made of.

use super::{Field, SpatialField};
use glam::DVec2;

/// Rays of a flank, root or tip, column by column along the profile and row by row along the tooth: every row stands in
/// one transverse section.
pub trait RayGrid {
    /// Arc length of each column along the target profile, mm.
    fn arcs_mm(&self) -> Vec<f64>;

    /// Place of each row along the tooth from the middle of the face, mm, increasing.
    fn rows_z_mm(&self) -> &[f64];

    /// Point of the row's transverse section where the surface stands `height_mm` over the target, gear frame, mm.
    fn point_mm(&self, column: usize, row: usize, height_mm: f64) -> DVec2;

    /// Unit normal of the target out of the gear, in the row's transverse section.
    fn normal(&self, column: usize, row: usize) -> DVec2;

    /// Whether the target runs straight along the gear's axis.
    fn is_straight(&self) -> bool;
}

impl RayGrid for Field {
    fn arcs_mm(&self) -> Vec<f64> {
        self.arcs_mm()
    }

    fn rows_z_mm(&self) -> &[f64] {
        &self.rows_z_mm
    }

    fn point_mm(&self, column: usize, _: usize, height_mm: f64) -> DVec2 {
        let column = &self.columns[column];
        column.origin_mm + height_mm * column.normal
    }

    fn normal(&self, column: usize, _: usize) -> DVec2 {
        self.columns[column].normal
    }

    fn is_straight(&self) -> bool {
        true
    }
}

/// Rays in space with the places of their columns and rows.
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

    fn rows_z_mm(&self) -> &[f64] {
        &self.rows_z_mm
    }

    /// A normal that leans along the axis by nz leaves the section; a surface `height_mm` along it cuts the section
    /// height / cos(lean) from the origin, to the first order in heights over radii of curvature.
    fn point_mm(&self, column: usize, row: usize, height_mm: f64) -> DVec2 {
        let ray = self.field.ray(column, row);
        let across = ray.normal.truncate();
        ray.origin_mm.truncate() + height_mm / across.length_squared() * across
    }

    fn normal(&self, column: usize, row: usize) -> DVec2 {
        self.field.ray(column, row).normal.truncate().normalize()
    }

    fn is_straight(&self) -> bool {
        false
    }
}
