//! What an axis does at random.
//!
//! In: a standard deviation, a law, a seed. Out: the displacement of the axis at any moment, the same one whenever and
//! in whatever order it is asked for. Two laws:
//!
//! - **Passage by passage**: one independent normal number for every passage of the tool (a stroke and its way back).
//! - **In time**: the first-order Gauss-Markov process, normal with autocovariance sigma^2 exp(-|dt| / tau) (Uhlenbeck
//!   and Ornstein, *On the theory of the Brownian motion*, 1930). It is noise behind a low-pass filter of first order;
//!   its power falls to a half at the bandwidth f_c = 1 / (2 pi tau).
//!
//! The process is halved where others walk along it. Knots 64 tau apart are taken as independent: their correlation is
//! exp(-64), below what f64 resolves. Between two knots a time h away on both sides, with c = exp(-h / tau), the value
//! is normal with the mean c (a + b) / (1 + c^2) and the variance sigma^2 (1 - c^2) / (1 + c^2): the two conditions of
//! a Gauss-Markov process on both its neighbours. That is exact (as is the step forwards of Gillespie, *Exact numerical
//! simulation of the Ornstein-Uhlenbeck process*, 1996), and each value has a place in a tree of halves, which is its
//! key. Eighteen halvings lead to pieces of tau / 4096; within them the course is straight, with at most 0.012 % of the
//! variance missing in their middles. What a slow noise changes by within a stroke, of which 64 pieces are but 0.18
//! sigma, then has its variance to 1 %.
//!
//! A tool that is in the work all the time cuts with polynomials in its angle ([`gearcut_core::passes::MotionTable`]),
//! and an axis with a mass does not jump: there the process is made **smooth**, a quintic B-spline with its values at
//! even knots as coefficients (de Boor, *A Practical Guide to Splines*, 1978), over the spline's own standard deviation
//! at the moment. Four rates are continuous, the variance is sigma^2 at every moment, and what is slower than some
//! knots stays as it is.
//!
//! Road not taken: stepping forwards from the beginning and keeping all values. It takes memory that grows with time
//! and bandwidth, and would need a limit.

use crate::random::Draws;
use std::f64::consts::TAU;
use std::sync::LazyLock;

/// Knots without correlation stand this many time constants apart.
const KNOTS_APART: f64 = 64.0;
/// Halvings between them.
const HALVINGS: u32 = 18;
/// For every halving c and the deviation of a value from its mean.
static HALVES: LazyLock<[[f64; 2]; HALVINGS as usize]> = LazyLock::new(|| {
    std::array::from_fn(|halving| {
        let c = (-0.5_f64.powi(halving as i32 + 1) * KNOTS_APART).exp();
        [c, ((1.0 - c * c) / (1.0 + c * c)).sqrt()]
    })
});

/// Noise of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisNoise {
    /// Standard deviation, rad or mm.
    pub deviation: f64,
    /// How it goes on.
    pub law: NoiseLaw,
    /// Where its numbers come from.
    pub draws: Draws,
}

/// How noise goes on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoiseLaw {
    /// Another value for every passage of the tool.
    EachPassage,
    /// In time, whether the feed goes on or rests.
    InTime {
        /// Bandwidth f_c, Hz.
        bandwidth_hz: f64,
    },
    /// Along the feed: in time while the feed goes on, and at rest where it rests.
    AlongFeed {
        /// Bandwidth f_c while the feed goes on, Hz.
        bandwidth_hz: f64,
    },
}

impl NoiseLaw {
    /// The process along a feed that takes so long for the arc in which it forgets.
    pub fn along_feed(time_constant_s: f64) -> Self {
        Self::AlongFeed { bandwidth_hz: 1.0 / (TAU * time_constant_s) }
    }

    /// Bandwidth, Hz, of a process in time.
    pub fn bandwidth_hz(&self) -> Option<f64> {
        match *self {
            Self::EachPassage => None,
            Self::InTime { bandwidth_hz } | Self::AlongFeed { bandwidth_hz } => Some(bandwidth_hz),
        }
    }

