//! The material probability curve: Spq, Svq, Smq (ISO 25178-2:2021, after ISO 13565-3).
//!
//! In: the material ratio curve. Out: [`Probability`], or why the surface is not of two strata. Law: heights over the
//! standard deviations s at which a normal distribution has their material ratio. A normally distributed surface is a
//! straight line there, of slope minus its standard deviation; a plateau over the dales of a coarser surface is two
//! lines, the upper one flatter. Spq and Svq are the slopes of both, Smq the material ratio where they meet.
//!
//! 1. The curve is sampled at equal steps of s, from -3 to 3 or as far as five heights lie beyond.
//! 2. A conic section `z = A s^2 + B s z + C z^2 + D s + E` is fitted by least squares, both axes from -1 to 1. It must
//!    be a hyperbola.
//! 3. The angle of its asymptotes is halved three times towards either of them. What lies beyond the points where these
//!    lines meet the hyperbola is straight: plateau and dales.
//! 4. A least-squares line through each.
//!
//! This is the way of ISO 13565-3, whose wording was not at hand: its limits against outlying peaks and pits, from
//! second derivatives, are replaced by the ends of step 1. Where the slopes differ by less than a fifth, or the dales
//! are the flatter part (feed marks are hills on a plain), there are no two strata.

use super::ratio::MaterialRatio;
use crate::error::TextureError;
use std::f64::consts::TAU;

/// Standard deviations on either side.
const ENDS: f64 = 3.0;
/// Steps from end to end.
const STEPS: usize = 1200;
/// A step, the ends being -1 and 1.
const STEP: f64 = 2.0 / STEPS as f64;
/// Heights that lie beyond the ends.
const BEYOND: f64 = 5.0;
/// Samples that a line is fitted to at least: a quarter of a standard deviation.
const FEWEST: usize = STEPS / 24;
/// Slopes of two strata differ by more than this share: what waves of a surface of one stratum bend its curve by is
/// less.
const DIFFER: f64 = 0.2;

/// Both strata.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probability {
    /// Root mean square height of the plateau, um.
    pub spq: f64,
    /// Root mean square height of the dales, um.
    pub svq: f64,
    /// Material ratio where they meet, per cent.
    pub smq: f64,
}

impl Probability {
    /// Of a curve.
    ///
    /// # Errors
    /// Too few heights, or no two strata.
    pub fn of(curve: &MaterialRatio) -> Result<Self, TextureError> {
        let samples = samples(curve);
        if samples.len() < 2 * FEWEST {
            return Err(TextureError::ShortProbability { heights: curve.len() });
        }
        let ends = straight_parts(&samples).ok_or(TextureError::OneStratum)?;
        let plateau: Vec<[f64; 2]> = samples.iter().copied().filter(|[s, _]| *s <= ends[0]).collect();
        let dales: Vec<[f64; 2]> = samples.iter().copied().filter(|[s, _]| *s >= ends[1]).collect();
        if plateau.len().min(dales.len()) < FEWEST {
            return Err(TextureError::OneStratum);
        }
        let ([p0, p1], [d0, d1]) = (line(&plateau), line(&dales));
        if d1 > p1 * (1.0 + DIFFER) {
            return Err(TextureError::OneStratum);
        }
        let meet = (d0 - p0) / (p1 - d1);
        Ok(Self { spq: -p1, svq: -d1, smq: 100.0 * normal(meet) })
    }
}

/// Share of a standard normal distribution below `s`, by the series of its integral; exact to 1e-13 for the `s` used
/// here.
fn normal(s: f64) -> f64 {
    let (mut term, mut sum, mut odd) = (s, s, 1.0);
    while term.abs() > 1e-17 * sum.abs() {
        odd += 2.0;
        term *= s * s / odd;
        sum += term;
    }
    0.5 + sum * (-0.5 * s * s).exp() / TAU.sqrt()
}

/// Standard deviations and heights, um, from the highest part down.
fn samples(curve: &MaterialRatio) -> Vec<[f64; 2]> {
    let n = curve.len() as f64;
    let place = |i: usize| ENDS * (2.0 * i as f64 / STEPS as f64 - 1.0);
    let sample = |s: f64| {
        let ratio = normal(s);
        (ratio.min(1.0 - ratio) * n >= BEYOND).then(|| [s, curve.smc_um(100.0 * ratio)])
    };
    (0..=STEPS).map(place).filter_map(sample).collect()
}

/// Where the plateau ends and where the dales begin, in standard deviations.
fn straight_parts(samples: &[[f64; 2]]) -> Option<[f64; 2]> {
    let [first, last] = [samples[0], samples[samples.len() - 1]];
    let middle = [0, 1].map(|k| 0.5 * (first[k] + last[k]));
    let half = [0, 1].map(|k| 0.5 * (first[k] - last[k]).abs());
    if half[1] == 0.0 {
        return None;
    }
    let unit = |sample: &[f64; 2]| [0, 1].map(|k| (sample[k] - middle[k]) / half[k]);
    let [a, b, c, d, e] = conic(samples.iter().map(unit))?;
    // a s^2 + b s z + c z^2 + d s - z + e = 0: its middle, and the slopes of its asymptotes.
    let discriminant = b * b - 4.0 * a * c;
    if discriminant <= 0.0 {
        return None;
    }
    let center = [(2.0 * c * d + b) / discriminant, (-2.0 * a - b * d) / discriminant];
    // The roots of a + b t + c t^2 = 0.
    let root = discriminant.sqrt();
    let q = -0.5 * (b + if b < 0.0 { -root } else { root });
    let mut slopes = [q / c, a / q];
    slopes.sort_by(|a, b| b.total_cmp(a));
    // Both fall, the plateau less steeply.
    let [plateau, dales] = slopes;
    if !(plateau <= 0.0 && dales.is_finite()) {
        return None;
    }
    let (to_plateau, to_dales) = ((-plateau).atan2(-1.0), dales.atan2(1.0).rem_euclid(TAU));
    let eighth = 0.125 * (to_dales - to_plateau);
    let level = a * center[0] * center[0] + b * center[0] * center[1] + c * center[1] * center[1] + d * center[0]
        - center[1]
        + e;
    let meets = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        let along = -level / (a * cos * cos + b * cos * sin + c * sin * sin);
        // Two lines that cross are a hyperbola without bend; within a step it may open to either side.
        let along = if along.abs() < STEP * STEP { 0.0 } else { along };
        (along >= 0.0).then(|| middle[0] + half[0] * (center[0] + along.sqrt() * cos))
    };
    Some([meets(to_plateau + eighth)?, meets(to_dales - eighth)?])
}

