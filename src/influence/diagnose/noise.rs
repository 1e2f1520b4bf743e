//! Noise of measured values: each on its own, and that of the machine's axes, which goes on from place to place.
//!
//! In: the standard deviation of the values, the scene's noise of its axes, and when each place is cut. Out: values
//! over their noise, as least squares take them.
//!
//! Law. A place that is cut at the time t is off by the sum of s n(t) over the noisy axes: n the axis's noise, s what a
//! unit of that axis adds there, by cuts with the axis shifted by its standard deviation to either side. Noise in time
//! has the autocovariance exp(-|dt| / tau) ([`crate::machine_errors::AxisNoise`]): a Gauss-Markov process, of which the
//! past says no more than its last value. In the order of cutting, values over their noise are the innovations of the
//! Kalman filter (R. E. Kalman, *A New Approach to Linear Filtering and Prediction Problems*, 1960) over their standard
//! deviations: independent and of variance 1, and the sum of their squares is that of the values over their whole
//! covariance. Noise of passages is known anew with every pass.
//!
//! That is linear in n, and heights are not: where two strokes come about as deep (the cut ends over its beginning),
//! the deeper one remains. For noises m and n of both a place then has (m + n) / 2 - |m - n| / 2, and the line n alone:
//! its error has twice the mean square of the even part, |m - n| / 2. Gears that are cut with courses of noise and with
//! the same courses turned over show that part at every place; twice its mean square is added to the variance of its
//! value.
//!
//! Roads not taken: whole flanks that are off at random. A drive that wanders over some seconds bends profiles of a
//! gear whose teeth take longer, and neighbouring teeth lean alike. The whole covariance as a matrix: the same numbers
//! for the cube of the places. Roughness of the edges as marks that places of one stroke share along the tooth: guide
//! and wobble lead the edge some micrometres past the place, which is enough for another part of the roughness, and
//! intervals held less often than with a noise of each value.

use super::cuts::{MeasuredCuts, without_random};
use crate::interrupt::Interrupt;
use crate::machine_errors::{AxisErrors, AxisNoise, NoiseLaw, PeriodicError};
use crate::progress::Progress;
use crate::scene::Scene;
use gearcut_core::error::Result;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Courses of noise, each cut to both sides, that show where heights are not linear in it.
const COURSES: u32 = 8;

/// Noise of the values of a diagnosis.
#[derive(Debug, Clone, Default)]
pub struct Noise {
    /// Standard deviation of each value on its own, um.
    pub value_um: f64,
    axes: Vec<PlacedNoise>,
    /// When the places are cut, s; none without noise of axes.
    times_s: Vec<f64>,
    /// Variances of what the axes do besides, um^2; none without noise of axes.
    bent_um2: Vec<f64>,
}

/// Noise of an axis at the measured places.
#[derive(Debug, Clone)]
struct PlacedNoise {
    law: NoiseLaw,
    /// What a standard deviation of it adds at each place, um.
    um: Vec<f64>,
}

impl Noise {
    /// Of values alone, um.
    pub fn of_values(value_um: f64) -> Self {
        Self { value_um, ..Self::default() }
    }

