//! Passes whose rake face is a transverse plane: strokes of a cutter, and which of them can matter to rays in that
//! plane.

pub mod blank_candidates;
pub mod bounds;
pub mod candidates;
pub mod near;
pub mod record;
pub mod samples;
pub mod strokes;
pub mod time_intervals;
pub mod upper_bound;
