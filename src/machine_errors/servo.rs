//! The lag of a drive behind its command.
//!
//! In: the commanded speed and acceleration at nodes in time. Out: the lag at any time. Law: T e'' + e' + K_v e =
//! T q'' + (1 - f) q' (see [`super`]). Between two nodes the speed is the cubic through both speeds and accelerations;
//! for it the solution is a cubic in time and the loop's own decay, both in closed form, so that cells may be as long
//! as the command is smooth, whatever K_v is.
//!
//! Road not taken: a Runge-Kutta integration. Its step has to be a tenth of 1 / K_v: a hundred steps in a double stroke
//! instead of one.

/// A drive with velocity gain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Servo {
    /// K_v, 1/s, above 0.
    pub velocity_gain_per_s: f64,
    /// f: share of the commanded speed that is fed forward.
    pub feed_forward: f64,
    /// T: time constant of the speed loop, s; 0: it follows at once.
    pub speed_loop_s: f64,
}

/// Speed and acceleration of a command at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rates {
    pub velocity: f64,
    pub acceleration: f64,
}

/// A part of a motion over which the commanded speed is one cubic in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SpeedCell {
    pub start_s: f64,
    /// Coefficients in the time from the start.
    speed: [f64; 4],
}

/// The lag over one cell.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LagCell {
    /// Cubic in the time from the start.
    forced: [f64; 4],
    /// Value and rate of what decays.
    decaying: [f64; 2],
}

/// The lag over all cells.
#[derive(Debug, Clone)]
pub(super) struct Lag {
    servo: Servo,
    cells: Vec<LagCell>,
}

/// A cubic and its derivative.
fn cubic([a, b, c, d]: [f64; 4], t: f64) -> [f64; 2] {
    [a + t * (b + t * (c + t * d)), b + t * (2.0 * c + t * 3.0 * d)]
}

impl SpeedCell {
    pub fn new(start_s: f64, end_s: f64, from: Rates, to: Rates) -> Self {
        let h = end_s - start_s;
        let rise = (to.velocity - from.velocity) / h;
        let speed = [
            from.velocity,
            from.acceleration,
            (3.0 * rise - 2.0 * from.acceleration - to.acceleration) / h,
            (from.acceleration + to.acceleration - 2.0 * rise) / (h * h),
        ];
        Self { start_s, speed }
    }

    /// Speed at a time.
    pub fn speed(&self, time_s: f64) -> f64 {
        cubic(self.speed, time_s - self.start_s)[0]
    }
}

impl Servo {
    /// Whether the axis leaves its command at all: not if the whole speed is fed forward to a speed loop that follows
    /// at once.
    pub fn lags(&self) -> bool {
        self.feed_forward < 1.0 || self.speed_loop_s > 0.0
    }

    /// Time in which the loop forgets how it began, s: to e^-30 of it.
    pub(super) fn settling_s(&self) -> f64 {
        let [_, slowest] = self.poles_per_s();
        30.0 / slowest
    }

    /// Rates at which the loop decays, fast and slow, 1/s; their real parts.
    fn poles_per_s(&self) -> [f64; 2] {
        let (gain, t) = (self.velocity_gain_per_s, self.speed_loop_s);
        if t <= 0.0 {
            return [gain; 2];
        }
        let middle = 0.5 / t;
        let apart = (middle * middle - gain / t).max(0.0).sqrt();
        // The slow one without the difference of two large numbers.
        let fast = middle + apart;
        [fast, if apart > 0.0 { gain / t / fast } else { middle }]
    }

    /// The cubic that the lag settles to.
    fn forced(&self, cell: &SpeedCell) -> [f64; 4] {
        let (gain, t, rest) = (self.velocity_gain_per_s, self.speed_loop_s, 1.0 - self.feed_forward);
        let speed = |k: usize| cell.speed.get(k).copied().unwrap_or(0.0);
        let mut p = [0.0; 6];
        for k in (0..4).rev() {
            let order = k as f64;
            let force = rest * speed(k) + t * (order + 1.0) * speed(k + 1);
            p[k] = (force - (order + 1.0) * p[k + 1] - t * (order + 2.0) * (order + 1.0) * p[k + 2]) / gain;
        }
        [p[0], p[1], p[2], p[3]]
    }

    /// What is left of a deviation and its rate after a time, and its rate then.
    fn decay(&self, [from, rate]: [f64; 2], time_s: f64) -> [f64; 2] {
        let (gain, t) = (self.velocity_gain_per_s, self.speed_loop_s);
        if t <= 0.0 {
            let left = from * (-gain * time_s).exp();
            return [left, -gain * left];
        }
        let middle = 0.5 / t;
        let square = middle * middle - gain / t;
        if square.abs() < 1e-12 * middle * middle {
            let (fall, slope) = ((-middle * time_s).exp(), rate + middle * from);
            return [(from + slope * time_s) * fall, (rate - middle * slope * time_s) * fall];
        }
        if square < 0.0 {
            let around = (-square).sqrt();
            let ((sin, cos), fall) = ((around * time_s).sin_cos(), (-middle * time_s).exp());
            let across = (rate + middle * from) / around;
            let left = from * cos + across * sin;
            return [left * fall, (around * (across * cos - from * sin) - middle * left) * fall];
        }
        let [fast, slow] = self.poles_per_s();
        // e = A exp(-slow t) + B exp(-fast t).
        let a = (rate + fast * from) / (fast - slow);
        let [a, b] = [a * (-slow * time_s).exp(), (from - a) * (-fast * time_s).exp()];
        [a + b, -slow * a - fast * b]
    }
}

impl Lag {
    /// Lag over cells that follow each other; before the first one it has settled.
    pub fn new(servo: Servo, cells: &[SpeedCell]) -> Self {
        let mut lag = Self { servo, cells: Vec::with_capacity(cells.len()) };
        let mut before: Option<(&SpeedCell, [f64; 2])> = None;
        for (index, cell) in cells.iter().enumerate() {
            let forced = servo.forced(cell);
            let [at, rate] = match before {
                None => [forced[0], forced[1]],
                // The axis itself does not jump, nor does its speed: a jump of the command's speed is one of the lag's.
                Some((last, [at, rate])) => [at, rate + cell.speed[0] - last.speed(cell.start_s)],
            };
            lag.cells.push(LagCell { forced, decaying: [at - forced[0], rate - forced[1]] });
            if let Some(next) = cells.get(index + 1) {
                before = Some((cell, lag.in_cell(index, next.start_s - cell.start_s)));
            }
        }
        lag
    }

    /// Lag and its rate in a cell, at a time from the cell's start.
    pub fn in_cell(&self, cell: usize, passed_s: f64) -> [f64; 2] {
        let LagCell { forced, decaying } = self.cells[cell];
        let (forced, left) = (cubic(forced, passed_s), self.servo.decay(decaying, passed_s));
        [forced[0] + left[0], forced[1] + left[1]]
    }
}
