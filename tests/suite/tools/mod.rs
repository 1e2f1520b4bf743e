//! Tools of any kind, without a process: blades that differ, and blades that stand along their axis.

mod conical_gear;
mod face_mill;
mod pass_times;
mod planar_edges;
pub mod spatial_edges;
