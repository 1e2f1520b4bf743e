//! Noise that goes on within a stroke, and how far the cubics of strokes follow it.
//!
//! In: how the ram passes the face, the bandwidth of a noise. Out: by which share of its standard deviation a stroke
//! leaves the noise in the mean over the face, and a warning where that is much.
//!
//! A stroke keeps its pose as the cubic p through four places of the face ([`gearcut_core::passes::planar::strokes`]).
//! Law: noise of the autocovariance rho(dt) = exp(-2 pi f_c |dt|) is n_i at those places; with Lagrange's polynomials
//! l_i the cubic is sum l_i n_i, and the mean square of n - p at a place is
//!
//! ```text
//! 1 - 2 sum l_i rho(t - t_i) + sum l_i l_j rho(t_i - t_j)
//! ```
//!
//! At the four places a stroke has the noise itself, however fast that is, and what two of them differ by is the
//! noise's own. What lies between is too smooth: the helix of a fast noise is cut with four random places instead of
//! many. Road not taken: a refusal, as on machines whose tool is in the work all the time. There the whole surface
//! hangs on the polynomial; here it is right stroke by stroke.

use crate::findings::Notice;
use crate::machine_errors::NoiseLaw;
use crate::number_text::significant;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::linkage::dynamics::AXES;
use crate::process::shaping::notices::FastNoise;
use gearcut_core::math::roots::bisect;
use gearcut_core::passes::planar::strokes::{NODES, StrokeLaw, cubic_through};
use std::f64::consts::TAU;

/// Share of the standard deviation up to which strokes are said to follow a noise: that of machines whose tool is in
/// the work all the time.
const MOST_APART: f64 = 0.1;
/// Places of the face over which the mean is taken, but for one.
const PLACES: u32 = 64;
/// Bandwidths between which the fastest one that strokes follow is sought, Hz: those that a scene may name.
const BANDWIDTHS_HZ: [f64; 2] = [1e-6, 1e6];

/// The face as strokes pass it.
struct Face {
    /// How places become phases of the cubic.
    law: StrokeLaw,
    /// How places become times.
    crank: StrokeLaw,
    width_mm: f64,
    stroke_s: f64,
}

impl Face {
    /// Time at a phase from the stroke's own moment on, s.
    fn time_s(&self, tau: f64) -> f64 {
        self.crank.stroke_share(self.crank.tau(self.law.z_mm(tau))) * self.stroke_s
    }

    /// Distance of a noise from the cubics of strokes over its standard deviation; root mean square over places that
    /// are even over the face, so many from one end to the other.
    fn apart(&self, bandwidth_hz: f64, places: u32) -> f64 {
        let rho = |from_s: f64, to_s: f64| (-TAU * bandwidth_hz * (to_s - from_s).abs()).exp();
        let nodes_s = NODES.map(|tau| self.time_s(tau));
        let polynomials = [0, 1, 2, 3].map(|node| cubic_through(&[0, 1, 2, 3].map(|of| f64::from(of == node))));
        let square = |z_mm: f64| {
            let tau = self.law.tau(z_mm);
            let time_s = self.time_s(tau);
            let weights = polynomials.map(|[a, b, c, d]| a + tau * (b + tau * (c + tau * d)));
            let with_nodes: f64 =
                weights.iter().zip(nodes_s).map(|(weight, node_s)| weight * rho(time_s, node_s)).sum();
            let of_nodes = weights
                .iter()
                .zip(nodes_s)
                .flat_map(|(a, from_s)| weights.iter().zip(nodes_s).map(move |(b, to_s)| a * b * rho(from_s, to_s)));
            1.0 - 2.0 * with_nodes + of_nodes.sum::<f64>()
        };
        let squares = (0..=places).map(|place| square(self.width_mm * (f64::from(place) / f64::from(places) - 0.5)));
        // Rounding may leave less than nothing of a slow noise.
        (squares.sum::<f64>() / f64::from(places + 1)).max(0.0).sqrt()
    }
}

/// Noise that strokes do not follow, operation by operation.
pub fn warnings(job: &ShapingJob) -> Vec<Notice> {
    let width_mm = job.scene.gear.face_width_mm;
    let crank = job.machine.crank(width_mm);
    let mut warnings = Vec::new();
    for operation in &job.operations {
        let face = Face { law: operation.strokes.law, crank, width_mm, stroke_s: operation.schedule.time_s(1.0) };
        for (errors, axis) in job.machine.errors.axes.iter().zip(&AXES) {
            for noise in &errors.noise {
                let NoiseLaw::InTime { bandwidth_hz } = noise.law else { continue };
                let apart = face.apart(bandwidth_hz, PLACES);
                if apart <= MOST_APART {
                    continue;
                }
                let most_hz = bisect(|hz| face.apart(hz, PLACES) < MOST_APART, BANDWIDTHS_HZ[0], BANDWIDTHS_HZ[1]);
                let fast = FastNoise {
                    operation: &operation.spec.name,
                    axis: axis.name,
                    bandwidth_hz: significant(bandwidth_hz, 3),
                    apart: significant(apart, 2),
                    most_hz: significant(most_hz, 2),
                    most_apart: MOST_APART,
                };
                warnings.push(fast.notice());
            }
        }
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine_errors::AxisNoise;
    use crate::random::Draws;

    fn faces() -> [Face; 2] {
        let (width_mm, stroke_s) = (20.0, 0.2);
        let crank = StrokeLaw::crank(width_mm, 5.0, 3.0);
        let guided = StrokeLaw::Guided { half_face_mm: 0.5 * width_mm };
        [guided, crank].map(|law| Face { law, crank, width_mm, stroke_s })
    }

    /// Noise that is drawn, through the cubics that strokes keep of it. Strokes are 64 time constants apart and more,
    /// so that each has its own. Of 4000 strokes with three independent places each the mean square scatters by 1.3 %,
    /// its root by half of that: three times that.
    #[test]
    fn drawn_noise_leaves_its_cubics_by_as_much() {
        let last = 8_u32;
        for (face, bandwidth_hz) in faces().iter().flat_map(|face| [1.0, 40.0].map(|hz| (face, hz))) {
            let noise = AxisNoise { deviation: 1.0, law: NoiseLaw::InTime { bandwidth_hz }, draws: Draws::new(3, 1) };
            let apart_s = face.stroke_s + 64.0 / (TAU * bandwidth_hz);
            let (mut sum, mut count) = (0.0, 0.0);
            for stroke in 0..4000 {
                let at = |tau: f64| noise.at(f64::from(stroke) * apart_s + face.time_s(tau), 0);
                let [a, b, c, d] = cubic_through(&NODES.map(at));
                for place in 0..=last {
                    let tau = face.law.tau(face.width_mm * (f64::from(place) / f64::from(last) - 0.5));
                    sum += (at(tau) - a - tau * (b + tau * (c + tau * d))).powi(2);
                    count += 1.0;
                }
            }
            let (found, expected) = (f64::sqrt(sum / count), face.apart(bandwidth_hz, last));
            println!("{:?}, {bandwidth_hz} Hz: {found:.4}, {expected:.4} expected", face.law);
            assert!((found / expected - 1.0).abs() < 0.02, "{found} of {expected}");
            // Planted: a noise half as fast.
            assert!((found / face.apart(0.5 * bandwidth_hz, last) - 1.0).abs() > 0.02);
        }
    }
}
