//! Where a surface crosses the pitch curve: the points A, B, C, D of Gao et al. (2017, Fig. 9).
//!
//! A and D lie on the surface that an operation leaves (left and right flank), B and C on the finished one. How such a
//! point is found belongs to the processes.

use glam::DVec2;

/// A point of a surface on the pitch curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Gear frame, mm.
    pub point_mm: DVec2,
    /// Polar angle, rad, unwrapped like the linkage's.
    pub phi_rad: f64,
    /// Arc of the pitch curve, mm.
    pub arc_mm: f64,
}
