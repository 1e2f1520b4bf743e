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
//! Road not taken: stepping forwards from the beginning and keeping all values. It takes memory that grows with time
//! and bandwidth, and would need a limit.

use crate::random::Draws;
use std::f64::consts::TAU;

/// Knots without correlation stand this many time constants apart.
const KNOTS_APART: f64 = 64.0;
/// Halvings between them.
const HALVINGS: u32 = 18;
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

    /// Whether the noise goes on while the feed rests.
    pub fn goes_on_at_rest(&self) -> bool {
        matches!(self, Self::InTime { .. })
    }
}

impl AxisNoise {
    /// Displacement of the axis, rad or mm, at a time from the beginning of the first operation and in a passage.
    pub fn at(&self, since_start_s: f64, passage: i64) -> f64 {
        let number = match self.law {
            NoiseLaw::EachPassage => self.draws.normal([passage, 0]),
            NoiseLaw::InTime { bandwidth_hz } | NoiseLaw::AlongFeed { bandwidth_hz } => {
                self.course(since_start_s * TAU * bandwidth_hz)
            }
        };
        self.deviation * number
    }

    /// The process of variance 1 at a time in time constants.
    fn course(&self, time: f64) -> f64 {
        let place = time / KNOTS_APART;
        let first = place.floor();
        let knot = |knot: f64| self.draws.normal([knot as i64, 0]);
        let (mut before, mut after) = (knot(first), knot(first + 1.0));
        let (mut share, mut node, mut half) = (place - first, 1_i64, 0.5 * KNOTS_APART);
        for _ in 0..HALVINGS {
            let c = (-half).exp();
            let (mean, variance) = (c * (before + after) / (1.0 + c * c), (1.0 - c * c) / (1.0 + c * c));
            let middle = mean + variance.sqrt() * self.draws.normal([first as i64, node]);
            share *= 2.0;
            if share < 1.0 {
                (after, node) = (middle, 2 * node);
            } else {
                (before, node) = (middle, 2 * node + 1);
                share -= 1.0;
            }
            half *= 0.5;
        }
        before + share * (after - before)
    }
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
