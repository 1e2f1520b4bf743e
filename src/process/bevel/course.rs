//! One slot's motion: how the machine goes through it in time, and the linked axes with their rates.
//!
//! In: settings and the ends of a roll, or the way of a plunge. Out: [`SlotCourse`], the moment of the slot
//! ([`CradleSettings::at`]) at any time from its beginning, and [`SlotCourse::axes`]. A roll is even and goes on so
//! beyond its ends, where blades are still in the work. A plunge is even as well; then the head stays at full depth.

use crate::machine::{Axis, AxisKind, AxisMotion};
use gearcut_core::bevel::cradle::CradleSettings;
use gearcut_core::bevel::five_axis::FiveAxisMachine;
use gearcut_core::math::Jet;

/// The linked axes.
pub const AXES: [Axis; 5] = [
    Axis::new("X", "x", 'X', AxisKind::Linear).called("X axis"),
    Axis::new("Y", "y", 'Y', AxisKind::Linear).called("Y axis"),
    Axis::new("Z", "z", 'Z', AxisKind::Linear).called("Z axis"),
    Axis::new("A work spindle", "work", 'A', AxisKind::Rotary).called("work spindle"),
    Axis::new("B swing", "swing", 'B', AxisKind::Rotary).called("swing axis"),
];

/// One slot in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlotCourse {
    /// Moments at which the motion begins and ends: cradle angles, rad, or places of the head before full depth, mm.
    pub range: [f64; 2],
    /// Change of the moment per second, with its sign.
    pub per_s: f64,
    /// How long the head then stays at full depth, s; 0 where the cradle rolls.
    pub dwell_s: f64,
}

impl SlotCourse {
    /// Time until the motion ends, s.
    pub fn moving_s(&self) -> f64 {
        (self.range[1] - self.range[0]) / self.per_s
    }

    /// Time of a slot, s.
    pub fn slot_s(&self) -> f64 {
        self.moving_s() + self.dwell_s
    }

    /// Times of a slot between which rates do not jump, s.
    pub fn pieces_s(&self) -> Vec<[f64; 2]> {
        let moving_s = self.moving_s();
        let dwell = (self.dwell_s > 0.0).then_some([moving_s, self.slot_s()]);
        [[0.0, moving_s]].into_iter().chain(dwell).collect()
    }

    /// The moment at a time from the beginning of the slot, and its rate per second.
    pub fn at(&self, time_s: f64) -> [f64; 2] {
        let dwells = self.dwell_s > 0.0 && time_s >= self.moving_s();
        if dwells { [self.range[1], 0.0] } else { [self.range[0] + self.per_s * time_s, self.per_s] }
    }

    /// X, Y, Z, A and B at a time from the beginning of the slot, mm, rad and per s: those of a circle and of the
    /// roll's polynomial, of a tilted head, or of a straight way along Z.
    pub fn axes(&self, machine: FiveAxisMachine, settings: &CradleSettings, time_s: f64) -> [AxisMotion; 5] {
        let [moment, per_s] = self.at(time_s);
        let axes = machine.axes_of_cradle(settings, moment);
        let [x, y, z] = axes.slides_mm.to_array();
        let of_moment = if settings.plunges() {
            let rest = [x, y, axes.work_rad, axes.swing_rad].map(Jet::constant);
            [rest[0], rest[1], Jet::from_derivatives([z, 1.0, 0.0]), rest[2], rest[3]]
        } else if !settings.tilt.is_none() {
            let [x, y, z, work, swing, _] = machine.axes_of_tilted(settings, moment);
            [x, y, z, work, swing]
        } else {
            let (sin, cos) = moment.sin_cos();
            let s = settings.radial_setting_mm;
            [
                Jet::from_derivatives([x, -s * sin, -s * cos]),
                Jet::from_derivatives([y, s * cos, -s * sin]),
                Jet::constant(z),
                settings.work_angle_jet(moment),
                Jet::constant(axes.swing_rad),
            ]
        };
        of_moment.map(|series: Jet<3>| AxisMotion::along(series, per_s))
    }
}
