//! Tools: how many blades, where they sit, and the edge each one cuts with.
//!
//! A tool gives its edge as a chain of named segments in the **blade frame** (x along the blade's centre line towards
//! its tip, y across it so that the blade's left flank has y > 0) and the place of every blade in the tool. What cuts
//! is the rake face's outline: a tool whose rake faces stay in transverse planes of the work ([`PlanarTool`]: shaper
//! cutters, by the profile projected along the stroke) gives plane motions, any other one ([`SpatialTool`]: hobs)
//! gives places in space. All blades share one edge, or they have several in turn ([`BladeEdges`]).

pub mod blade_edges;
pub mod closed_tooth;
pub mod edge;
pub mod edge_profile;
pub mod edge_table;
pub mod involute;
pub mod segment_course;

use crate::frame::{Rigid2, Rigid3};
use blade_edges::BladeEdges;
use edge::Edge;
use std::f64::consts::PI;

/// A tool with blades.
pub trait CuttingTool: Sync {
    /// Number of blades (teeth of a shaper cutter or hob).
    fn blade_count(&self) -> u32;
    /// The cutting edges of its blades, each in its blade's frame.
    fn edges(&self) -> &BladeEdges;
    /// The cutting edge of one blade, in the blade frame.
    fn edge_of(&self, blade: u32) -> &Edge {
        self.edges().edge_of(blade)
    }
}

/// A tool that cuts in transverse planes of the work.
pub trait PlanarTool: CuttingTool {
    /// Place of blade `index` in the tool's spindle frame, mounting and pitch errors included.
    fn tool_from_blade(&self, index: u32) -> Rigid2;
}

/// A tool whose rake faces move through space.
pub trait SpatialTool: CuttingTool {
    /// Place of blade `index` in the tool frame, whose z axis is the tool's own. The rake face holds the blade's x and
    /// y axes and the tool's axis; z = x cross y is its normal. A blade may look away from the axis (hobs) or along it
    /// (face-mill heads).
    fn tool_from_blade(&self, index: u32) -> Rigid3;
    /// How much the rake face turns about the tool's axis per mm along it, in the direction of the blade's y, rad/mm,
    /// counted about the tool's +z: 0 for a plane rake face. With a twist a blade looks away from the axis, and its
    /// coordinates are cylindrical: x is the distance from the tool's axis, y runs along it.
    fn rake_twist_rad_per_mm(&self) -> f64 {
        0.0
    }
    /// Half of the angular window in which its blades can cut, rad, up to pi: further than this from the direction that
    /// the head's x axis has, towards the work, every blade is clear of the blank. The tool says what follows from its
    /// size and from the work that it is made for, such as [`half_window_of`].
    fn half_window_rad(&self) -> f64;
}

/// Half of the window in which blades can meet a work that, seen along the tool's axis, lies within `reach_mm` of a
/// point `distance_mm` away from that axis: the circle round that point is seen from the axis under twice this angle,
/// rad. A work that may reach the axis is all round it.
pub fn half_window_of(distance_mm: f64, reach_mm: f64) -> f64 {
    if reach_mm < distance_mm { (reach_mm / distance_mm).asin() } else { PI }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn no_point_of_the_work_is_seen_outside_the_window() {
        let half_rad = half_window_of(100.0, 30.0);
        let seen = (0..360).map(|i| DVec2::new(100.0, 0.0) + 30.0 * DVec2::from_angle(f64::from(i).to_radians()));
        let widest_rad = seen.map(|point| point.to_angle().abs()).fold(0.0, f64::max);
        assert!(widest_rad <= half_rad && widest_rad > half_rad - 1e-3, "{widest_rad} of {half_rad} rad");
        assert!(half_window_of(100.0, 100.0) == PI && half_window_of(0.0, 1.0) == PI);
    }
}
