//! A machine as its axes say it, whatever the process: names, kinds, motion, limits, peaks.
//!
//! In: the axes of a machine ([`Axis`]), where they stand and how they move at any value of one coordinate, time or
//! stroke ([`Motion`]), and what each is allowed ([`Limits`]). Out: units and names of columns, which follow from the
//! kind of an axis ([`AxisKind`]), and the largest speeds and accelerations against the limits ([`peaks`]).
//!
//! How a table, a chart or a sentence is made from that is said once for all processes in [`crate::steps::axes`].
//!
//! Road not taken: a struct with a named field for every axis. Each table, chart and warning then has to list the axes
//! again, in its own words and units.

mod axis;
mod peak;
#[cfg(test)]
pub(crate) mod tests;

pub use axis::{Axis, AxisKind, Order};
pub use peak::{Limits, Peak, peaks, smallest_margin};

use gearcut_core::math::Jet;

/// One axis at one moment; rad or mm, per s, per s^2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisMotion {
    /// Where it stands.
    pub position: f64,
    /// How fast it moves, per s.
    pub velocity: f64,
    /// How it accelerates, per s^2.
    pub acceleration: f64,
}

/// A part of a motion without corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionPiece {
    /// Coordinate at which it begins.
    pub from: f64,
    /// Coordinate at which it ends, just before a corner: what holds there belongs to the next piece.
    pub to: f64,
    /// Even cells, no hump of a speed or acceleration narrower than two of them.
    pub cells: usize,
}

/// N named axes that move along one coordinate.
pub trait Motion<const N: usize> {
    /// The axes in their order.
    const AXES: &'static [Axis; N];

    /// Where they stand and how they move at a coordinate, in the order of [`Self::AXES`].
    fn at(&self, coordinate: f64) -> [AxisMotion; N];

    /// Pieces without corners that show all of the motion.
    fn pieces(&self) -> Vec<MotionPiece>;
}

impl AxisMotion {
    /// From a series in a coordinate that advances by `per_s` every second.
    pub fn along(series: Jet<3>, per_s: f64) -> Self {
        Self {
            position: series.value(),
            velocity: series.derivative(1) * per_s,
            acceleration: series.derivative(2) * per_s * per_s,
        }
    }

    /// Position, velocity or acceleration.
    pub fn of(&self, order: Order) -> f64 {
        match order {
            Order::Position => self.position,
            Order::Speed => self.velocity,
            Order::Acceleration => self.acceleration,
        }
    }
}
