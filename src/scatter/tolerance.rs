//! Tolerances: keys of the scene whose values differ from gear to gear.
//!
//! In: keys with two limits, and the seed of a gear. Out: the settings of that gear.
//!
//! Law: of a size that is only known to lie within its limits every value is as likely as any other (JCGM 100:2008,
//! 4.3.7). It follows from the seed and from the tolerance's place among the others ([`crate::random`]), so that equal
//! seeds give equal gears, whatever the number of threads.
//!
//! Road not taken: normal distributions. They need a deviation, which no drawing gives, and go beyond the limits.

use crate::random::Draws;
use std::str::FromStr;

/// The random numbers of tolerances: no axis, stock or edge draws from here.
const SOURCE: u32 = u32::MAX;

/// A key and the limits of its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerance {
    /// Path of the key, such as `mounting.eccentricity_um`.
    pub key: String,
    /// Smallest and largest value, in the key's unit.
    pub limits: [f64; 2],
}

impl FromStr for Tolerance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form = || format!("`{text}` is no tolerance: write KEY=LOW..HIGH, such as mounting.eccentricity_um=0..10");
        let (key, limits) = text.split_once('=').ok_or_else(form)?;
        let (low, high) = limits.split_once("..").ok_or_else(form)?;
        let number = |limit: &str| limit.trim().parse::<f64>().ok().filter(|limit| limit.is_finite()).ok_or_else(form);
        let limits = [number(low)?, number(high)?];
        if limits[0] >= limits[1] {
            return Err(format!("`{text}`: the first limit must be smaller than the second one"));
        }
        Ok(Self { key: key.trim().to_owned(), limits })
    }
}

impl Tolerance {
    /// The value in the gear of a seed; `place` counts this tolerance among the others.
    pub fn value(&self, place: usize, seed: u32) -> f64 {
        let share = Draws::new(seed, SOURCE).even([place as i64, 0])();
        self.limits[0] + share * (self.limits[1] - self.limits[0])
    }

    /// A value of the key as a setting of the scene.
    pub fn setting(&self, value: f64) -> String {
        // Debug writes every number so that it reads back as the same, and as a number of TOML.
        format!("{}={value:?}", self.key)
    }
}

/// The settings of the gear of a seed.
pub fn settings(tolerances: &[Tolerance], seed: u32) -> impl Iterator<Item = String> + '_ {
    tolerances.iter().enumerate().map(move |(place, tolerance)| tolerance.setting(tolerance.value(place, seed)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean and variance of an even distribution between a and b: (a + b) / 2, (b - a)^2 / 12. Of n values the mean
    /// scatters by sqrt(1 / 12 n) of the range, the variance by sqrt(1 / 180 n) of its square (fourth moment 1 / 80);
    /// four times that is allowed. Neighbouring tolerances of one gear have nothing to do with each other.
    #[test]
    fn values_are_even_between_their_limits() {
        let tolerance: Tolerance = "a.b_um=-2..6".parse().expect("a tolerance");
        assert_eq!((tolerance.key.as_str(), tolerance.limits), ("a.b_um", [-2.0, 6.0]));
        let n = 20_000;
        let values = |place| (1..=n).map(|seed| tolerance.value(place, seed)).collect::<Vec<_>>();
        let (first, second) = (values(0), values(1));
        assert!(first.iter().all(|value| (-2.0..=6.0).contains(value)));
        let count = f64::from(n);
        let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
        let covariance = |a: &[f64], b: &[f64]| {
            let (of_a, of_b) = (mean(a), mean(b));
            a.iter().zip(b).map(|(a, b)| (a - of_a) * (b - of_b)).sum::<f64>() / count
        };
        assert!((mean(&first) - 2.0).abs() < 4.0 * 8.0 / (12.0 * count).sqrt());
        assert!((covariance(&first, &first) - 64.0 / 12.0).abs() < 4.0 * 64.0 / (180.0 * count).sqrt());
        assert!(covariance(&first, &second).abs() < 4.0 * (64.0 / 12.0) / count.sqrt());
        assert_eq!(values(0), first);
    }

    #[test]
    fn what_is_no_tolerance_is_refused() {
        for text in ["a", "a=1", "a=1..x", "a=2..1", "a=1..1", "a=nan..2", "a=0..inf"] {
            assert!(text.parse::<Tolerance>().is_err(), "{text}");
        }
    }

    #[test]
    fn settings_read_back_as_the_same_numbers() {
        let tolerance = Tolerance { key: "a".to_owned(), limits: [1e-12, 3e-12] };
        for setting in (1..50).flat_map(|seed| settings(std::slice::from_ref(&tolerance), seed).collect::<Vec<_>>()) {
            let value: toml::Table = setting.parse().expect("TOML");
            assert!(value["a"].as_float().is_some_and(|value| (1e-12..=3e-12).contains(&value)), "{setting}");
        }
    }
}
