//! Width of 95 % intervals of numbers that were fitted, and the distribution behind them.
//!
//! In: degrees of freedom. Out: half the width over the standard deviation; the share below so many of them.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// Chance beyond either end of a 95 % interval.
pub const TAIL: f64 = 0.025;
/// Degrees from which Student's t is taken as normal; its quantiles are not found any more in the millions.
const MANY_DEGREES: usize = 1000;

/// Half the width of a 95 % interval over the standard deviation: Student's t of so many degrees. From a thousand
/// degrees on it is the normal distribution's, 0.1 % less, and without freedom, where the deviation is stated and not
/// found.
pub fn interval(freedom: usize) -> f64 {
    if freedom == 0 || freedom >= MANY_DEGREES {
        return Normal::standard().inverse_cdf(1.0 - TAIL);
    }
    StudentsT::new(0.0, 1.0, freedom as f64).expect("freedom is above 0").inverse_cdf(1.0 - TAIL)
}

/// Chance below so many standard deviations from the fitted number, by the same distributions.
pub fn share_below(deviations: f64, freedom: usize) -> f64 {
    if freedom == 0 || freedom >= MANY_DEGREES {
        return Normal::standard().cdf(deviations);
    }
    StudentsT::new(0.0, 1.0, freedom as f64).expect("freedom is above 0").cdf(deviations)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Abramowitz and Stegun, *Handbook of Mathematical Functions*, 1964, table 26.10.
    #[test]
    fn intervals_are_those_of_tables() {
        for (freedom, expected) in [(1, 12.706), (5, 2.571), (30, 2.042), (120, 1.980), (1_000_000, 1.960), (0, 1.960)]
        {
            assert!((interval(freedom) - expected).abs() < 6e-4, "{freedom}: {}", interval(freedom));
            let below = share_below(expected, freedom);
            assert!((below - 0.975).abs() < 3e-5, "{freedom}: {below}");
        }
    }
}
