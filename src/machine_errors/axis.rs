//! What is wrong with one axis.

use super::noise::AxisNoise;
use super::servo::Servo;

/// Errors of an axis; rad on rotary axes, mm on linear ones.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AxisErrors {
    /// The axis moves 1 + this times as far as its scale says, counted from position 0.
    pub scale: f64,
    /// Errors that repeat along the axis.
    pub periodic: Vec<PeriodicError>,
    /// Play: how far the drive turns back before the axis follows.
    pub backlash: f64,
    /// How the drive follows its command; `None`: without lag.
    pub servo: Option<Servo>,
    /// How the electronic gearbox gives commands; `None`: continuously and exactly.
    pub gearbox: Option<GearboxCycle>,
    /// How the axis drifts as the machine warms up; `None`: not at all.
    pub drift: Option<ThermalDrift>,
    /// What is left at random, each independent of the others.
    pub noise: Vec<AxisNoise>,
}

/// An error A sin(k y + phi) of an axis at y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeriodicError {
    /// k: waves in 2 pi rad of a rotary axis, rad per mm of a linear one.
    pub rate: f64,
    /// A, rad or mm.
    pub amplitude: f64,
    /// phi, rad.
    pub phase_rad: f64,
}

/// Commands once in a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GearboxCycle {
    /// Time of a cycle, s, above 0.
    pub cycle_s: f64,
    /// Step to which commands are rounded, rad or mm; 0: none.
    pub increment: f64,
}

/// A drift `rate` t, or `rate` tau (1 - exp(-t / tau)) where it settles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThermalDrift {
    /// Speed at the beginning, rad/s or mm/s.
    pub per_s: f64,
    /// Time constant tau, s; `None`: it goes on evenly.
    pub time_constant_s: Option<f64>,
}

impl AxisErrors {
    /// Whether nothing is wrong.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Where the axis stands when its drive, the backlash passed, stands at `drive`; `since_start_s` is the time from
    /// the beginning of the first operation.
    pub(super) fn guided(&self, drive: f64, since_start_s: f64) -> f64 {
        let periodic = self.periodic.iter().map(|of| of.amplitude * (of.rate * drive + of.phase_rad).sin());
        let drift = self.drift.map_or(0.0, |drift| drift.after(since_start_s));
        drive + self.scale * drive + periodic.sum::<f64>() + drift
    }
}

impl ThermalDrift {
    fn after(&self, time_s: f64) -> f64 {
        match self.time_constant_s {
            None => self.per_s * time_s,
            Some(tau_s) => -self.per_s * tau_s * (-time_s / tau_s).exp_m1(),
        }
    }
}

impl GearboxCycle {
    /// The command in force at a time, from the exact one: reached a cycle late, straight from one to the next.
    pub(super) fn command(&self, time_s: f64, exact: impl Fn(f64) -> f64) -> f64 {
        let cycle = (time_s / self.cycle_s).floor();
        let share = time_s / self.cycle_s - cycle;
        let given = |cycle: f64| {
            let position = exact(cycle * self.cycle_s);
            if self.increment > 0.0 { (position / self.increment).round() * self.increment } else { position }
        };
        let (before, after) = (given(cycle - 1.0), given(cycle));
        before + share * (after - before)
    }
}
