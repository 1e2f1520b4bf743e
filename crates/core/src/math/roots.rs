//! Roots within brackets: nothing but signs is needed, and nothing can fail.
//!
//! In: a function or a condition, and two values between which it changes once. Out: the place, to the accuracy asked
//! for or to the last bit. Kinks and jumps (a spline's third derivative) do no harm.
//!
//! [`sign_changes`] finds its brackets itself, all round a turn; the function must be sampled densely enough that no
//! two changes fall between neighbours.

use crate::units::TURN_RAD;
use std::convert::Infallible;

/// A place where a periodic function changes sign.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SignChange {
    /// Where, in [0, 2 pi).
    pub phi_rad: f64,
    /// From negative to positive.
    pub rising: bool,
}

/// As many halvings as any bracket of finite numbers can take: after them its ends are neighbours.
const TO_THE_LAST_BIT: u32 = 2200;
/// Steps of [`regula_falsi`] before only halving is left: it mostly takes ten.
const MOST_SECANTS: u32 = 200;

/// The bracket of a condition that holds at `inside` and, once it has ceased, up to `outside`, after some halvings: its
/// new ends, in this order. It is narrower by 2^-`halvings`, or its ends are neighbouring numbers. One evaluation per
/// halving.
pub fn halve(mut holds: impl FnMut(f64) -> bool, inside: f64, outside: f64, halvings: u32) -> [f64; 2] {
    let Ok(bracket) = try_halve(|x| Ok::<_, Infallible>(holds(x)), inside, outside, halvings);
    bracket
}

/// [`halve`] for a condition that may have no answer.
///
/// # Errors
/// The condition's.
pub fn try_halve<E>(
    mut holds: impl FnMut(f64) -> Result<bool, E>,
    mut inside: f64,
    mut outside: f64,
    halvings: u32,
) -> Result<[f64; 2], E> {
    for _ in 0..halvings {
        let middle = 0.5 * (inside + outside);
        if middle == inside || middle == outside {
            break;
        }
        if holds(middle)? {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    Ok([inside, outside])
}

/// The place between `lo` and `hi` where `is_low` turns from true to false, to the last bit.
pub fn bisect(is_low: impl FnMut(f64) -> bool, lo: f64, hi: f64) -> f64 {
    let [lo, hi] = halve(is_low, lo, hi, TO_THE_LAST_BIT);
    0.5 * (lo + hi)
}

/// [`bisect`] for a condition that may have no answer.
///
/// # Errors
/// The condition's.
pub fn try_bisect<E>(is_low: impl FnMut(f64) -> Result<bool, E>, lo: f64, hi: f64) -> Result<f64, E> {
    let [lo, hi] = try_halve(is_low, lo, hi, TO_THE_LAST_BIT)?;
    Ok(0.5 * (lo + hi))
}

/// Zero of a function that is at most 0 at `from` and at least 0 at `to`: where it is nearer to 0 than `residual`, or
/// to some 1e-14 of the place. `None` where the function does not change its sign nor is so near to 0 at an end, or is
/// not a number.
///
/// Regula falsi with the value at the end that stays halved (Illinois rule), so that both ends close in; after 200
/// steps the bracket is halved to the last bit.
pub fn regula_falsi(mut f: impl FnMut(f64) -> f64, from: f64, to: f64, residual: f64) -> Option<f64> {
    let (mut a, mut b) = (from, to);
    let (mut f_a, mut f_b) = (f(a), f(b));
    if !(f_a <= 0.0 && f_b >= 0.0) {
        return [(from, f_a), (to, f_b)].into_iter().find_map(|(end, f)| (f.abs() < residual).then_some(end));
    }
    for _ in 0..MOST_SECANTS {
        if f_b == f_a || (b - a).abs() < 1e-14 * (1.0 + a.abs()) {
            return Some(0.5 * (a + b));
        }
        let secant = (a * f_b - b * f_a) / (f_b - f_a);
        let x = if secant.is_finite() { secant } else { 0.5 * (a + b) };
        let f_x = f(x);
        if f_x.is_nan() {
            return None;
        }
        if f_x.abs() < residual {
            return Some(x);
        }
        if f_x < 0.0 {
            (a, f_a) = (x, f_x);
            f_b *= 0.5;
        } else {
            (b, f_b) = (x, f_x);
            f_a *= 0.5;
        }
    }
    Some(bisect(|x| f(x) < 0.0, a, b))
}

/// Sample angles of one turn. The grid is shifted off zero, because curves with symmetric lobes have their extrema on
/// round fractions of the turn, where the sign would be a matter of rounding.
pub fn sample_angle_rad(index: usize, samples: usize) -> f64 {
    (index as f64 - 0.381_966) * TURN_RAD / samples as f64
}

/// All sign changes of a 2 pi-periodic function in one turn, in increasing order.
pub fn sign_changes(f: impl Fn(f64) -> f64, samples: usize) -> Vec<SignChange> {
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
    fn brackets_close_as_far_as_asked() {
        let is_low = |x: f64| x * x < 2.0;
        let [low, high] = halve(is_low, 1.0, 2.0, 10);
        assert!(high - low == 1.0 / 1024.0 && low * low < 2.0 && high * high >= 2.0);
        let [low, high] = halve(is_low, 1.0, 2.0, 100);
        assert_eq!(low.next_up(), high);
        // From the other side, and across zero.
        assert_eq!(halve(|x: f64| x * x > 2.0, 2.0, 1.0, 100)[0], high);
        assert!((bisect(is_low, 0.0, 1e300) - 2.0_f64.sqrt()).abs() < 1e-15);
        assert!(bisect(|x| x < 0.0, -1.0, 3.0).abs() < f64::MIN_POSITIVE);
        assert!(bisect(|_| true, f64::NAN, 1.0).is_nan());
    }

    #[test]
    fn a_condition_without_an_answer_is_reported() {
        let asked = |x: f64| if x > 1.4 { Err(x) } else { Ok(true) };
        assert_eq!(try_halve(asked, 1.0, 2.0, 100), Err(1.5));
    }

    #[test]
    fn regula_falsi_finds_zeros_of_either_direction() {
        for (from, to) in [(0.0, 3.0), (3.0, 0.0)] {
            let f = |x: f64| (x * x - 2.0) * f64::signum(to - from);
            assert!((regula_falsi(f, from, to, 1e-13).unwrap() - 2.0_f64.sqrt()).abs() < 1e-13);
        }
        assert_eq!(regula_falsi(|x| x * x + 1.0, -1.0, 2.0, 1e-13), None);
        assert_eq!(regula_falsi(|x| x - 2.0 - 1e-15, 0.0, 2.0, 1e-13), Some(2.0));
        assert_eq!(regula_falsi(|_| f64::NAN, -1.0, 2.0, 1e-13), None);
    }

    /// No value of a jump is near zero, and secants towards a pole creep.
    #[test]
    fn jumps_and_poles_are_bracketed() {
        let jump = regula_falsi(|x| if x < 0.3 { -1.0 } else { 1e9 }, 0.0, 1.0, 1e-13).unwrap();
        assert!((jump - 0.3).abs() < 1e-13, "{jump}");
        let pole = regula_falsi(|x: f64| (x - 0.7).powi(-3).max(-1e300), 0.0, 1.0, 1e-13).unwrap();
        assert!((pole - 0.7).abs() < 1e-13, "{pole}");
    }

    #[test]
    fn a_constant_has_none() {
        assert!(sign_changes(|_| 0.0, 100).is_empty());
    }
}