/// Coefficients of `z = a s^2 + b s z + c z^2 + d s + e` by least squares.
fn conic(points: impl Iterator<Item = [f64; 2]>) -> Option<[f64; 5]> {
    let mut matrix = [[0.0; 7]; 6];
    for [s, z] in points {
        let row = [s * s, s * z, z * z, s, 1.0];
        for i in 0..5 {
            for k in 0..5 {
                matrix[i][k] += row[i] * row[k];
            }
            matrix[i][6] += row[i] * z;
        }
    }
    let [a, b, c, d, e, _] = super::form::solve(&mut matrix, 5)?;
    Some([a, b, c, d, e])
}

/// Height at 0 and slope of the line through points.
fn line(points: &[[f64; 2]]) -> [f64; 2] {
    let n = points.len() as f64;
    let [s, z] = [0, 1].map(|k| points.iter().map(|point| point[k]).sum::<f64>() / n);
    let (ss, sz) = points.iter().fold((0.0, 0.0), |(ss, sz), point| {
        (ss + (point[0] - s) * (point[0] - s), sz + (point[0] - s) * (point[1] - z))
    });
    [z - sz / ss * s, sz / ss]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Standard deviations of `n` ratios, by bisection of [`normal`].
    fn deviations(n: usize) -> impl Iterator<Item = f64> {
        (0..n).map(move |k| {
            let ratio = (k as f64 + 0.5) / n as f64;
            let (mut low, mut high) = (-6.0, 6.0);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if normal(middle) < ratio { low = middle } else { high = middle }
            }
            low
        })
    }

    fn of(heights: impl Iterator<Item = f64>) -> Result<Probability, TextureError> {
        Probability::of(&MaterialRatio::of_heights(&heights.collect::<Vec<_>>()))
    }

    /// Known values of the normal distribution.
    #[test]
    fn the_normal_distribution_has_its_tabled_values() {
        for (s, share) in
            [(0.0, 0.5), (1.0, 0.841_344_746_068_543), (-2.0, 0.022_750_131_948_179), (3.0, 0.998_650_101_968_370)]
        {
            assert!((normal(s) - share).abs() < 1e-14, "{s}: {}", normal(s));
        }
    }

    /// Two normal distributions, one of the highest heights and one of the rest, that meet at a ratio: the plateau's
    /// and the dales' standard deviations and the ratio are known.
    #[test]
    fn two_normal_strata_have_their_own_numbers() {
        for (spq, svq, smq) in [(0.1, 1.0, 80.0), (0.2, 0.6, 50.0), (0.3, 2.0, 90.0), (0.05, 1.0, 30.0)] {
            let s: Vec<f64> = deviations(200_000).collect();
            let meet = s[(smq * 2000.0) as usize];
            let heights = s.iter().map(|s| if *s < meet { -spq * (s - meet) } else { -svq * (s - meet) });
            let found = of(heights).expect("two strata");
            for (value, closed) in [(found.spq, spq), (found.svq, svq), (found.smq, smq)] {
                assert!((value / closed - 1.0).abs() < 1e-3, "{found:?}: {value} is not {closed}");
            }
        }
    }

    /// A plateau worked into a coarser surface: of both everywhere the lower one. Away from where they meet the curve
    /// tends to the lines of both.
    #[test]
    fn a_plateau_cut_into_a_coarse_surface_has_nearly_the_numbers_of_both() {
        let n = 40_009_u64;
        let s: Vec<f64> = deviations(n as usize).collect();
        let cut = |i: u64| {
            let (plateau, coarse) = (s[(i * 7919 % n) as usize], s[(i * i % n) as usize]);
            (0.1 * plateau).min(coarse + 1.5)
        };
        let found = of((0..n).map(cut)).expect("two strata");
        assert!((found.spq / 0.1 - 1.0).abs() < 0.15 && (found.svq - 1.0).abs() < 0.1, "{found:?}");
    }

    #[test]
    fn one_stratum_and_hills_on_a_plain_have_no_numbers() {
        let one = of(deviations(100_000)).expect_err("normal heights");
        assert!(one.to_string().contains("one stratum"), "{one}");
        let marks = (0..100_000).map(|i| (f64::from(i) / 50_000.0 - 1.0).powi(2));
        assert!(of(marks).is_err(), "feed marks");
        assert!(of(std::iter::repeat_n(1.0, 5000)).is_err(), "a flat surface");
        assert!(of((0..11).map(f64::from)).expect_err("few").to_string().contains("too few"));
    }
}
