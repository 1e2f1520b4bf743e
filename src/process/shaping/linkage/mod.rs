//! Linkages: from a parameter to the machine's axis positions, and from there to the pose of the cutter in the work.
//!
//! In: the pitch curve, the cutter's pitch radius, the operation. Out: [`ShapingLinkage`] (axes and poses at any polar
//! angle), [`StrokeSchedule`] (axes and pose at any stroke), [`dynamics`] (speeds and accelerations), [`relief`]
//! (clearance when the cutter backs off).
//!
//! **Frames.** The gear frame has its origin in the work axis O_c, fixed to the work, phi counter-clockwise. The cutter
//! centre O_b stands in it at the distance l under the polar angle psi_c, and the cutter's tooth 0 points in the
//! direction psi_c + pi + psi_b. On the machine the work turns by -psi_c and the cutter by +psi_b while O_b stays at
//! (l, 0). At phi = 0 cutter tooth 0 points at P(0): a tooth space of the gear is centred there. Nothing is subtracted,
//! so that curves with r'(0) != 0 start with axis angles other than zero.

mod axes;
pub mod dynamics;
mod external;
mod inverse;
mod normal;
pub mod relief;
pub mod schedule;
#[cfg(test)]
mod tests;
mod traditional;

pub use axes::{Axes, CutterPose, PoseMotion};
pub use external::ShapingLinkage;
pub use schedule::{StrokeIncrement, StrokeSchedule, StrokeState};
