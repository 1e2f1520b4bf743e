//! How far a force moves tool and work: the compliance of both sides, and the displacement that it makes.
//!
//! In: compliances as they are measured, one side fixed and the other one pushed. Out: a [`Deflection`], four numbers
//! that say how the tool stands against the work, and what it does to a pose.
//!
//! Law: statics of small displacements, q = C Q. The four coordinates q are the shift of the tool against the work
//! along the line of centres and across it, the turn of the tool on its spindle and that of the work on its own; Q are
//! the forces and torques that do work on them. C is diagonal: a force along one coordinate moves no other one. Tool
//! and work are pushed by opposite forces, so that their compliances for a shift add.
//!
//! Road not taken: a full matrix of each side. Its entries off the diagonal are seldom measured, and the torques of the
//! cut already carry a force at the edge into turns of both spindles.

use gearcut_core::frame::Rigid2;
use glam::{DVec2, DVec4};

/// Compliance of one side of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SideCompliance {
    /// Along the line of centres, mm/N.
    pub radial_mm_per_n: f64,
    /// Across it, in the transverse plane, mm/N.
    pub tangential_mm_per_n: f64,
    /// Of the spindle about its axis, rad/(N mm).
    pub torsional_rad_per_nmm: f64,
}

/// Compliance of a machine with a tool and a work spindle that stand parallel.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Compliance {
    /// Tool, its spindle, the slides and the frame behind them.
    pub tool: SideCompliance,
    /// Work, its clamping and its spindle.
    pub work: SideCompliance,
}

/// How the tool is displaced against the work.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deflection {
    /// Shift of the tool along the line of centres, away from the work axis, mm.
    pub radial_mm: f64,
    /// Shift of the tool across the line of centres, counter-clockwise about the work axis, mm.
    pub tangential_mm: f64,
    /// Turn of the tool about its axis, counter-clockwise, rad.
    pub tool_rad: f64,
    /// Turn of the work about its axis, counter-clockwise, rad.
    pub work_rad: f64,
}

impl Compliance {
    /// Whether nothing yields.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// The diagonal of C for the coordinates of a [`Deflection`]: mm/N twice, rad/(N mm) twice.
    pub fn diagonal(&self) -> DVec4 {
        let Self { tool, work } = self;
        DVec4::new(
            tool.radial_mm_per_n + work.radial_mm_per_n,
            tool.tangential_mm_per_n + work.tangential_mm_per_n,
            tool.torsional_rad_per_nmm,
            work.torsional_rad_per_nmm,
        )
    }
}

impl Deflection {
    /// From its four coordinates.
    pub fn of_coordinates(q: DVec4) -> Self {
        Self { radial_mm: q.x, tangential_mm: q.y, tool_rad: q.z, work_rad: q.w }
    }

    /// Its four coordinates.
    pub fn coordinates(&self) -> DVec4 {
        DVec4::new(self.radial_mm, self.tangential_mm, self.tool_rad, self.work_rad)
    }

    /// What each of the coordinates moves: how far a point of the tool goes against the work along `direction`, for one
    /// mm or rad. The frame is the work's; its spindle axis and the tool's axis are points of it.
    pub fn moves(point_mm: DVec2, direction: DVec2, work_axis_mm: DVec2, tool_axis_mm: DVec2) -> DVec4 {
        let out = (tool_axis_mm - work_axis_mm).normalize_or(DVec2::X);
        DVec4::new(
            direction.dot(out),
            direction.dot(out.perp()),
            direction.dot((point_mm - tool_axis_mm).perp()),
            -direction.dot((point_mm - work_axis_mm).perp()),
        )
    }

    /// The pose of the tool in the work's frame after this displacement; the work's spindle axis is a point of that
    /// frame.
    #[must_use]
    pub fn displaced(&self, work_from_tool: &Rigid2, work_axis_mm: DVec2) -> Rigid2 {
        let center_mm = work_from_tool.translation_mm - work_axis_mm;
        let out = center_mm.normalize_or(DVec2::X);
        let shifted_mm = center_mm + out.rotate(DVec2::new(self.radial_mm, self.tangential_mm));
        // A work that turns on its spindle sees the tool turned the other way about that spindle.
        let back = DVec2::from_angle(-self.work_rad);
        Rigid2 {
            rotation: DVec2::from_angle(self.tool_rad - self.work_rad).rotate(work_from_tool.rotation),
            translation_mm: work_axis_mm + back.rotate(shifted_mm),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Poses before and after against the moves of a point, for each coordinate alone and for all of them.
    #[test]
    fn moves_are_the_derivatives_of_the_displaced_pose() {
        let (work_axis_mm, pose) = (DVec2::new(0.3, -0.2), Rigid2::new(0.7, DVec2::new(50.0, 41.0)));
        let point_in_tool = DVec2::new(30.0, -4.0);
        let point_mm = pose.point(point_in_tool);
        for q in [DVec4::X, DVec4::Y, DVec4::Z, DVec4::W, DVec4::new(0.4, -0.3, 0.02, 0.05)] {
            let small = 1e-6;
            let moved = Deflection::of_coordinates(small * q).displaced(&pose, work_axis_mm).point(point_in_tool);
            for direction in [DVec2::X, DVec2::from_angle(2.0)] {
                let exact = (moved - point_mm).dot(direction) / small;
                let ours = Deflection::moves(point_mm, direction, work_axis_mm, pose.translation_mm).dot(q);
                assert!((ours - exact).abs() < 1e-3 * exact.abs().max(0.1), "{ours} {exact} {q}");
            }
        }
    }

    #[test]
    fn signs_are_those_of_the_axes() {
        let pose = Rigid2::new(0.0, DVec2::new(60.0, 0.0));
        let one = |q: DVec4| Deflection::of_coordinates(q).displaced(&pose, DVec2::ZERO);
        assert!(one(DVec4::X * 0.01).translation_mm.x > 60.0, "away from the work axis");
        assert!(one(DVec4::Y * 0.01).translation_mm.y > 0.0, "counter-clockwise about it");
        assert!(one(DVec4::Z * 0.01).rotation.y > 0.0, "the tool turns counter-clockwise");
        let turned = one(DVec4::W * 0.01);
        assert!(turned.rotation.y < 0.0 && turned.translation_mm.y < 0.0, "seen from a work that turns with it");
    }
}
