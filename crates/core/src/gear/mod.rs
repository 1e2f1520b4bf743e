//! The gear by itself: its pitch curve, and the blank before cutting.
//!
//! Comes from the checked scene, goes to the linkage, the target flanks and the fields. Frame: the gear frame, origin
//! in the work axis, polar angle phi counter-clockwise, fixed to the work.

pub mod blank;
pub mod blank_outline;
mod kind;
pub mod pitch_curve;
pub mod rolling;

pub use kind::GearKind;
pub use pitch_curve::shape::{Driver, PitchCurveShape};
pub use pitch_curve::{CurvatureExtremum, CurveFacts, PitchCurve, PitchFrame};
pub use rolling::Rolling;
