//! The gear by itself: its pitch curve, on which side of it the material lies, and the blank before cutting.
//!
//! In: shape, module and number of teeth from the checked scene. Out: what linkages, target flanks and fields build on.
//! Frame: the gear frame, origin in the work axis, polar angle phi counter-clockwise, fixed to the work.

mod back;
pub mod blank;
pub mod blank_outline;
mod dwell;
mod kind;
pub mod pitch_curve;
pub mod rolling;

pub use back::Back;
pub use dwell::Dwell;
pub use kind::GearKind;
pub use pitch_curve::shape::{Driver, FormulaMeaning, LARGEST_UNASKED_SCALING, PitchCurveShape, TableScaling};
pub use pitch_curve::{CurvatureExtremum, CurveFacts, PitchCurve, PitchFrame};
pub use rolling::Rolling;
