//! The involute flank of a tooth, in the tooth's frame (x along the tooth's centre line, outwards).
//!
//! With base radius r_b and half tooth angle psi_b on the base circle, the flank on side sigma (+1: counter-clockwise,
//! -1: clockwise) at roll u (tangent of the local pressure angle; arc of the base circle unrolled over r_b) is
//!
//! `p(u) = r_b exp(i sigma (psi_b - u)) (1 + i sigma u)`
//!
//! Its outward normal is `i sigma exp(i sigma (psi_b - u))`, its radius of curvature r_b u, and the arc from the base
//! circle r_b u^2 / 2. Parallel involutes share their normals: an offset d outwards is the same flank with psi_b + d /
//! r_b (Litvin and Fuentes, Gear Geometry and Applied Theory, 2004, chapter 10).

use glam::DVec2;

/// One involute flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Involute {
    /// Base radius r_b in mm.
    pub base_radius_mm: f64,
    /// Half tooth angle psi_b on the base circle.
    pub half_angle_rad: f64,
    /// +1: the tooth's counter-clockwise flank (left), -1: the clockwise one (right).
    pub side: f64,
}

impl Involute {
    /// Direction from the tooth's origin to the point where the normal at roll `u` touches the base circle.
    fn base_direction(&self, u: f64) -> DVec2 {
        DVec2::from_angle(self.side * (self.half_angle_rad - u))
    }

    /// Point at roll `u` in mm.
    pub fn point(&self, u: f64) -> DVec2 {
        let e = self.base_direction(u);
        self.base_radius_mm * (e + self.side * u * e.perp())
    }

    /// Unit normal at roll `u`, out of the tooth.
    pub fn normal(&self, u: f64) -> DVec2 {
        self.side * self.base_direction(u).perp()
    }

    /// Roll at radius `radius_mm`; 0 inside the base circle.
    pub fn roll_at_radius(&self, radius_mm: f64) -> f64 {
        ((radius_mm / self.base_radius_mm).powi(2) - 1.0).max(0.0).sqrt()
    }
}

/// Involute function inv(alpha) = tan(alpha) - alpha.
pub fn inv(alpha_rad: f64) -> f64 {
    alpha_rad.tan() - alpha_rad
}