    /// With that of the scene's axes.
    ///
    /// # Errors
    /// Geometry that cannot be cut; the backend's; places where no pass comes; Ctrl-C.
    pub fn and_axes(self, cuts: &MeasuredCuts, progress: &Progress, interrupt: &Interrupt) -> Result<Self> {
        let noises = axis_noises(&cuts.loaded.scene);
        if noises.iter().all(Vec::is_empty) {
            return Ok(self);
        }
        let still = without_random(&cuts.loaded.scene);
        let cut_um = |change: &dyn Fn(usize, &mut AxisErrors)| {
            let mut scene = still.clone();
            scene.process.axis_errors_mut().iter_mut().enumerate().for_each(|(index, axis)| change(index, axis));
            interrupt.check()?;
            cuts.one_gears_um(&scene)
        };
        let noisy = noises.iter().filter(|noise| !noise.is_empty()).count() as u64;
        let step = progress.step("noise of axes", u64::from(COURSES) + noisy, "axes and courses");
        let mut axes = Vec::new();
        for (axis, noise) in noises.iter().enumerate().filter(|(_, noise)| !noise.is_empty()) {
            let deviation = noise.iter().map(|noise| noise.deviation.powi(2)).sum::<f64>().sqrt();
            let shifted_um = |by: f64| {
                cut_um(&|index, errors| {
                    if index == axis {
                        errors.periodic.push(PeriodicError { rate: 0.0, amplitude: by, phase_rad: FRAC_PI_2 });
                    }
                })
            };
            let (above, below) = (shifted_um(deviation)?, shifted_um(-deviation)?);
            axes.extend(noise.iter().map(|&AxisNoise { deviation: own, law, .. }| {
                let um = above.iter().zip(&below).map(|(a, b)| 0.5 * (a - b) * own / deviation);
                PlacedNoise { law, um: um.collect() }
            }));
            step.advance(1);
        }
        let still_um = cut_um(&|_, _| ())?;
        let mut bent_um2 = vec![0.0; still_um.len()];
        for course in 1..=COURSES {
            let with_um = |sign: f64| {
                let of_course = |noise: &AxisNoise| {
                    let AxisNoise { deviation, law, draws } = *noise;
                    AxisNoise { deviation: sign * deviation, law, draws: draws.of_gear(course) }
                };
                cut_um(&|index, errors| errors.noise = noises[index].iter().map(of_course).collect())
            };
            let (one, other) = (with_um(1.0)?, with_um(-1.0)?);
            for (place, variance) in bent_um2.iter_mut().enumerate() {
                let even_um = 0.5 * (one[place] + other[place]) - still_um[place];
                *variance += 2.0 * even_um.powi(2) / f64::from(COURSES);
            }
            step.advance(1);
        }
        step.finish();
        Ok(Self { axes, times_s: cuts.times_s()?, bent_um2, ..self })
    }

    /// Standard deviation that the axes make, root mean square over the places, um.
    pub fn axes_um(&self) -> f64 {
        let squares: f64 = self.axes.iter().flat_map(|axis| &axis.um).map(|um| um * um).sum();
        (squares / self.times_s.len().max(1) as f64).sqrt()
    }

    /// Values of all places over their noise; `taken` says which of them there are.
    pub(super) fn over(&self, values_um: &[f64], taken: impl Fn(usize) -> bool) -> Vec<f64> {
        let mut order: Vec<usize> = (0..values_um.len()).filter(|&place| taken(place)).collect();
        if self.axes.is_empty() {
            return order.into_iter().map(|place| values_um[place] / self.value_um).collect();
        }
        order.sort_by(|&a, &b| self.times_s[a].total_cmp(&self.times_s[b]));
        let mut filter = KalmanFilter::new(self.axes.len());
        let mut over = Vec::with_capacity(order.len());
        let mut before_s = f64::NEG_INFINITY;
        for place in order {
            let passed_s = self.times_s[place] - before_s;
            filter.wait(self.axes.iter().map(|axis| correlation(axis.law, passed_s)));
            let adds_um: Vec<f64> = self.axes.iter().map(|axis| axis.um[place]).collect();
            let own_um2 = self.value_um.powi(2) + self.bent_um2[place];
            over.push((place, filter.innovation(&adds_um, values_um[place], own_um2)));
            before_s = self.times_s[place];
        }
        over.sort_by_key(|&(place, _)| place);
        over.into_iter().map(|(_, over)| over).collect()
    }
}

/// Noise of every axis of a scene.
fn axis_noises(scene: &Scene) -> Vec<Vec<AxisNoise>> {
    scene.clone().process.axis_errors_mut().iter().map(|axis| axis.noise.clone()).collect()
}

/// Correlation of a noise with itself so much later.
fn correlation(law: NoiseLaw, passed_s: f64) -> f64 {
    match law.bandwidth_hz() {
        Some(bandwidth_hz) => (-TAU * bandwidth_hz * passed_s).exp(),
        None => f64::from(u8::from(passed_s == 0.0)),
    }
}

/// Of processes of variance 1.
struct KalmanFilter {
    expected: Vec<f64>,
    /// Covariance of what is not known of them, row by row.
    covariance: Vec<f64>,
}

impl KalmanFilter {
    /// Before the first value.
    fn new(count: usize) -> Self {
        let one = |index: usize| f64::from(u8::from(index.is_multiple_of(count + 1)));
        Self { expected: vec![0.0; count], covariance: (0..count * count).map(one).collect() }
    }

