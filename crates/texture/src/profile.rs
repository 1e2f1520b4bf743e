//! Profile parameters of a line after its chain (ISO 21920-2:2021): Ra Rq Rsk Rku Rt Rp Rv Rz Rzx Rdq RSm Rk Rpk Rvk
//! Rmrk1 Rmrk2 Rmr(c), and the same of a primary or a waviness profile.
//!
//! In: heights about the reference line, which the chain made the line z = 0, and how the line is divided into
//! sections.
//!
//! - Ra, Rq, Rsk, Rku, Rt, Rdq, RSm and what is read from the material ratio curve belong to the evaluation length.
//! - Rp, Rv and Rz are means over the sections of their highest peak, their deepest pit, and both together.
//! - Rzx is the largest height within one section's length anywhere on the line, moved point by point.
//! - Rdq: slopes by seven points, `(z[3] - 9 z[2] + 45 z[1] - 45 z[-1] + 9 z[-2] - z[-3]) / 60 dx` (ISO 4287, 4.4.1).
//! - RSm: `elements`.
//! - Rk and its kin: the construction of [`crate::core`] on the line's heights.

use super::core::Core;
use super::elements::spacing;
use super::ratio::MaterialRatio;
use crate::error::TextureError;
use std::collections::VecDeque;

/// Profile parameters; heights in um, ratios in per cent.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Arithmetical mean height.
    pub a: f64,
    /// Root mean square height.
    pub q: f64,
    /// Skewness; NaN on a flat line.
    pub sk: f64,
    /// Kurtosis; NaN on a flat line.
    pub ku: f64,
    /// Height of the whole line.
    pub t: f64,
    /// Mean of the highest peaks of the sections.
    pub p: f64,
    /// Mean of the deepest pits of the sections.
    pub v: f64,
    /// Mean of the heights of the sections.
    pub z: f64,
    /// Largest height within a section's length anywhere.
    pub zx: f64,
    /// Root mean square slope, 1.
    pub dq: f64,
    /// Mean spacing of profile elements, um, or why there is none.
    pub sm: Result<f64, TextureError>,
    /// Core: Rk, Rpk, Rvk, Rmrk1, Rmrk2.
    pub core: Core,
    /// Material ratio curve about the reference line.
    pub curve: MaterialRatio,
}

impl Profile {
    /// Of heights over the reference line, which are divided into so many sections of equal length.
    pub(crate) fn of(z: &[f64], spacing_um: f64, sections: usize) -> Self {
        let n = z.len();
        let mean_of = |f: &dyn Fn(f64) -> f64| z.iter().map(|&z| f(z)).sum::<f64>() / n as f64;
        let q = mean_of(&|z| z * z).sqrt();
        let [low, high] = ends(z);
        let t = high - low;
        // Neighbouring sections share the point on their border, so that both directions have the same ones.
        let section = (n - 1) as f64 / sections as f64;
        let border = |i: usize| (i as f64 * section).round() as usize;
        let parts: Vec<[f64; 2]> = (0..sections).map(|i| ends(&z[border(i)..=border(i + 1)])).collect();
        let mean = |f: &dyn Fn([f64; 2]) -> f64| parts.iter().map(|&part| f(part)).sum::<f64>() / sections as f64;
        let height = mean(&|[low, high]| high - low);
        let over = |power: i32| if t == 0.0 { f64::NAN } else { mean_of(&|z| z.powi(power)) / q.powi(power) };
        let curve = MaterialRatio::of_heights(z);
        Self {
            a: mean_of(&f64::abs),
            q,
            sk: over(3),
            ku: over(4),
            t,
            p: mean(&|[_, high]| high),
            v: mean(&|[low, _]| -low),
            z: height,
            zx: moving_height(z, section as usize + 1),
            dq: slope(z) / spacing_um,
            sm: spacing(z, spacing_um, section, height),
            core: Core::of(&curve),
            curve,
        }
    }
}

fn ends(z: &[f64]) -> [f64; 2] {
    z.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &z| [low.min(z), high.max(z)])
}

/// Largest difference between two of so many neighbouring points.
fn moving_height(z: &[f64], points: usize) -> f64 {
    // Places that can still be the highest or the lowest of the window, the best first.
    let mut kept: [VecDeque<usize>; 2] = [VecDeque::new(), VecDeque::new()];
    let mut largest = 0.0_f64;
    for i in 0..z.len() {
        for (places, sign) in kept.iter_mut().zip([1.0, -1.0]) {
            while places.back().is_some_and(|&last| sign * z[last] <= sign * z[i]) {
                places.pop_back();
            }
            places.push_back(i);
            if places[0] + points <= i {
                places.pop_front();
            }
        }
        largest = largest.max(z[kept[0][0]] - z[kept[1][0]]);
    }
    largest
}

