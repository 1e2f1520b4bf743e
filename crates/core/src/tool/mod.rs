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

use crate::frame::{Rigid2, Rigid3};
use blade_edges::BladeEdges;
use edge::Edge;

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
    /// Place of blade `index` in the tool frame. The rake face holds the blade's x and y axes; z = x cross y is its
    /// normal.
    fn tool_from_blade(&self, index: u32) -> Rigid3;
    /// How much the rake face turns about the tool's axis per mm of blade y, rad/mm, counted about the tool's +z: 0 for
    /// a plane rake face through the axis. With a twist, blade coordinates are cylindrical: x is the distance from the
    /// tool's axis, y runs along it.
    fn rake_twist_rad_per_mm(&self) -> f64;
    /// Largest angle between a blade in the work and the direction from the tool's axis towards the work, rad, below
    /// half pi: further round, every blade is clear of the blank.
    fn half_sweep_rad(&self) -> f64;
}
