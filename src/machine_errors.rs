//! Errors of machine and clamping: from the motion that the control commands to the one that the machine makes.
//!
//! In: the commanded motion of the axes ([`crate::machine::Motion`]), what is wrong with each of them ([`AxisErrors`]),
//! how the work sits on its spindle ([`WorkMounting`]), how the tool sits on its own ([`ToolMounting`]), and how the
//! guide along the work runs ([`Guide`]). Out: actual positions ([`ActualMotion`]) and the rigid motions that belong to
//! the poses. Every process asks the same way, between its linkage and its passes: tables and programs show what is
//! commanded, the cut follows what is made, and the target stays that of the commanded motion.
//!
//! Law of an axis, in this order:
//!
//! ```text
//! gearbox   c(t)  = the command of the cycle before, rounded to increments, straight between cycles
//! servo     m(t)  = c(t) - e(t),  T e'' + e' + K_v e = T q'' + (1 - f) q'
//! backlash  w(t)  = play of the width b, driven by m
//! guide     y(t)  = w + s w + sum of A_k sin(k w + phi_k) + drift
//! noise     y(t) + n, a new n for each passage of the tool, or n(t) of a bandwidth
//! ```
//!
//! Servo: a position loop of velocity gain K_v over a speed loop that answers like a first-order element of time
//! constant T, with the share f of the commanded speed fed forward (Groß, Hamann and Wiegärtner, *Electrical Feed
//! Drives in Automation*, 2001; Altintas, *Manufacturing Automation*, 2nd ed. 2012, ch. 5). At constant speed v the lag
//! e is (1 - f) v / K_v. The gearbox's own lag of a cycle is not sent through the servo again: a difference of second
//! order.
//!
//! Road not taken: errors as displacements of the finished flank. Each would need its own formula for every process and
//! flank, and none would show facets, undercut or what one error does to another.

mod axis;
mod backlash;
mod balance;
mod chip_force;
mod compliance;
mod edge_element;
mod fast_noise;
mod layers;
mod motion;
mod mounting;
mod noise;
mod one_mass;
mod servo;
#[cfg(test)]
mod tests;

pub use axis::{AxisErrors, GearboxCycle, PeriodicError, ThermalDrift};
pub use balance::{NoBalance, balance};
pub use chip_force::ChipForce;
pub use compliance::{Compliance, Deflection, SideCompliance};
pub use edge_element::EdgeElement;
pub use fast_noise::{noise_knots_s, refuse_fast_noise};
pub use layers::ErrorLayer;
pub use motion::{ActualMotion, Course, MachineMoment};
pub use mounting::{Guide, ToolMounting, WorkMounting};
pub use noise::{AxisNoise, NoiseLaw};
pub use one_mass::{Chatter, OneMass};
pub use servo::Servo;

/// What is wrong with a machine of N axes and the work in it.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineErrors<const N: usize> {
    /// Axis by axis, in the machine's order.
    pub axes: [AxisErrors; N],
    /// The guide along the gear's axis, where the machine has one.
    pub guide: Guide,
    /// The work on its spindle.
    pub mounting: WorkMounting,
}

impl<const N: usize> MachineErrors<N> {
    /// Whether they may let passes that follow each other along the tooth differ: all of them but a gear that is off
    /// its spindle's axis, parallel to it.
    pub fn vary_along_feed(&self) -> bool {
        let of_axes = self.axes.iter().any(|axis| !axis.is_none());
        of_axes || !self.guide.is_none() || self.mounting.wobble_rad != 0.0
    }
}

impl<const N: usize> Default for MachineErrors<N> {
    fn default() -> Self {
        Self {
            axes: std::array::from_fn(|_| AxisErrors::default()),
            guide: Guide::default(),
            mounting: WorkMounting::default(),
        }
    }
}
