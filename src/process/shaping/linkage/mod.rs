//! Linkages: from a parameter to the machine's axis positions, and from there to the pose of the cutter in the work.
//!
//! In: the pitch curve, the cutter's pitch radius, the operation. Out: [`ShapingLinkage`] (axes and poses at any polar
//! angle), [`StrokeSchedule`] (axes and pose at any stroke), [`dynamics`] (speeds and accelerations), [`relief`]
//! (clearance when the cutter backs off), [`retraction`] (where it stands then).
//!
//! **Frames.** The gear frame has its origin in the work axis O_c, fixed to the work, phi counter-clockwise. The cutter
//! centre O_b stands in it at the distance l under the polar angle psi_c, and the cutter's tooth 0 points in the
//! direction psi_c + pi + psi_b. On the machine the work turns by -psi_c and the cutter by +psi_b while O_b stays at
//! (l, 0). At phi = 0 cutter tooth 0 points at P(0): a tooth space of the gear is centred there. Nothing is subtracted,
//! so that curves with r'(0) != 0 start with axis angles other than zero.
//!
//! A **ring** is shaped from inside: the cutter's centre is P - r_c n instead of P + r_c n, its tooth 0 points in the
//! direction psi_c + psi_b, and it rolls the other way round. All of that is the external law with a **negative cutter
//! radius**, d = -(r_c + delta_d) for d = r_c + delta_d and -r_c for r_c ([`ShapingLinkage`] puts the sign in), so
//! there is one law for both. The internal paper writes a = l, Phi = psi_c and psi = -psi_b.

mod axes;
pub mod dynamics;
mod inverse;
mod normal;
pub mod relief;
pub mod retraction;
pub mod schedule;
mod shaping_linkage;
#[cfg(test)]
mod tests;
mod traditional;

pub use axes::{Axes, CutterPose};
pub use schedule::{StrokeSchedule, StrokeState};
pub use shaping_linkage::ShapingLinkage;
