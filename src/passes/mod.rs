//! Passes: one blade's one trip through the work, and which passes can matter to which dexels.

pub mod blank_candidates;
pub mod bounds;
pub mod candidates;
pub mod near;
pub mod record;
pub mod rulers;
pub mod spells;
pub mod strokes;

pub use candidates::{CutPlan, Tile};
pub use record::PassRecord;
pub use strokes::StrokeSet;