    /// Whether the noise goes on while the feed rests.
    pub fn goes_on_at_rest(&self) -> bool {
        matches!(self, Self::InTime { .. })
    }
}

impl AxisNoise {
    /// Displacement of the axis, rad or mm, at a time from the beginning of the first operation and in a passage.
    pub fn at(&self, since_start_s: f64, passage: i64) -> f64 {
        let number = match self.law.bandwidth_hz() {
            None => self.draws.normal([passage, 0]),
            Some(bandwidth_hz) => self.course(since_start_s * TAU * bandwidth_hz),
        };
        self.deviation * number
    }

    /// The same smoothed, where the process goes on in time: by a spline over knots so far apart, s.
    pub fn smoothed_at(&self, since_start_s: f64, passage: i64, knots_s: f64) -> f64 {
        let Some(bandwidth_hz) = self.law.bandwidth_hz() else { return self.at(since_start_s, passage) };
        let place = since_start_s / knots_s;
        let (first, share) = (place.floor(), place - place.floor());
        let correlation = (-TAU * bandwidth_hz * knots_s).exp();
        // Sums over the knots so far: of the weights, each less by the correlation with every knot passed since; of
        // the variance, from the covariances of all pairs; of the values.
        let (mut correlated, mut variance, mut value) = (0.0, 0.0, 0.0);
        for (knot, weight) in quintic(share).into_iter().enumerate() {
            correlated *= correlation;
            variance += weight * (weight + 2.0 * correlated);
            correlated += weight;
            value += weight * self.at((first + knot as f64 - 2.0) * knots_s, passage);
        }
        value / variance.sqrt()
    }

    /// The process of variance 1 at a time in time constants.
    fn course(&self, time: f64) -> f64 {
        let place = time / KNOTS_APART;
        let first = place.floor();
        let knot = |knot: f64| self.draws.normal([knot as i64, 0]);
        let (mut before, mut after) = (knot(first), knot(first + 1.0));
        let (mut share, mut node) = (place - first, 1_i64);
        for [c, deviation] in *HALVES {
            let mean = c * (before + after) / (1.0 + c * c);
            let middle = mean + deviation * self.draws.normal([first as i64, node]);
            share *= 2.0;
            if share < 1.0 {
                (after, node) = (middle, 2 * node);
            } else {
                (before, node) = (middle, 2 * node + 1);
                share -= 1.0;
            }
        }
        before + share * (after - before)
    }
}

