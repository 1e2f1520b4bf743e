//! Largest speeds and accelerations of a machine's axes against what it allows.
//!
//! In: a [`Motion`] and the [`Limits`] of its axes. Out: a [`Peak`] for every axis and order. Law: each smooth piece of
//! the motion is sampled once for all axes, densely enough to see every lobe, and the best sample of each axis and
//! order is refined by golden-section search ([`gearcut_core::math::extremum`]).

use super::{Axis, Motion, Order};
use gearcut_core::math::extremum::{grid_place, maximum_of_grid};

/// What the machine allows an axis; `None`: not limited.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Limits {
    /// Largest speed, rad/s or mm/s.
    pub speed: Option<f64>,
    /// Largest acceleration, rad/s^2 or mm/s^2.
    pub acceleration: Option<f64>,
}

/// Largest magnitude of an axis's speed or acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// The axis.
    pub axis: &'static Axis,
    /// Speed or acceleration.
    pub order: Order,
    /// Magnitude, in rad or mm per s or s^2.
    pub value: f64,
    /// Coordinate of the motion at which it is reached.
    pub at: f64,
    /// What the machine allows, if it is known.
    pub limit: Option<f64>,
}

impl Limits {
    /// Largest value of an order; positions have none.
    pub fn of(&self, order: Order) -> Option<f64> {
        match order {
            Order::Position => None,
            Order::Speed => self.speed,
            Order::Acceleration => self.acceleration,
        }
    }
}

impl Peak {
    /// What is largest: `work spindle speed`.
    pub fn name(&self) -> String {
        format!("{} {}", self.axis.name, self.order.word())
    }

    /// Unit in which it is read.
    pub fn unit(&self) -> &'static str {
        self.axis.kind.unit(self.order)
    }

    /// The magnitude in that unit.
    pub fn shown(&self) -> f64 {
        self.axis.kind.shown(self.value)
    }

    /// The limit in that unit.
    pub fn shown_limit(&self) -> Option<f64> {
        self.limit.map(|limit| self.axis.kind.shown(limit))
    }

    /// What is left of the limit, as a share of it: negative when the limit is exceeded; `None` without a limit.
    pub fn margin(&self) -> Option<f64> {
        self.limit.map(|limit| 1.0 - self.value / limit)
    }

    /// Whether the machine allows less.
    pub fn exceeds_its_limit(&self) -> bool {
        self.limit.is_some_and(|limit| self.value > limit)
    }
}

/// Speed and acceleration of every axis, axis by axis; no acceleration where an axis has none to state.
pub fn peaks<const N: usize, M: Motion<N>>(motion: &M, limits: &[Limits; N]) -> Vec<Peak> {
    let quantities = (0..N).flat_map(|index| [Order::Speed, Order::Acceleration].map(|order| (index, order)));
    let mut peaks: Vec<(usize, Peak)> = quantities
        .filter(|&(index, order)| M::AXES[index].has(order))
        .map(|(index, order)| {
            (index, Peak { axis: &M::AXES[index], order, value: 0.0, at: 0.0, limit: limits[index].of(order) })
        })
        .collect();
    for (number, piece) in motion.pieces().into_iter().enumerate() {
        let range = [piece.from, piece.to];
        let grid: Vec<_> = (0..=piece.cells).map(|i| motion.at(grid_place(range, piece.cells, i))).collect();
        for (index, peak) in &mut peaks {
            let samples = grid.iter().map(|axes| axes[*index].of(peak.order).abs());
            let value = |coordinate| motion.at(coordinate)[*index].of(peak.order).abs();
            let (at, value) = maximum_of_grid(samples, value, range, piece.cells);
            // Of equal peaks the last one, so that the same motion always tells the same place.
            if number == 0 || value.total_cmp(&peak.value).is_ge() {
                (peak.at, peak.value) = (at, value);
            }
        }
    }
    peaks.into_iter().map(|(_, peak)| peak).collect()
}

/// What is left of the tightest limit, as a share of it; `None` without limits.
pub fn smallest_margin<'a>(peaks: impl IntoIterator<Item = &'a Peak>) -> Option<f64> {
    peaks.into_iter().filter_map(Peak::margin).min_by(f64::total_cmp)
}
