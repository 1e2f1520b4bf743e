//! Passes whose rake face turns with the tool: sweeps, and which of them can matter to rays in space.

pub mod motion;
#[cfg(test)]
mod straight_hob;
pub mod sweep;
mod sweep_bounds;
mod sweep_near;
pub mod sweep_plan;
mod sweep_regions;
pub mod sweep_roots;
mod sweep_samples;
mod sweep_starts;
pub mod sweep_tile;
pub mod turning_passes;
