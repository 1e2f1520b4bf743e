//! The cutter: its teeth, and what their edges are beside sharp and smooth.
//!
//! In: what the scene says of the tool. Out: [`cutter::ShaperCutter`] with its blades; the tooth as a polygon for
//! chips; roughness, rounding and built-up edges. A tooth may be drawn or measured ([`crate::drawn_tooth`]).

pub(super) mod built_up_edge;
pub mod cutter;
pub mod edge_polygon;
pub mod edge_roughness;
pub(super) mod edge_rounding;
pub mod ground_flank;
pub mod involute_tooth;
