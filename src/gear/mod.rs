//! The gear by itself: its pitch curve, and what the later stages build on that curve.
//!
//! Comes from the checked scene, goes to the linkage, the target flanks and the fields. Frame: the gear frame, origin in the
//! work axis, polar angle phi counter-clockwise, fixed to the work.

pub mod blank;
pub mod blank_outline;
pub mod flank_patch;
pub mod generation;
pub mod jet;
pub(crate) mod periodic_integral;
pub mod pitch_curve;
pub mod rack_generation;
pub mod rack_root;
pub(crate) mod roots;
pub mod target;
pub mod target_outline;

pub use jet::Jet;
pub use pitch_curve::{CurvatureExtremum, CurveFacts, PitchCurve, PitchFrame};
