//! Sign changes of functions of one angle.
//!
//! In: a function, sampled densely enough that no two sign changes fall between neighbours. Out: the places, to rounding.
//! Bisection: it needs only signs, so that kinks and jumps (a spline's third derivative) do no harm. The road not taken is
//! Newton's iteration; these roots are found a few dozen times per scene, and never fail this way.

use crate::units::TURN_RAD;

/// A place where a periodic function changes sign.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SignChange {
    /// Where, in [0, 2 pi).
    pub(crate) phi_rad: f64,
    /// From negative to positive.
    pub(crate) rising: bool,
}

/// The place between `lo` and `hi` where `is_low` turns from true to false, to the last bit.
pub(crate) fn bisect(is_low: impl Fn(f64) -> bool, mut lo: f64, mut hi: f64) -> f64 {
    loop {
        let mid = f64::midpoint(lo, hi);
        if mid <= lo || mid >= hi {
            return mid;
        }
        if is_low(mid) {
            lo = mid;
        } else {
            hi = mid;
        }
    }
}

/// Sample angles of one turn. The grid is shifted off zero, because curves with symmetric lobes have their extrema on round
/// fractions of the turn, where the sign would be a matter of rounding.
pub(crate) fn sample_angle_rad(index: usize, samples: usize) -> f64 {
    (index as f64 - 0.381_966) * TURN_RAD / samples as f64
}

/// All sign changes of a 2 pi-periodic function in one turn, in increasing order.
pub(crate) fn sign_changes(f: impl Fn(f64) -> f64, samples: usize) -> Vec<SignChange> {
    let mut found = Vec::new();
    let mut before = f(sample_angle_rad(0, samples));
    for i in 1..=samples {
        let here = f(sample_angle_rad(i, samples));
        if before * here < 0.0 {
            let rising = here > 0.0;
            let (lo, hi) = (sample_angle_rad(i - 1, samples), sample_angle_rad(i, samples));
            let phi_rad = bisect(|phi| (f(phi) < 0.0) == rising, lo, hi).rem_euclid(TURN_RAD);
            found.push(SignChange { phi_rad, rising });
        }
        if here != 0.0 {
            before = here;
        }
    }
    found.sort_by(|a, b| a.phi_rad.total_cmp(&b.phi_rad));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_every_change_of_a_wave() {
        let changes = sign_changes(|phi| (3.0 * phi - 0.1).sin(), 100);
        assert_eq!(changes.len(), 6);
        for (i, change) in changes.iter().enumerate() {
            let expected = (i as f64 * std::f64::consts::PI + 0.1) / 3.0;
            assert!((change.phi_rad - expected).abs() < 1e-14, "{} not {expected}", change.phi_rad);
            assert_eq!(change.rising, i % 2 == 0);
        }
    }

    #[test]
    fn a_constant_has_none() {
        assert!(sign_changes(|_| 0.0, 100).is_empty());
    }
}
