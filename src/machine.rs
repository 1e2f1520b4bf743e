//! What a machine is asked for, whatever its axes are called.

/// Largest magnitude of a speed or acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Magnitude, in rad or mm per s or s^2.
    pub value: f64,
    /// Moment at which it is reached: stroke coordinate of a shaper, s of a hobbing machine.
    pub stroke: f64,
    /// What the machine allows, if it is known.
    pub limit: Option<f64>,
}

impl Peak {
    /// What is left of the limit, as a share of it: negative when the limit is exceeded; `None` without a limit.
    pub fn margin(&self) -> Option<f64> {
        self.limit.map(|limit| 1.0 - self.value / limit)
    }
}
