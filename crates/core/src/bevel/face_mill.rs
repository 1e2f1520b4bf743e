//! The face-mill head: inside and outside blades in turn on one circle, and the surfaces that they sweep at rest.
//!
//! In: radius, point width, blade angles, rounds, runouts. Out: a tool for the passes, and for both sides of the slot
//! the surface of revolution that all blades of the kind sweep: a cone with a torus at its foot ([`CuttingSurface`]).
//!
//! **Frames.** Tool frame: origin in the middle of the tips' plane, z along the head's axis to the work (see
//! [`super`]). Blade b stands at the angle 2 pi b / n. Blade frame: x along the axis to the tip, y away from the axis,
//! origin [`FaceMill::blade_height_mm`] short of the tips on the mean radius.
//!
//! **Blades.** Outside blades have even numbers: they cut the slot's outer side, on which the tooth is concave. Inside
//! blades cut the inner one, the convex side of the next tooth. The back of a blade leans half as much as its cutting
//! edge and clears the other side of the slot.
//!
//! The road not taken: hook and rake angles. Rake faces hold the head's axis, as [`crate::passes`] asks.

use crate::error::Refusal;
use crate::frame::Rigid3;
use crate::parameter;
use crate::tool::blade_edges::BladeEdges;
use crate::tool::edge::{Edge, Segment, SegmentName};
use crate::tool::{CuttingTool, SpatialTool};
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Inside or outside blades, and the side of the slot that they cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BladeKind {
    /// Cuts the slot's outer side, where the tooth is concave.
    Outside,
    /// Cuts the slot's inner side, where the tooth is convex.
    Inside,
}

impl BladeKind {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::Outside, Self::Inside];

    /// +1 for outside blades, -1 for inside ones.
    pub fn sign(self) -> f64 {
        match self {
            Self::Outside => 1.0,
            Self::Inside => -1.0,
        }
    }

    /// Its place in pairs of values: 0 outside, 1 inside.
    pub fn index(self) -> usize {
        usize::from(self == Self::Inside)
    }

    /// `outside` or `inside`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Outside => "outside",
            Self::Inside => "inside",
        }
    }

    /// Form of the flank that they cut: `concave` or `convex`.
    pub fn flank(self) -> &'static str {
        match self {
            Self::Outside => "concave",
            Self::Inside => "convex",
        }
    }
}

/// A face-mill head; mm and rad.
#[derive(Debug, Clone, PartialEq)]
pub struct FaceMill {
    /// Mean radius r_c: of the middle of the slot at the tips.
    pub radius_mm: f64,
    /// Point width W: from outside to inside cutting edge at the tips.
    pub point_width_mm: f64,
    /// Blade angles of outside and inside blades against the head's axis.
    pub blade_angles_rad: [f64; 2],
    /// Radius of the round at the cutting corner of outside and inside blades; 0 is sharp.
    pub corner_radii_mm: [f64; 2],
    /// Width of a blade at its tip: more than half of the point width, so that both kinds together clear the slot.
    pub tip_width_mm: f64,
    /// Height of the cutting edges over the tips.
    pub blade_height_mm: f64,
    /// How far each blade stands out in radius, one entry for each blade; their number is the head's, even.
    pub runouts_mm: Vec<f64>,
    /// Half of the angular window in which blades are in the work.
    pub half_window_rad: f64,
}

/// The surface that the blades of a kind sweep while the head rests, tool frame: a cone, and at its foot the torus of
/// their rounds, which touches the plane of the tips.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CuttingSurface {
    /// Side of the slot.
    pub kind: BladeKind,
    /// Radius of the cone in the plane of the tips, mm.
    pub point_radius_mm: f64,
    /// Angle of its straight lines against the axis, rad.
    pub blade_angle_rad: f64,
    /// Radius of the round, mm.
    pub corner_radius_mm: f64,
}

impl CuttingSurface {
    /// Place along the edge, from the plane of the tips, at which the round touches the straight edge, mm.
    pub fn corner_end_mm(&self) -> f64 {
        let (sin, cos) = self.blade_angle_rad.sin_cos();
        self.corner_radius_mm * (1.0 - sin) / cos
    }

    /// Point of the cone at an angle about the axis, `edge_mm` along the edge from the plane of the tips; tool frame.
    pub fn point_mm(&self, angle_rad: f64, edge_mm: f64) -> DVec3 {
        let (sin, cos) = self.blade_angle_rad.sin_cos();
        let radius_mm = self.point_radius_mm + self.kind.sign() * edge_mm * sin;
        radius_mm * out(angle_rad) - edge_mm * cos * DVec3::Z
    }