/// Root mean square slope per point.
fn slope(z: &[f64]) -> f64 {
    let squares = z.windows(7).map(|w| {
        let slope = (w[6] - 9.0 * w[5] + 45.0 * w[4] - 45.0 * w[2] + 9.0 * w[1] - w[0]) / 60.0;
        slope * slope
    });
    (squares.sum::<f64>() / (z.len() - 6) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn near(value: f64, closed: f64, share: f64) {
        assert!((value - closed).abs() <= share * closed.abs(), "{value} is not {closed}");
    }

    #[test]
    fn a_sine_has_its_closed_forms() {
        // 20 waves of 500 points, amplitude 2 um, 0.05 um apart.
        let line: Vec<f64> = (0..10_000).map(|i| 2.0 * (TAU * (f64::from(i) + 0.3) / 500.0).sin()).collect();
        let profile = Profile::of(&line, 0.05, 5);
        near(profile.a, 4.0 / PI, 1e-5);
        near(profile.q, 2_f64.sqrt(), 1e-9);
        near(profile.ku, 1.5, 1e-9);
        // Three points at either end have no slope.
        near(profile.dq, 2_f64.sqrt() * TAU / 25.0, 5e-4);
        near(profile.sm.expect("whole waves"), 25.0, 1e-9);
        near(profile.core.sk, 1.7747 * 2.0, 1e-3);
        for (height, closed) in
            [(profile.z, 4.0), (profile.zx, 4.0), (profile.t, 4.0), (profile.p, 2.0), (profile.v, 2.0)]
        {
            near(height, closed, 1e-4);
        }
        // Material at or above half the amplitude: a third.
        near(profile.curve.smr_percent(1.0), 100.0 / 3.0, 3e-3);
        assert!(profile.sk.abs() < 1e-9);
    }

    /// A triangle of height 3 um: uniform heights, whose curve is a straight line.
    #[test]
    fn a_triangle_has_its_closed_forms() {
        let at = |i: i32| 1.5 - 3.0 * (f64::from((2 * i + 1) % 2000) / 1000.0 - 1.0).abs();
        let line: Vec<f64> = (0..20_000).map(at).collect();
        let profile = Profile::of(&line, 0.1, 5);
        near(profile.a, 0.75, 1e-5);
        near(profile.q, 3_f64.sqrt() / 2.0, 1e-5);
        near(profile.ku, 1.8, 1e-5);
        near(profile.dq, 3.0 / 50.0, 2e-3);
        near(profile.sm.expect("whole waves"), 100.0, 1e-9);
        near(profile.core.sk, 3.0, 1e-3);
        near(profile.z, 3.0, 2e-3);
        assert!(profile.core.spk < 1e-3 && profile.core.svk < 1e-3 && profile.sk.abs() < 1e-9);
    }

    /// Gaussian heights in a shuffled order: Rk 2.57396, Rpk and Rvk 0.94503, Rmrk1 9.905 % and Ra 0.79788 of Rq.
    #[test]
    fn random_heights_have_the_known_core() {
        let n = 20_011_u64;
        let quantile = |p: f64| {
            // Bisection of the error function's integral by its series.
            let phi = |x: f64| {
                let (mut term, mut sum) = (x, x);
                for k in 1..200 {
                    term *= -x * x / (2.0 * f64::from(k));
                    sum += term / f64::from(2 * k + 1);
                }
                0.5 + sum / TAU.sqrt()
            };
            let (mut low, mut high) = (-6.0, 6.0);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if phi(middle) < p { low = middle } else { high = middle }
            }
            low
        };
        let line: Vec<f64> = (0..n).map(|i| quantile(((i * 7919 % n) as f64 + 0.5) / n as f64)).collect();
        let profile = Profile::of(&line, 1.0, 5);
        near(profile.a, 0.797_88, 1e-3);
        near(profile.core.sk, 2.573_96, 2e-3);
        near(profile.core.spk, 0.945_03, 5e-3);
        near(profile.core.svk, 0.945_03, 5e-3);
        near(profile.core.smr1, 9.905, 5e-3);
        near(profile.core.smr2, 90.095, 1e-3);
    }

    /// A peak before and a pit behind the border of two sections: no section has the whole height, the moving one does.
    #[test]
    fn the_largest_height_is_found_across_the_borders_of_sections() {
        let mut line = vec![0.0; 100];
        (line[19], line[21]) = (3.0, -4.0);
        let profile = Profile::of(&line, 1.0, 5);
        assert_eq!((profile.zx, profile.t), (7.0, 7.0));
        assert_eq!((profile.z, profile.p, profile.v), (7.0 / 5.0, 3.0 / 5.0, 4.0 / 5.0));
        // Further apart than a section they are never seen together.
        let mut far = vec![0.0; 100];
        (far[10], far[30]) = (3.0, -4.0);
        assert_eq!(Profile::of(&far, 1.0, 5).zx, 4.0);
    }

    #[test]
    fn a_flat_line_has_no_skewness() {
        let flat = Profile::of(&[0.0; 50], 1.0, 5);
        assert!(flat.sk.is_nan() && flat.ku.is_nan() && flat.sm.is_err() && flat.a == 0.0);
    }
}