    /// Lets time pass after which the processes have these correlations with themselves.
    fn wait(&mut self, correlations: impl Iterator<Item = f64>) {
        let kept: Vec<f64> = correlations.collect();
        for (row, of_row) in kept.iter().enumerate() {
            self.expected[row] *= of_row;
            for (column, of_column) in kept.iter().enumerate() {
                self.covariance[row * kept.len() + column] *= of_row * of_column;
            }
            self.covariance[row * (kept.len() + 1)] += 1.0 - of_row * of_row;
        }
    }

    /// How far a value is off what the earlier ones let expect, over its standard deviation. The processes add
    /// `adds` each to it, and a noise of its own of this variance.
    fn innovation(&mut self, adds: &[f64], value: f64, own: f64) -> f64 {
        let dot = |a: &[f64]| a.iter().zip(adds).map(|(a, b)| a * b).sum::<f64>();
        let off = value - dot(&self.expected);
        let with: Vec<f64> = self.covariance.chunks(adds.len()).map(dot).collect();
        let variance = dot(&with) + own;
        for (row, of_row) in with.iter().enumerate() {
            self.expected[row] += of_row * off / variance;
            for (column, of_column) in with.iter().enumerate() {
                self.covariance[row * adds.len() + column] -= of_row * of_column / variance;
            }
        }
        off / variance.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TAU_S: f64 = 2.0;

    /// Places in no order of time, two at the same moment, under a noise in time and one of passages.
    fn noise() -> Noise {
        let in_time = NoiseLaw::InTime { bandwidth_hz: 1.0 / (TAU * TAU_S) };
        Noise {
            value_um: 0.4,
            axes: vec![
                PlacedNoise { law: in_time, um: vec![0.9, -0.7, 1.3, 0.2, 0.5] },
                PlacedNoise { law: NoiseLaw::EachPassage, um: vec![0.3, 0.6, -0.8, 0.4, 2.0] },
            ],
            times_s: vec![3.0, 1.0, 3.0, 9.0, 1.5],
            bent_um2: vec![0.0, 0.5, 0.0, 0.0, 0.0],
        }
    }

    /// x C^-1 x by elimination.
    fn squares_over(covariance: &[Vec<f64>], x: &[f64]) -> f64 {
        let mut rows: Vec<Vec<f64>> = covariance.iter().zip(x).map(|(row, x)| [&row[..], &[*x]].concat()).collect();
        let mut sum = 0.0;
        for pivot in 0..x.len() {
            let row = rows[pivot].clone();
            sum += row[x.len()] * row[x.len()] / row[pivot];
            for below in &mut rows[pivot + 1..] {
                let times = below[pivot] / row[pivot];
                below.iter_mut().zip(&row).for_each(|(a, b)| *a -= times * b);
            }
        }
        sum
    }

    /// The squares are those over the covariance matrix, with a place left out; a noise that forgets a little faster
    /// has others.
    #[test]
    fn squares_over_the_noise_are_those_of_its_covariance() {
        let (noise, x) = (noise(), [0.3, -1.2, 0.8, 2.0, 50.0]);
        let covariance = |tau_s: f64| -> Vec<Vec<f64>> {
            let of = |a: usize, b: usize| {
                let apart_s = (noise.times_s[a] - noise.times_s[b]).abs();
                let [slow, passing] = [0, 1].map(|axis| noise.axes[axis].um[a] * noise.axes[axis].um[b]);
                let own = if a == b { 0.16 + noise.bent_um2[a] } else { 0.0 };
                own + slow * (-apart_s / tau_s).exp() + if apart_s == 0.0 { passing } else { 0.0 }
            };
            (0..4).map(|a| (0..4).map(|b| of(a, b)).collect()).collect()
        };
        let found: f64 = noise.over(&x, |place| place < 4).iter().map(|over| over * over).sum();
        let [right, other] = [TAU_S, 1.01 * TAU_S].map(|tau_s| squares_over(&covariance(tau_s), &x[..4]));
        assert!((found / right - 1.0).abs() < 1e-12, "{found} not {right}");
        assert!((found / other - 1.0).abs() > 1e-4, "{found} is {other} as well");
        let alone = Noise::of_values(0.4).over(&x, |_| true);
        assert_eq!(alone, x.map(|x| x / 0.4));
    }
}