/// Weights of six even knots, from the second before the interval's beginning on, at a share of the interval.
fn quintic(x: f64) -> [f64; 6] {
    let outer = |x: f64| x.powi(5);
    let middle = |x: f64| 26.0 + x * (50.0 + x * (20.0 + x * (-20.0 + x * (-20.0 + x * 10.0))));
    let inner = |x: f64| 1.0 + x * (5.0 + x * (10.0 + x * (10.0 + x * (5.0 - 5.0 * x))));
    let y = 1.0 - x;
    [outer(y), inner(y), middle(y), middle(x), inner(x), outer(x)].map(|weight| weight / 120.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(law: NoiseLaw, seed: u32) -> AxisNoise {
        AxisNoise { deviation: 3.0, law, draws: Draws::new(seed, 0) }
    }

    /// Mean of products of values, each pair from times that share nothing with those of others.
    fn covariance(noise: &AxisNoise, apart: f64, offset: f64, count: i32) -> f64 {
        let tau_s = 2.0;
        let products = (0..count).map(|index| {
            let time_s = (f64::from(index) * 3.0 * KNOTS_APART + offset) * tau_s;
            noise.at(time_s, 0) * noise.at(time_s + apart * tau_s, 0)
        });
        products.sum::<f64>() / f64::from(count)
    }

    /// The variance is that of the process wherever the moment is between knots; what is slow against the knots stays;
    /// and fourth differences shrink with the fourth power of their step, as those of a smooth course do.
    #[test]
    fn smoothed_noise_has_its_variance_and_four_rates() {
        let tau_s = 2.0;
        let noise = noise(NoiseLaw::InTime { bandwidth_hz: 1.0 / (TAU * tau_s) }, 5);
        let count = 5_000;
        for place in [0.0, 0.25, 0.5] {
            let square = |index: i32| {
                let time_s = (f64::from(index) * 160.0 + place) * 0.4 * tau_s;
                noise.smoothed_at(time_s, 0, 0.4 * tau_s).powi(2)
            };
            let found = (0..count).map(square).sum::<f64>() / f64::from(count) / 9.0;
            assert!((found - 1.0).abs() < 4.0 * (2.0 / f64::from(count)).sqrt(), "{place}: variance {found}");
        }
        let apart = (0..500)
            .map(|i| 0.77 * f64::from(i))
            .map(|time_s| (noise.smoothed_at(time_s, 0, 1e-4 * tau_s) - noise.at(time_s, 0)).abs());
        assert!(apart.fold(0.0, f64::max) < 3.0 * 6.0 * (2e-4_f64).sqrt());
        let fourth = |step_s: f64| {
            let at = |time_s: f64| noise.smoothed_at(time_s, 0, 1.0);
            let of = |t: f64| {
                let [a, b, c, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| at(t + k * step_s));
                (a - 4.0 * b + 6.0 * c - 4.0 * d + e).abs()
            };
            (0..2000).map(|i| of(0.37 * f64::from(i))).fold(0.0, f64::max)
        };
        let shrinks = fourth(0.02) / fourth(0.01);
        assert!((15.0..17.0).contains(&shrinks), "{shrinks}");
    }

    /// sigma^2 exp(-|dt| / tau), wherever the pair stands among the knots. Products of normal numbers of correlation r
    /// have the variance 1 + r^2: of 60,000 four times the scatter is 2.3 %.
    #[test]
    fn noise_in_time_has_the_covariance_of_its_process() {
        let noise = noise(NoiseLaw::InTime { bandwidth_hz: 1.0 / (TAU * 2.0) }, 5);
        let count = 60_000;
        for (apart, offset) in [(0.0, 0.0), (0.0, 10.1), (0.1, 3.3), (0.5, 31.9), (1.0, 63.5), (2.0, 17.0), (9.0, 60.0)]
        {
            let expected = f64::exp(-apart);
            let found = covariance(&noise, apart, offset, count) / 9.0;
            let scatter = ((1.0 + expected * expected) / f64::from(count)).sqrt();
            assert!(
                (found - expected).abs() < 4.0 * scatter + 0.002,
                "{apart} tau from {offset}: {found} for {expected}"
            );
        }
    }

    #[test]
    fn noise_of_passages_is_white() {
        let noise = noise(NoiseLaw::EachPassage, 5);
        let count = 200_000;
        for apart in [0, 1, 2, 7] {
            let sum: f64 = (0..count).map(|passage| noise.at(0.0, passage) * noise.at(1.0, passage + apart)).sum();
            let expected = if apart == 0 { 9.0 } else { 0.0 };
            let scatter = 9.0 * (2.0 / count as f64).sqrt();
            assert!((sum / count as f64 - expected).abs() < 4.0 * scatter, "{apart} passages apart");
        }
    }

    #[test]
    fn noise_is_continuous_and_another_one_with_another_seed() {
        let law = NoiseLaw::InTime { bandwidth_hz: 1.0 };
        let (here, there) = (noise(law, 1), noise(law, 2));
        let piece_s = 1.0 / TAU / 4096.0;
        let mut differences = 0.0_f64;
        for index in 0..5000 {
            let time_s = f64::from(index) * 5.92 * piece_s - 3.0;
            // Over a thousandth of a piece; a piece's ends differ by 0.022 sigma at one standard deviation.
            let step = here.at(time_s + 1e-3 * piece_s, 0) - here.at(time_s, 0);
            assert!(step.abs() < 3.0 * 0.022 * 6.0 * 1e-3, "{step} at {time_s} s");
            differences = differences.max((here.at(time_s, 0) - there.at(time_s, 0)).abs());
        }
        assert!(differences > 1.0);
    }
}
