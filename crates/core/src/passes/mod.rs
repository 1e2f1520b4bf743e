//! Passes: one blade's one trip through the work, and which passes can matter to which dexels.

pub mod planar;
pub mod sections;
pub mod spatial;

pub use planar::candidates::{CutPlan, Tile};
pub use planar::record::PassRecord;
pub use planar::strokes::StrokeSet;
pub use spatial::motion::MotionTable;
pub use spatial::sweep_plan::SweepPlan;
pub use spatial::turning_passes::TurningPasses;
