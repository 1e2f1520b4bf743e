//! Rigid motions of the transverse plane: where a tool, a blade or a tile stands.
//!
//! A motion is named `target_from_source`; points go through it from right to left. All f64, mm and rad.

use glam::DVec2;

/// Rotation by an angle, then translation: `p_target = R p_source + t`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rigid2 {
    /// Unit vector (cos, sin) of the rotation.
    pub rotation: DVec2,
    /// Translation in mm.
    pub translation_mm: DVec2,
}

impl Rigid2 {
    /// Rotation by `angle_rad` (counter-clockwise) followed by `translation_mm`.
    pub fn new(angle_rad: f64, translation_mm: DVec2) -> Self {
        Self { rotation: DVec2::from_angle(angle_rad), translation_mm }
    }

    /// Image of a point.
    pub fn point(&self, p_mm: DVec2) -> DVec2 {
        self.rotation.rotate(p_mm) + self.translation_mm
    }

    /// Image of a direction.
    pub fn direction(&self, d: DVec2) -> DVec2 {
        self.rotation.rotate(d)
    }

    /// The motion back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = DVec2::new(self.rotation.x, -self.rotation.y);
        Self { rotation, translation_mm: -rotation.rotate(self.translation_mm) }
    }

    /// `self` after `first`: `a_from_b.after(b_from_c)` is `a_from_c`.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        Self { rotation: self.rotation.rotate(first.rotation), translation_mm: self.point(first.translation_mm) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_undoes_and_composition_chains() {
        let a_from_b = Rigid2::new(0.7, DVec2::new(3.0, -1.0));
        let b_from_c = Rigid2::new(-1.9, DVec2::new(0.5, 8.0));
        let p_c = DVec2::new(2.0, 5.0);
        let p_a = a_from_b.after(&b_from_c).point(p_c);
        assert!(p_a.distance(a_from_b.point(b_from_c.point(p_c))) < 1e-14);
        assert!(a_from_b.inverse().point(p_a).distance(b_from_c.point(p_c)) < 1e-14);
    }
}