    /// Direction of the straight edge at an angle, away from the tips.
    pub fn edge_direction(&self, angle_rad: f64) -> DVec3 {
        let (sin, cos) = self.blade_angle_rad.sin_cos();
        self.kind.sign() * sin * out(angle_rad) - cos * DVec3::Z
    }

    /// Unit normal of the cone out of the material, into the head.
    pub fn normal(&self, angle_rad: f64) -> DVec3 {
        self.normal_of_corner(angle_rad, self.blade_angle_rad)
    }

    /// Middle of the round at an angle about the axis.
    pub fn corner_center_mm(&self, angle_rad: f64) -> DVec3 {
        let radius_mm = self.point_radius_mm - self.kind.sign() * self.corner_end_mm();
        radius_mm * out(angle_rad) - self.corner_radius_mm * DVec3::Z
    }

    /// Unit normal of the round out of the material, where it leans by `lean_rad`: the blade angle where it touches the
    /// cone, a right angle where it touches the plane of the tips.
    pub fn normal_of_corner(&self, angle_rad: f64, lean_rad: f64) -> DVec3 {
        let (sin, cos) = lean_rad.sin_cos();
        -self.kind.sign() * cos * out(angle_rad) - sin * DVec3::Z
    }
}

fn out(angle_rad: f64) -> DVec3 {
    DVec3::new(angle_rad.cos(), angle_rad.sin(), 0.0)
}

impl FaceMill {
    /// Number of blades of both kinds.
    pub fn blades(&self) -> u32 {
        self.runouts_mm.len() as u32
    }

    /// Kind of a blade.
    pub fn kind_of(blade: u32) -> BladeKind {
        if blade.is_multiple_of(2) { BladeKind::Outside } else { BladeKind::Inside }
    }

    /// Surface of a kind, without runout.
    pub fn surface(&self, kind: BladeKind) -> CuttingSurface {
        CuttingSurface {
            kind,
            point_radius_mm: self.radius_mm + 0.5 * kind.sign() * self.point_width_mm,
            blade_angle_rad: self.blade_angles_rad[kind.index()],
            corner_radius_mm: self.corner_radii_mm[kind.index()],
        }
    }

    /// The tool, if blades can be made so.
    ///
    /// # Errors
    /// Blades that leave material in the slot's middle, rounds that find no room on a tip, an odd number of blades.
    pub fn tool(&self) -> Result<FaceMillTool<'_>, Refusal> {
        if self.blades() < 2 || !self.blades().is_multiple_of(2) {
            return Err(Refusal::new(
                parameter::BLADES,
                format!("{} blades do not alternate between outside and inside", self.blades()),
                "use an even number of blades",
            ));
        }
        if 2.0 * self.tip_width_mm <= self.point_width_mm || self.tip_width_mm > self.point_width_mm {
            return Err(Refusal::new(
                parameter::TIP_WIDTH,
                format!(
                    "blades {} mm wide at their tips do not clear a slot of {} mm: each cuts its side and more than \
                     half of the bottom, but not the other side",
                    self.tip_width_mm, self.point_width_mm
                ),
                format!("use {} to {} mm", 0.5 * self.point_width_mm, self.point_width_mm),
            ));
        }
        for kind in BladeKind::BOTH {
            let surface = self.surface(kind);
            if surface.corner_end_mm() * surface.blade_angle_rad.cos() > self.tip_width_mm
                || surface.corner_radius_mm >= self.blade_height_mm
            {
                return Err(Refusal::new(
                    parameter::CORNER_RADIUS,
                    format!(
                        "a round of {} mm finds no room on the {} blade, {} mm wide at its tip",
                        surface.corner_radius_mm,
                        kind.name(),
                        self.tip_width_mm
                    ),
                    "use a smaller round or wider tips",
                ));
            }
        }
        let edges = BladeKind::BOTH.map(|kind| self.edge(kind));
        Ok(FaceMillTool { head: self, edges: BladeEdges::in_turn(edges.into()) })
    }

    /// Edge of a kind of blade in the blade frame.
    fn edge(&self, kind: BladeKind) -> Edge {
        let surface = self.surface(kind);
        let (sin, cos) = surface.blade_angle_rad.sin_cos();
        let (depth, half, round) = (self.blade_height_mm, 0.5 * self.point_width_mm, surface.corner_radius_mm);
        let center = DVec2::new(depth - round, half - surface.corner_end_mm());
        let touch = center + round * DVec2::new(sin, cos);
        let back = DVec2::new(depth, half - self.tip_width_mm);
        let back_end = back - depth * DVec2::new(1.0, (0.5 * surface.blade_angle_rad).tan());
        let flank_end = DVec2::new(0.0, half + depth * surface.blade_angle_rad.tan());
        let mut segments = vec![
            Segment::straight(SegmentName::FlankRight, back_end, back),
            Segment::straight(SegmentName::Tip, back, DVec2::new(depth, center.y)),
        ];
        if round > 0.0 {
            let leans = [0.0, FRAC_PI_2 - surface.blade_angle_rad];
            segments.push(Segment::arc(SegmentName::CornerLeft, center, round, leans));
        }
        segments.push(Segment::straight(SegmentName::FlankLeft, touch, flank_end));
        match kind {
            BladeKind::Outside => Edge::new(segments),
            BladeKind::Inside => Edge::new(segments.iter().rev().map(Segment::mirrored).collect()),
        }
    }
}

