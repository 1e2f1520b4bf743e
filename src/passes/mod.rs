//! Passes: one blade's one trip through the work, and which passes can matter to which dexels.

pub mod blank_candidates;
pub mod bounds;
pub mod candidates;
pub mod hob_sections;
pub mod hob_teeth;
pub mod motion;
pub mod near;
pub mod record;
pub mod rulers;
pub mod section_band;
pub mod spells;
pub mod strokes;
pub mod sweep;
mod sweep_bounds;
pub mod sweep_plan;
mod sweep_regions;
pub mod sweep_roots;
mod sweep_samples;
mod sweep_starts;
mod swept_pose;

pub use candidates::{CutPlan, Tile};
pub use hob_teeth::HobTeeth;
pub use motion::MotionTable;
pub use record::PassRecord;
pub use strokes::StrokeSet;
pub use sweep_plan::SweepPlan;
