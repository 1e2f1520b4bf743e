//! Rigid motions of the transverse plane and of space: where a tool, a blade or a tile stands.
//!
//! A motion is named `target_from_source`; points go through it from right to left. All numbers are f64, in mm and rad.

use glam::{DMat3, DVec2, DVec3};

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

/// Rotation, then translation, in space: `p_target = R p_source + t`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rigid3 {
    /// Rotation matrix; its columns are the source's axes in the target frame.
    pub rotation: DMat3,
    /// Translation in mm: the source's origin in the target frame.
    pub translation_mm: DVec3,
}

impl Rigid3 {
    /// Image of a point.
    pub fn point(&self, p_mm: DVec3) -> DVec3 {
        self.rotation * p_mm + self.translation_mm
    }

    /// Image of a direction.
    pub fn direction(&self, d: DVec3) -> DVec3 {
        self.rotation * d
    }

    /// The motion back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self { rotation, translation_mm: -(rotation * self.translation_mm) }
    }

    /// `self` after `first`: `a_from_b.after(b_from_c)` is `a_from_c`.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        Self { rotation: self.rotation * first.rotation, translation_mm: self.point(first.translation_mm) }
    }
}

/// A pose in space with its velocity: a point q of the source at `pose.point(q) = p` moves with
/// `velocity + angular_velocity x (p - pose.translation)` in the target frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidMotion3 {
    /// Where the source stands.
    pub pose: Rigid3,
    /// Velocity of the source's origin, mm/s, target frame.
    pub velocity_mm_per_s: DVec3,
    /// Angular velocity, rad/s, target frame.
    pub angular_velocity_rad_per_s: DVec3,
}

impl RigidMotion3 {
    /// Velocity (mm/s) of the source's point that is at `p_mm` (target frame).
    pub fn velocity_at(&self, p_mm: DVec3) -> DVec3 {
        self.velocity_mm_per_s + self.angular_velocity_rad_per_s.cross(p_mm - self.pose.translation_mm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_of_space_invert_and_chain() {
        let motion = |x: f64, y: f64, t: DVec3| Rigid3 {
            rotation: DMat3::from_rotation_x(x) * DMat3::from_rotation_y(y),
            translation_mm: t,
        };
        let a_from_b = motion(0.7, -0.2, DVec3::new(3.0, -1.0, 0.5));
        let b_from_c = motion(-1.9, 2.5, DVec3::new(0.5, 8.0, -2.0));
        let p_c = DVec3::new(2.0, 5.0, -3.0);
        let p_a = a_from_b.after(&b_from_c).point(p_c);
        assert!(p_a.distance(a_from_b.point(b_from_c.point(p_c))) < 1e-14);
        assert!(a_from_b.inverse().point(p_a).distance(b_from_c.point(p_c)) < 1e-14);
    }

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
