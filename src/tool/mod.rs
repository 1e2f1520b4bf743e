//! Tools: how many blades, where they sit, and the edge each one cuts with.
//!
//! A tool gives its edge as a chain of named segments in the **blade frame** (x along the blade's centre line towards its tip,
//! y counter-clockwise) and the place of every blade in the tool. Shaper cutters are given by their projected transverse profile:
//! the edge as seen along the stroke. A ground cutter (rake cone, relief, regrind) changes that projection and nothing else here.

pub mod closed_tooth;
pub mod edge;
pub mod edge_table;
pub mod involute;
pub mod shaper_cutter;

use crate::frame::Rigid2;
use edge::Edge;

pub use shaper_cutter::ShaperCutter;

/// A tool with equal blades.
pub trait CuttingTool: Sync {
    /// Number of blades (teeth of a shaper cutter).
    fn blade_count(&self) -> u32;
    /// The cutting edge of one blade, in the blade frame.
    fn edge(&self) -> &Edge;
    /// Place of blade `index` in the tool's spindle frame, mounting and pitch errors included.
    fn tool_from_blade(&self, index: u32) -> Rigid2;
}