/// A head with the edges of its blades.
#[derive(Debug)]
pub struct FaceMillTool<'a> {
    head: &'a FaceMill,
    edges: BladeEdges,
}

impl CuttingTool for FaceMillTool<'_> {
    fn blade_count(&self) -> u32 {
        self.head.blades()
    }

    fn edges(&self) -> &BladeEdges {
        &self.edges
    }
}

impl SpatialTool for FaceMillTool<'_> {
    fn tool_from_blade(&self, index: u32) -> Rigid3 {
        let out = out(TAU * f64::from(index) / f64::from(self.head.blades()));
        let radius_mm = self.head.radius_mm + self.head.runouts_mm[index as usize];
        Rigid3 {
            rotation: DMat3::from_cols(DVec3::Z, out, DVec3::Z.cross(out)),
            translation_mm: radius_mm * out - self.head.blade_height_mm * DVec3::Z,
        }
    }

    fn half_window_rad(&self) -> f64 {
        self.head.half_window_rad
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head() -> FaceMill {
        FaceMill {
            radius_mm: 95.25,
            point_width_mm: 2.0,
            blade_angles_rad: [0.3, 0.4],
            corner_radii_mm: [0.3, 0.5],
            tip_width_mm: 1.4,
            blade_height_mm: 9.0,
            runouts_mm: vec![0.0; 6],
            half_window_rad: 0.5,
        }
    }

    /// Edges of blades at their places are lines of the surfaces that they are said to sweep.
    #[test]
    fn blades_lie_on_their_cutting_surfaces() {
        let head = head();
        let tool = head.tool().expect("a head");
        for blade in 0..head.blades() {
            let surface = head.surface(FaceMill::kind_of(blade));
            let angle = TAU * f64::from(blade) / 6.0;
            let wanted = surface.kind.sign();
            let mut flanks = 0;
            for segment in &tool.edge_of(blade).segments {
                let at = |y_mm: f64| {
                    let x_mm = segment.x_and_slope(y_mm)[0];
                    let in_blade = segment.blade_from_segment.point(DVec2::new(x_mm, y_mm));
                    tool.tool_from_blade(blade).point(in_blade.extend(0.0))
                };
                let middle = at(0.0);
                // The cutting edge is the flank that stands farther out on outside blades, farther in on inside ones.
                let is_flank = matches!(segment.name, SegmentName::FlankLeft | SegmentName::FlankRight);
                let from_cone = (middle - surface.point_mm(angle, 0.0)).dot(surface.normal(angle));
                if is_flank && from_cone.abs() < 1e-9 {
                    flanks += 1;
                    assert!((at(1.0) - surface.point_mm(angle, 0.0)).dot(surface.normal(angle)).abs() < 1e-12);
                } else if matches!(segment.name, SegmentName::CornerLeft | SegmentName::CornerRight) {
                    let off = at(0.1).distance(surface.corner_center_mm(angle)) - surface.corner_radius_mm;
                    assert!(off.abs() < 1e-12, "{off:e}");
                } else {
                    // Backs and tips stand on the head's side of the cone.
                    assert!(from_cone > 0.0, "{wanted}: {from_cone}");
                }
            }
            assert_eq!(flanks, 1, "blade {blade}");
            let end = surface.corner_end_mm();
            let touch = surface.corner_center_mm(angle) - surface.corner_radius_mm * surface.normal(angle);
            assert!(touch.distance(surface.point_mm(angle, end)) < 1e-12);
        }
    }

    #[test]
    fn heads_that_cannot_be_made_are_refused() {
        assert!(head().tool().is_ok());
        for wrong in [
            FaceMill { runouts_mm: vec![0.0; 5], ..head() },
            FaceMill { tip_width_mm: 1.0, ..head() },
            FaceMill { tip_width_mm: 2.1, ..head() },
            FaceMill { corner_radii_mm: [0.3, 3.0], ..head() },
        ] {
            assert!(wrong.tool().is_err(), "{wrong:?}");
        }
    }
}
